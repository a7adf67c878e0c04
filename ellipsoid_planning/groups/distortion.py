"""The distortion of coordinates of rotations, thesis (4.1) and (4.11)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def distortion_of_jacobian(jacobians: ArrayLike) -> Array:
    """C = ||J^T J - 1|| / sqrt(3) of Jacobians (..., 3, 3), thesis (4.1)."""
    jacobian = np.asarray(jacobians, dtype=float)
    metric = np.swapaxes(jacobian, -1, -2) @ jacobian
    return np.linalg.norm(metric - np.eye(3), axis=(-2, -1)) / math.sqrt(3.0)


def distortion(angle: float) -> float:
    """C of exponential coordinates at the angle [rad]: sqrt(2/3) |1 - 2 (1 - cos t) / t^2|."""
    half = 0.5 * angle
    shrink = np.sinc(half / np.pi) ** 2  # (sin(t/2) / (t/2))^2 = 2 (1 - cos t) / t^2
    return float(math.sqrt(2.0 / 3.0) * abs(1.0 - shrink))


def euler_distortion(beta: ArrayLike) -> Array:
    """C of ZXZ Euler angles at the middle angle beta [rad]: sqrt(2/3) |cos beta|."""
    return math.sqrt(2.0 / 3.0) * np.abs(np.cos(np.asarray(beta, dtype=float)))
