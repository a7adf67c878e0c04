"""``crystal phase``: targets found again, a killed run that goes on, data and bad input."""

import json
import signal
import subprocess
import time

import pytest
from typer.testing import CliRunner

from ellipsoid_planning.crystal.diffraction.magnitude_writing import write_magnitudes
from ellipsoid_planning.crystal.diffraction.magnitudes import simulate
from ellipsoid_planning.crystal.packing.model import load_model, load_target
from planners.cli.main import app
from tests.cli.command import COMMAND, refused

PLANE = ("rabbit-plane", "--target", "rabbit-plane-target")


def phase(*arguments):
    """`crystal phase` in this process."""
    done = CliRunner().invoke(app, ["crystal", "phase", *map(str, arguments)])
    return subprocess.CompletedProcess(arguments, done.exit_code, done.stdout, done.stderr)


def found(done):
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def without_times(result):
    every = [result, *result["refined"], result["arrangement"]]
    for entry in every:
        entry.pop("time", None)
        entry.pop("seconds", None)
    return result


def test_the_target_is_found_again(tmp_path):
    drawn = [tmp_path / name for name in ("candidates.png", "trends.svg", "cell.html")]
    options = ("--figure", drawn[0], "--trends", drawn[1], "--html", drawn[2])
    done = phase(*PLANE, "--output", tmp_path / "result.json", *options, "--json")
    result = found(done)
    assert result == json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))
    assert (result["found"], result["configurations"]) == (True, 216)
    assert len(result["candidates"]) == 46  # no more are free
    costs = [entry["cost"] for entry in result["candidates"]]
    assert costs == sorted(costs)
    assert result["arrangement"]["cost"] <= result["threshold"]
    assert result["arrangement"]["errors"]["MAE_deg"] < 1e-3
    assert result["arrangement"]["free"] is True
    assert all(file.stat().st_size > 1000 for file in drawn)
    shown = CliRunner().invoke(
        app, ["crystal", "show", "rabbit-plane", "--target", str(tmp_path / "result.json")]
    )
    assert "yaw_deg 100.82" in shown.stdout
    table = phase(*PLANE)
    assert "Found" in table.stdout
    assert "yes, proved" in table.stdout


def test_a_threshold_that_nothing_reaches_is_not_found():
    done = phase(*PLANE, "--refine", "polish", "--threshold", 1e-300, "--best", 2, "--json")
    result = json.loads(done.stdout)
    assert (done.returncode, result["found"], len(result["refined"])) == (1, False, 2)


def test_potential_candidates_too():
    result = found(phase(*PLANE, "--method", "potential", "--step-deg", 90, "--json"))
    assert result["configurations"] == 8
    assert result["arrangement"]["errors"]["MAE_deg"] < 1e-3


