"""The traps that planners.bindings wraps; dangerous ones in a child process."""

import os
import signal
import threading

import numpy as np
import pytest
from ompl import base as ob
from ompl import geometric as og
from ompl import util as ou

from ellipsoid_planning.errors import PlannerError
from planners import bindings
from planners.registry import BoundPlanner, find_planner, planner_names
from planners.setup import simple_setup
from planners.spaces import state_access, write_configuration
from tests.planners.planner_scenes import run_python, scenario_of

BOUND = tuple(name for name in planner_names() if isinstance(find_planner(name), BoundPlanner))
EXACT = ob.PlannerStatus.PlannerStatusType.EXACT_SOLUTION

PROBLEM = """
import gc
import numpy as np
from ompl import base as ob, geometric as og
from planners import bindings
from planners.setup import simple_setup
from planners.spaces import state_access
from tests.planners.planner_scenes import scenario_of

def problem(name="RRTConnect", blocked=False):
    scenario = scenario_of("planar", blocked=blocked)
    setup = simple_setup(scenario, seed=1)
    planner = bindings.allocate_bound_planner(name, setup.getSpaceInformation())
    setup.setPlanner(planner)
    return setup, planner, state_access(scenario.cspace())
"""


def assert_clean(code: str) -> str:
    """Run ``code`` after PROBLEM; it must end by itself and leave no noise. Returns its output."""
    run = run_python(PROBLEM + code)
    assert run.returncode == 0, run.stderr
    assert run.stderr == ""
    return run.stdout


# --- output and seeds ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("target", "out", "err"),
    [("silent", False, False), ("stderr", False, True), ("stdout", True, False)],
)
def test_output_goes_where_it_is_sent_and_the_former_handler_returns(target, out, err, capfd):
    before = ou.getOutputHandler()
    with bindings.ompl_output(target):
        ou.OMPL_INFORM("hello from inside")
    after = ou.getOutputHandler()
    assert after is before
    captured = capfd.readouterr()
    assert ("hello" in captured.out, "hello" in captured.err) == (out, err)


def test_output_blocks_nest(capfd):
    with bindings.ompl_output("stdout"):
        with bindings.ompl_output("silent"):
            ou.OMPL_INFORM("inner")
        ou.OMPL_INFORM("outer")
    captured = capfd.readouterr()
    assert "inner" not in captured.out + captured.err
    assert "outer" in captured.out


@pytest.mark.parametrize("seed", [0, 1, 2**32 - 1])
def test_the_same_seed_gives_the_same_numbers(seed, capfd):
    draws = []
    for _ in range(2):
        bindings.set_seed(seed)
        draws.append((ou.RNG().uniform01(), bindings.draw_seed()))
    assert draws[0] == draws[1]
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("seed", [-1, 2**32, 1.5, True, None])
def test_bad_seeds_are_refused(seed):
    with pytest.raises(PlannerError, match="seed"):
        bindings.set_seed(seed)


# --- starts, goals, paths, graphs ------------------------------------------------------------


def test_starts_and_goals_can_be_read_again_and_again():
    scenario = scenario_of("planar")
    setup = simple_setup(scenario)
    access = state_access(scenario.cspace())
    si = setup.getSpaceInformation()
    other, blocked = si.allocState(), si.allocState()
    access.write(other, [-5.0, 1.0, 0.5])
    access.write(blocked, [0.0, 0.0, 0.0])
    setup.addStartState(other)
    setup.addStartState(blocked)
    goals = ob.GoalStates(si)
    for row in ([6.0, 0.0, 0.0], [0.0, 0.0, 0.0], [5.0, 1.0, 0.5]):
        access.write(other, row)
        goals.addState(other)
    setup.setGoal(goals)
    planner = og.RRT(si)
    planner.setProblemDefinition(setup.getProblemDefinition())
    for _ in range(3):
        starts = bindings.start_configurations(planner, access)
        assert starts == pytest.approx(np.array([scenario.start, [-5.0, 1.0, 0.5]]))
        found = bindings.goal_configurations(planner, access)
        assert sorted(found.tolist()) == [[5.0, 1.0, 0.5], [6.0, 0.0, 0.0]]


def test_starts_and_goals_outlive_their_states():
    assert_clean("""
setup, planner, access = problem()
setup.setup()
for _ in range(10):
    bindings.start_configurations(planner, access), bindings.goal_configurations(planner, access)
    gc.collect()
""")


def test_a_path_is_read_simplified_and_read_again():
    out = assert_clean("""
def main():
    setup, planner, access = problem()
    with bindings.ompl_output("silent"):
        assert setup.solve(bindings.stop_after(2.0))
    si = setup.getSpaceInformation()
    path = bindings.configurations_of_path(setup.getSolutionPath(), access)
    for _ in range(20):
        shorter = bindings.simplified(si, path, access, bindings.stop_after(1.0))
        again = bindings.configurations_of_path(setup.getSolutionPath(), access)
        assert np.array_equal(path, again)
        gc.collect()
    setup.clear()
    del setup, planner, si
    gc.collect()
    assert np.array_equal(shorter[[0, -1]], path[[0, -1]])
    print(len(path), len(shorter))

main()
""")
    before, after = map(int, out.split())
    assert 2 <= after <= before


