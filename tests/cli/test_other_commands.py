"""`show`, `figure`, `scenarios`, `verify`, `schema`, `--version`, `--help`."""

import json
import subprocess
import sys

import pytest

from ellipsoid_planning import __version__
from ellipsoid_planning.scenario import bundled_scenarios, scenario_schema
from tests.cli.command import run

COMMANDS = ("plan", "show", "figure", "scenarios", "verify", "schema")


def test_version():
    done = run("--version")
    assert (done.returncode, done.stdout) == (0, f"ellipsoid-planning {__version__}\n")


def test_help_names_every_command_and_shows_examples():
    done = run("--help")
    assert done.returncode == 0
    for word in (*COMMANDS, "plan rabbit-3d-open --output", "Exit codes"):
        assert word in done.stdout


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_every_command(command):
    done = run(command, "--help")
    assert done.returncode == 0
    assert f"ellipsoid-planning {command}" in done.stdout


def test_help_loads_nothing_heavy():
    code = (
        "import sys\n"
        "from planners.cli.main import app\n"
        "try:\n    app(['plan', '--help'])\nexcept SystemExit:\n    pass\n"
        "heavy = {'numpy', 'numba', 'ompl', 'matplotlib', 'meshcat', 'fcl', 'scipy', 'ruamel'}\n"
        "sys.stderr.write(repr(heavy & set(sys.modules)))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr == "set()"


def test_help_loads_few_modules():
    # That is what makes it instant.
    code = (
        "import sys\n"
        "before = len(sys.modules)\n"
        "from planners.cli.main import app\n"
        "try:\n    app(['--help'])\nexcept SystemExit:\n    pass\n"
        "sys.stderr.write(str(len(sys.modules) - before))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert 50 < int(done.stderr) < 450


def test_scenarios_are_listed():
    done = run("scenarios")
    assert done.returncode == 0
    assert all(name in done.stdout for name in bundled_scenarios())


def test_the_schema_is_json():
    done = run("schema")
    assert done.returncode == 0
    assert json.loads(done.stdout) == scenario_schema()


def test_verify_accepts_what_was_planned(result_file):
    done = run("verify", result_file)
    assert done.returncode == 0, done.stdout
    assert "verified" in done.stdout
    assert "NOT VERIFIED" not in done.stdout


def edited(result_file, folder, change):
    """A copy of the result with something changed."""
    data = json.loads(result_file.read_text(encoding="utf-8"))
    change(data)
    file = folder / "edited.json"
    file.write_text(json.dumps(data), encoding="utf-8")
    return file


def test_verify_refuses_an_edited_length(result_file, tmp_path):
    file = edited(result_file, tmp_path, lambda data: data["path"].update(length=1.0))
    done = run("verify", file)
    assert done.returncode == 1
    assert "path.length" in done.stderr


def test_verify_refuses_an_overstated_clearance(result_file, tmp_path):
    file = edited(result_file, tmp_path, lambda data: data["path"].update(min_clearance=3.0))
    done = run("verify", file)
    assert done.returncode == 1
    assert "NOT VERIFIED" in done.stdout


def test_verify_refuses_a_scenario_that_was_exchanged(result_file, tmp_path):
    def move_pillar(data):
        data["scenario"]["obstacles"][0]["position"] = [-6.0, 1.0]

    done = run("verify", edited(result_file, tmp_path, move_pillar))
    assert done.returncode == 1
    assert "hits obstacle 'left'" in " ".join(done.stdout.split())


def test_verify_judges_against_a_scenario_of_one_s_own(result_file, tmp_path):
    document = json.loads(result_file.read_text(encoding="utf-8"))["scenario"]
    document["obstacles"].append({"name": "post", "semi_axes": [9, 9], "position": [0, 0]})
    yours = tmp_path / "yours.yaml"
    yours.write_text(json.dumps(document), encoding="utf-8")
    assert "the result's own" in " ".join(run("verify", result_file).stdout.split())
    done = run("verify", result_file, "--scenario", yours)
    assert done.returncode == 1
    assert "hits obstacle 'post'" in done.stdout
    assert run("verify", result_file, "--scenario", tmp_path / "none.yaml").returncode == 2


def test_verify_needs_a_path(result_file, tmp_path):
    def lose_path(data):
        data.update(status="timeout", path=None)

    assert run("verify", edited(result_file, tmp_path, lose_path)).returncode == 1


def test_show_writes_a_page_of_a_scenario_and_of_a_result(result_file, tmp_path):
    for source in ("rabbit-2d-open", result_file):
        page = tmp_path / "page.html"
        done = run("show", source, "--html", page)
        assert (done.returncode, done.stdout) == (0, "")
        assert page.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_figure_draws_a_scenario_and_a_result(result_file, tmp_path):
    for source in ("rabbit-2d-open", result_file):
        picture = tmp_path / "picture.png"
        done = run("figure", source, "--output", picture)
        assert (done.returncode, done.stdout) == (0, "")
        assert picture.read_bytes().startswith(b"\x89PNG")
