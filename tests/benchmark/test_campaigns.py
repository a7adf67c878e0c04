"""Who and what takes part, in which order, and what is found again in a folder."""

import json

import pytest

from ellipsoid_planning.errors import EllipsoidPlanningError, PlannerError
from ellipsoid_planning.scenario import Scenario
from planners.benchmark.campaign import Campaign
from planners.benchmark.checks import check_numbers
from planners.benchmark.contenders import line_up
from planners.benchmark.problems import (
    clearances_from,
    family_problems,
    scenario_problems,
    scientific,
)
from planners.benchmark.store import Store
from tests.benchmark.runs import WALL, record


def campaign(**changes):
    problems = scenario_problems([Scenario.from_dict(WALL)])
    contenders = line_up(["HighwayRoadmap", "RRT"], ["plugin", "fcl"]).contenders
    entries = {"runs": 2, "time_limit": 1.0, "memory_limit": 100.0, "seed": 5, **changes}
    return Campaign(problems, contenders, **entries)


def test_labels_name_the_checker_where_it_matters():
    line = line_up(["HighwayRoadmap", "RRT"], ["plugin", "fcl"])
    labels = [contender.label for contender in line.contenders]
    assert labels == ["HighwayRoadmap", "RRT (plugin)", "RRT (fcl)"]
    assert line.notes == ("HighwayRoadmap runs with the plug-in checker only, not with fcl.",)
    assert [c.label for c in line_up(["RRT"], ["fcl"]).contenders] == ["RRT"]


@pytest.mark.parametrize(
    ("planners", "checkers", "words"),
    [
        (["RTRConnect"], ["plugin"], "RRTConnect"),
        (["RRT"], ["bullet"], "plugin, tabulated, fcl"),
        (["RRT", "RRT"], ["plugin"], "twice"),
        ([], ["plugin"], "--planners"),
        (["HighwayRoadmap"], ["fcl"], "plug-in checker only"),
        (["nowhere:Planner"], ["plugin"], "cannot import"),
        (["json:Planner"], ["plugin"], "has no Planner"),
        (["RRT", "ompl.geometric:RRT"], ["plugin"], "called RRT"),
    ],
)
def test_contenders_that_cannot_take_part(planners, checkers, words):
    with pytest.raises(PlannerError, match=words):
        line_up(planners, checkers)


def test_contenders_take_turns_and_runs_have_their_seeds():
    tasks = list(campaign().tasks())
    assert [(t.label, t.run, t.seed) for t in tasks] == [
        (label, run, 5 + run)
        for run in range(2)
        for label in ("HighwayRoadmap", "RRT (plugin)", "RRT (fcl)")
    ]
    assert len({t.key for t in tasks}) == len(tasks)


def test_numbers_in_short():
    assert [scientific(x) for x in (0.1, 1e-3, 2.5e-4, 1.0, 1e-6, 30.0)] == [
        "1e-1",
        "1e-3",
        "2.5e-4",
        "1e0",
        "1e-6",
        "3e1",
    ]
    assert clearances_from("1e-1, 0.001") == (0.1, 0.001)
    for text in ("", "0", "-1", "nan", "a", "0.1,0.1"):
        with pytest.raises(EllipsoidPlanningError, match="--clearances"):
            clearances_from(text)


def test_a_family_is_drawn_anew_for_each_run_and_the_same_at_every_clearance():
    problems = family_problems("turned-gap", (1e-1, 1e-3), 2, runs=2, seed=3)
    assert [p.name for p in problems] == ["turned-gap-2d-1e-1", "turned-gap-2d-1e-3"]
    assert {p.family for p in problems} == {"turned-gap-2d"}
    assert problems[0].parameters()["clearance REAL"] == "0.1"
    for problem in problems:
        assert problem.scenario(0) != problem.scenario(1)
    assert problems[0].scenario(1)["start"] == problems[1].scenario(1)["start"]
    with pytest.raises(EllipsoidPlanningError, match="turned-gap"):
        family_problems("turned-gpa", (1e-1,), 2, runs=1, seed=1)


def test_scenarios_of_a_family_are_known_by_their_names():
    names = ("window-3d 3-D, clearance 1e-05, seed 7", "gap 2-D, clearance 0.1, blocked", "wall")
    scenarios = [Scenario.from_dict({**WALL, "name": name}) for name in (*names, "wall")]
    problems = scenario_problems(scenarios)
    families = [(p.family, p.clearance) for p in problems]
    assert families == [("window-3d", 1e-5), (None, None), (None, None), (None, None)]
    assert [p.name for p in problems][2:] == ["wall", "wall-2"]


@pytest.mark.parametrize(
    ("option", "changes"),
    [
        ("--runs", {"runs": 0}),
        ("--jobs", {"jobs": 0}),
        ("--time-limit", {"time_limit": 0.0}),
        ("--time-limit", {"time_limit": float("nan")}),
        ("--memory-limit", {"memory_limit": float("inf")}),
        ("--seed", {"seed": -1}),
        ("--seed", {"seed": 2**32 - 1}),
    ],
)
def test_numbers_out_of_range(option, changes):
    good = {"runs": 2, "time_limit": 1.0, "memory_limit": 1.0, "seed": 1}
    with pytest.raises(PlannerError, match=option):
        check_numbers(**{**good, **changes})


def test_a_finished_run_is_found_again(tmp_path):
    asked = campaign()
    store = Store(tmp_path / "new")
    store.check(asked)
    assert not store.folder.exists()
    store.open(asked)
    task = next(asked.tasks())
    assert store.finished(task) is None
    kept = record(task.label, seed=task.seed, log="text", seconds=0.25)
    store.keep(kept)
    assert store.finished(task) == kept
    store.check(asked)
    (store.folder / "runs" / task.key / "record.json").write_text("{", encoding="utf-8")
    assert store.finished(task) is None


@pytest.mark.parametrize(
    ("changes", "words"),
    [({"runs": 3}, "runs"), ({"seed": 6, "time_limit": 2.0}, "time limit, seed")],
)
def test_a_campaign_of_other_settings_is_refused(changes, words, tmp_path):
    Store(tmp_path).open(campaign())
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(EllipsoidPlanningError, match=f"other settings \\({words}\\)"):
        Store(tmp_path).check(campaign(**changes))
    assert sorted(tmp_path.rglob("*")) == before


def test_folders_that_cannot_be_used(tmp_path):
    (tmp_path / "file").write_text("", encoding="utf-8")
    broken = tmp_path / "broken"
    broken.mkdir()
    (broken / "campaign.json").write_text(json.dumps([]), encoding="utf-8")
    for name, words in (
        ("file", "expected a folder"),
        ("no/such", "does not exist"),
        ("", "holds other files"),
        ("broken", "cannot be read"),
    ):
        with pytest.raises(EllipsoidPlanningError, match=words):
            Store(tmp_path / name).check(campaign())
