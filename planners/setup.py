"""Everything installed: from a scenario, or into a user's own space information."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from ompl import base as ob
from ompl import geometric as og

from ellipsoid_planning.errors import PlannerError

from .bindings import set_seed
from .motion import CertifiedMotionValidator
from .sampler import install_free_interval_sampler
from .spaces import check_cspace, check_space, state_space, write_configuration
from .validity import EllipsoidValidityChecker, TabulatedValidityChecker

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.space import CSpace
    from ellipsoid_planning.scenario import Scenario

Checker = Literal["plugin", "tabulated", "fcl"]
CHECKERS: tuple[Checker, ...] = ("plugin", "tabulated", "fcl")
PLUGIN_CHECKERS: tuple[Checker, ...] = ("plugin", "tabulated")
"""Those with certified motions; planners that need the plug-in work with them."""


def install(
    si: ob.SpaceInformation,
    cspace: CSpace,
    checker: Checker = "plugin",
    resolution: float | None = None,
    uniform_sampling: bool = False,
) -> None:
    """Install a checker, and what goes with it, into a space information of one's own.

    Args:
        si: over the plain OMPL space of the robot (see `planners.spaces.state_space`), not set up.
        cspace: of a world and a robot; no file is needed.
        checker: "plugin" for exact validity, certified motions and collision-free sampling;
            "tabulated" for the same with states looked up in tables, which are kept in the
            user's cache and made first if need be; "fcl" for python-fcl and discrete motions.
        resolution: for "fcl" alone, distance of the checked states along a motion as a fraction
            of the space's extent; OMPL's default, 0.01, if None.
        uniform_sampling: not for "fcl": draw valid states uniformly instead of favouring
            narrow places.

    Raises:
        PlannerError: unknown checker, bad resolution, a space that does not fit ``cspace``, or
            a ``cspace`` that is none.
        TableError: a table cannot be made, kept, or read.
    """
    check_cspace(cspace)
    if checker in PLUGIN_CHECKERS:
        if resolution is not None:
            raise PlannerError("resolution: certified motions have none; use it with checker 'fcl'")
        check_space(si.getStateSpace(), cspace)
        si.setStateValidityChecker(_plugin_checker(si, cspace, checker))
        si.setMotionValidator(CertifiedMotionValidator(si, cspace))
        install_free_interval_sampler(si, cspace, uniform_sampling)
    elif checker == "fcl":
        from .fcl import RESOLUTION, FclValidityChecker, check_motions_discretely

        si.setStateValidityChecker(FclValidityChecker(si, cspace))
        check_motions_discretely(si, RESOLUTION if resolution is None else resolution)
    else:
        raise PlannerError(f"checker: expected one of {', '.join(CHECKERS)}, got {checker!r}")


def _plugin_checker(
    si: ob.SpaceInformation, cspace: CSpace, checker: Checker
) -> EllipsoidValidityChecker:
    if checker == "plugin":
        return EllipsoidValidityChecker(si, cspace)
    from ellipsoid_planning.safety.tabulated import TabulatedSafety

    return TabulatedValidityChecker(si, TabulatedSafety(cspace))


def simple_setup(
    scenario: Scenario,
    checker: Checker = "plugin",
    seed: int | None = None,
    resolution: float | None = None,
    uniform_sampling: bool = False,
    cspace: CSpace | None = None,
) -> og.SimpleSetup:
    """An `og.SimpleSetup` with space, checker, motions, sampler, start and goal of ``scenario``.

    Args:
        scenario: what to plan for; its goal is an exact goal state.
        checker: "plugin", "tabulated" or "fcl", see `install`.
        seed: seeds OMPL's random numbers before anything random is made, unless None.
        resolution: see `install`.
        uniform_sampling: see `install`.
        cspace: of the scenario, if it exists already.

    Raises:
        PlannerError: see `install` and `planners.bindings.set_seed`; also for the C-space of
            another world, robot or clearance than the scenario's.
    """
    if cspace is not None:
        check_cspace(cspace, scenario)
    if seed is not None:
        set_seed(seed)
    cspace = scenario.cspace() if cspace is None else cspace
    si = ob.SpaceInformation(state_space(cspace))
    install(si, cspace, checker, resolution, uniform_sampling)
    si.setup()
    setup = og.SimpleSetup(si)
    start, goal = si.allocState(), si.allocState()
    write_configuration(start, scenario.start, cspace)
    write_configuration(goal, scenario.goal, cspace)
    setup.setStartAndGoalStates(start, goal)
    # Kernels are compiled or loaded here, and not on a planner's time.
    si.isValid(start)
    si.checkMotion(start, start)
    return setup
