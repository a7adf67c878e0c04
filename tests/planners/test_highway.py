"""HighwayRoadmap as OMPL sees it."""

import numpy as np
import pytest
from ompl import base as ob
from ompl import geometric as og
from ompl import tools as ot

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.world import World
from planners import bindings
from planners.highway import HighwayRoadmap
from planners.registry import checked_parameters, find_planner
from planners.setup import install, simple_setup
from planners.solve import plan
from planners.spaces import state_access, state_space
from tests.planners.planner_scenes import KINDS, scenario_of
from tests.planners.test_plugin_memory import growth
from tests.roadmap.scenes import cage
from tests.told import StopAt

Statuses = ob.PlannerStatus.PlannerStatusType


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
    planner = HighwayRoadmap(si)
    setup.setPlanner(planner)
    return setup, planner


def path_of(setup, cspace):
    return bindings.configurations_of_path(setup.getSolutionPath(), state_access(cspace))


def is_proved(cspace, path):
    return bool(cspace.are_motions_valid(path[:-1], path[1:]).all())


@pytest.mark.parametrize("kind", KINDS)
def test_three_lines_plan_a_proved_path(kind):
    scenario = scenario_of(kind)
    setup = simple_setup(scenario, seed=1)
    setup.setPlanner(HighwayRoadmap(setup.getSpaceInformation()))
    assert setup.solve(10.0).getStatus() == Statuses.EXACT_SOLUTION
    path = path_of(setup, scenario.cspace())
    np.testing.assert_allclose(path[[0, -1]], [scenario.start, scenario.goal], atol=1e-12)
    assert is_proved(scenario.cspace(), path)
    planner = setup.getPlanner()
    assert planner.statistics["lines"] > 0
    graph = planner.roadmap_graph()
    first, last = graph.configurations[graph.edges.T]
    assert len(graph.edges) > 0
    assert scenario.cspace().are_motions_valid(first, last).all()


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
        assert planner.statistics["lines"] == 0


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
def test_it_ends_when_told(n):
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


def test_queries_reuse_the_roadmap_until_it_is_cleared():
    setup = simple_setup(scenario_of("spatial"), seed=1)
    planner = HighwayRoadmap(setup.getSpaceInformation())
    setup.setPlanner(planner)
    setup.solve(5.0)
    first = planner.statistics
    setup.getProblemDefinition().clearSolutionPaths()
    planner.clearQuery()
    assert planner.statistics == first
    assert setup.solve(5.0).getStatus() == Statuses.EXACT_SOLUTION
    # Both queries are counted, on one and the same roadmap.
    assert planner.statistics["levels"] == first["levels"]
    assert planner.statistics["expansions"] > first["expansions"]
    planner.clear()
    assert planner.statistics == {}
    setup.getProblemDefinition().clearSolutionPaths()
    setup.solve(5.0)
    assert planner.statistics == first


def test_anytime_adds_better_solutions_and_the_best_counts():
    scenario = scenario_of("planar")
    setup = simple_setup(scenario, seed=1)
    planner = HighwayRoadmap(setup.getSpaceInformation())
    setup.setPlanner(planner)
    setup.solve(5.0)
    first = setup.getSolutionPath().length()
    setup.clear()
    planner.anytime = True
    assert setup.solve(0.5).getStatus() == Statuses.EXACT_SOLUTION
    assert setup.getProblemDefinition().getSolutionCount() > 1
    assert setup.getSolutionPath().length() < first
    assert is_proved(scenario.cspace(), path_of(setup, scenario.cspace()))


BAD = [
    ("lines", 0), ("layers", 10**9), ("axis", 2), ("axis", -1), ("neighbours", 0),
    ("inflation", 0.5), ("inflation", float("nan")), ("refine", -1), ("refine", 1.5),
    ("seed", -1), ("metric_weight", -1.0), ("lines", "ten"), ("anytime", 1), ("lines", True),
]  # fmt: skip


