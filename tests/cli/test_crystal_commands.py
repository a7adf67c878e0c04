"""``crystal models``, ``show``, ``pack`` and ``schema``: results, going on, bad input."""

import csv
import json
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from typer.testing import CliRunner

from ellipsoid_planning.crystal.packing.grid_search import GridSearch
from ellipsoid_planning.crystal.packing.model import load_model
from ellipsoid_planning.crystal.packing.model_files import bundled_models
from ellipsoid_planning.crystal.packing.model_format import packing_model_schema, target_schema
from ellipsoid_planning.crystal.phasing.runs import search_pieces
from planners.cli.main import app
from tests.cli.command import COMMAND, refused, run

P1 = bundled_models()["rabbit-p1"].read_text(encoding="utf-8")


def crystal(*arguments, **options):
    return run("crystal", *arguments, **options)


def inside(*arguments):
    """As `crystal`, in this process, which has everything loaded."""
    done = CliRunner().invoke(app, ["crystal", *map(str, arguments)])
    return subprocess.CompletedProcess(arguments, done.exit_code, done.stdout, done.stderr)


def test_models_and_schema():
    done = inside("models")
    assert done.returncode == 0, done.stderr
    for name in bundled_models():
        assert name in done.stdout
    assert "94,478,400" in done.stdout
    assert json.loads(inside("schema").stdout) == packing_model_schema()
    assert json.loads(inside("schema", "--target").stdout) == target_schema()


@pytest.mark.parametrize("command", ["models", "show", "pack", "phase", "schema"])
def test_help_has_an_example(command):
    done = inside(command, "--help")
    assert done.returncode == 0
    assert f"ellipsoid-planning crystal {command}" in done.stdout


