"""One request: built once, validated once, compiled before its clock starts."""

import sys

import numpy as np
import pytest
from numba.core.dispatcher import Dispatcher

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.scenario import Scenario, load_scenario
from ellipsoid_planning.trees.parameters import TreeParameters
from planners import solve
from planners.bindings import clear_sampler
from planners.registry import checked_parameters, default_range, find_planner, planner_names
from planners.setup import simple_setup
from tests.cli.command import run

WITH_RANGE = [
    name for name in planner_names() if "range" in getattr(find_planner(name), "parameters", {})
]


def versions():
    """How many versions of each kernel this process has compiled, or loaded from the cache."""
    modules = [m for name, m in list(sys.modules.items()) if name.startswith("ellipsoid_planning")]
    kernels = {id(k): k for m in modules for k in vars(m).values() if isinstance(k, Dispatcher)}
    return {key: len(kernel.overloads) for key, kernel in kernels.items()}, kernels


@pytest.fixture
def compiled_while_solving(monkeypatch):
    """Names of the kernels that were compiled or loaded between the set-up and the result."""
    inner, names = solve._solved, []

    def watched(*arguments):
        before, _ = versions()
        outcome = inner(*arguments)
        after, kernels = versions()
        names.extend(
            kernels[key].py_func.__name__ for key in after if after[key] > before.get(key, 0)
        )
        return outcome

    monkeypatch.setattr(solve, "_solved", watched)
    return names


@pytest.mark.parametrize("scenario", ["rabbit-2d-open", "rabbit-3d-narrow", "translation-3d"])
@pytest.mark.parametrize(
    ("planner", "parameters"),
    [
        ("HighwayRoadmap", {"metric_weight": 3, "inflation": 2}),
        ("HighwayRoadmap", {"metric_weight": 3.5, "anytime": True}),
        ("HighwayRoadmap", {"refine": 0, "lines": 4}),
        ("FreeIntervalRRTConnect", {"metric_weight": 3, "range": 5, "uniform": 1}),
        ("FreeIntervalRRTConnect", {"anytime": True}),
        ("RRTConnect", {"range": 20}),
        ("PRM", {}),
    ],
)
def test_nothing_is_compiled_while_a_planner_runs(
    scenario, planner, parameters, compiled_while_solving
):
    scene = load_scenario(scenario)
    solve.plan(scene, planner, time_limit=0.5, seed=1, parameters=parameters)
    assert compiled_while_solving == []


@pytest.mark.parametrize("planner", ["HighwayRoadmap", "RRTConnect"])
def test_nothing_is_compiled_for_joints_either(planner, compiled_while_solving):
    solve.plan(load_scenario("arm-6r"), planner, time_limit=0.5, seed=1)
    assert compiled_while_solving == []


@pytest.mark.parametrize("kind", [RoadmapParameters, TreeParameters])
def test_parameters_have_one_type_whatever_came(kind):
    given = kind(metric_weight=np.int64(3), seed=np.int64(2))
    assert type(given.metric_weight) is float
    assert type(given.seed) is int
    entry = find_planner("HighwayRoadmap")
    assert type(checked_parameters(entry, {"metric_weight": 3})["metric_weight"]) is float


def test_the_scene_of_a_command_is_built_once(monkeypatch, capsys):
    from planners.cli.main import app

    built, inner = [], Scenario.cspace

    def counted(self):
        built.append(self.name)
        return inner(self)

    monkeypatch.setattr(Scenario, "cspace", counted)
    with pytest.raises(SystemExit) as ended:
        app(["plan", "rabbit-2d-open", "--seed", "1", "--json"])
    assert ended.value.code == 0
    assert capsys.readouterr().out.startswith("{")
    assert len(built) == 1


@pytest.mark.parametrize("limit", [0.0, -1.0, float("inf"), float("nan")])
def test_command_and_call_refuse_the_same_limits(limit):
    with pytest.raises(PlannerError, match="time limit: expected a positive number"):
        solve.plan(load_scenario("rabbit-2d-open"), time_limit=limit)
    done = run("plan", "rabbit-2d-open", "--time-limit", limit)
    assert done.returncode == 2
    assert "--time-limit: expected a positive number" in done.stderr


def test_times_add_up():
    scene = load_scenario("rabbit-2d-open")
    time = solve.plan(scene, seed=1).time
    assert time["total"] == pytest.approx(time["planning"] + time["simplification"])
    time = solve.plan(scene, seed=1, simplify=False).time
    assert time["simplification"] is None
    assert time["total"] == time["planning"]


@pytest.mark.parametrize("name", WITH_RANGE)
def test_ranges_are_short_unless_they_are_chosen(name):
    setup = simple_setup(load_scenario("maze-2d"))
    si = setup.getSpaceInformation()
    entry = find_planner(name)
    assert entry.allocate(si, {}).getRange() == default_range(si)
    assert 0.0 < default_range(si) < 0.1 * si.getMaximumExtent()
    assert entry.allocate(si, {"range": 7.0}).getRange() == 7.0
    clear_sampler(si)
