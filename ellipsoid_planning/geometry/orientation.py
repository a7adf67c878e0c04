"""Rotation matrices from headings and quaternions, and back, in plain numpy.

Headings are in radians and counted anticlockwise; quaternions are (x, y, z, w).
Rotation matrices map body coordinates to world coordinates.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError

ORTHONORMALITY_TOLERANCE = 1e-9
# What products of rotations are off by through rounding.
_ORTHONORMAL = 1e-14


def normalised_heading(yaw: float) -> float:
    """Return the heading in [-pi, pi) [rad] that equals `yaw` [rad] modulo a full turn.

    These are the headings that OMPL has for valid.

    A heading that is already in the range keeps its bits.
    """
    if -math.pi <= yaw < math.pi:
        return yaw
    wrapped = math.remainder(yaw, 2.0 * math.pi)
    return -math.pi if wrapped >= math.pi else wrapped


def rotation_from_yaw(yaw: float) -> NDArray[np.float64]:
    """Return the (2, 2) rotation by the heading `yaw` [rad]."""
    cosine, sine = math.cos(yaw), math.sin(yaw)
    return np.array([[cosine, -sine], [sine, cosine]])


def yaw_from_rotation(rotation: ArrayLike) -> float:
    """Return the heading [rad], in [-pi, pi), of a (2, 2) rotation."""
    matrix = np.asarray(rotation, dtype=float)
    return normalised_heading(math.atan2(matrix[1, 0], matrix[0, 0]))


def rotation_from_quaternion(quaternion: ArrayLike) -> NDArray[np.float64]:
    """Return the (3, 3) rotation of a quaternion (x, y, z, w) of any positive length."""
    q = np.asarray(quaternion, dtype=float)
    length = math.sqrt(q.dot(q)) if q.shape == (4,) else math.nan
    if not (length > 0.0 and math.isfinite(length)):
        raise GeometryError(f"expected a non-zero quaternion (x, y, z, w), got {q.tolist()}")
    x, y, z, w = (q / length).tolist()  # numbers of Python, for numpy's take longer
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def quaternion_from_rotation(rotation: ArrayLike) -> NDArray[np.float64]:
    """Return the unit quaternion (x, y, z, w), w >= 0, of a (3, 3) rotation."""
    m = np.asarray(rotation, dtype=float)
    # Each row is the quaternion times one of its own entries; the longest is the accurate one.
    xx, yy, zz = m[0, 0], m[1, 1], m[2, 2]
    xy, xz, yz = m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[1, 2] + m[2, 1]
    x, y, z = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]
    rows = np.array(
        [
            [1 + xx - yy - zz, xy, xz, x],
            [xy, 1 - xx + yy - zz, yz, y],
            [xz, yz, 1 - xx - yy + zz, z],
            [x, y, z, 1 + xx + yy + zz],
        ]
    )
    lengths = np.linalg.norm(rows, axis=1)
    longest = int(np.argmax(lengths))
    quaternion: NDArray[np.float64] = rows[longest] / lengths[longest]
    return -quaternion if quaternion[3] < 0.0 else quaternion


def check_rotation(rotation: ArrayLike, dimension: int) -> NDArray[np.float64]:
    """Return `rotation` as a new (dimension, dimension) array, or raise GeometryError.

    A rotation is orthonormal to 1e-9 and keeps the handedness. Unless it is so to rounding, the
    nearest rotation is returned: bodies are inverted by transposing it.
    """
    matrix = np.array(rotation, dtype=float)
    if matrix.shape != (dimension, dimension):
        expected = (dimension, dimension)
        raise GeometryError(f"expected a rotation of shape {expected}, got shape {matrix.shape}")
    error = float(np.max(np.abs(matrix.T @ matrix - np.eye(dimension))))
    if not error <= ORTHONORMALITY_TOLERANCE:
        raise GeometryError(
            f"expected a rotation, but its columns miss being orthonormal by {error:.3g}"
        )
    if np.linalg.det(matrix) < 0.0:
        raise GeometryError("expected a rotation, got a reflection (its determinant is -1)")
    if error > _ORTHONORMAL:
        # One step of Newton's method for the polar factor squares the error.
        return np.asarray(0.5 * (matrix + np.linalg.inv(matrix).T))
    return matrix
