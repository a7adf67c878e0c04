"""The corners of OMPL's Python bindings (2.0.1) that hang, crash or leak, wrapped once.

Nothing else in the plug-in touches them. What the wrappers protect from:

- *Dangling states.* OMPL hands out borrowed states; those of a path die when the path is changed
  (simplified), those of a `PlannerData` when the planner is cleared, and reading one afterwards
  ends the process. Here states are read into arrays at once and never kept.
- *Starts and goals.* `ProblemDefinition.getStartState` and `getInputStates` crash on their second
  use; a planner's `PlannerInputStates` does not.
- *Values.* `copyToReals` fills nothing, and reading a compound state component by component costs
  80 ns each. `serialize` copies all values at once, but to a bare address: too short a buffer, or
  a state of another space, and memory is overwritten.
- *Allocation.* `space.allocState` leaks, and so do `cloneState` of the space *and* of the space
  information; `si.allocState` does not. `freeState` on a state that Python holds crashes.
- *Cycles.* A motion validator that holds `si`, or a sampler allocator whose closure holds it, keeps
  the whole set-up alive for ever. `BITstar.getPlannerData` does so on its own.
- *Destruction.* An AORRTC that was never set up crashes when it is deleted.
- *Threads.* PRM and PRMstar run a second thread. A termination condition made from a Python
  function, a Python objective or a Python goal deadlocks there, and an exception in a callback
  (Ctrl-C is one) aborts the process. All conditions here are C++ objects.
- *Output.* OMPL writes its log to stdout.
"""

from __future__ import annotations

import ctypes
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob
from ompl import geometric as og
from ompl import util as ou

from ellipsoid_planning.errors import PlannerError

from .spaces import StateAccess

SEED_INSTEAD_OF_ZERO = 0x9E3779B9
"""OMPL ignores a seed of 0 with a message; this one takes its place."""

Output = Literal["silent", "stderr", "stdout"]


# --- output and random numbers ---------------------------------------------------------------


@contextmanager
def ompl_output(target: Output = "silent") -> Iterator[None]:
    """Send OMPL's log to ``target`` inside the block and restore the former handler after it."""
    former = ou.getOutputHandler()
    handler = _output_handler(target)
    if handler is None:
        ou.noOutputHandler()
    else:
        ou.useOutputHandler(handler)
    try:
        yield
    finally:
        if former is None:
            ou.noOutputHandler()
        else:
            ou.useOutputHandler(former)


def _output_handler(target: Output) -> Any:
    if target == "silent":
        return None
    return ou.OutputHandlerSTD() if target == "stdout" else ou.OutputHandlerFile("/dev/stderr")


def set_seed(seed: int) -> None:
    """Seed everything random in OMPL that is created from now on (0 is allowed here).

    Raises:
        PlannerError: ``seed`` is not an integer in [0, 2**32).
    """
    if type(seed) is not int or not 0 <= seed < 2**32:  # True is an int, but no seed
        raise PlannerError(f"seed: expected an integer in [0, 2**32), got {seed!r}")
    with ompl_output("silent"):  # a second call works, but logs an error
        ou.RNG.setSeed(seed or SEED_INSTEAD_OF_ZERO)


def draw_seed() -> int:
    """A fresh seed from OMPL's own sequence, so that `set_seed` governs our samplers too."""
    return int(ou.RNG().getLocalSeed())


# --- stopping --------------------------------------------------------------------------------


def stop_after(seconds: float) -> ob.PlannerTerminationCondition:
    """A condition that ends a solve after ``seconds``; it has no thread and no Python callback."""
    return ob.timedPlannerTerminationCondition(float(seconds))


def stop_when_solved(
    problem: ob.ProblemDefinition, seconds: float
) -> ob.PlannerTerminationCondition:
    """A condition that ends a solve after ``seconds`` or once ``problem`` has an exact path.

    AORRTC needs this to stop at its first path: it ignores the objective's threshold.
    """
    solved = ob.exactSolnPlannerTerminationCondition(problem)
    return ob.plannerOrTerminationCondition(stop_after(seconds), solved)


