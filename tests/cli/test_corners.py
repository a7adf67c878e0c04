"""What users run into at the edges: half turns, unusual outputs, values out of range."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.command import run

FULL = Path("/dev/full")


@pytest.mark.parametrize("degrees", [180, -180, 540])
@pytest.mark.parametrize("planner", ["HighwayRoadmap", "RRTConnect"])
def test_half_turns_are_planned(scenario_file, degrees, planner):
    file = scenario_file(("yaw_deg: 90", f"yaw_deg: {degrees}"))
    done = run("plan", file, "--planner", planner, "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["status"] == "solved"


def test_an_output_that_is_a_link_is_followed(scenario_file, tmp_path):
    file = scenario_file()
    link, target = tmp_path / "link.json", tmp_path / "target.json"
    target.write_text("old", encoding="utf-8")
    link.symlink_to(target)
    assert run("plan", file, "--seed", 1, "--output", link).returncode == 0
    assert link.is_symlink()
    assert json.loads(target.read_text(encoding="utf-8"))["status"] == "solved"


@pytest.mark.skipif(not FULL.exists(), reason="this system has no /dev/full")
def test_output_that_cannot_be_written_is_no_traceback():
    with FULL.open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "planners.cli", "scenarios"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 2
    assert "cannot write the output" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("limit", ["inf", "nan", "0", "-1"])
def test_time_limits_are_finite_and_positive(scenario_file, limit):
    done = run("plan", scenario_file(), "--time-limit", limit)
    assert done.returncode == 2
    assert "--time-limit" in done.stderr


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ("{name: RRTConnect}", "{name: Foo}", "planner.name"),
        ("{name: RRTConnect}", "{name: HighwayRoadmap, layers: 0}", "planner.layers"),
        ("{name: RRTConnect}", "{name: HighwayRoadmap, layers: x}", "planner.layers"),
        ("{name: RRTConnect}", "{name: RRTConnect, foo: 1}", "planner.foo"),
    ],
)
def test_the_planner_block_is_named_with_its_line(scenario_file, old, new, field):
    done = run("plan", scenario_file((old, new)))
    assert done.returncode == 2
    assert field in done.stderr
    assert "two-pillars.yaml:16:" in done.stderr


def test_aliases_that_multiply_are_refused(tmp_path):
    lines = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    lines += [f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 9)}]" for k in range(1, 9)]
    file = tmp_path / "bomb.yaml"
    file.write_text("\n".join(lines), encoding="utf-8")
    done = run("plan", file)
    assert done.returncode == 2
    assert "entries" in done.stderr


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_small_and_large_units_are_verified(tmp_path, scale):
    body = f"{{semi_axes: [{scale}, {2 * scale}], position: [0, {0.5 * scale}]}}"
    file = tmp_path / "scaled.yaml"
    file.write_text(
        f"""\
format: 1
name: scaled
dimension: 2
bounds: {{low: [{-6 * scale}, {-6 * scale}], high: [{6 * scale}, {6 * scale}]}}
obstacles: [{body}]
robot: {{parts: [{{semi_axes: [{0.5 * scale}, {0.2 * scale}]}}]}}
start: {{position: [{-4 * scale}, 0]}}
goal: {{position: [{4 * scale}, 0]}}
""",
        encoding="utf-8",
    )
    result = tmp_path / "result.json"
    assert run("plan", file, "--seed", 1, "--output", result).returncode == 0
    done = run("verify", result)
    assert done.returncode == 0, done.stdout