def test_show_says_what_meets():
    done = inside("show", "rabbit-p212121", "--number", 1000, "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert (found["group"], len(found["operations"])) == ("P212121", 4)
    assert (found["arrangements"], found["free"]) == (94_478_400, False)
    assert found["meetings"][0]["operation"] == "x,y,z"
    assert found["meetings"][0]["lattice"] == [0, 0, 1]
    done = inside("show", "rabbit-plane", "--target", "rabbit-plane-target")
    assert "yes, proved" in done.stdout
    assert "yaw_deg 100.82" in done.stdout


def test_pack_counts_the_arrangements_of_the_thesis():
    done = crystal("pack", "rabbit-p1", "--json", "--list", 2)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert (found["configurations"], found["free"], found["method"]) == (944_784, 98_845, "grid")
    model = load_model("rabbit-p1")
    for entry in found["arrangements"]:
        configuration = model.configuration(entry["configuration"])
        assert model.is_free(configuration)
        node = model.grid.configurations([entry["number"]])[0]
        assert np.allclose(node, configuration, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("suffix", ["json", "csv"])
def test_pack_writes_all_arrangements(suffix, tmp_path):
    file = tmp_path / f"free.{suffix}"
    done = inside("pack", "rabbit-plane", "--output", file)
    assert done.returncode == 0, done.stderr
    model = load_model("rabbit-plane")
    if suffix == "csv":
        rows = list(csv.reader(file.read_text(encoding="utf-8").splitlines()))
        assert rows[0] == ["number", *model.keys]
        found = [dict(zip(model.keys, map(float, row[1:]), strict=True)) for row in rows[1:]]
    else:
        result = json.loads(file.read_text(encoding="utf-8"))
        found = [entry["configuration"] for entry in result["arrangements"]]
        assert result["free"] == len(found)
    every = model.grid.configurations(range(model.grid.count))
    expected = every[model.are_free(every)]
    assert len(found) == len(expected)
    assert np.allclose([model.configuration(entry) for entry in found], expected)
    assert list(tmp_path.iterdir()) == [file]


def test_nothing_free_is_exit_code_1(tmp_path):
    text = P1.replace("[14, 14, 14]", "[11, 11, 11]")
    (tmp_path / "tight.yaml").write_text(text, encoding="utf-8")
    done = inside("pack", tmp_path / "tight.yaml", "--figure", tmp_path / "x.png", "--json")
    assert (done.returncode, json.loads(done.stdout)["free"]) == (1, 0)
    assert "nothing is drawn" in done.stderr
    target = ("--target", "rabbit-p1-target", "--json")
    done = inside("phase", tmp_path / "tight.yaml", *target)
    found = json.loads(done.stdout)
    assert (done.returncode, found["found"], found["arrangement"]) == (1, False, None)
    assert inside("phase", tmp_path / "tight.yaml", *target[:2]).returncode == 1


def test_a_killed_run_goes_on_and_a_changed_model_is_refused(tmp_path, monkeypatch):
    model = tmp_path / "model.yaml"
    whole = bundled_models()["rabbit-p212121"].read_text(encoding="utf-8")
    fine = whole.replace("upper: 3", "upper: 1")
    model.write_text(fine, encoding="utf-8")
    arguments = ("crystal", "pack", "model.yaml", "--run", "run", "--jobs", "1", "--json")
    pieces = tmp_path / "run" / "search"
    for how in (signal.SIGINT, signal.SIGKILL):
        before = len(list(pieces.glob("*"))) if pieces.exists() else 0
        process = subprocess.Popen(
            [*COMMAND, *arguments], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        while process.poll() is None and not (
            pieces.exists() and len(list(pieces.glob("*"))) > before + 3
        ):
            time.sleep(0.01)
        process.send_signal(how)
        out, errors = process.communicate(timeout=900)
        if how == signal.SIGINT:
            assert (process.returncode, out) == (130, b""), errors
            assert b"give the same command to go on" in errors
        assert b"Traceback" not in errors
    kept = {file: file.stat().st_mtime_ns for file in pieces.glob("0*")}
    free = len(GridSearch(load_model(model)).free(0, load_model(model).grid.base_poses))
    assert 8 <= len(kept) < len(search_pieces(load_model(model).grid))
    changed = fine.replace("lengths: [22, 22, 22]", "lengths: [22, 22, 23]")
    model.write_text(changed, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    done = inside(*arguments[1:])
    assert refused(done, "--run run", "model.cell.lengths[2]: 22.0 there, 23.0 now")
    model.write_text(fine, encoding="utf-8")
    damaged = min(kept)
    damaged.write_bytes(damaged.read_bytes()[:-3])
    kept.pop(damaged)
    done = inside(*arguments[1:])
    assert json.loads(done.stdout)["free"] == free
    assert all(file.stat().st_mtime_ns == when for file, when in kept.items())


CELL = "group: P1\ncell: {lengths: [14, 14, 14]}"
BAD = {
    "unknown group": ("group: P1", "group: P212122", ("group", "P212122")),
    "wrong cell": (CELL, CELL.replace("P1", "P4").replace("[14, 14", "[20, 24"), ("cell", "P4")),
    "too large": ("{lengths: [14, 14, 14]", "{lengths: [10, 10, 10]", ("cell", "do not fit")),
    "unknown key": ("parts:", "prats:", ("did you mean 'parts'",)),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_models(case, tmp_path):
    old, new, words = BAD[case]
    assert old in P1
    file = tmp_path / "bad.yaml"
    file.write_text(P1.replace(old, new, 1), encoding="utf-8")
    last = P1[: P1.index(old) + len(old)].count("\n") + 1
    assert refused(inside("show", file), f"{file}:{last}:", *words)


OPTIONS = {
    "unknown model": (("pack", "rabbit-p11"), ("did you mean rabbit-p1",)),
    "grid's options": (("pack", "rabbit-p1", "--spread", 1), ("--spread", "--method potential")),
    "suffix": (("pack", "rabbit-p1", "--output", "x.txt"), ("'.txt'", ".json or .csv")),
    "folder": (("pack", "rabbit-p1", "--run", "no/such"), ("--run", "does not exist")),
    "jobs": (("pack", "rabbit-p1", "--cluster", "tcp://127.0.0.1:9", "--jobs", 2), ("--jobs",)),
    "number": (("show", "rabbit-plane", "--number", 216), ("--number 216", "0 to 215")),
    "key": (("show", "rabbit-plane", "--configuration", "yaw=3"), ("'yaw'", "yaw_deg")),
    "value": (("show", "rabbit-plane", "--configuration", "yaw_deg=x"), ("KEY=NUMBER",)),
    "no result": (("show", "rabbit-plane", "--target", "no.json"), ("no.json", "cannot read")),
    "twice": (
        ("show", "rabbit-plane", "--number", 1, "--target", "rabbit-plane-target"),
        ("expected one arrangement",),
    ),
    "another's target": (
        ("show", "rabbit-plane", "--target", "rabbit-p1-target"),
        ("rabbit-p1-target.yaml", "configuration", "alpha_deg"),
    ),
}


@pytest.mark.parametrize("case", OPTIONS)
def test_bad_options(case, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    arguments, words = OPTIONS[case]
    assert refused(inside(*arguments), *words)
    assert not list(tmp_path.iterdir())


def test_gemmi_missing_is_one_message(tmp_path):
    (tmp_path / "gemmi.py").write_text("raise ImportError", encoding="utf-8")
    code = "import sys; sys.path.insert(0, '.'); from planners.cli.main import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", code, "crystal", "pack", "rabbit-p1"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert refused(done, "gemmi", "ellipsoid-planning[crystal]")
