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

from . import articulated_motion, articulated_validity, kinematics, motion, placement, validity
from .articulated_motion import MotionWorkspace, new_motion_workspace
from .compile import kernel
from .layout import CLEARANCE, new_placed, part_rows
from .self_collision import new_body, new_order


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
    return model if isinstance(model, np.ndarray) else model.scene


@overload(scene_of, inline="always")
def _scene_of(model):
    if _is_rigid(model):
        return lambda model: model
    return lambda model: model.scene


def place_at(model, pose, placed):
    """Write all parts of the robot at ``pose`` to ``placed``."""
    if isinstance(model, np.ndarray):
        placement.place(model, *pose, placed)
    else:
        kinematics.place_robot(
            part_rows(model.scene), model.kinematics, pose, model.work.frames, placed
        )


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


@kernel
def ways_are_free(model, first, last, counts):
    """:func:`prove_way` of every pair of rows (m, 7 or 7 + V)."""
    workspaces = motion.motion_workspaces()
    for k in range(first.shape[0]):
        counts[k] = prove_way(model, first[k], last[k], workspaces)


@kernel
def layers_are_free(model, poses, out):
    """:func:`layer_is_free` of every row, placed with its base where the row says."""
    placed = new_placed(scene_of(model))
    for k in range(poses.shape[0]):
        place_at(model, poses[k], placed)
        out[k] = layer_is_free(model, poses[k], placed)


@kernel
def poses_are_free(model, poses, out):
    """:func:`pose_is_free` of every row; bounds of rigid robots are not looked at."""
    placed = new_placed(scene_of(model))
    for k in range(poses.shape[0]):
        out[k] = pose_is_free(model, poses[k], placed)
