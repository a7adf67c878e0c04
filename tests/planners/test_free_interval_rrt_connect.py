"""FreeIntervalRRTConnect as OMPL sees it."""

import os
import signal
import threading

import numpy as np
import pytest
from ompl import base as ob
from ompl import geometric as og
from ompl import tools as ot

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import load_scenario
from ellipsoid_planning.world import World
from planners import bindings
from planners.free_interval_rrt_connect import FreeIntervalRRTConnect
from planners.registry import checked_parameters, find_planner, planner_names
from planners.setup import install, simple_setup
from planners.solve import plan
from planners.spaces import state_access, state_space
from planners.verify.result import verify_result
from tests.planners.planner_scenes import KINDS, scenario_of
from tests.planners.test_plugin_memory import growth
from tests.roadmap.scenes import cage
from tests.told import StopAt

Statuses = ob.PlannerStatus.PlannerStatusType
NAME = "FreeIntervalRRTConnect"


@pytest.fixture(autouse=True)
def silent():
    with bindings.ompl_output("silent"):
        yield


def own_setup(cspace, starts, goals):
    """A user's own set-up, without any scenario or file."""
    si = ob.SpaceInformation(state_space(cspace))
    install(si, cspace)
    si.setup()
    setup, access = og.SimpleSetup(si), state_access(cspace)
    region = ob.GoalStates(si)
    for rows, add in ((starts, setup.addStartState), (goals, region.addState)):
        for row in rows:
            state = si.allocState()
            access.write(state, row)
            add(state)
    setup.setGoal(region)
    planner = FreeIntervalRRTConnect(si)
    setup.setPlanner(planner)
    return setup, planner


def of(kind, **parameters):
    setup = simple_setup(scenario_of(kind), seed=1)
    planner = FreeIntervalRRTConnect(setup.getSpaceInformation())
    for name, value in parameters.items():
        setattr(planner, name, value)
    setup.setPlanner(planner)
    return setup, planner


def path_of(setup, cspace):
    return bindings.configurations_of_path(setup.getSolutionPath(), state_access(cspace))


def is_proved(cspace, path):
    return bool(cspace.are_motions_valid(path[:-1], path[1:]).all())


@pytest.mark.parametrize("kind", KINDS)
def test_three_lines_plan_a_proved_path(kind):
    scenario = scenario_of(kind)
    setup, planner = of(kind)
    assert setup.solve(10.0).getStatus() == Statuses.EXACT_SOLUTION
    path = path_of(setup, scenario.cspace())
    np.testing.assert_allclose(path[[0, -1]], [scenario.start, scenario.goal], atol=1e-12)
    assert is_proved(scenario.cspace(), path)
    assert planner.statistics["steps"] > 0
    first, last = planner.tree_edges()
    assert len(first) > 0
    assert scenario.cspace().are_motions_valid(first, last).all()


@pytest.mark.parametrize(
    "name",
    [
        "maze-2d",
        "rabbit-2d-narrow",
        "rabbit-2d-open",
        "rabbit-3d-cluttered",
        "rabbit-3d-narrow",
        "rabbit-3d-open",
        "translation-2d",
        "translation-3d",
        pytest.param("window-3d", marks=pytest.mark.slow),
    ],
)
def test_bundled_scenarios_are_solved_and_verified(name):
    for seed in (1, 2):
        result = plan(load_scenario(name), NAME, time_limit=600.0, seed=seed)
        assert result.status == "solved"
        assert result.path.certified
        assert verify_result(result).passed


def test_runs_repeat_by_seed():
    scenario = load_scenario("rabbit-3d-cluttered")
    runs = [plan(scenario, NAME, seed=seed, simplify=False) for seed in (3, 3, 4)]
    paths = [run.path.configurations for run in runs]
    np.testing.assert_array_equal(paths[0], paths[1])
    assert runs[0].statistics == runs[1].statistics
    assert not np.array_equal(paths[0], paths[2])


@pytest.mark.parametrize("n", [2, 3])
def test_an_empty_world_takes_one_motion(n):
    robot = RigidRobot((Ellipsoid.from_semi_axes(np.ones(n)),))
    cspace = CSpace(World(np.full(n, -5.0), np.full(n, 5.0)), robot)
    turn = [0.0] if n == 2 else [0.0, 0.0, 0.0, 1.0]
    start, goal = [-4.0] * n + turn, [4.0] * n + turn
    for ends in ((start, goal), (start, start)):
        setup, planner = own_setup(cspace, [ends[0]], [ends[1]])
        assert setup.solve(1.0).getStatus() == Statuses.EXACT_SOLUTION
        assert setup.getSolutionPath().getStateCount() == 2
        assert planner.statistics["direct_motions"] == 1
        assert planner.statistics["steps"] == 0


