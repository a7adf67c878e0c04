"""The fastest way from OMPL's states of an articulated robot to their proofs: two calls."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob

from ellipsoid_planning.cspace.poses import rotation_quaternion
from ellipsoid_planning.kernels import articulated_states as states
from ellipsoid_planning.kernels import safety_table
from ellipsoid_planning.robots.articulated import FIXED_BASE, FREE_BASE, ArticulatedRobot
from ellipsoid_planning.robots.joint import BALL, CONTINUOUS
from ellipsoid_planning.safety.planning import as_articulated

from .bindings import StateValues
from .spaces import state_space

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
    from ellipsoid_planning.cspace.space import CSpace
    from ellipsoid_planning.safety.tabulated import TabulatedSafety


def state_form(robot: ArticulatedRobot) -> NDArray[np.float64]:
    """What tells kernels how the states of ``robot`` are laid out (kernels.articulated_states)."""
    kind = _base_kind(robot)
    angles = [2] if kind == states.FREE_2D else []
    quaternions = [3] if kind == states.FREE_3D else []
    for joint in robot.moving_joints:
        first = robot.joint_slices[joint.name].start
        if joint.type == CONTINUOUS:
            angles.append(first)
        elif joint.type == BALL:
            quaternions.append(first)
    form = [kind, *_base_pose(robot), len(angles), *angles, len(quaternions), *quaternions]
    return np.array(form, dtype=np.float64)


def _base_kind(robot: ArticulatedRobot) -> int:
    if robot.base == FIXED_BASE:
        return states.FIXED
    if robot.base == FREE_BASE:
        return states.FREE_2D if robot.dimension == 2 else states.FREE_3D
    return states.TRANSLATING_2D if robot.dimension == 2 else states.TRANSLATING_3D


def _base_pose(robot: ArticulatedRobot) -> list[float]:
    pose = np.zeros(7)
    if robot.position is not None:
        pose[: robot.dimension] = robot.position
    if robot.orientation is not None:
        pose[3:] = rotation_quaternion(robot.orientation)
    return pose.tolist()


def articulated_state_check(cspace: ArticulatedCSpace) -> Callable[[ob.State], bool]:
    """From a state to whether it is proved free."""
    scene, kinematics, form = cspace.scene, cspace.kinematics, state_form(cspace.robot)
    return values_check(cspace, states.state_is_free, (scene, kinematics, form))


def tabulated_state_check(safety: TabulatedSafety) -> Callable[[ob.State], bool]:
    """From a state to whether it is proved safe, by tables where they tell."""
    arrays = (safety.cspace.scene, safety.kinematics, safety.book, safety.offsets, safety.intervals)
    form = state_form(as_articulated(safety.cspace))
    return values_check(safety.cspace, safety_table.tabulated_state_is_free, (*arrays, form))


def values_check(
    cspace: CSpace, is_free: Callable[..., bool], arguments: tuple[Any, ...]
) -> Callable[[ob.State], bool]:
    """From a state to what ``is_free`` says of ``arguments`` and then its values (1, d)."""
    space, size = state_space(cspace), cspace.robot.configuration_size
    serialize = space.serialize
    # Every call takes a buffer for itself, so that calls from several threads are safe.
    spare = [StateValues(space, 1, size)]

    def check(state: ob.State) -> bool:
        try:
            buffer = spare.pop()
        except IndexError:
            buffer = StateValues(space, 1, size)
        serialize(buffer.places[0], state)
        free = is_free(*arguments, buffer.values)
        spare.append(buffer)
        return free

    return check


def articulated_motion_check(
    cspace: ArticulatedCSpace,
) -> Callable[[ob.State, ob.State], bool]:
    """From two states to whether the motion between them is proved free."""
    scene, kinematics, form = cspace.scene, cspace.kinematics, state_form(cspace.robot)
    space, size = state_space(cspace), cspace.robot.configuration_size
    serialize, is_free = space.serialize, states.motion_of_states_is_free
    spare = [StateValues(space, 2, size)]

    def check(first: ob.State, second: ob.State) -> bool:
        try:
            buffer = spare.pop()
        except IndexError:
            buffer = StateValues(space, 2, size)
        serialize(buffer.places[0], first)
        serialize(buffer.places[1], second)
        free: bool = is_free(scene, kinematics, form, buffer.values)
        spare.append(buffer)
        return free

    return check


def articulated_reader(cspace: ArticulatedCSpace) -> Callable[[ob.State], NDArray[np.float64]]:
    """From a state to its configuration (d,), a view that holds until the next call."""
    space = state_space(cspace)
    serialize = space.serialize
    buffer = StateValues(space, 1, cspace.robot.configuration_size)
    place, values = buffer.places[0], buffer.values[0]  # the view keeps the memory alive

    def read(state: ob.State) -> NDArray[np.float64]:
        serialize(place, state)
        return values

    return read