def path_length_objective(
    si: ob.SpaceInformation, first_path_suffices: bool
) -> ob.OptimizationObjective:
    """OMPL's path-length objective; optimising planners stop at any path when the first suffices.

    PRM does that by itself as long as nobody sets an objective, the optimising planners do not.
    """
    objective = ob.PathLengthOptimizationObjective(si)
    if first_path_suffices:
        objective.setCostThreshold(objective.infiniteCost())
    return objective


@dataclass
class Interruption:
    """Whether SIGINT arrived inside an `interruptible` block."""

    requested: bool = False


@contextmanager
def interruptible(condition: ob.PlannerTerminationCondition) -> Iterator[Interruption]:
    """Let SIGINT end a solve cleanly: inside the block it only calls ``condition.terminate()``.

    Python's own handler raises inside a callback, which aborts the process under PRM. The former
    handler is restored afterwards; the caller looks at ``requested`` and raises. Outside the main
    thread, where Python allows no handlers, the block changes nothing.
    """
    interruption = Interruption()
    if threading.current_thread() is not threading.main_thread():
        yield interruption
        return

    def on_signal(*_: object) -> None:
        interruption.requested = True
        condition.terminate()

    former = signal.signal(signal.SIGINT, on_signal)
    try:
        yield interruption
    finally:
        signal.signal(signal.SIGINT, signal.SIG_DFL if former is None else former)


# --- starts and goals ------------------------------------------------------------------------


def start_configurations(planner: ob.Planner, access: StateAccess) -> NDArray[np.float64]:
    """All *valid* start states of the planner's problem, shape (k, d)."""
    inputs = planner.getPlannerInputStates()
    inputs.restart()
    rows = []
    while (state := inputs.nextStart()) is not None:
        rows.append(access.read(state))
    return _as_rows(rows, access)


def goal_configurations(
    planner: ob.Planner, access: StateAccess, limit: int = 100
) -> NDArray[np.float64]:
    """The *valid* ones of up to ``limit`` goal states of the planner's problem, shape (k, d).

    Goal regions that can be sampled for ever are sampled ``limit`` times.
    """
    inputs = planner.getPlannerInputStates()
    inputs.restart()
    rows = []
    for _ in range(limit):
        if not inputs.haveMoreGoalStates():
            break
        state = inputs.nextGoal()  # one draw; None when it is invalid, though others may follow
        if state is not None:
            rows.append(access.read(state))
    return _as_rows(rows, access)


def _as_rows(rows: Sequence[tuple[float, ...]], access: StateAccess) -> NDArray[np.float64]:
    return np.array(rows, dtype=np.float64).reshape(len(rows), access.size)


# --- values of states --------------------------------------------------------------------------


class StateValues:
    """Room for the values of states of one space, copied in one call (90 ns) each way.

    It takes spaces whose states are float64 numbers alone: real vectors, SO(2), SO(3) and
    compounds of them, in the order of their subspaces. Only states of that space may be given.

    Attributes:
        values: (count, size); row i has those of the state that was last read into it.
        places: (count,), what `serialize(places[i], state)` and `deserialize(state, places[i])`
            of the space want to know of row i.
    """

    def __init__(self, space: ob.StateSpace, count: int, size: int) -> None:
        """Room for ``count`` states of ``size`` values.

        Raises:
            PlannerError: states of ``space`` have another number of values.
        """
        if space.getSerializationLength() != 8 * size:
            raise PlannerError(
                f"expected a space with states of {size} numbers,"
                f" got one of {space.getSerializationLength()} bytes"
            )
        self.values = np.zeros((count, size))
        # Views alone do not own their memory, so it is `values` that must stay.
        self.places = tuple(_capsule(row.ctypes.data) for row in self.values)


def _capsule(address: int) -> Any:
    """An address as the bindings take `void *`: a capsule of nanobind's name for it."""
    new = ctypes.pythonapi.PyCapsule_New
    new.restype = ctypes.py_object
    new.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
    return new(address, _CAPSULE_NAME, None)


_CAPSULE_NAME = b"nb_handle"  # the capsule keeps the pointer to it: it must live as long


# --- paths -----------------------------------------------------------------------------------


