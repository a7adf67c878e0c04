"""OMPL state spaces for a C-space, and the way between states and flat configurations.

The spaces keep OMPL's defaults: SE(2) with weights 1 (translation) and 0.5 (heading), SE(3) with
1 and 1, and a real vector space for a robot that only translates. An articulated robot has a
compound of its base's space and one a joint (see `planners.compound`). Readers and writers use the
typed accessors of the states: they need no `setup()` of the space (`copyFromReals` crashes
without it) and cost 0.15 to 0.3 microseconds.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeGuard

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.robots.articulated import FIXED_BASE, ArticulatedRobot
from ellipsoid_planning.robots.configurations import checked_configuration

from .compound import check_compound, compound_access, compound_space

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
    from ellipsoid_planning.scenario import Scenario


@dataclass(frozen=True)
class StateAccess:
    """How the states of one kind of space are read and written.

    Attributes:
        size: length d of a configuration.
        read: state -> tuple of d floats, in the order of a configuration.
        write: (state, sequence of d floats) -> None; values are taken as they are.
    """

    size: int
    read: Callable[[ob.State], tuple[float, ...]]
    write: Callable[[ob.State, Sequence[float]], None]


def read_se2(state: ob.State) -> tuple[float, float, float]:
    """(x, y, yaw) of an SE(2) state."""
    return state.getX(), state.getY(), state.getYaw()


def read_se3(state: ob.State) -> tuple[float, float, float, float, float, float, float]:
    """(x, y, z, qx, qy, qz, qw) of an SE(3) state."""
    q = state.rotation()
    return state.getX(), state.getY(), state.getZ(), q.x, q.y, q.z, q.w


def read_vector2(state: ob.State) -> tuple[float, float]:
    """(x, y) of a state of a two-dimensional real vector space."""
    return state[0], state[1]


def read_vector3(state: ob.State) -> tuple[float, float, float]:
    """(x, y, z) of a state of a three-dimensional real vector space."""
    return state[0], state[1], state[2]


def write_se2(state: ob.State, values: Sequence[float]) -> None:
    """Set an SE(2) state to (x, y, yaw)."""
    x, y, yaw = values
    state.setXY(x, y)
    state.setYaw(yaw)


def write_se3(state: ob.State, values: Sequence[float]) -> None:
    """Set an SE(3) state to (x, y, z, qx, qy, qz, qw)."""
    x, y, z, qx, qy, qz, qw = values
    state.setXYZ(x, y, z)
    q = state.rotation()
    q.x, q.y, q.z, q.w = qx, qy, qz, qw


def write_vector(state: ob.State, values: Sequence[float]) -> None:
    """Set a state of a real vector space."""
    for i, value in enumerate(values):
        state[i] = value


_ACCESS = {
    (2, True): StateAccess(3, read_se2, write_se2),
    (3, True): StateAccess(7, read_se3, write_se3),
    (2, False): StateAccess(2, read_vector2, write_vector),
    (3, False): StateAccess(3, read_vector3, write_vector),
}


def is_articulated(cspace: CSpace) -> TypeGuard[ArticulatedCSpace]:
    """Whether ``cspace`` is that of an articulated robot."""
    return isinstance(cspace.robot, ArticulatedRobot)


def state_access(cspace: CSpace) -> StateAccess:
    """The readers and writers for the states of ``cspace``."""
    robot = cspace.robot
    base = _ACCESS[cspace.dimension, cspace.rotates]
    if not isinstance(robot, ArticulatedRobot):
        return base
    placed = None if robot.base == FIXED_BASE else (base.read, base.write)
    return StateAccess(robot.configuration_size, *compound_access(robot, placed))


def fixed_quaternion(cspace: CSpace) -> tuple[float, float, float, float]:
    """The unit quaternion (x, y, z, w) of a robot that only translates, as kernels take it."""
    qx, qy, qz, qw = cspace.poses(np.zeros(cspace.dimension))[0][3:].tolist()
    return qx, qy, qz, qw


def state_space(cspace: CSpace) -> ob.StateSpace:
    """The OMPL space of ``cspace``, bounded by its world.

    SE(2), SE(3) or a real vector space, and for articulated robots a compound that begins with it.
    """
    robot = cspace.robot
    if not isinstance(robot, ArticulatedRobot):
        return _base_space(cspace)
    return compound_space(robot, None if robot.base == FIXED_BASE else _base_space(cspace))


def _base_space(cspace: CSpace) -> ob.StateSpace:
    if cspace.rotates:
        space = ob.SE2StateSpace() if cspace.dimension == 2 else ob.SE3StateSpace()
    else:
        space = ob.RealVectorStateSpace(cspace.dimension)
    space.setBounds(_bounds(cspace))
    return space


def _bounds(cspace: CSpace) -> ob.RealVectorBounds:
    bounds = ob.RealVectorBounds(cspace.dimension)
    for i in range(cspace.dimension):
        bounds.setLow(i, float(cspace.world.low[i]))
        bounds.setHigh(i, float(cspace.world.high[i]))
    return bounds


def check_cspace(cspace: CSpace, scenario: Scenario | None = None) -> None:
    """Refuse what is no C-space, or not the one of ``scenario``.

    Raises:
        PlannerError: it is none, or that of another world, robot or clearance.
    """
    if not isinstance(cspace, CSpace):
        raise PlannerError(
            f"cspace: expected a CSpace, got {type(cspace).__name__}; make one with "
            "CSpace(world, robot) or scenario.cspace()"
        )
    if scenario is not None and not (
        cspace.world is scenario.world
        and cspace.robot is scenario.robot
        and cspace.clearance_required == scenario.clearance
    ):
        raise PlannerError(
            f"cspace: expected that of scenario {scenario.name!r}, got another world's, robot's "
            "or clearance's; make it with scenario.cspace()"
        )


def check_space(space: ob.StateSpace, cspace: CSpace) -> None:
    """Refuse a state space whose states or motions are not those that ``cspace`` speaks of.

    Subclasses are refused too: a Dubins car has SE(2) states, but other motions between them.

    Raises:
        PlannerError: the space is not the plain OMPL space of this robot.
    """
    if isinstance(cspace.robot, ArticulatedRobot):
        check_compound(space, cspace.robot)
        return
    expected = {
        (2, True): ob.SE2StateSpace,
        (3, True): ob.SE3StateSpace,
    }.get((cspace.dimension, cspace.rotates), ob.RealVectorStateSpace)
    got = type(space)
    if got is not expected or (not cspace.rotates and space.getDimension() != cspace.dimension):
        motion = "rotating" if cspace.rotates else "translating"
        raise PlannerError(
            f"a {motion} robot in {cspace.dimension}-D needs {expected.__name__}"
            f" of matching dimension, got {got.__name__} (build one with planners.spaces)"
        )


def write_configuration(
    state: ob.State, configuration: NDArray[np.float64], cspace: CSpace
) -> None:
    """Set ``state`` to ``configuration`` (d,).

    Raises:
        GeometryError: if it is no single configuration of finite numbers.
    """
    access = state_access(cspace)
    access.write(state, checked_configuration(configuration, access.size).tolist())


def read_configuration(state: ob.State, cspace: CSpace) -> NDArray[np.float64]:
    """The configuration (d,) of ``state``, as an array of its own."""
    return np.array(state_access(cspace).read(state), dtype=np.float64)