def test_a_killed_run_ends_as_an_unbroken_one(tmp_path):
    arguments = (*PLANE, "--refine", "rrt", "--threshold", "1e-300", "--best", "3", "--json")
    folder = tmp_path / "run"
    process = subprocess.Popen(
        [*COMMAND, "crystal", "phase", *arguments, "--run", folder],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    while process.poll() is None and not list(folder.glob("refined/*")):
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    out, errors = process.communicate(timeout=900)
    assert (process.returncode, out) == (130, b""), errors
    assert b"give the same command to go on" in errors
    assert b"Traceback" not in errors
    kept = {file: file.stat().st_mtime_ns for file in folder.glob("*/*")}
    assert len(list(folder.glob("refined/*"))) < 3
    again = phase(*arguments, "--run", folder)
    unbroken = phase(*arguments)
    assert again.returncode == unbroken.returncode == 1
    broken, whole = json.loads(again.stdout), json.loads(unbroken.stdout)
    assert without_times(broken) == without_times(whole)
    assert all(file.stat().st_mtime_ns == when for file, when in kept.items())
    assert refused(phase(*arguments, "--seed", 2, "--run", folder), "refinement.seed: 1 there")
    other = ("rabbit-plane", "--target", folder.parent / "other.yaml", *arguments[3:])
    (tmp_path / "other.yaml").write_text(
        json.dumps(
            {
                "format": 1,
                "name": "other",
                "configuration": dict.fromkeys(load_model("rabbit-plane").keys, 5.0),
            }
        ),
        encoding="utf-8",
    )
    assert refused(phase(*other, "--run", folder), "target: ")


def test_magnitudes_of_a_file(tmp_path):
    model = load_model("rabbit-p1")
    data = tmp_path / "data.mtz"
    write_magnitudes(data, simulate(model, load_target("rabbit-p1-target", model)), model)
    result = found(phase("rabbit-p1", "--target", data, "--threshold", 1e-3, "--json"))
    assert result["target"]["scaled"] is True
    assert result["target"]["configuration"] is None
    assert "errors" not in result["arrangement"]
    known = ("--compare", "rabbit-p1-target")
    result = found(phase("rabbit-p1", "--target", data, *known, "--threshold", 1e-3, "--json"))
    assert result["arrangement"]["errors"]["MAE_deg"] < 0.5
    assert result["arrangement"]["cost_share"] < 1e-3


CIF = """\
data_p1
_cell.length_a 14
_cell.length_b 14
_cell.length_c 14
_cell.angle_alpha 90
_cell.angle_beta 90
_cell.angle_gamma 90
loop_
_refln.index_h
_refln.index_k
_refln.index_l
_refln.F_meas_au
1 0 0 {first}
0 1 0 7.5
"""


def test_few_reflections_are_said_to_be_few(tmp_path):
    (tmp_path / "few.cif").write_text(CIF.format(first=7.5), encoding="utf-8")
    done = phase("rabbit-p1", "--target", tmp_path / "few.cif", "--best", 1, "--refine", "polish")
    assert done.returncode in {0, 1}
    assert "has 2 reflections" in done.stderr and "for 8 unknowns" in done.stderr


BAD = {
    "no target": (("--target", "rabbit-p1-traget"), ("did you mean rabbit-p1-target",)),
    "unknown coordinate": (("--target", "t.yaml"), ("t.yaml:3", "gama_deg", "gamma_deg")),
    "unknown key": (("--target", "k.yaml"), ("k.yaml:4", "colour", "unknown key")),
    "missing": (("--target", "missing.cif"), ("missing.cif", "1, 0, 0")),
    "negative": (("--target", "negative.cif"), ("negative.cif", "1, 0, 0", "-3")),
    "no data": (("--target", "no.mtz"), ("no.mtz",)),
    "column": (("--target", "rabbit-p1-target", "--column", "F"), ("--column",)),
    "compare": (("--target", "rabbit-p1-target", "--compare", "x"), ("--compare",)),
    "threshold": (("--target", "rabbit-p1-target", "--threshold", -1), ("threshold", "-1")),
    "picture": (("--target", "rabbit-p1-target", "--trends", "x.nope"), ("picture format",)),
    "same file": (
        ("--target", "rabbit-p1-target", "--figure", "x.png", "--trends", "x.png"),
        ("two files",),
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input(case, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "t.yaml").write_text(
        "format: 1\nname: t\nconfiguration: {alpha_deg: 1, gama_deg: 2}\n", encoding="utf-8"
    )
    (tmp_path / "k.yaml").write_text(
        "format: 1\nname: k\nconfiguration: {alpha_deg: 1}\ncolour: red\n", encoding="utf-8"
    )
    (tmp_path / "missing.cif").write_text(CIF.format(first="?"), encoding="utf-8")
    (tmp_path / "negative.cif").write_text(CIF.format(first="-3"), encoding="utf-8")
    before = sorted(tmp_path.iterdir())
    arguments, words = BAD[case]
    assert refused(phase("rabbit-p1", *arguments, "--run", "run"), *words)
    assert sorted(tmp_path.iterdir()) == before