def test_several_starts_and_goals_of_which_some_are_invalid():
    cspace = scenario_of("planar").cspace()
    starts = [[0.0, 0.5, 0.0], [-6.0, 0.0, 0.0], [-6.0, 2.0, 1.0]]
    goals = [[0.0, 0.5, 0.0], [6.0, 0.0, 1.0], [6.0, 1.0, 0.0]]
    setup, _ = own_setup(cspace, starts, goals)
    assert setup.solve(5.0).getStatus() == Statuses.EXACT_SOLUTION
    path = path_of(setup, cspace)
    assert path[0].tolist() in starts[1:]
    assert path[-1].tolist() in goals[1:]


def test_invalid_starts_and_goals_have_their_own_status():
    cspace = scenario_of("planar").cspace()
    blocked, free = [0.0, 0.5, 0.0], [-6.0, 0.0, 0.0]
    assert own_setup(cspace, [blocked], [free])[0].solve(1.0).getStatus() == Statuses.INVALID_START
    assert own_setup(cspace, [free], [blocked])[0].solve(1.0).getStatus() == Statuses.INVALID_GOAL


@pytest.mark.parametrize("n", [2, 3])
def test_without_a_path_it_ends_when_told_and_says_timeout(n):
    cspace = cage(n, 60.0)
    turn = [0.0] if n == 2 else [0.0, 0.0, 0.0, 1.0]
    setup, planner = own_setup(cspace, [[40.0] * n + turn], [[0.0] * n + turn])
    planner.warm_up()
    setup.setup()
    planner.setProblemDefinition(setup.getProblemDefinition())
    for look in (1, 2, 10, 40):
        stop = StopAt(look)
        assert planner.solve(stop).getStatus() == Statuses.TIMEOUT
        assert 0 <= stop.later <= 5
    for limit in (0.02, 0.2):
        assert setup.solve(limit).getStatus() == Statuses.TIMEOUT
    assert not setup.haveExactSolutionPath()


@pytest.mark.parametrize("kind", KINDS)
def test_a_closed_wall_is_a_timeout_in_plan(kind):
    result = plan(scenario_of(kind, blocked=True), NAME, time_limit=0.3)
    assert (result.status, result.path) == ("timeout", None)


def test_an_interrupt_ends_it(monkeypatch):
    scenario = scenario_of("spatial", blocked=True)
    plan(scenario, NAME, time_limit=0.01)
    ended = []

    def endless(_):
        # Nothing but the interrupt ends it.
        condition = ob.plannerNonTerminatingCondition()
        ended.append(True)
        return condition

    monkeypatch.setattr(bindings, "stop_after", endless)
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        plan(scenario, NAME, time_limit=600.0)
    assert ended == [True]


def test_a_second_solve_goes_on_and_clear_begins_anew():
    setup, planner = of("spatial")
    planner.warm_up()
    assert setup.solve(5.0).getStatus() == Statuses.EXACT_SOLUTION
    path, first = path_of(setup, scenario_of("spatial").cspace()), planner.statistics
    setup.getProblemDefinition().clearSolutionPaths()
    assert setup.solve(5.0).getStatus() == Statuses.EXACT_SOLUTION
    assert planner.statistics["steps"] > first["steps"]
    planner.clearQuery()
    setup.getProblemDefinition().clearSolutionPaths()
    assert setup.solve(5.0).getStatus() == Statuses.EXACT_SOLUTION
    planner.clear()
    assert planner.statistics == {}
    setup.getProblemDefinition().clearSolutionPaths()
    assert setup.solve(5.0).getStatus() == Statuses.EXACT_SOLUTION
    assert planner.statistics == first
    np.testing.assert_array_equal(path_of(setup, scenario_of("spatial").cspace()), path)


def test_another_problem_begins_new_trees():
    cspace = scenario_of("planar").cspace()
    setup, planner = own_setup(cspace, [[-6.0, 0.0, 0.0]], [[6.0, 0.0, 1.0]])
    assert setup.solve(5.0).getStatus() == Statuses.EXACT_SOLUTION
    si, access = setup.getSpaceInformation(), state_access(cspace)
    setup.clear()
    setup.clearStartStates()
    state = si.allocState()
    access.write(state, [6.0, 5.0, 2.0])
    setup.addStartState(state)
    assert setup.solve(5.0).getStatus() == Statuses.EXACT_SOLUTION
    path = path_of(setup, cspace)
    np.testing.assert_allclose(path[0], [6.0, 5.0, 2.0], atol=1e-12)
    assert is_proved(cspace, path)
    assert planner.error is None


