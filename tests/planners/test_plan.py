"""Whole plans: results, statuses, refusals, interrupts."""

import json
import os
import signal
import threading

import numpy as np
import pytest

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.result import PlanResult
from ellipsoid_planning.scenario import Scenario
from planners.solve import plan
from tests.planners.planner_scenes import least_clearance, run_python, scenario_of


def with_ends(scenario: Scenario, start=None, goal=None, planner=None) -> Scenario:
    """The scenario with another start, goal or planner."""
    return Scenario(
        scenario.name,
        scenario.world,
        scenario.robot,
        scenario.start if start is None else start,
        scenario.goal if goal is None else goal,
        scenario.clearance,
        planner or {},
    )


def test_a_result_is_complete_and_can_be_written():
    scenario = scenario_of("planar")
    result = plan(scenario, "RRTConnect", seed=1)
    assert (result.status, result.planner, result.seed) == ("solved", "RRTConnect", 1)
    assert result.time["total"] > 0.0
    assert result.time["build"] is None
    assert result.time["search"] is None
    assert result.statistics["vertices"] > 1
    copy = PlanResult.from_dict(json.loads(json.dumps(result.to_dict())))
    assert np.array_equal(copy.path.configurations, result.path.configurations)


def test_simplification_is_optional_and_keeps_the_ends():
    scenario = scenario_of("planar")
    plain = plan(scenario, "RRT", seed=3, simplify=False).path
    short = plan(scenario, "RRT", seed=3, simplify=True).path
    assert short.length < plain.length
    assert np.array_equal(short.configurations[[0, -1]], plain.configurations[[0, -1]])


def test_anytime_planners_improve_until_the_limit():
    scenario = scenario_of("planar")
    first = plan(scenario, "RRTstar", seed=3, simplify=False)
    later = plan(scenario, "RRTstar", seed=3, simplify=False, anytime=True, time_limit=0.5)
    assert later.statistics["vertices"] > first.statistics["vertices"]
    assert later.path.length < first.path.length


@pytest.mark.parametrize("name", ["RRT", "RRTConnect", "PRM", "RRTstar"])
def test_without_a_path_the_run_ends_in_time(name):
    result = plan(scenario_of("planar", blocked=True), name, seed=1, time_limit=0.3)
    assert result.status == "timeout"
    assert result.path is None


def test_a_planner_that_gives_up_early_is_exhausted():
    result = plan(
        scenario_of("planar", blocked=True),
        "FMT",
        seed=1,
        time_limit=600.0,
        parameters={"num_samples": 50, "extended_fmt": False},
    )
    assert result.status == "exhausted"


@pytest.mark.parametrize("checker", ["plugin", "fcl"])
def test_invalid_ends_are_a_status(checker):
    scenario = scenario_of("planar")
    inside = [0.0, 0.5, 0.0]
    for ends, status in (({"start": inside}, "invalid_start"), ({"goal": inside}, "invalid_goal")):
        result = plan(with_ends(scenario, **ends), "RRT", checker)
        assert result.status == status
        assert result.path is None


def test_start_and_goal_may_coincide():
    scenario = scenario_of("planar")
    result = plan(with_ends(scenario, goal=scenario.start), "RRTConnect", seed=1)
    assert result.status == "solved"
    assert result.path.certified
    assert result.path.length == 0.0


def test_paths_of_the_fcl_checker_are_certified_only_where_that_is_true():
    scenario = scenario_of("planar")
    flags = set()
    for seed in range(12):
        path = plan(scenario, "RRTConnect", "fcl", seed=seed, simplify=False, resolution=0.2).path
        flags.add(path.certified)
        if path.certified:
            assert least_clearance(scenario, path.configurations) > 0.0
        else:
            assert path.min_clearance <= 0.0
    assert flags == {True, False}


def test_the_scenarios_planner_and_parameters_are_used():
    planner = {"name": "FMT", "num_samples": 60}
    scenario = with_ends(scenario_of("planar"), planner=planner)
    assert plan(scenario, seed=1).planner == "FMT"
    assert plan(scenario, seed=1).statistics["vertices"] <= 65
    more = plan(scenario, seed=1, parameters={"num_samples": 300})
    assert 250 < more.statistics["vertices"] <= 305
    assert plan(scenario, "RRT", seed=1).planner == "RRT"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"planner": "RRTKonnect"}, "did you mean RRTConnect"),
        ({"planner": "RRT", "parameters": {"rang": 1.0}}, "did you mean range"),
        ({"planner": "RRT", "checker": "bullet"}, "expected one of plugin, tabulated, fcl"),
        ({"planner": "HighwayRoadmap", "checker": "fcl"}, "plug-in checker only"),
        ({"planner": "RRT", "time_limit": 0.0}, "time limit"),
        ({"planner": "RRT", "time_limit": float("nan")}, "time limit"),
        ({"planner": "RRT", "seed": -1}, "seed"),
        ({"planner": "RRT", "resolution": 0.1}, "resolution"),
        ({"planner": "RRT", "checker": "fcl", "resolution": 2.0}, "resolution"),
    ],
)
def test_bad_requests_are_planner_errors(arguments, message):
    with pytest.raises(PlannerError, match=message):
        plan(scenario_of("planar"), **arguments)


@pytest.mark.parametrize("name", ["RRTConnect", "PRM"])
@pytest.mark.parametrize("checker", ["plugin", "fcl"])
def test_an_interrupt_raises_after_a_clean_return(name, checker):
    former = signal.getsignal(signal.SIGINT)
    timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        plan(scenario_of("planar", blocked=True), name, checker, time_limit=600.0)
    timer.join()
    assert signal.getsignal(signal.SIGINT) is former


def test_a_plan_writes_nothing_to_the_terminal(capfd):
    plan(scenario_of("spatial"), "PRM", seed=1)
    plan(scenario_of("planar"), "BITstar", "fcl", seed=1)
    assert capfd.readouterr() == ("", "")


def test_a_process_that_planned_ends_without_noise():
    run = run_python("""
        from planners.registry import find_planner, planner_names
        from planners.solve import plan
        from tests.planners.planner_scenes import scenario_of
        for name in planner_names():
            for checker in ("plugin",) if find_planner(name).needs_plugin else ("plugin", "fcl"):
                result = plan(scenario_of("planar"), name, checker, seed=1, time_limit=300.0)
        print(result.status)
    """)
    assert (run.returncode, run.stdout, run.stderr) == (0, "solved\n", "")
