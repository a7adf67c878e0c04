"""Forward kinematics of articulated robots, and how fast their bodies move.

A *body* is a set of links that cannot move against each other; body 0 holds the base, body j + 1
hangs on joint j, and every body's parent has a lower number. The robot is one flat array, the
*kinematics*: a header, then tables

- *joints*, rows of ``JOINT`` numbers: kind, parent body, place of the value in a row, limits,
  origin (rotation row-major, translation) in the parent's frame. The z axis of a body's frame is
  the axis that it turns about or slides along;
- *owners*, the body of each part;
- *shapes*, rows of ``SHAPE`` numbers: A of each part made regular (planar parts are flat) and its
  inverse, in the body's frame;
- *pairs*, a matrix (parts, parts) of 1 where two parts may meet, else 0.

A *row* is a configuration as kernels take it: the base's pose (x, y, z, q_x, q_y, q_z, q_w), then
the values of the joints, one number each or a quaternion.
"""

import math

import numpy as np

from .compile import inlined, kernel
from .linear import cross, product, rotation_matrix
from .placement import place_part
from .validity import is_rotation

# Header
JOINT_COUNT = 0
PARTS = 1
WIDTH = 2
# How many numbers a step has, whether the base moves at all, how far points get from the base.
STEP_SIZE = 3
BASE_MOVES = 4
ROBOT_REACH = 5
KINEMATICS_HEADER = 6

REVOLUTE = 0
CONTINUOUS = 1
PRISMATIC = 2
BALL = 3

# Joint rows
JOINT_KIND = 0
JOINT_PARENT = 1
JOINT_VALUE = 2
JOINT_LOW = 3
JOINT_HIGH = 4
JOINT_ROTATION = 5
JOINT_TRANSLATION = 14
# Largest distance of a downstream point from the joint's origin, and the weight in OMPL's metric.
JOINT_REACH = 17
JOINT_WEIGHT = 18
# Where the joint stands in steps (see articulated_steps).
JOINT_TANGENT = 19
JOINT = 20

# Shape rows
SHAPE_MATRIX = 0
SHAPE_INVERSE = 9
SHAPE = 18

# Frames of bodies: rotation row-major, translation, then angular and linear velocity.
FRAME_ROTATION = 0
FRAME_TRANSLATION = 9
FRAME_SPIN = 12
FRAME_VELOCITY = 15
FRAME = 18


@kernel
def joint_rows(kinematics):
    """Rows of the joints, shape (J, JOINT), as a view."""
    count = int(kinematics[JOINT_COUNT])
    return kinematics[KINEMATICS_HEADER : KINEMATICS_HEADER + count * JOINT].reshape((count, JOINT))


@kernel
def owners_of(kinematics):
    """The body of each part, shape (P,), as a view."""
    first = KINEMATICS_HEADER + int(kinematics[JOINT_COUNT]) * JOINT
    return kinematics[first : first + int(kinematics[PARTS])]


@kernel
def shape_rows(kinematics):
    """Rows of the parts' shapes, shape (P, SHAPE), as a view."""
    parts = int(kinematics[PARTS])
    first = KINEMATICS_HEADER + int(kinematics[JOINT_COUNT]) * JOINT + parts
    return kinematics[first : first + parts * SHAPE].reshape((parts, SHAPE))


@kernel
def pair_matrix(kinematics):
    """Which parts may meet, shape (P, P), as a view."""
    parts = int(kinematics[PARTS])
    first = KINEMATICS_HEADER + int(kinematics[JOINT_COUNT]) * JOINT + parts * (1 + SHAPE)
    return kinematics[first : first + parts * parts].reshape((parts, parts))


@kernel
def new_frames(kinematics):
    """An empty table for the frames of all bodies, shape (J + 1, FRAME)."""
    return np.empty((int(kinematics[JOINT_COUNT]) + 1, FRAME))


