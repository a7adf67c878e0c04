"""Molecules of ellipsoids on a chain of coordinates: poses of frames and of parts.

A molecule has K coordinates in an order where parents come first. Coordinate k moves its frame by
``values[k]`` after a fixed pose in the frame of its parent (-1 is the world): a turn [rad] about
``axes[k]``, or a shift along it. Positions, Euler angles and joints are all such coordinates. Each
of P parts is an ellipsoid in the frame of one coordinate (-1 for one that never moves).

Frames are rows of ``FRAME`` numbers: rotation (row-major), position. Placed parts are rows of
``POSED`` numbers: centre, A (row-major, A = R diag(a)). Planar molecules lie in z = 0.
"""

import math

from .compile import kernel

TURN, SHIFT = 0, 1
FRAME = 12
POSED = 12


@kernel
def turn_about(x, y, z, angle):
    """The rotation matrix about a unit axis, row-major, by Rodrigues' formula."""
    s = math.sin(angle)
    half = math.sin(0.5 * angle)
    v = 2.0 * half * half
    c = 1.0 - v
    return (
        v * x * x + c,
        v * x * y - s * z,
        v * x * z + s * y,
        v * x * y + s * z,
        v * y * y + c,
        v * y * z - s * x,
        v * x * z - s * y,
        v * y * z + s * x,
        v * z * z + c,
    )


@kernel
def compose(first, i, second, j, out, k):
    """Frame ``out[k]`` = ``first[i]`` after ``second[j]``; ``out`` may be ``first`` or another."""
    for row in range(3):
        a, b, c = first[i, 3 * row], first[i, 3 * row + 1], first[i, 3 * row + 2]
        x = a * second[j, 9] + b * second[j, 10] + c * second[j, 11] + first[i, 9 + row]
        p = a * second[j, 0] + b * second[j, 3] + c * second[j, 6]
        q = a * second[j, 1] + b * second[j, 4] + c * second[j, 7]
        r = a * second[j, 2] + b * second[j, 5] + c * second[j, 8]
        out[k, 3 * row], out[k, 3 * row + 1], out[k, 3 * row + 2] = p, q, r
        out[k, 9 + row] = x


@kernel
def place_frames(kinds, parents, origins, axes, values, frames):
    """Fill ``frames`` (K, FRAME) in the world for the ``values`` (K,) of all coordinates.

    ``kinds`` and ``parents`` are (K,), ``origins`` (K, FRAME), ``axes`` (K, 3).
    """
    for k in range(kinds.size):
        if parents[k] < 0:
            for m in range(FRAME):
                frames[k, m] = origins[k, m]
        else:
            compose(frames, parents[k], origins, k, frames, k)
        move_frame(kinds[k], axes, k, values[k], frames)


@kernel
def move_frame(kind, axes, k, value, frames):
    """Turn frame k about its axis, or shift it along it, by ``value``."""
    x, y, z = axes[k, 0], axes[k, 1], axes[k, 2]
    if kind == SHIFT:
        for row in range(3):
            a, b, c = frames[k, 3 * row], frames[k, 3 * row + 1], frames[k, 3 * row + 2]
            frames[k, 9 + row] += value * (a * x + b * y + c * z)
        return
    r0, r1, r2, r3, r4, r5, r6, r7, r8 = turn_about(x, y, z, value)
    for row in range(3):
        a, b, c = frames[k, 3 * row], frames[k, 3 * row + 1], frames[k, 3 * row + 2]
        frames[k, 3 * row] = a * r0 + b * r3 + c * r6
        frames[k, 3 * row + 1] = a * r1 + b * r4 + c * r7
        frames[k, 3 * row + 2] = a * r2 + b * r5 + c * r8


@kernel
def pose_part(frames, k, parts, p, posed, i):
    """Fill row i of ``posed`` with part p (rows of ``parts``: centre, A) in frame k."""
    for row in range(3):
        a, b, c = frames[k, 3 * row], frames[k, 3 * row + 1], frames[k, 3 * row + 2]
        posed[i, row] = a * parts[p, 0] + b * parts[p, 1] + c * parts[p, 2] + frames[k, 9 + row]
        for column in range(3):
            posed[i, 3 + 3 * row + column] = (
                a * parts[p, 3 + column] + b * parts[p, 6 + column] + c * parts[p, 9 + column]
            )


@kernel
def pose_parts(frames, part_frames, parts, posed):
    """Fill ``posed`` (P, POSED) with all ``parts`` (P, POSED), each in the frame it belongs to."""
    for p in range(part_frames.size):
        k = part_frames[p]
        if k < 0:
            for m in range(POSED):
                posed[p, m] = parts[p, m]
        else:
            pose_part(frames, k, parts, p, posed, p)


@kernel
def motion_axes(axes, frames, lines):
    """Fill ``lines`` (K, 6) with each coordinate's axis in the world and a point on it.

    A point x that coordinate k moves has the rate axis × (x − point) for a turn, axis for a shift.
    """
    for k in range(axes.shape[0]):
        # A turn leaves its own axis and position where they are, a shift its axis.
        for row in range(3):
            a, b, c = frames[k, 3 * row], frames[k, 3 * row + 1], frames[k, 3 * row + 2]
            lines[k, row] = a * axes[k, 0] + b * axes[k, 1] + c * axes[k, 2]
            lines[k, 3 + row] = frames[k, 9 + row]
