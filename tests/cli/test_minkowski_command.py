"""``minkowski``: exact volumes and bounds of sums and differences, and pictures of them."""

import json
import math

import pytest

from tests.cli.command import refused, run

FIGURE_5_11C = (
    *("--semi-axes", "7,3,3", "--semi-axes", "2,3,4"),
    *("--euler-zxz-deg", "-45,-22.5,45", "--euler-zxz-deg", "60,45,-30"),
)
FIGURE_5_9B = ("--semi-axes", "1,5", "--semi-axes", "3,6", "--yaw-deg", "45")


def computed(*arguments):
    done = run("minkowski", *arguments, "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_the_thesis_ellipses():
    volume = computed(*FIGURE_5_9B)["volume"]
    expected = {"brunn_minkowski": 131.86, "lower": 165.22, "exact": 171.09, "upper": 179.09}
    for name, value in expected.items():
        assert volume[name] == pytest.approx(value, abs=0.05)


def test_the_thesis_ellipsoids():
    found = computed(*FIGURE_5_11C)
    volume = found["volume"]
    assert volume["brunn_minkowski"] == pytest.approx(1354.37, abs=0.05)
    assert volume["exact"] == pytest.approx(1626.29, abs=0.05)
    for name, kind in found["kinds"].items():
        if kind == "lower":
            assert volume[name] <= volume["exact"]
        if kind == "upper":
            assert volume[name] >= volume["exact"]
    assert found["operation"] == "sum"
    assert found["rolling"] is None
    for one in found["approximations"]:
        assert (one["volume"] < volume["exact"]) == (one["kind"] == "inner")


def test_one_orientation_is_the_second_body_s():
    once = computed("--semi-axes", "2,1", "--semi-axes", "3,1", "--yaw-deg", "30")
    twice = computed(
        *("--semi-axes", "2,1", "--semi-axes", "3,1", "--yaw-deg", "0", "--yaw-deg", "30")
    )
    assert once == twice
    assert once["bodies"][0]["rotation"] == [[1.0, 0.0], [0.0, 1.0]]


def test_a_difference():
    found = computed("--semi-axes", "18,15", "--semi-axes", "2,3", "--difference")
    volume = found["volume"]
    assert found["operation"] == "difference"
    assert found["rolling"]["holds"]
    assert volume["steiner"] == pytest.approx(volume["exact"], rel=1e-12)
    assert volume["lower"] <= volume["exact"] <= volume["upper"]
    discs = computed("--semi-axes", "5,5", "--semi-axes", "2,2", "--difference")
    assert discs["volume"]["exact"] == pytest.approx(9.0 * math.pi, rel=1e-12)


def test_a_difference_with_a_cut():
    found = computed("--semi-axes", "12,5", "--semi-axes", "3,3", "--difference")
    assert not found["rolling"]["holds"]
    assert found["rolling"]["margin"] < 0.0
    assert found["volume"]["lower"] <= found["volume"]["exact"] <= found["volume"]["upper"]


def test_a_body_that_just_fits():
    found = computed("--semi-axes", "5,5,5", "--semi-axes", "5,5,5", "--difference")
    assert found["volume"]["exact"] == pytest.approx(0.0, abs=1e-9)


def test_tables_for_people():
    done = run("minkowski", *FIGURE_5_11C)
    assert done.returncode == 0, done.stderr
    for words in ("1626.2", "brunn minkowski", "(5.88)", "kurzhanski volume", "inner", "%"):
        assert words in done.stdout
    done = run("minkowski", "--semi-axes", "12,5", "--semi-axes", "3,3", "--difference")
    assert "does not roll freely" in done.stdout


@pytest.mark.parametrize(
    "arguments",
    [
        FIGURE_5_9B,
        FIGURE_5_11C,
        ("--semi-axes", "12,5", "--semi-axes", "3,3", "--difference"),
        ("--semi-axes", "9,5,6", "--semi-axes", "3,3,2", "--difference"),
    ],
    ids=["ellipses", "ellipsoids", "ellipses' difference", "ellipsoids' difference"],
)
def test_pictures(arguments, tmp_path):
    file = tmp_path / "picture.png"
    done = run("minkowski", *arguments, "--figure", file, "--json")
    assert done.returncode == 0, done.stderr
    assert file.read_bytes().startswith(b"\x89PNG")
    json.loads(done.stdout)


BALLS = ("--semi-axes", "2,2,2", "--semi-axes", "1,1,1")
BAD = {
    "mixed": (("--semi-axes", "1,2", "--semi-axes", "1,2,3"), ("one dimension", "1,2,3")),
    "negative": (("--semi-axes", "1,-2", "--semi-axes", "1,2"), ("1,-2", "positive")),
    "zero": (("--semi-axes", "1,2", "--semi-axes", "0,2"), ("0,2", "positive")),
    "endless": (("--semi-axes", "1,inf", "--semi-axes", "1,2"), ("1,inf", "finite")),
    "words": (("--semi-axes", "1,x", "--semi-axes", "1,2"), ("1,x", "2 or 3 numbers")),
    "four": (("--semi-axes", "1,2,3,4", "--semi-axes", "1,2"), ("2 or 3 numbers", "got 4")),
    "one body": (("--semi-axes", "1,2"), ("two bodies", "got 1")),
    "three bodies": (("--semi-axes", "1,2") * 3, ("two bodies", "got 3")),
    "yaw in space": ((*BALLS, "--yaw-deg", "3"), ("--euler-zxz-deg",)),
    "zxz in the plane": (("--semi-axes", "1,2") * 2 + ("--euler-zxz-deg", "1,2,3"), ("--yaw-deg",)),
    "angles": ((*BALLS, "--euler-zxz-deg", "1,2"), ("expected 3 numbers", "got 2")),
    "too many turns": ((*BALLS, *("--euler-zxz-deg", "1,2,3") * 3), ("at most twice",)),
    "format": ((*BALLS, "--figure", "x.nope"), ("unknown picture format",)),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input(case, tmp_path):
    arguments, words = BAD[case]
    assert refused(run("minkowski", *arguments, folder=tmp_path), *words)
    assert not list(tmp_path.iterdir())


def test_an_empty_difference_says_where_and_by_how_much():
    axes = ("--semi-axes", "12,5,6", "--semi-axes", "2,7,1", "--difference")
    assert refused(run("minkowski", *axes), "empty", "[0.0, 1.0, 0.0]", "by 2")