@inlined
def _set_base(row, frames):
    """Write the base's frame; it stands still."""
    entries = rotation_matrix(row[3], row[4], row[5], row[6])
    for k in range(9):
        frames[0, k] = entries[k]
    for k in range(3):
        frames[0, FRAME_TRANSLATION + k] = row[k]


@kernel
def hang(joints, j, parent, row, frames):
    """Write the frame of body j + 1 from its parent's."""
    o, t, body = JOINT_ROTATION, JOINT_TRANSLATION, j + 1
    for k in range(3):
        a, b, c = frames[parent, 3 * k], frames[parent, 3 * k + 1], frames[parent, 3 * k + 2]
        for m in range(3):
            frames[body, 3 * k + m] = (
                a * joints[j, o + m] + b * joints[j, o + 3 + m] + c * joints[j, o + 6 + m]
            )
        frames[body, FRAME_TRANSLATION + k] = frames[parent, FRAME_TRANSLATION + k] + (
            a * joints[j, t] + b * joints[j, t + 1] + c * joints[j, t + 2]
        )
    kind, value = int(joints[j, JOINT_KIND]), int(joints[j, JOINT_VALUE])
    if kind == PRISMATIC:
        for k in range(3):
            frames[body, FRAME_TRANSLATION + k] += row[value] * frames[body, 3 * k + 2]
        return
    if kind == BALL:
        r0, r1, r2, r3, r4, r5, r6, r7, r8 = rotation_matrix(
            row[value], row[value + 1], row[value + 2], row[value + 3]
        )
        for k in range(3):
            a, b, c = frames[body, 3 * k], frames[body, 3 * k + 1], frames[body, 3 * k + 2]
            frames[body, 3 * k] = a * r0 + b * r3 + c * r6
            frames[body, 3 * k + 1] = a * r1 + b * r4 + c * r7
            frames[body, 3 * k + 2] = a * r2 + b * r5 + c * r8
        return
    cosine, sine = math.cos(row[value]), math.sin(row[value])
    for k in range(3):
        a, b = frames[body, 3 * k], frames[body, 3 * k + 1]
        frames[body, 3 * k] = cosine * a + sine * b
        frames[body, 3 * k + 1] = cosine * b - sine * a


@kernel
def body_frames(kinematics, row, frames):
    """Write the rotations and translations of all bodies at ``row`` to ``frames``."""
    joints = joint_rows(kinematics)
    _set_base(row, frames)
    for j in range(joints.shape[0]):
        hang(joints, j, int(joints[j, JOINT_PARENT]), row, frames)


@kernel
def place_on_frames(parts, owners, frames, placed):
    """Write all parts to ``placed`` where the frames of their bodies put them."""
    for i in range(parts.shape[0]):
        b = int(owners[i])
        f = frames[b]
        rotation = (f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8])
        place_part(parts, i, f[9], f[10], f[11], rotation, placed, i)


@kernel
def place_robot(parts, kinematics, row, frames, placed):
    """Write the frames of all bodies and all parts at ``row`` to ``frames`` and ``placed``."""
    body_frames(kinematics, row, frames)
    place_on_frames(parts, owners_of(kinematics), frames, placed)