@pytest.mark.parametrize(("name", "value"), BAD)
def test_bad_parameters_are_refused(name, value):
    setup = simple_setup(scenario_of("planar"), seed=1)
    planner = HighwayRoadmap(setup.getSpaceInformation())
    setattr(planner, name, value)
    with pytest.raises(PlannerError, match=f"^{name}: expected"):
        planner.check_parameters()
    setup.setPlanner(planner)
    with pytest.raises(PlannerError, match=f"^{name}: expected"):
        setup.solve(1.0)


def test_parameters_reach_it_through_the_registry():
    setup = simple_setup(scenario_of("planar"), seed=1)
    entry = find_planner("HighwayRoadmap")
    values = checked_parameters(entry, {"lines": 30.0, "layers": None, "metric_weight": 2})
    planner = entry.allocate(setup.getSpaceInformation(), values)
    assert (planner.lines, planner.layers, planner.metric_weight) == (30, None, 2)
    with pytest.raises(PlannerError, match="did you mean lines"):
        checked_parameters(entry, {"line": 3})


def test_an_exception_is_a_crash_with_its_traceback(monkeypatch):
    setup = simple_setup(scenario_of("planar"), seed=1)
    planner = HighwayRoadmap(setup.getSpaceInformation())
    setup.setPlanner(planner)
    monkeypatch.setattr(planner, "_add_path", lambda *_: 1 / 0)
    assert setup.solve(1.0).getStatus() == Statuses.CRASH
    assert "ZeroDivisionError" in planner.error
    monkeypatch.undo()
    assert setup.solve(1.0).getStatus() == Statuses.EXACT_SOLUTION
    assert planner.error is None


def test_it_needs_the_plugin_s_checker():
    setup = simple_setup(scenario_of("planar"), "fcl", seed=1)
    setup.setPlanner(HighwayRoadmap(setup.getSpaceInformation()))
    with pytest.raises(PlannerError, match="needs the plug-in's EllipsoidValidityChecker"):
        setup.solve(1.0)


def test_benchmark_runs_it_beside_ompl_s_planners(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # OMPL leaves a console file where it runs
    setup = simple_setup(scenario_of("spatial"), seed=1)
    si = setup.getSpaceInformation()
    benchmark = ot.Benchmark(setup, "beside")
    benchmark.addPlanner(HighwayRoadmap(si))
    benchmark.addPlannerAllocator(HighwayRoadmap)
    benchmark.addPlanner(og.RRTConnect(si))
    request = ot.Request()
    request.maxTime, request.runCount, request.displayProgress = 2.0, 3, False
    benchmark.benchmark(request)
    assert benchmark.saveResultsToFile(str(tmp_path / "runs.log"))
    log = (tmp_path / "runs.log").read_text()
    assert log.count("geometric_RRTConnect") + log.count("HighwayRoadmap") >= 3
    assert "3 planners" in log
    planners = benchmark.getRecordedExperimentData().planners
    assert all(run["solved BOOLEAN"] == "1" for p in planners for run in p.runs)
    assert [len(p.runs) for p in planners] == [3, 3, 3]


def test_hundreds_of_plans_leave_nothing():
    scenario = scenario_of("planar")
    assert growth(lambda: plan(scenario, "HighwayRoadmap", seed=1), 500) < 10_000


class Near(ob.GoalRegion):
    """Tells how far a state is from a place, and no more."""

    def distanceGoal(self, state):  # noqa: N802
        return abs(state.getX())


def test_a_goal_that_cannot_be_sampled_is_named():
    cspace = scenario_of("planar").cspace()
    setup, planner = own_setup(cspace, [[-6.0, 0.0, 0.0]], [[6.0, 0.0, 1.0]])
    setup.setGoal(Near(setup.getSpaceInformation()))
    status = setup.solve(5.0).getStatus()
    assert status == Statuses.UNRECOGNIZED_GOAL_TYPE
    assert "GoalRegion" in planner.error
    assert "GoalStates" in planner.error
