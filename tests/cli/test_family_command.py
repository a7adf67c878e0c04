"""``family``: writes scenarios that the other commands take."""

import pytest

from ellipsoid_planning.families import family_names, make_family
from ellipsoid_planning.scenario import load_scenario
from tests.cli.command import refused, run


def test_a_scenario_is_written_and_taken(tmp_path):
    file = tmp_path / "wide.yaml"
    done = run("family", "turned-gap", "--clearance", "0.8", "--seed", 3, "--output", file)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
    assert f"Wrote {file}" in done.stderr
    expected = make_family("turned-gap", 0.8, seed=3)
    assert load_scenario(file).to_dict() == expected.to_dict()
    planned = run("plan", file, "--planner", "RRTConnect", "--seed", 1)
    assert planned.returncode == 0, planned.stderr


def test_options_reach_the_family(tmp_path):
    file = tmp_path / "scene.yaml"
    arguments = ("family", "gap", "--clearance", "1e-3", "--dimension", 3, "--output", file)
    for option, key in (("--blocked", "blocked"), ("--without-passage", "without_passage")):
        assert run(*arguments, option).returncode == 0
        assert load_scenario(file).to_dict() == make_family("gap", 1e-3, 3, **{key: True}).to_dict()


def test_the_same_seed_writes_the_same_bytes(tmp_path):
    for name in ("first", "second"):
        options = ("--clearance", "1e-6", "--seed", 11, "--output", tmp_path / name)
        assert run("family", "window-3d", *options).returncode == 0
    assert (tmp_path / "first").read_bytes() == (tmp_path / "second").read_bytes()


def test_help_names_every_family():
    text = run("family", "--help").stdout
    for name in family_names():
        assert name in text
    assert "ellipsoid-planning family" in text


BAD = {
    "unknown": (("turned-gpa", "--clearance", "0.1"), ("turned-gpa", "did you mean turned-gap?")),
    "no clearance": (("gap", "--clearance", "0"), ("clearance", "above 0")),
    "negative clearance": (("gap", "--clearance", "-1"), ("clearance", "above 0")),
    "endless clearance": (("gap", "--clearance", "inf"), ("clearance", "at most 1")),
    "no number": (("gap", "--clearance", "nan"), ("clearance", "above 0")),
    "too flat": (("window-3d", "--clearance", "0.1", "--dimension", "2"), ("dimension 3",)),
    "too deep": (("gap", "--clearance", "0.1", "--dimension", "4"), ("dimension 2 or 3",)),
    "seed": (("gap", "--clearance", "0.1", "--seed", "-3"), ("seed", "-3")),
    "both": (("gap", "--clearance", "0.1", "--blocked", "--without-passage"), ("not both",)),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_writes_nothing(case, tmp_path):
    arguments, words = BAD[case]
    assert refused(run("family", *arguments, "--output", tmp_path / "scene.yaml"), *words)
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_not_there(tmp_path):
    options = ("--clearance", "0.1", "--output", tmp_path / "missing" / "scene.yaml")
    assert refused(run("family", "gap", *options), "--output", "does not exist")


@pytest.mark.parametrize("missing", ["--clearance", "--output"])
def test_required_options(missing, tmp_path):
    options = {"--clearance": "0.1", "--output": str(tmp_path / "scene.yaml")}
    del options[missing]
    done = run("family", "gap", *[word for pair in options.items() for word in pair])
    assert (done.returncode, done.stdout) == (2, "")
    assert missing in done.stderr
    assert not list(tmp_path.iterdir())
