"""Steps in the C-space of an articulated robot: how joints change gaps, and moving by a step.

A step is (t, r, joints): as for a rigid robot (see contact_model), then one number for each
revolute, continuous or prismatic joint and a rotation vector in the joint's frame for a ball
joint, scaled by how far the joint's turn moves points, so that all are lengths.
"""

import math

from .compile import kernel
from .kinematics import (
    BALL,
    CONTINUOUS,
    JOINT_HIGH,
    JOINT_KIND,
    JOINT_LOW,
    JOINT_PARENT,
    JOINT_REACH,
    JOINT_ROTATION,
    JOINT_TANGENT,
    JOINT_VALUE,
    PRISMATIC,
    joint_rows,
    owners_of,
    turned,
)
from .linear import cross, norm, product
from .motion import SMALL_ROTATION


@kernel
def _lever(frames, b, px, py, pz, ux, uy, uz):
    """The moment (p − origin of body b) × u of a push along u at the point p."""
    f = frames[b]
    return cross(px - f[9], py - f[10], pz - f[11], ux, uy, uz)


@kernel
def add_joint_gradient(kinematics, frames, i, sign, ux, uy, uz, px, py, pz, gradient):
    """Add ``sign`` times how the joints move the world's point p of part ``i`` along u.

    ``gradient`` is the row of a whole step's.
    """
    joints, owners = joint_rows(kinematics), owners_of(kinematics)
    b = int(owners[i])
    while b > 0:
        j = b - 1
        kind, at = int(joints[j, JOINT_KIND]), int(joints[j, JOINT_TANGENT])
        f = frames[b]
        if kind == PRISMATIC:
            gradient[at] += sign * (f[2] * ux + f[5] * uy + f[8] * uz)
        else:
            mx, my, mz = _lever(frames, b, px, py, pz, ux, uy, uz)
            scale = sign / joints[j, JOINT_REACH]
            if kind == BALL:
                g = frames[int(joints[j, JOINT_PARENT])]
                for k in range(3):
                    o = JOINT_ROTATION + k
                    ax = g[0] * joints[j, o] + g[1] * joints[j, o + 3] + g[2] * joints[j, o + 6]
                    ay = g[3] * joints[j, o] + g[4] * joints[j, o + 3] + g[5] * joints[j, o + 6]
                    az = g[6] * joints[j, o] + g[7] * joints[j, o + 3] + g[8] * joints[j, o + 6]
                    gradient[at + k] += scale * (ax * mx + ay * my + az * mz)
            else:
                gradient[at] += scale * (f[2] * mx + f[5] * my + f[8] * mz)
        b = int(joints[j, JOINT_PARENT])


@kernel
def move_joints(kinematics, pose, step, out):
    """Write the joints of ``pose`` moved by ``step`` to ``out``, kept within their limits."""
    joints = joint_rows(kinematics)
    for j in range(joints.shape[0]):
        kind, at = int(joints[j, JOINT_KIND]), int(joints[j, JOINT_TANGENT])
        v, scale = int(joints[j, JOINT_VALUE]), 1.0 / joints[j, JOINT_REACH]
        if kind == BALL:
            q = turned(
                scale * step[at], scale * step[at + 1], scale * step[at + 2], 1.0,
                pose[v], pose[v + 1], pose[v + 2], pose[v + 3],
            )  # fmt: skip
            length = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
            for k in range(4):
                out[v + k] = q[k] / length
        elif kind == CONTINUOUS:
            value = pose[v] + scale * step[at]
            out[v] = value - 2.0 * math.pi * math.floor((value + math.pi) / (2.0 * math.pi))
        else:
            value = pose[v] + (step[at] if kind == PRISMATIC else scale * step[at])
            out[v] = min(max(value, joints[j, JOINT_LOW]), joints[j, JOINT_HIGH])


@kernel
def joint_difference(kinematics, first, last, out):
    """Write the step of the joints from ``first`` to ``last``, the shorter way round."""
    joints = joint_rows(kinematics)
    for j in range(joints.shape[0]):
        kind, at = int(joints[j, JOINT_KIND]), int(joints[j, JOINT_TANGENT])
        v, reach = int(joints[j, JOINT_VALUE]), joints[j, JOINT_REACH]
        if kind == BALL:
            x, y, z, w = product(
                last[v], last[v + 1], last[v + 2], last[v + 3],
                -first[v], -first[v + 1], -first[v + 2], first[v + 3],
            )  # fmt: skip
            if w < 0.0:
                x, y, z, w = -x, -y, -z, -w
            sine = norm(x, y, z)
            scale = reach * (2.0 if sine < 1e-12 else 2.0 * math.atan2(sine, w) / sine)
            out[at], out[at + 1], out[at + 2] = scale * x, scale * y, scale * z
            continue
        away = last[v] - first[v]
        if kind == CONTINUOUS:
            away -= 2.0 * math.pi * math.floor((away + math.pi) / (2.0 * math.pi))
        out[at] = away if kind == PRISMATIC else reach * away


@kernel
def hold_small_turns(kinematics, first, last):
    """Give ball joints of ``last`` that turn too little for OMPL their values in ``first``."""
    joints = joint_rows(kinematics)
    for j in range(joints.shape[0]):
        if int(joints[j, JOINT_KIND]) != BALL:
            continue
        v = int(joints[j, JOINT_VALUE])
        x, y, z, _ = product(
            last[v], last[v + 1], last[v + 2], last[v + 3],
            -first[v], -first[v + 1], -first[v + 2], first[v + 3],
        )  # fmt: skip
        if 2.0 * norm(x, y, z) < 1.1 * SMALL_ROTATION:
            for k in range(4):
                last[v + k] = first[v + k]