@kernel
def body_velocities(kinematics, rates, frames):
    """Write angular and linear velocities of all bodies whose frames are known.

    ``rates`` stand where a row's values do: the base's translation (3), the base's rotation vector
    in the world (3), one place for its error, then a number for each joint or, for a ball joint,
    its rotation vector in the joint's frame. The linear velocity is that of the frame's origin.
    """
    joints = joint_rows(kinematics)
    for k in range(3):
        frames[0, FRAME_SPIN + k] = rates[3 + k]
        frames[0, FRAME_VELOCITY + k] = rates[k]
    for j in range(joints.shape[0]):
        p, b = int(joints[j, JOINT_PARENT]), j + 1
        kind, value = int(joints[j, JOINT_KIND]), int(joints[j, JOINT_VALUE])
        sx, sy, sz = frames[p, FRAME_SPIN], frames[p, FRAME_SPIN + 1], frames[p, FRAME_SPIN + 2]
        t = FRAME_TRANSLATION
        vx, vy, vz = cross(
            sx, sy, sz,
            frames[b, t] - frames[p, t],
            frames[b, t + 1] - frames[p, t + 1],
            frames[b, t + 2] - frames[p, t + 2],
        )  # fmt: skip
        vx += frames[p, FRAME_VELOCITY]
        vy += frames[p, FRAME_VELOCITY + 1]
        vz += frames[p, FRAME_VELOCITY + 2]
        if kind == PRISMATIC:
            vx += rates[value] * frames[b, 2]
            vy += rates[value] * frames[b, 5]
            vz += rates[value] * frames[b, 8]
        elif kind == BALL:
            # The rotation vector is fixed in the joint's frame, which the parent carries.
            o = JOINT_ROTATION
            ax, ay, az = rates[value], rates[value + 1], rates[value + 2]
            bx = joints[j, o] * ax + joints[j, o + 1] * ay + joints[j, o + 2] * az
            by = joints[j, o + 3] * ax + joints[j, o + 4] * ay + joints[j, o + 5] * az
            bz = joints[j, o + 6] * ax + joints[j, o + 7] * ay + joints[j, o + 8] * az
            sx += frames[p, 0] * bx + frames[p, 1] * by + frames[p, 2] * bz
            sy += frames[p, 3] * bx + frames[p, 4] * by + frames[p, 5] * bz
            sz += frames[p, 6] * bx + frames[p, 7] * by + frames[p, 8] * bz
        else:
            sx += rates[value] * frames[b, 2]
            sy += rates[value] * frames[b, 5]
            sz += rates[value] * frames[b, 8]
        frames[b, FRAME_SPIN], frames[b, FRAME_SPIN + 1], frames[b, FRAME_SPIN + 2] = sx, sy, sz
        frames[b, FRAME_VELOCITY] = vx
        frames[b, FRAME_VELOCITY + 1] = vy
        frames[b, FRAME_VELOCITY + 2] = vz


@kernel
def turned(x, y, z, s, qx, qy, qz, qw):
    """The quaternion q after the rotation by s times the rotation vector (x, y, z)."""
    angle = math.sqrt(x * x + y * y + z * z)
    scale = 0.5 * s if angle < 1e-300 else math.sin(0.5 * s * angle) / angle
    return product(scale * x, scale * y, scale * z, math.cos(0.5 * s * angle), qx, qy, qz, qw)


@kernel
def row_at(kinematics, start, rates, s, row):
    """Write the row at parameter ``s`` of the motion from ``start`` with ``rates``."""
    joints = joint_rows(kinematics)
    for k in range(3):
        row[k] = start[k] + s * rates[k]
    row[3], row[4], row[5], row[6] = turned(
        rates[3], rates[4], rates[5], s, start[3], start[4], start[5], start[6]
    )
    for j in range(joints.shape[0]):
        v = int(joints[j, JOINT_VALUE])
        if int(joints[j, JOINT_KIND]) == BALL:
            row[v], row[v + 1], row[v + 2], row[v + 3] = turned(
                rates[v], rates[v + 1], rates[v + 2], s,
                start[v], start[v + 1], start[v + 2], start[v + 3],
            )  # fmt: skip
        else:
            row[v] = start[v] + s * rates[v]


@kernel
def within_limits(kinematics, row):
    """Whether every joint's value is in its limits (to 1e-9) and every quaternion a rotation."""
    joints = joint_rows(kinematics)
    for j in range(joints.shape[0]):
        v = int(joints[j, JOINT_VALUE])
        if int(joints[j, JOINT_KIND]) == BALL:
            if not is_rotation(row[v], row[v + 1], row[v + 2], row[v + 3]):
                return False
        elif not (joints[j, JOINT_LOW] - 1e-9 <= row[v] <= joints[j, JOINT_HIGH] + 1e-9):
            return False
    return True
