"""OMPL's compound state space of an articulated robot: the base, then a subspace a joint.

States of compound spaces hand out their components by number, each with its own type; a number
out of range ends the process. That costs 80 ns a component and 60 ns a value, so checkers read
whole states at once instead, see `planners.bindings.StateValues`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from ompl import base as ob

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.robots.articulated import FIXED_BASE
from ellipsoid_planning.robots.joint import BALL, CONTINUOUS, Joint

if TYPE_CHECKING:
    from ellipsoid_planning.robots.articulated import ArticulatedRobot

Read = Callable[[ob.State], tuple[float, ...]]
Write = Callable[[ob.State, Sequence[float]], None]


def compound_space(robot: ArticulatedRobot, base: ob.StateSpace | None) -> ob.StateSpace:
    """The space of ``robot``: ``base`` (None if it is fixed), then each joint by its name.

    The base weighs 1 and a joint what `ArticulatedRobot.joint_weights` says. Compound spaces have
    no projection, which KPIECE1 and its kin need: they get the base's position or, on a fixed
    base, the joint that weighs most.
    """
    space = ob.CompoundStateSpace()
    if base is not None:
        space.addSubspace(base, 1.0)
    weights = [float(weight) for weight in robot.joint_weights]
    for joint, weight in zip(robot.moving_joints, weights, strict=True):
        space.addSubspace(_joint_space(joint), weight)
    projected = weights.index(max(weights)) if base is None else 0
    space.registerDefaultProjection(ob.SubspaceProjectionEvaluator(space, projected))
    space.lock()
    return space


def _joint_space(joint: Joint) -> ob.StateSpace:
    if joint.type == BALL:
        space = ob.SO3StateSpace()
    elif joint.type == CONTINUOUS:
        space = ob.SO2StateSpace()
    else:
        space = ob.RealVectorStateSpace(1)
        bounds = ob.RealVectorBounds(1)
        bounds.setLow(joint.lower)
        bounds.setHigh(joint.upper)
        space.setBounds(bounds)
    space.setName(joint.name)
    return space


def check_compound(space: ob.StateSpace, robot: ArticulatedRobot) -> None:
    """Refuse a space whose states or motions are not those of ``robot``.

    Weights and bounds may be others: they change no motion, and what is beyond the robot's own
    limits is invalid anyway.

    Raises:
        PlannerError: the space is not the plain compound space of this robot.
    """
    if type(space) is not ob.CompoundStateSpace:
        got = type(space).__name__
    else:
        parts = [space.getSubspace(i) for i in range(space.getSubspaceCount())]
        found = [(type(part), part.getDimension()) for part in parts]
        if found == _subspaces(robot):
            return
        got = _listed(found)
    raise PlannerError(
        f"an articulated robot of {len(robot.joint_names)} joints needs a CompoundStateSpace of"
        f" {_listed(_subspaces(robot))}, got {got} (build one with planners.spaces)"
    )


def _subspaces(robot: ArticulatedRobot) -> list[tuple[type, int]]:
    """Type and dimension of every subspace."""
    kinds = {CONTINUOUS: (ob.SO2StateSpace, 1), BALL: (ob.SO3StateSpace, 3)}
    joints = [kinds.get(joint.type, (ob.RealVectorStateSpace, 1)) for joint in robot.moving_joints]
    if robot.base == FIXED_BASE:
        return joints
    if not robot.rotates:
        return [(ob.RealVectorStateSpace, robot.dimension), *joints]
    return [(ob.SE2StateSpace, 3) if robot.dimension == 2 else (ob.SE3StateSpace, 6), *joints]


def _listed(subspaces: Sequence[tuple[type, int]]) -> str:
    names = [f"{kind.__name__.removesuffix('StateSpace')}({size})" for kind, size in subspaces]
    return " + ".join(names) or "nothing"


def compound_access(robot: ArticulatedRobot, base: tuple[Read, Write] | None) -> tuple[Read, Write]:
    """Reader and writer of states, from those of the base's own states (None if it is fixed)."""
    first = 0 if base is None else 1
    getters, setters = [], []
    if base is not None:
        getters.append(_base_getter(base[0]))
        setters.append(_base_setter(base[1], slice(0, robot.base_size)))
    for index, joint in enumerate(robot.moving_joints, first):
        place = robot.joint_slices[joint.name]
        getter, setter = _JOINT_ACCESS.get(joint.type, (_number, _set_number))
        getters.append(getter(index))
        setters.append(setter(index, place))

    def read(state: ob.State) -> tuple[float, ...]:
        values: list[float] = []
        for get in getters:
            values += get(state)
        return tuple(values)

    def write(state: ob.State, values: Sequence[float]) -> None:
        for put in setters:
            put(state, values)

    return read, write


def _base_getter(read: Read) -> Read:
    return lambda state: read(state[0])


def _base_setter(write: Write, place: slice) -> Write:
    return lambda state, values: write(state[0], values[place])


def _number(index: int) -> Read:
    return lambda state: (state[index][0],)


def _angle(index: int) -> Read:
    return lambda state: (state[index].value,)


def _quaternion(index: int) -> Read:
    def read(state: ob.State) -> tuple[float, ...]:
        q = state[index]
        return q.x, q.y, q.z, q.w

    return read


def _set_number(index: int, place: slice) -> Write:
    def write(state: ob.State, values: Sequence[float]) -> None:
        state[index][0] = values[place.start]

    return write


def _set_angle(index: int, place: slice) -> Write:
    def write(state: ob.State, values: Sequence[float]) -> None:
        state[index].value = values[place.start]

    return write


def _set_quaternion(index: int, place: slice) -> Write:
    def write(state: ob.State, values: Sequence[float]) -> None:
        q = state[index]
        q.x, q.y, q.z, q.w = values[place]

    return write


_JOINT_ACCESS = {
    CONTINUOUS: (_angle, _set_angle),
    BALL: (_quaternion, _set_quaternion),
}
