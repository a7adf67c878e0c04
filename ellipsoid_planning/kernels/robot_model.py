# ruff: noqa: ARG001, ARG005 (every version of a function has the same arguments)
"""What the search asks of a robot, rigid or articulated, decided when it is compiled.

A *model* is what kernels know of a robot in its world: for a rigid robot the packed scene alone,
for an articulated one an :class:`ArticulatedModel`. The search and the passages are written once
and compiled for either; the functions here are where they differ. Poses are rows of 7 numbers, or
of 7 + V with the values of joints.
"""

from typing import NamedTuple

import numpy as np
from numba.core import types
from numba.extending import overload
from numpy.typing import NDArray

from . import (
    articulated_motion,
    articulated_steps,
    articulated_validity,
    kinematics,
    motion,
    placement,
    self_collision,
    validity,
)
from .articulated_motion import MotionWorkspace, new_motion_workspace
from .compile import kernel
from .layout import CLEARANCE, PART_RADIUS, PART_REACH, new_placed, part_rows
from .self_collision import new_body, new_order
from .separation import CONVERGE, separation

# About how many pairs a piece of an articulated motion looks at.
_PAIRS_PER_PIECE = 8


class ArticulatedModel(NamedTuple):
    """An articulated robot in its world, with the workspaces that kernels need for it."""

    scene: NDArray[np.float64]
    kinematics: NDArray[np.float64]
    work: MotionWorkspace
    order: NDArray[np.int64]
    body: NDArray[np.float64]


@kernel
def new_articulated_model(scene, kinematics):
    """The model of ``scene`` and ``kinematics``, with workspaces of its own."""
    return ArticulatedModel(
        scene,
        kinematics,
        new_motion_workspace(scene, kinematics),
        new_order(kinematics),
        new_body(),
    )


def _is_rigid(model):
    return isinstance(model, types.Array)


def scene_of(model):
    """The packed scene of a model."""
    raise NotImplementedError


@overload(scene_of, inline="always")
def _scene_of(model):
    if _is_rigid(model):
        return lambda model: model
    return lambda model: model.scene


def place_at(model, pose, placed):
    """Write all parts of the robot at ``pose`` to ``placed``."""
    raise NotImplementedError


@overload(place_at)
def _place_at(model, pose, placed):
    if _is_rigid(model):

        def place_rigid(model, pose, placed):
            placement.place(
                model, pose[0], pose[1], pose[2], pose[3], pose[4], pose[5], pose[6], placed
            )

        return place_rigid

    def place_articulated(model, pose, placed):
        kinematics.place_robot(
            part_rows(model.scene), model.kinematics, pose, model.work.frames, placed
        )

    return place_articulated


def pose_is_free(model, pose, placed):
    """Whether the robot at ``pose`` is proved free, itself included; it is left in ``placed``."""
    raise NotImplementedError


@overload(pose_is_free)
def _pose_is_free(model, pose, placed):
    if _is_rigid(model):

        def rigid_is_free(model, pose, placed):
            placement.place(
                model, pose[0], pose[1], pose[2], pose[3], pose[4], pose[5], pose[6], placed
            )
            return validity.placed_is_free(model, placed)

        return rigid_is_free

    def articulated_is_free(model, pose, placed):
        return articulated_validity.row_is_free(
            model.scene,
            model.kinematics,
            pose,
            model.work.frames,
            placed,
            model.order,
            model.body,
        )

    return articulated_is_free


def layer_is_free(model, pose, placed):
    """Whether a layer's placed robot stays clear of itself, wherever its base is."""
    raise NotImplementedError


@overload(layer_is_free)
def _layer_is_free(model, pose, placed):
    if _is_rigid(model):
        return lambda model, pose, placed: True

    def articulated_layer_is_free(model, pose, placed):
        contact = articulated_validity.first_self_contact(
            model.scene, model.kinematics, model.work.frames, placed, model.order, model.body
        )
        return contact[0] < 0 and kinematics.within_limits(model.kinematics, pose)

    return articulated_layer_is_free


def prove_way(model, first, last, workspaces):
    """:func:`kernels.motion.prove_motion` at the scene's clearance, for either kind of robot.

    ``workspaces`` are those of :func:`kernels.motion.motion_workspaces`.
    """
    raise NotImplementedError


@overload(prove_way)
def _prove_way(model, first, last, workspaces):
    if _is_rigid(model):

        def prove_rigid(model, first, last, workspaces):
            work, placed, stack = workspaces
            return motion.prove_motion(model, first, last, model[CLEARANCE], work, placed, stack)

        return prove_rigid

    def prove_articulated(model, first, last, workspaces):
        return articulated_motion.prove_articulated_motion(
            model.scene, model.kinematics, first, last, model.scene[CLEARANCE], model.work
        )

    return prove_articulated


def limit_proofs(model, workspaces, most):
    """Let one motion take at most so many proofs before it is refused."""
    raise NotImplementedError


@overload(limit_proofs)
def _limit_proofs(model, workspaces, most):
    if _is_rigid(model):

        def limit_rigid(model, workspaces, most):
            workspaces[0][motion.BUDGET] = most

        return limit_rigid

    def limit_articulated(model, workspaces, most):
        # A piece looks at all pairs.
        model.work.pieces[1] = int(most) // _PAIRS_PER_PIECE

    return limit_articulated


def pairs_looked_at(model):
    """About how many pairs of bodies the last proof looked at, beyond what is usual."""
    raise NotImplementedError


@overload(pairs_looked_at)
def _pairs_looked_at(model):
    if _is_rigid(model):
        return lambda model: 0
    return lambda model: model.work.pieces[0] * _PAIRS_PER_PIECE


def step_size(model):
    """How many numbers a step has (see contact_model)."""
    raise NotImplementedError


