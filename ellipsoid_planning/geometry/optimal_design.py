"""D-optimal designs, the duals of minimum-volume ellipsoids, by an interior-point method.

P. Sun and R. M. Freund, "Computation of minimum-volume covering ellipsoids", Operations Research
52 (2004), the dual reduced Newton method. First-order methods, such as Khachiyan's, take many
thousand steps where points crowd on a curve, as those of tessellated cylinders do.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MOST_STEPS = 60
# How far a step goes to the boundary, and how much smaller the next complementarity should be.
FRACTION = 0.99
CENTRING = 0.1


def optimal_design(points: Array, tolerance: float) -> tuple[Array, float]:
    """The weights (m,), sum 1, of points (m, n), and the farthest point's squared norm.

    The norm is that of the ellipsoid {(x - c)' S^-1 (x - c) <= n} of the weights' mean c and
    covariance S, whose volume no enclosing ellipsoid falls below; at the optimum it is 1, and
    here at most 1 + tolerance unless rounding prevents it. The points must span the space.
    """
    m, n = points.shape
    dual = np.full(m, 0.5 * n / m)
    gram, squares = _gram(points, dual)
    scale = squares.max() / 0.95
    dual, squares, gram = dual * scale, squares / scale, gram / scale
    slack = 1.0 - squares
    for _ in range(MOST_STEPS):
        if farthest_of_design(points, dual / dual.sum()) <= 1.0 + tolerance:
            break
        target = CENTRING * float(dual @ slack) / m
        jacobian = 2.0 * (gram / dual.sum() + gram * gram)
        jacobian[np.diag_indices(m)] += slack / dual
        step = np.linalg.solve(jacobian, squares - 1.0 + target / dual)
        slack_step = (target - dual * slack - slack * step) / dual
        length = min(_length(dual, step), _length(slack, slack_step))
        dual, slack = dual + length * step, slack + length * slack_step
        gram, squares = _gram(points, dual)
    weights = dual / dual.sum()
    return weights, farthest_of_design(points, weights)


def ellipsoid_of_design(points: Array, weights: Array) -> tuple[Array, Array]:
    """Centre c (n,) and matrix (n, n) of the ellipsoid {(x - c)' S^-1 (x - c) <= n}."""
    centre = weights @ points
    offset = points - centre
    squares, axes = np.linalg.eigh(points.shape[1] * (offset.T * weights) @ offset)
    return centre, axes * np.sqrt(np.maximum(squares, 1e-300))


def farthest_of_design(points: Array, weights: Array) -> float:
    """The largest squared norm of the points (m, n) in the ellipsoid of their design."""
    centre, matrix = ellipsoid_of_design(points, weights)
    return float(np.max(np.sum(np.linalg.solve(matrix, (points - centre).T) ** 2, axis=0)))


def _gram(points: Array, dual: Array) -> tuple[Array, Array]:
    """Inner products (m, m) of the points about their mean in the norm S^-1 / 2; squares (m,)."""
    offset = points - (dual @ points) / dual.sum()
    covariance = (offset.T * dual) @ offset
    gram = 0.5 * offset @ np.linalg.solve(covariance, offset.T)
    return gram, np.diagonal(gram).copy()


def _length(values: Array, step: Array) -> float:
    """The step length, at most 1, that keeps the values positive."""
    shrinking = step < 0.0
    if not np.any(shrinking):
        return 1.0
    return min(1.0, FRACTION * float(np.min(-values[shrinking] / step[shrinking])))
