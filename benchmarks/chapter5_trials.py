"""Random bodies and relative errors for the figures of the thesis' chapter 5."""

from __future__ import annotations

import numpy as np

from ellipsoid_planning.geometry.bound import Bound
from ellipsoid_planning.geometry.intrinsic_estimates import mean_curvature_bounds, surface_bounds
from ellipsoid_planning.geometry.sum_bounds import sum_volume_bounds

TRIALS = 100
SIZES = (10.0, 50.0)
RATIOS = np.linspace(1.0, 5.0, 161)


def axes_of(dimension: int, count: int = TRIALS, seed: int = 1) -> np.ndarray:
    """Semi-axes (count, dimension), uniform in ``SIZES``."""
    return np.random.default_rng(seed).uniform(*SIZES, (count, dimension))


def rotations_of(dimension: int, count: int, seed: int) -> np.ndarray:
    """Rotations (count, n, n) whose angles (heading; ZXZ) are uniform in [0, 2 pi]."""
    angles = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, (count, 3))
    if dimension == 2:
        return about(2, angles[:, 0])[:, :2, :2]
    return about(2, angles[:, 0]) @ about(0, angles[:, 1]) @ about(2, angles[:, 2])


def about(axis: int, angles: np.ndarray) -> np.ndarray:
    """Rotations (m, 3, 3) about a coordinate axis by angles (m,)."""
    matrices = np.tile(np.eye(3), (len(angles), 1, 1))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrices[:, i, i] = matrices[:, j, j] = np.cos(angles)
    matrices[:, j, i] = np.sin(angles)
    matrices[:, i, j] = -matrices[:, j, i]
    return matrices


def sums(dimension: int, count: int = TRIALS, seed: int = 1) -> dict[str, Bound]:
    """Exact volumes, bounds and estimates of random pairs."""
    first = np.eye(dimension) * axes_of(dimension, count, seed)[:, None, :]
    second = rotations_of(dimension, count, seed + 1) * axes_of(dimension, count, seed + 2)[:, None]
    return sum_volume_bounds(first, second)


def errors(bounds: dict[str, Bound]) -> dict[str, np.ndarray]:
    """Relative errors [%] of all but the exact value."""
    exact = bounds["exact"].value
    return {k: 100.0 * (b.value / exact - 1.0) for k, b in bounds.items() if k != "exact"}


def grid_errors(which: str) -> dict[str, np.ndarray]:
    """Errors [%] of the bounds of F or M on the grid of b/a and c/a, (161, 161) each."""
    b, c = np.meshgrid(RATIOS, RATIOS, indexing="ij")
    axes = np.stack([np.ones_like(b), b, c], axis=-1)
    return errors({"F": surface_bounds, "M": mean_curvature_bounds}[which](axes))


def median_of_largest(names: tuple[str, ...], runs: int = 200) -> float:
    """The median, over runs of 100 trials in space, of the largest error of these bounds [%]."""
    found = errors(sums(3, runs * TRIALS, 7))
    largest = np.max([np.abs(found[name]).reshape(runs, TRIALS).max(axis=1) for name in names], 0)
    return float(np.median(largest))