@overload(step_size, inline="always")
def _step_size(model):
    if _is_rigid(model):
        return lambda model: 6
    return lambda model: int(model.kinematics[kinematics.STEP_SIZE])


def base_moves(model):
    """1 if the robot's base can move, 0 if it is fixed."""
    raise NotImplementedError


@overload(base_moves, inline="always")
def _base_moves(model):
    if _is_rigid(model):
        return lambda model: 1.0
    return lambda model: model.kinematics[kinematics.BASE_MOVES]


def reach_of(model):
    """Largest distance of a point of the robot from its base."""
    raise NotImplementedError


@overload(reach_of)
def _reach_of(model):
    if _is_rigid(model):

        def rigid_reach(model):
            parts = part_rows(model)
            reach = 0.0
            for i in range(parts.shape[0]):
                reach = max(reach, parts[i, PART_REACH])
            return reach

        return rigid_reach
    return lambda model: model.kinematics[kinematics.ROBOT_REACH]


def add_joints(model, i, sign, ux, uy, uz, px, py, pz, gradient):
    """Add how the joints move the world's point p of part ``i`` along u to a step's gradient."""
    raise NotImplementedError


@overload(add_joints)
def _add_joints(model, i, sign, ux, uy, uz, px, py, pz, gradient):
    if _is_rigid(model):
        return lambda model, i, sign, ux, uy, uz, px, py, pz, gradient: None

    def add_articulated(model, i, sign, ux, uy, uz, px, py, pz, gradient):
        articulated_steps.add_joint_gradient(
            model.kinematics, model.work.frames, i, sign, ux, uy, uz, px, py, pz, gradient
        )

    return add_articulated


def next_own_pair(model, placed, pair, within):
    """The first pair of the robot's own parts after ``pair`` that may meet and is near, or −1.

    Pairs are numbered i · parts + j, i < j; near are those whose boxes are within ``within``.
    """
    raise NotImplementedError


@overload(next_own_pair)
def _next_own_pair(model, placed, pair, within):
    if _is_rigid(model):
        return lambda model, placed, pair, within: -1

    def next_articulated(model, placed, pair, within):
        may_meet, count = kinematics.pair_matrix(model.kinematics), placed.shape[0]
        for k in range(pair + 1, count * count):
            i, j = k // count, k % count
            if i < j and may_meet[i, j] != 0.0:
                away = abs(placed[i, 0] - placed[j, 0]) - placed[i, 12] - placed[j, 12]
                if away <= within and self_collision.boxes_meet(placed, i, j, within):
                    return k
        return -1

    return next_articulated


def own_gap(model, placed, i, j):
    """Gap of two of the robot's own parts with its direction from ``i`` to ``j``."""
    raise NotImplementedError


@overload(own_gap)
def _own_gap(model, placed, i, j):
    if _is_rigid(model):
        return lambda model, placed, i, j: (0.0, 1.0, 0.0, 0.0, 0.5)

    def articulated_gap(model, placed, i, j):
        parts = part_rows(model.scene)
        owners = kinematics.owners_of(model.kinematics)
        shapes = kinematics.shape_rows(model.kinematics)
        frame = model.work.frames[int(owners[i])]
        self_collision.as_body(shapes, i, frame, placed, model.body)
        lam = parts[i, PART_RADIUS] / (parts[i, PART_RADIUS] + parts[j, PART_RADIUS])
        return separation(model.body, 0, placed, j, lam, np.inf, CONVERGE)

    return articulated_gap


def move_other(model, pose, step, out):
    """Write what of ``pose`` is not the base's, moved by ``step``, to ``out``."""
    raise NotImplementedError


@overload(move_other)
def _move_other(model, pose, step, out):
    if _is_rigid(model):
        return lambda model, pose, step, out: None
    return lambda model, pose, step, out: articulated_steps.move_joints(
        model.kinematics, pose, step, out
    )


def other_difference(model, first, last, out):
    """Write the step, but for the base's part, that moves ``first`` to ``last``."""
    raise NotImplementedError


@overload(other_difference)
def _other_difference(model, first, last, out):
    if _is_rigid(model):
        return lambda model, first, last, out: None
    return lambda model, first, last, out: articulated_steps.joint_difference(
        model.kinematics, first, last, out
    )


def hold_other(model, first, last):
    """Let what of ``last`` turns too little for OMPL, but for the base, stay as in ``first``."""
    raise NotImplementedError


@overload(hold_other)
def _hold_other(model, first, last):
    if _is_rigid(model):
        return lambda model, first, last: None
    return lambda model, first, last: articulated_steps.hold_small_turns(
        model.kinematics, first, last
    )


@kernel
def ways_are_free(model, first, last, counts):
    """:func:`prove_way` of every pair of rows (m, 7 or 7 + V)."""
    workspaces = motion.motion_workspaces()
    for k in range(first.shape[0]):
        counts[k] = prove_way(model, first[k], last[k], workspaces)


@kernel
def place_layer(model, pose, placed):
    """Place a layer's robot at ``pose``: whether it stays clear of itself."""
    place_at(model, pose, placed)
    return layer_is_free(model, pose, placed)


@kernel
def layers_are_free(model, poses, out):
    """:func:`layer_is_free` of every row, placed with its base where the row says."""
    placed = new_placed(scene_of(model))
    for k in range(poses.shape[0]):
        out[k] = place_layer(model, poses[k], placed)


@kernel
def poses_are_free(model, poses, out):
    """:func:`pose_is_free` of every row; bounds of rigid robots are not looked at."""
    placed = new_placed(scene_of(model))
    for k in range(poses.shape[0]):
        out[k] = pose_is_free(model, poses[k], placed)


@kernel
def step_count(model):
    """:func:`step_size`, for callers in Python."""
    return step_size(model)
