"""Layers of articulated robots: values of everything but translation (thesis 6.3.1).

A layer's row is the base's quaternion, then the values of the joints (4 + V,).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.poses import rotation_quaternion
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import articulated_rates, kinematics
from ellipsoid_planning.kernels.roadmap_metric import (
    METRIC,
    METRIC_BALL,
    METRIC_CONTINUOUS,
    METRIC_REAL,
)
from ellipsoid_planning.kernels.robot_model import layers_are_free
from ellipsoid_planning.roadmap.orientations import headings
from ellipsoid_planning.robots.articulated import FIXED_BASE, ArticulatedRobot
from ellipsoid_planning.robots.joint import BALL, CONTINUOUS, Joint

Array = NDArray[np.float64]

# With more angles than this (the base's among them) layers are quasi-random, not a product grid.
MOST_GRID_ANGLES = 3
_KINDS = {BALL: METRIC_BALL, CONTINUOUS: METRIC_CONTINUOUS}


def has_fixed_base(cspace: CSpace) -> bool:
    """Whether the robot's base cannot move: then a layer is one configuration."""
    return isinstance(cspace, ArticulatedCSpace) and cspace.articulated.base == FIXED_BASE


def has_few_angles(robot: ArticulatedRobot) -> bool:
    """Whether a product grid of the robot's layers is dense enough to lead everywhere."""
    simple = all(joint.value_count == 1 for joint in robot.moving_joints)
    turns = robot.rotates and robot.dimension == 3
    angles = len(robot.moving_joints) + int(robot.rotates)
    return simple and not turns and angles <= MOST_GRID_ANGLES


def layer_metric(cspace: CSpace) -> Array:
    """What joints count in the distance of layers, (J, METRIC) of kernels.roadmap_metric."""
    if not isinstance(cspace, ArticulatedCSpace):
        return np.empty((0, METRIC))
    robot = cspace.articulated
    table = np.empty((len(robot.moving_joints), METRIC))
    for row, joint, weight in zip(table, robot.moving_joints, robot.joint_weights, strict=True):
        at = robot.joint_slices[joint.name].start - robot.base_size + 4
        row[:] = _KINDS.get(joint.type, METRIC_REAL), at, weight
    return table


def spread_layers(cspace: ArticulatedCSpace, count: int, first: int = 0) -> Array:
    """About ``count`` well spread layers (L, 4 + V) at which the robot does not meet itself.

    A product grid of the base's headings and the joints' values for a planar robot of few joints,
    else points ``first``, ``first`` + 1, … of a sequence of low discrepancy.
    """
    robot = cspace.articulated
    if has_few_angles(robot):
        rows = _product_layers(robot, count)
    else:
        rows = _quasi_random_layers(cspace, count, first)
    return rows[clear_of_itself(cspace, rows)]


def clear_of_itself(cspace: ArticulatedCSpace, rows: Array) -> NDArray[np.bool_]:
    """Whether, (L,), the robot does not meet itself in layers (L, 4 + V), and is in its limits."""
    poses = np.zeros((len(rows), 3 + rows.shape[1]))
    poses[:, 3:] = rows
    out = np.empty(len(rows), dtype=np.bool_)
    layers_are_free(cspace.model, poses, out)
    return out


def _fixed_quaternion(robot: ArticulatedRobot) -> Array:
    return rotation_quaternion(np.asarray(robot.orientation))


def _steps(joint: Joint, step: float, weight: float) -> int:
    """How many values of a joint stand ``step`` apart in the metric."""
    return max(2, math.ceil(weight * (joint.upper - joint.lower) / step - 1e-9) + 1)


def _product_layers(robot: ArticulatedRobot, count: int) -> Array:
    """The product grid of about ``count`` layers whose steps are as equal as can be."""
    joints, weights = robot.moving_joints, robot.joint_weights
    turn = 0.5 * max(robot.reach, 1e-300)
    step = 2.0 * math.pi * turn
    while True:
        numbers = [
            _steps(joint, step, float(weight))
            for joint, weight in zip(joints, weights, strict=True)
        ]
        turns = max(1, math.ceil(2.0 * math.pi * turn / step)) if robot.rotates else 1
        if turns * math.prod(numbers) >= count:
            break
        step *= 0.93
    values = [np.linspace(j.lower, j.upper, k) for j, k in zip(joints, numbers, strict=True)]
    quaternions = headings(turns) if robot.rotates else _fixed_quaternion(robot)[None]
    index = np.meshgrid(np.arange(len(quaternions)), *values, indexing="ij")
    turned = quaternions[index[0].ravel().astype(int)]
    return np.column_stack([turned, *(value.ravel() for value in index[1:])])