def test_anytime_adds_better_solutions_and_the_best_counts():
    setup, planner = of("planar")
    setup.solve(5.0)
    first = setup.getSolutionPath().length()
    setup.clear()
    planner.anytime = True
    assert setup.solve(0.5).getStatus() == Statuses.EXACT_SOLUTION
    assert setup.getProblemDefinition().getSolutionCount() > 1
    assert setup.getSolutionPath().length() < first
    cspace = scenario_of("planar").cspace()
    assert is_proved(cspace, path_of(setup, cspace))


def test_seeds_reach_the_search():
    setup, planner = of("planar")
    planner.seeds = np.array([[0.0, -3.0, 0.0, 0.0, 0.0, 0.0, 1.0]])
    assert setup.solve(5.0).getStatus() == Statuses.EXACT_SOLUTION
    planner.clear()
    planner.seeds = np.ones((2, 3))
    assert setup.solve(1.0).getStatus() == Statuses.CRASH
    assert "seeds: expected poses" in planner.error


BAD = [
    ("range", 0.0), ("range", -1.0), ("range", float("nan")), ("range", "far"),
    ("range", float("inf")), ("halvings", -1), ("halvings", 51), ("halvings", 1.5),
    ("halvings", True), ("uniform", 1.1), ("uniform", -0.1), ("uniform", None),
    ("gate_share", 2), ("gate_share", "all"), ("seed", -1), ("seed", 0.5),
    ("metric_weight", -1.0), ("metric_weight", float("nan")), ("anytime", 1),
]  # fmt: skip


@pytest.mark.parametrize(("name", "value"), BAD)
def test_bad_parameters_are_refused(name, value):
    setup, planner = of("planar", **{name: value})
    with pytest.raises(PlannerError, match=f"^{name}: expected"):
        planner.check_parameters()
    with pytest.raises(PlannerError, match=f"^{name}: expected"):
        setup.solve(1.0)


def test_parameters_reach_it_through_the_registry():
    assert NAME in planner_names()
    entry = find_planner(NAME)
    values = checked_parameters(entry, {"range": 3, "halvings": 2.0, "metric_weight": None})
    planner = entry.allocate(of("planar")[0].getSpaceInformation(), values)
    assert (planner.range, planner.halvings, planner.metric_weight) == (3, 2, None)
    with pytest.raises(PlannerError, match="did you mean range"):
        checked_parameters(entry, {"rnge": 3})
    with pytest.raises(PlannerError, match="uniform: expected a number from 0 to 1"):
        checked_parameters(entry, {"uniform": 3})


@pytest.mark.parametrize("parameters", [{"range": 0.7}, {"uniform": 1.0}, {"halvings": 0}])
@pytest.mark.parametrize("kind", KINDS)
def test_it_plans_with_other_parameters(kind, parameters):
    setup, _ = of(kind, **parameters)
    assert setup.solve(20.0).getStatus() == Statuses.EXACT_SOLUTION
    cspace = scenario_of(kind).cspace()
    assert is_proved(cspace, path_of(setup, cspace))


def test_an_exception_is_a_crash_with_its_traceback(monkeypatch):
    setup, planner = of("planar")
    monkeypatch.setattr(planner, "_add_path", lambda *_: 1 / 0)
    assert setup.solve(1.0).getStatus() == Statuses.CRASH
    assert "ZeroDivisionError" in planner.error
    monkeypatch.undo()
    assert setup.solve(5.0).getStatus() == Statuses.EXACT_SOLUTION
    assert planner.error is None


def test_it_needs_the_plugin_s_checker():
    setup = simple_setup(scenario_of("planar"), "fcl", seed=1)
    setup.setPlanner(FreeIntervalRRTConnect(setup.getSpaceInformation()))
    with pytest.raises(PlannerError, match=f"{NAME} needs the plug-in's EllipsoidValidityChecker"):
        setup.solve(1.0)


def test_benchmark_runs_it_beside_ompl_s_planners(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # OMPL leaves a console file where it runs
    setup = simple_setup(scenario_of("spatial"), seed=1)
    benchmark = ot.Benchmark(setup, "beside")
    benchmark.addPlannerAllocator(FreeIntervalRRTConnect)
    benchmark.addPlanner(og.RRTConnect(setup.getSpaceInformation()))
    request = ot.Request()
    request.maxTime, request.runCount, request.displayProgress = 2.0, 3, False
    benchmark.benchmark(request)
    assert benchmark.saveResultsToFile(str(tmp_path / "runs.log"))
    assert NAME in (tmp_path / "runs.log").read_text()
    planners = benchmark.getRecordedExperimentData().planners
    assert all(run["solved BOOLEAN"] == "1" for p in planners for run in p.runs)


def test_hundreds_of_plans_leave_nothing():
    scenario = scenario_of("planar")
    assert growth(lambda: plan(scenario, NAME, seed=1, simplify=False), 300) < 10_000