def path_from_configurations(
    si: ob.SpaceInformation, configurations: NDArray[np.float64], access: StateAccess
) -> og.PathGeometric:
    """An OMPL path through ``configurations`` (m, d); the path owns copies of its states."""
    path = og.PathGeometric(si)
    state = si.allocState()
    for row in configurations.tolist():
        access.write(state, row)
        path.append(state)
    return path


def configurations_of_path(path: og.PathGeometric, access: StateAccess) -> NDArray[np.float64]:
    """The states of ``path`` as an array (m, d) of its own, read at once."""
    states = (path.getState(i) for i in range(path.getStateCount()))
    return _as_rows([access.read(state) for state in states], access)


def simplified(
    si: ob.SpaceInformation,
    configurations: NDArray[np.float64],
    access: StateAccess,
    condition: ob.PlannerTerminationCondition,
) -> NDArray[np.float64]:
    """OMPL's path simplification of ``configurations`` (m, d), which themselves stay as they are.

    It works on a path of its own, so no state that anyone holds can be freed by it.
    """
    path = path_from_configurations(si, configurations, access)
    og.PathSimplifier(si).simplify(path, condition)
    return configurations_of_path(path, access)


# --- planners --------------------------------------------------------------------------------


def allocate_bound_planner(name: str, si: ob.SpaceInformation) -> ob.Planner:
    """A new planner of the bound class ``ompl.geometric.<name>``."""
    planner: ob.Planner = getattr(og, name)(si)
    if isinstance(planner, og.AORRTC):
        with ompl_output("silent"):
            planner.setup()
    return planner


def is_bound(planner: ob.Planner) -> bool:
    """Whether ``planner`` is one of OMPL's own classes (False: a subclass in Python)."""
    return type(planner).__module__.startswith("ompl.")


def graph_of_planner(
    planner: ob.Planner, access: StateAccess
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The tree or roadmap of a bound planner: configurations (m, d) and edges (k, 2).

    Each edge appears as OMPL stores it: in one direction, with PRM and PRMstar in both. Call it
    before `clear`. Planners written in Python are refused, because an overridden `getPlannerData`
    aborts the process when C++ calls it. After a call on a BITstar its space information is
    never freed.

    Raises:
        PlannerError: ``planner`` is a subclass written in Python.
    """
    data = _planner_data(planner)
    rows = [access.read(data.getVertex(i).getState()) for i in range(data.numVertices())]
    edges = [(i, j) for i in range(data.numVertices()) for j in data.getEdges(i)]
    return _as_rows(rows, access), np.array(edges, dtype=np.int64).reshape(len(edges), 2)


def graph_size_of_planner(planner: ob.Planner) -> tuple[int, int] | None:
    """Numbers of vertices and edges of a bound planner; an edge counts once.

    None where asking would leak (BITstar), or the planner keeps its graph to itself (AORRTC).
    """
    if isinstance(planner, og.BITstar | og.AORRTC):
        return None
    if isinstance(planner, og.PRM):  # copying its graph can take longer than the search
        return int(planner.milestoneCount()), int(planner.edgeCount())
    data = _planner_data(planner)
    return int(data.numVertices()), int(data.numEdges())


def _planner_data(planner: ob.Planner) -> ob.PlannerData:
    if not is_bound(planner):
        raise PlannerError(
            f"{planner.getName()} is written in Python: ask it for its roadmap itself,"
            " OMPL's PlannerData cannot be filled from Python safely"
        )
    data = ob.PlannerData(planner.getSpaceInformation())
    planner.getPlannerData(data)
    data.decoupleFromPlanner()
    return data


# --- valid-state samplers --------------------------------------------------------------------


def install_sampler(
    si: ob.SpaceInformation, allocator: Callable[[ob.SpaceInformation], ob.ValidStateSampler]
) -> None:
    """Make ``si`` draw valid states with ``allocator``, which must not hold ``si`` itself."""
    si.setValidStateSamplerAllocator(allocator)


def clear_sampler(si: ob.SpaceInformation) -> None:
    """Take the installed allocator away; call it when a set-up has served."""
    si.clearValidStateSamplerAllocator()