def low_discrepancy(count: int, dimensions: int, first: int = 0) -> Array:
    """Points ``first``, ``first`` + 1, … of a sequence in [0, 1)^dimensions, (count, dimensions).

    The additive recurrence by powers of 1/φ, φ^(dimensions + 1) = φ + 1, the generalised golden
    ratio (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
    """
    ratio = 2.0
    for _ in range(64):
        ratio = (1.0 + ratio) ** (1.0 / (dimensions + 1.0))
    steps = (1.0 / ratio) ** np.arange(1, dimensions + 1)
    index = np.arange(first + 1, first + count + 1)
    return np.asarray((0.5 + np.outer(index, steps)) % 1.0)


def rotations_from_unit(points: Array) -> Array:
    """Quaternions (m, 4) of points (m, 3) of the unit cube, uniform as they are (Shoemake 1992)."""
    a, b, c = points.T
    r, s, t, u = np.sqrt(1.0 - a), np.sqrt(a), 2.0 * np.pi * b, 2.0 * np.pi * c
    return np.column_stack([r * np.sin(t), r * np.cos(t), s * np.sin(u), s * np.cos(u)])


def _quasi_random_layers(cspace: ArticulatedCSpace, count: int, first: int) -> Array:
    robot = cspace.articulated
    base = (1 if robot.dimension == 2 else 3) if robot.rotates else 0
    widths = [3 if joint.type == BALL else 1 for joint in robot.moving_joints]
    points = low_discrepancy(count, base + sum(widths), first)
    if not robot.rotates:
        rows = [np.tile(_fixed_quaternion(robot), (count, 1))]
    elif robot.dimension == 3:
        rows = [rotations_from_unit(points[:, :3])]
    else:
        half = np.pi * points[:, 0]
        zero = np.zeros(count)
        rows = [np.column_stack([zero, zero, np.sin(half), np.cos(half)])]
    at = base
    for joint, width in zip(robot.moving_joints, widths, strict=True):
        own = points[:, at : at + width]
        if joint.type == BALL:
            rows.append(rotations_from_unit(own))
        else:
            rows.append(joint.lower + own * (joint.upper - joint.lower))
        at += width
    return np.hstack(rows)


def guided_layers(cspace: ArticulatedCSpace, first: Array, last: Array, between: int) -> Array:
    """Layers (L, 4 + V) that a query between two rows (7 + V,) is likely to need.

    Those along OMPL's interpolation, those where the base and the joints turn one after the other,
    and along the way with the joints in the middle of their ranges.
    """
    rates, row = np.empty(len(first)), np.empty(len(first))
    articulated_rates.set_rates(cspace.scene, cspace.kinematics, first, last, rates)
    rows = []
    middle = middle_of_joints(cspace.articulated)
    for k in range(between + 2):
        kinematics.row_at(cspace.kinematics, first, rates, k / (between + 1.0), row)
        row[3:7] /= np.linalg.norm(row[3:7])
        _normalise(cspace.articulated, row)
        rows.append(row[3:].copy())
        rows.append(np.concatenate([row[3:7], middle]))
    rows.append(np.concatenate([first[3:7], last[7:]]))
    rows.append(np.concatenate([last[3:7], first[7:]]))
    found = np.array(rows[2:-3] + rows[-2:])
    return found[clear_of_itself(cspace, found)]


def _normalise(robot: ArticulatedRobot, row: Array) -> None:
    """Bring the joint values of a row (7 + V,) to where OMPL has them."""
    for joint in robot.moving_joints:
        at = robot.joint_slices[joint.name]
        own = slice(at.start - robot.base_size + 7, at.stop - robot.base_size + 7)
        if joint.type == BALL:
            row[own] /= np.linalg.norm(row[own])
        elif joint.type == CONTINUOUS:
            row[own] = np.remainder(row[own] + np.pi, 2.0 * np.pi) - np.pi
        else:
            row[own] = np.clip(row[own], joint.lower, joint.upper)


def middle_of_joints(robot: ArticulatedRobot) -> Array:
    """The joint values (V,) nearest to 0 within the limits; ball joints at the identity."""
    values: list[float] = []
    for joint in robot.moving_joints:
        if joint.type == BALL:
            values += [0.0, 0.0, 0.0, 1.0]
        else:
            values.append(min(max(0.0, joint.lower), joint.upper))
    return np.array(values)


def home_configuration(robot: ArticulatedRobot) -> Array:
    """The configuration (d,) with the base at the origin and the joints in their middle."""
    base = np.zeros(robot.base_size)
    if robot.base_size == 7:
        base[6] = 1.0
    return np.concatenate([base, middle_of_joints(robot)])
