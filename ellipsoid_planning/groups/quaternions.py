"""Arithmetic of many unit quaternions at once, in plain numpy.

Quaternions are (x, y, z, w), as in scipy; q and -q are the same rotation. Exponential coordinates
are the axis times the angle [rad]; Rodrigues coordinates are the axis times tan(angle / 2).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

IDENTITY = np.array([0.0, 0.0, 0.0, 1.0])
IDENTITY.setflags(write=False)


def product(first: Array, second: Array) -> Array:
    """The rotations "first after second", (..., 4) by (..., 4), broadcast."""
    a, b = np.asarray(first), np.asarray(second)
    out = np.empty(np.broadcast_shapes(a.shape, b.shape))
    x, y, z, w = (a[..., i] for i in range(4))
    p, q, r, s = (b[..., i] for i in range(4))
    out[..., 0] = w * p + x * s + y * r - z * q
    out[..., 1] = w * q - x * r + y * s + z * p
    out[..., 2] = w * r + x * q - y * p + z * s
    out[..., 3] = w * s - x * p - y * q - z * r
    return out


def left_matrix(quaternion: Array) -> Array:
    """The (4, 4) matrix L with ``product(quaternion, q) == L @ q``."""
    x, y, z, w = quaternion
    return np.array([[w, -z, y, x], [z, w, -x, y], [-y, x, w, z], [-x, -y, -z, w]])


def inverse(quaternions: Array) -> Array:
    """The inverse rotations (..., 4)."""
    return np.asarray(quaternions) * np.array([-1.0, -1.0, -1.0, 1.0])


def canonical(quaternions: Array) -> Array:
    """Of q and -q the one whose last entry that is not zero is positive, (..., 4)."""
    q = np.asarray(quaternions, dtype=float)
    sign = np.zeros(q.shape[:-1])
    for i in (3, 2, 1, 0):
        entry = np.where(np.abs(q[..., i]) > 1e-12, np.sign(q[..., i]), 0.0)
        sign = np.where(sign == 0.0, entry, sign)
    return q * sign[..., None]


def unit(quaternions: ArrayLike) -> Array:
    """The quaternions (..., 4) divided by their lengths."""
    q = np.asarray(quaternions, dtype=float)
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def angle(first: Array, second: Array) -> Array:
    """The angles [rad] in [0, pi] of the rotations from first to second, thesis (4.4)."""
    a, b = np.asarray(first), np.asarray(second)
    # From chords, because an arc cosine knows small angles to 1e-8 only.
    chord = np.minimum(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))
    return angle_of_chord(chord)


def angle_of_chord(chord: ArrayLike) -> Array:
    """The angle [rad] between rotations whose quaternions are ``chord`` <= sqrt(2) apart."""
    return 4.0 * np.arcsin(np.minimum(0.5 * np.asarray(chord), 1.0))


def chord_of_angle(turn: float) -> float:
    """The distance of the quaternions of two rotations that are ``turn`` [rad] apart."""
    return float(2.0 * np.sin(0.25 * turn))


def exponential(coordinates: ArrayLike) -> Array:
    """Exponential coordinates (..., 3) [rad] to quaternions (..., 4), thesis (2.24)."""
    x = np.asarray(coordinates, dtype=float)
    half = 0.5 * np.linalg.norm(x, axis=-1, keepdims=True)
    # numpy's sinc(t) is sin(pi t) / (pi t), whole at 0.
    return np.concatenate([0.5 * np.sinc(half / np.pi) * x, np.cos(half)], axis=-1)


def logarithm(quaternions: ArrayLike) -> Array:
    """Quaternions (..., 4) to exponential coordinates (..., 3) [rad], at most pi long."""
    q = canonical(np.asarray(quaternions, dtype=float))
    sine = np.linalg.norm(q[..., :3], axis=-1, keepdims=True)
    turn = 2.0 * np.arctan2(sine, q[..., 3:])
    safe = np.where(sine > 0.0, sine, 1.0)
    return np.where(sine > 0.0, turn / safe, 2.0) * q[..., :3]


def rodrigues(quaternions: ArrayLike) -> Array:
    """Quaternions (..., 4) to Rodrigues coordinates (..., 3), axis times tan(angle / 2)."""
    q = np.asarray(quaternions, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        return q[..., :3] / q[..., 3:]


def from_rodrigues(coordinates: ArrayLike) -> Array:
    """Rodrigues coordinates (..., 3) to quaternions (..., 4)."""
    rho = np.asarray(coordinates, dtype=float)
    return unit(np.concatenate([rho, np.ones((*rho.shape[:-1], 1))], axis=-1))


def random_rotations(count: int, seed: int | np.random.Generator = 0) -> Array:
    """``count`` uniformly random rotations (count, 4), the same for the same seed."""
    return unit(np.random.default_rng(seed).normal(size=(count, 4)))