def test_the_graph_of_bound_planners_can_be_read_and_survives_them():
    # BITstar leaks what it is asked (see bindings), which is reported at exit.
    names = [name for name in BOUND if name != "BITstar"]
    out = assert_clean(f"""
def read(name):
    setup, planner, access = problem(name)
    with bindings.ompl_output("silent"):
        setup.solve(bindings.stop_after(0.1))
        size = bindings.graph_size_of_planner(planner)
        configurations, edges = bindings.graph_of_planner(planner, access)
        setup.clear()
    del setup, planner
    gc.collect()
    if size is not None:
        stored = len(edges) // 2 if name.startswith("PRM") else len(edges)
        assert size == (len(configurations), stored) and len(configurations) > 1
    assert np.isfinite(configurations).all() and (edges < len(configurations)).all()
    print(name, configurations.shape[1], edges.shape[1], flush=True)

for name in {names!r}:
    read(name)
""")
    assert out.splitlines() == [f"{name} 3 2" for name in names]


def test_the_size_of_a_bitstar_graph_is_not_asked_for():
    assert_clean("""
def main():
    setup, planner, access = problem("BITstar")
    with bindings.ompl_output("silent"):
        setup.solve(bindings.stop_after(0.05))
    assert bindings.graph_size_of_planner(planner) is None

main()
""")


def test_the_graph_of_a_planner_written_in_python_is_refused():
    class Idle(ob.Planner):
        def __init__(self, si: ob.SpaceInformation) -> None:
            super().__init__(si, "Idle")

    setup = simple_setup(scenario_of("planar"))
    planner = Idle(setup.getSpaceInformation())
    assert not bindings.is_bound(planner)
    with pytest.raises(PlannerError, match="Idle is written in Python"):
        bindings.graph_of_planner(planner, state_access(scenario_of("planar").cspace()))


def test_planners_that_were_never_used_can_be_dropped():
    out = assert_clean(f"""
for name in {BOUND!r}:
    problem(name)
    gc.collect()
    print(name, flush=True)
""")
    assert out.split() == list(BOUND)


# --- stopping --------------------------------------------------------------------------------


@pytest.mark.parametrize("name", BOUND)
def test_sigint_ends_every_planner_cleanly(name):
    setup = simple_setup(scenario_of("planar", blocked=True))
    setup.setPlanner(bindings.allocate_bound_planner(name, setup.getSpaceInformation()))
    condition = bindings.stop_after(20.0)
    former = signal.getsignal(signal.SIGINT)
    timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
    with bindings.ompl_output("silent"), bindings.interruptible(condition) as interruption:
        timer.start()
        status = setup.solve(condition)
    timer.join()
    assert status.getStatus() != EXACT
    assert interruption.requested
    assert setup.getLastPlanComputationTime() < 10.0
    assert signal.getsignal(signal.SIGINT) is former


def test_outside_the_main_thread_no_handler_is_touched():
    seen = []

    def solve() -> None:
        with bindings.interruptible(bindings.stop_after(1.0)) as interruption:
            seen.append(interruption.requested)

    thread = threading.Thread(target=solve)
    thread.start()
    thread.join()
    assert seen == [False]


@pytest.mark.parametrize("name", ["AORRTC", "RRTstar", "BITstar", "PRM", "PRMstar", "SORRTstar"])
def test_optimising_planners_stop_at_their_first_path_when_told_to(name):
    setup = simple_setup(scenario_of("planar"), seed=1)
    si = setup.getSpaceInformation()
    setup.setPlanner(bindings.allocate_bound_planner(name, si))
    setup.setOptimizationObjective(bindings.path_length_objective(si, first_path_suffices=True))
    with bindings.ompl_output("silent"):
        status = setup.solve(bindings.stop_when_solved(setup.getProblemDefinition(), 20.0))
    assert status.getStatus() == EXACT
    assert setup.getLastPlanComputationTime() < 10.0


def test_an_anytime_objective_uses_the_time():
    setup = simple_setup(scenario_of("planar"), seed=1)
    si = setup.getSpaceInformation()
    setup.setPlanner(bindings.allocate_bound_planner("RRTstar", si))
    setup.setOptimizationObjective(bindings.path_length_objective(si, first_path_suffices=False))
    with bindings.ompl_output("silent"):
        assert setup.solve(bindings.stop_after(0.3))
    assert 0.29 < setup.getLastPlanComputationTime() < 1.0


def test_a_path_owns_its_states():
    scenario = scenario_of("spatial")
    cspace = scenario.cspace()
    access = state_access(cspace)
    setup = simple_setup(scenario)
    si = setup.getSpaceInformation()
    rows = np.array([scenario.start, scenario.goal])
    path = bindings.path_from_configurations(si, rows, access)
    state = path.getState(0)
    write_configuration(state, scenario.goal, cspace)
    assert np.array_equal(bindings.configurations_of_path(path, access)[0], scenario.goal)
    assert np.array_equal(rows[0], scenario.start)
