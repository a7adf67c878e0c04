"""``rotations``: grids measured, written and drawn; bad input refused with one message."""

import json

import numpy as np
import pytest

from ellipsoid_planning.groups import grid_by_name, grid_names
from tests.cli.command import refused, run

ICOSAHEDRAL = ("--grid", "icosahedral", "--count", 480)


def test_json_has_the_measures_of_the_thesis_grid():
    done = run("rotations", *ICOSAHEDRAL, "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert (found["grid"], found["count"]) == ("icosahedral", 480)
    assert found["max_distortion"] == pytest.approx(0.0402, abs=1e-4)
    # No 480 balls of half the separation overlap, and those of the covering radius cover all.
    assert 0.0 < found["separation_deg"] < 2.0 * found["covering_deg"]
    assert found["covering_thickness"] > 1.0
    assert found["covering_is_exact"] is True


def test_a_table_for_people():
    done = run("rotations", "--grid", "600-cell", "--resolution-deg", 40)
    assert done.returncode == 0, done.stderr
    assert "420" in done.stdout
    assert "separation" not in done.stdout
    done = run("rotations", "--grid", "600-cell", "--resolution-deg", 40, "--metrics")
    assert "separation" in done.stdout
    assert "covering radius" in done.stdout


@pytest.mark.parametrize("suffix", ["csv", "npy"])
def test_written_rotations_are_the_grid_s(suffix, tmp_path):
    file = tmp_path / f"grid.{suffix}"
    done = run("rotations", *ICOSAHEDRAL, "--output", file)
    assert done.returncode == 0, done.stderr
    if suffix == "npy":
        found = np.load(file)
    else:
        assert file.read_text(encoding="utf-8").startswith("qx,qy,qz,qw\n")
        found = np.loadtxt(file, delimiter=",", skiprows=1)
    assert np.array_equal(found, grid_by_name("icosahedral", count=480).quaternions())
    assert list(tmp_path.iterdir()) == [file]


def test_random_rotations_follow_their_seed(tmp_path):
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        done = run(
            *("rotations", "--grid", "random", "--count", 20, "--seed", seed),
            *("--output", tmp_path / f"{name}.csv"),
        )
        assert done.returncode == 0, done.stderr
    one, same, other = ((tmp_path / f"{name}.csv").read_bytes() for name in "abc")
    assert one == same != other


@pytest.mark.parametrize("grid", [("600-cell", 420), ("super-fibonacci", 300), ("random", 1)])
def test_pictures(grid, tmp_path):
    name, count = grid
    file = tmp_path / "picture.png"
    done = run("rotations", "--grid", name, "--count", count, "--figure", file)
    assert done.returncode == 0, done.stderr
    assert file.read_bytes().startswith(b"\x89PNG")


def test_help_names_every_grid():
    done = run("rotations", "--help")
    words = "".join(done.stdout.replace("│", " ").split())
    for name in grid_names():
        assert name.removesuffix("-bcc").removesuffix("-cubic") in words


BAD = {
    "unknown": (("--grid", "icosahedrl", "--count", "480"), ("icosahedrl", "did you mean")),
    "nothing like it": (("--grid", "zzz", "--count", "480"), ("zzz", "600-cell")),
    "neither": (("--grid", "hopf"), ("--count or --resolution-deg", "neither")),
    "both": (("--grid", "hopf", "--count", "72", "--resolution-deg", "9"), ("got both",)),
    "no such count": (("--grid", "hopf", "--count", "73"), ("73", "72 or 576")),
    "none": (("--grid", "random", "--count", "0"), ("not 0",)),
    "too many": (("--grid", "random", "--count", "1000000000"), ("not 1000000000",)),
    "too fine": (("--grid", "hopf", "--resolution-deg", "0.001"), ("0.001",)),
    "too coarse": (("--grid", "hopf", "--resolution-deg", "720"), ("720",)),
    "no number": (("--grid", "hopf", "--resolution-deg", "nan"), ("nan",)),
    "seed": ((*ICOSAHEDRAL, "--seed", "3"), ("--seed 3", "not random")),
    "suffix": ((*ICOSAHEDRAL, "--output", "x.txt"), ("'.txt'", ".csv or .npy")),
    "picture": ((*ICOSAHEDRAL, "--figure", "x.nope"), ("unknown picture format",)),
    "folder": ((*ICOSAHEDRAL, "--output", "no/x.csv"), ("does not exist",)),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input(case, tmp_path):
    arguments, words = BAD[case]
    assert refused(run("rotations", *arguments, folder=tmp_path), *words)
    assert not list(tmp_path.iterdir())


def test_one_bad_output_leaves_the_other_unwritten(tmp_path):
    outputs = ("--output", "x.csv", "--figure", "no/x.png")
    assert refused(run("rotations", *ICOSAHEDRAL, *outputs, folder=tmp_path), "does not exist")
    assert not list(tmp_path.iterdir())
