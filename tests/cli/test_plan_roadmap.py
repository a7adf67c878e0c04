"""`plan --roadmap FILE`: loaded if it is there, written afterwards, never over another file."""

import json

import pytest

from tests.cli.command import refused, run

HIGHWAY = ("{name: RRTConnect}", "{name: HighwayRoadmap}")
# The direct motion leads nowhere, so that there is something to keep.
WALL = ("semi_axes: [1, 3], position: [0, -4]", "semi_axes: [1, 3], position: [0, -2]")


@pytest.fixture
def kept(scenario_file, tmp_path):
    """A scenario's file, and a roadmap's that a plan has written; with the statistics."""
    scenario, file = scenario_file(HIGHWAY, WALL), tmp_path / "yard.roadmap"
    done = run("plan", scenario, "--json", "--roadmap", file)
    assert done.returncode == 0, done.stderr
    assert f"Wrote {file}" in done.stderr
    return scenario, file, json.loads(done.stdout)["statistics"]


def test_a_second_plan_goes_on_with_it(kept):
    scenario, file, first = kept
    done = run("plan", scenario, "--json", "--roadmap", file)
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    assert result["path"]["certified"] is True
    assert 0 < first["lines"] <= result["statistics"]["lines"] < 1.5 * first["lines"]
    assert result["statistics"]["expansions"] > first["expansions"]


def test_other_ends_share_it_and_no_path_is_kept_too(kept, scenario_file, tmp_path):
    _, file, first = kept
    other = scenario_file(HIGHWAY, WALL, ("position: [6, -1]", "position: [6, 2]"))
    assert run("plan", other, "--roadmap", file).returncode == 0
    wall = ("semi_axes: [1, 3], position: [0, 4]", "semi_axes: [1, 15], position: [0, 4]")
    blocked, none = scenario_file(HIGHWAY, wall), tmp_path / "none.roadmap"
    quick = ("--set", "planner.refine=0")
    counts = []
    for _ in range(2):
        done = run("plan", blocked, "--json", *quick, "--roadmap", none)
        assert done.returncode == 1, done.stderr
        counts.append(json.loads(done.stdout)["statistics"]["lines"])
    assert counts[0] == counts[1] > first["lines"]


def test_other_scenes_are_refused_with_what_differs(kept, scenario_file):
    _, file, _ = kept
    before = file.read_bytes()
    cases = {
        "another world": ("semi_axes: [12, 12]", "semi_axes: [12, 11]"),
        "another robot": ("semi_axes: [0.2, 0.6]", "semi_axes: [0.2, 0.61]"),
        "clearance 0.0 (here 0.05)": ("dimension: 2", "dimension: 2\nclearance: 0.05"),
    }
    for words, change in cases.items():
        other = scenario_file(HIGHWAY, WALL, change)
        done = run("plan", other, "--roadmap", file)
        assert refused(done, str(file), "expected a roadmap of this scene, got one of", words)
    seeded = run("plan", scenario_file(HIGHWAY, WALL), "--roadmap", file, "--seed", 7)
    assert refused(seeded, "seed 1 (here 7)")
    assert file.read_bytes() == before


def test_foreign_and_damaged_files_stay_as_they_are(kept, tmp_path):
    scenario, file, _ = kept
    foreign = tmp_path / "notes.txt"
    foreign.write_text("notes", encoding="utf-8")
    file.write_bytes(file.read_bytes()[:-100])
    for path in (foreign, file):
        before, there = path.read_bytes(), set(tmp_path.iterdir())
        done = run("plan", scenario, "--roadmap", path, "--output", tmp_path / "out.json")
        assert refused(done, str(path), "expected a roadmap")
        assert path.read_bytes() == before
        assert set(tmp_path.iterdir()) == there


def test_mistakes_are_found_before_planning(scenario_file, tmp_path):
    file, other = scenario_file(HIGHWAY), scenario_file()
    cases = [
        (("--planner", "RRTConnect", "--roadmap", "a"), ("RRTConnect keeps no roadmap",)),
        (("--roadmap", tmp_path / "missing" / "a"), ("--roadmap", "does not exist")),
        (("--roadmap", tmp_path), ("--roadmap", "this is a folder")),
        (("--roadmap", "a", "--output", "a"), ("--output and --roadmap",)),
    ]
    for options, words in cases:
        done = run("plan", file, *options, folder=tmp_path)
        assert refused(done, *words)
        assert "Planning" not in done.stderr
    assert list(tmp_path.iterdir()) == [other]


def test_the_help_explains_it():
    text = run("plan", "--help").stdout
    assert "--roadmap" in text
    assert "loaded if it exists" in " ".join(text.replace("│", " ").split())
