"""What our own planners have in common: an OMPL planner around a core that knows no OMPL."""

from __future__ import annotations

import traceback
from abc import abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.outcome import SOLVED, Outcome

from . import bindings
from .spaces import is_articulated, state_access
from .validity import EllipsoidValidityChecker

Statuses = ob.PlannerStatus.PlannerStatusType


def cspace_of(si: ob.SpaceInformation, planner: str = "the planner") -> CSpace:
    """The C-space behind the validity checker of ``si``.

    Raises:
        PlannerError: the checker is not the plug-in's; ``planner`` says who needs it.
    """
    checker = si.getStateValidityChecker()
    if not isinstance(checker, EllipsoidValidityChecker):
        raise PlannerError(
            f"{planner} needs the plug-in's EllipsoidValidityChecker in its SpaceInformation;"
            " install it with planners.setup.install(si, cspace)"
        )
    return checker.cspace


class CorePlanner(ob.Planner):
    """An OMPL planner whose work is done by a core, an object made from a C-space and parameters.

    It is built from a `SpaceInformation` that has the plug-in's checker, so a subclass is itself
    a planner allocator. Parameters are plain attributes, read at every `solve`; changing one
    makes a new core.

    A core has ``cspace``, ``parameters``, ``statistics`` and ``compile_kernels()``.

    Attributes:
        error: why the last solve ended without an answer: the traceback of an exception (CRASH),
            or what is wrong with the goal (UNRECOGNIZED_GOAL_TYPE); None if it did not.
    """

    PARAMETERS: ClassVar[dict[str, Any]]
    """Names and types of the parameters."""
    PARAMETER_CLASS: ClassVar[type]
    """The dataclass that checks them."""
    RIGID_ONLY: ClassVar[bool] = True
    """Whether the core plans for rigid robots only."""

    # What `kernels_in_use` told whenever this process has loaded kernels.
    _warm: ClassVar[set[tuple[Any, ...]]] = set()

    def __init__(self, si: ob.SpaceInformation) -> None:
        """Create a planner; the scene is looked up in ``si`` when it solves."""
        super().__init__(si, type(self).__name__)
        for name, value in vars(self.PARAMETER_CLASS()).items():
            setattr(self, name, value)
        self.error: str | None = None
        self._core: Any = None

    @abstractmethod
    def new_core(self, cspace: CSpace, parameters: Any) -> Any:
        """A fresh core."""

    @abstractmethod
    def run(
        self,
        starts: NDArray[np.float64],
        goals: NDArray[np.float64],
        should_stop: Callable[[], bool],
        on_path: Callable[[NDArray[np.float64]], None],
    ) -> Outcome:
        """Let the core plan from one of ``starts`` (S, d) to one of ``goals`` (G, d)."""

    def solve(self, ptc: ob.PlannerTerminationCondition | float) -> ob.PlannerStatus:
        """Plan until there is a path, nothing is left to try, or ``ptc`` holds (or seconds passed).

        An exception ends the solve with CRASH and is kept in ``error``.
        """
        self.error = None
        try:
            self._load_kernels()  # before the clock starts, if that is ours
            if isinstance(ptc, int | float):
                ptc = bindings.stop_after(ptc)
            return ob.PlannerStatus(self._solve(ptc))
        # An exception that crosses the bindings would end a whole benchmark.
        except Exception:  # noqa: BLE001
            self.error = traceback.format_exc()
            return ob.PlannerStatus(Statuses.CRASH)

    def _solve(self, ptc: ob.PlannerTerminationCondition) -> Any:
        access = state_access(self.core().cspace)
        starts = bindings.start_configurations(self, access)
        if len(starts) == 0:
            return Statuses.INVALID_START
        if not isinstance(self.getProblemDefinition().getGoal(), ob.GoalSampleableRegion):
            self.error = (
                f"{self.getName()} plans to goals that can be sampled: a GoalState, GoalStates or"
                " another GoalSampleableRegion; a plain Goal or GoalRegion tells how far a state"
                " is from it, but not where it is"
            )
            return Statuses.UNRECOGNIZED_GOAL_TYPE
        goals = bindings.goal_configurations(self, access)
        if len(goals) == 0:
            return Statuses.INVALID_GOAL
        outcome = self.run(starts, goals, ptc, self._add_path)
        # To have run out of things to try is no proof that there is no path.
        return Statuses.EXACT_SOLUTION if outcome.status == SOLVED else Statuses.TIMEOUT

    def _add_path(self, path: NDArray[np.float64]) -> None:
        si = self.getSpaceInformation()
        solution = bindings.path_from_configurations(si, path, state_access(self.core().cspace))
        self.getProblemDefinition().addSolutionPath(solution, False, 0.0, self.getName())

    def core(self) -> Any:
        """The core of the present scene and parameters, a new one if either has changed."""
        parameters, cspace = self._parameters(), self._cspace()
        kept = self._core
        if kept is None or kept.cspace is not cspace or kept.parameters != parameters:
            self._core = self.new_core(cspace, parameters)
        return self._core

    def _parameters(self) -> Any:
        return self.PARAMETER_CLASS(**{name: getattr(self, name) for name in self.PARAMETERS})

    def _cspace(self) -> CSpace:
        cspace = cspace_of(self.getSpaceInformation(), self.getName())
        if self.RIGID_ONLY and is_articulated(cspace):
            raise PlannerError(
                f"{self.getName()} plans for rigid robots only, not for articulated ones"
            )
        return cspace

    def setup(self) -> None:
        """Check the parameters.

        The first planner of a process also loads the kernels, or compiles them on a machine that
        has not yet run them, which takes about half a minute.
        """
        super().setup()
        self.check_parameters()
        self._load_kernels()

    def _load_kernels(self) -> None:
        if self.kernels_in_use() not in CorePlanner._warm:
            self.warm_up()

    def kernels_in_use(self) -> tuple[Any, ...]:
        """What tells the kernels of this planner from others': the class, unless they vary."""
        return (type(self),)

    def warm_up(self) -> None:
        """Compile every kernel that a solve can call, leaving the planner as it was."""
        self.new_core(self._cspace(), self._parameters()).compile_kernels()
        CorePlanner._warm.add(self.kernels_in_use())

    @classmethod
    def check_values(cls, values: Mapping[str, Any]) -> None:
        """Check values of parameters as far as that is possible without a scene.

        Raises:
            PlannerError: a value is out of its range.
        """
        cls.PARAMETER_CLASS(**values)

    def check_parameters(self) -> None:
        """Check the present parameters.

        Raises:
            PlannerError: a value is out of its range.
        """
        self.core()

    def clear(self) -> None:
        """Forget everything computed, and the query."""
        super().clear()
        self._core = None

    @property
    def statistics(self) -> dict[str, Any]:
        """The core's counts since the last `clear`."""
        return {} if self._core is None else dict(self._core.statistics)
