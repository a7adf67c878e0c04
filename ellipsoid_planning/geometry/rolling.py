"""Blaschke's rolling condition: where the closed forms of a Minkowski difference hold.

A body rolls freely in another iff it is a Minkowski summand of it: outer = rest ⊕ inner. Then
the difference is that rest, its boundary has no swallow-tail, and Steiner's formula with the
sign of the odd terms changed gives its volume. Being a summand survives affine maps, and a ball
of radius r is a summand iff r does not exceed the least radius of curvature (W. Blaschke, Kreis
und Kugel, 1916). Where the inner ellipsoid is the unit ball and the outer one has the semi-axes
s, this radius is min(s)^2 / max(s), at the tips of its longest axis.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.affine import relative_axes
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.intrinsic import checked_axes


@dataclass(frozen=True, eq=False)
class RollingCondition:
    """Whether one ellipsoid rolls freely in another.

    Attributes:
        holds: whether it does.
        margin: the inner body could grow by the factor 1 + margin and would still just roll;
            negative: it must shrink by that factor.
        direction: the outward unit normal (n,) of the boundary point that decides, in the
            frame of the bodies.
    """

    holds: bool
    margin: float
    direction: NDArray[np.float64]


def rolls_freely(outer: Ellipsoid, inner: Ellipsoid) -> RollingCondition:
    """Tell whether the inner ellipsoid, at its orientation, rolls freely in the outer one.

    Raises:
        GeometryError: if the dimensions differ.
    """
    axes = relative_axes(outer, inner)
    margin = float(axes[-1] ** 2 / axes[0]) - 1.0
    # Where inner is the ball, the deciding normal is the outer body's longest axis.
    seen = (inner.rotation.T @ outer.matrix) / inner.semi_axes[:, None]
    left, _, _ = np.linalg.svd(seen)
    direction = inner.rotation @ (left[:, 0] / inner.semi_axes)
    return RollingCondition(margin >= 0.0, margin, direction / np.linalg.norm(direction))


def rolls_at_every_orientation(outer_axes: ArrayLike, inner_axes: ArrayLike) -> bool:
    """Tell whether an ellipsoid rolls freely in another however it is turned.

    That is so iff its largest radius of curvature max^2 / min does not exceed the least one
    min^2 / max of the outer: the condition of thesis eq. (5.97), (5.98).

    Args:
        outer_axes: semi-axes (n,).
        inner_axes: semi-axes (n,).
    """
    return rolling_margin(outer_axes, inner_axes) >= 0.0


def rolling_margin(outer_axes: ArrayLike, inner_axes: ArrayLike) -> float:
    """Return the margin, as of `RollingCondition`, at the worst orientation."""
    outer, inner = checked_axes(outer_axes), checked_axes(inner_axes)
    if outer.shape != inner.shape or outer.ndim != 1:
        raise GeometryError(
            f"expected semi-axes of two bodies of one dimension, got shapes {outer.shape} "
            f"and {inner.shape}"
        )
    least = np.min(outer) ** 2 / np.max(outer)
    return float(least / (np.max(inner) ** 2 / np.min(inner))) - 1.0
