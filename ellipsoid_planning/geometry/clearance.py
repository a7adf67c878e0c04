"""How far an ellipsoid inside another stays from its boundary."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.minkowski import check_same_dimension

Array = NDArray[np.float64]
STARTS = {2: 720, 3: 3000}
REFINED = 12


def inner_clearance(outer: Ellipsoid, inner: Ellipsoid) -> float:
    """Return the distance from `inner` to the complement of `outer`; negative: it sticks out.

    The least of h_outer(u) - h_inner(u) over unit vectors u, searched from many u; the support
    functions' difference is not convex, so that this is a numerical minimum, from above.

    Raises:
        GeometryError: if the dimensions differ.
    """
    check_same_dimension(outer, inner)
    spread = unit_directions(outer.dimension, STARTS[outer.dimension])
    axes = np.concatenate([outer.rotation.T, inner.rotation.T])
    starts = np.concatenate([spread, axes, -axes])
    # A flat outer body decides along normals that crowd about its shortest axis.
    crowded = (spread / outer.semi_axes) @ outer.rotation.T
    starts = np.concatenate([starts, crowded / np.linalg.norm(crowded, axis=1, keepdims=True)])
    values = outer.support(starts) - inner.support(starts)
    best = starts[np.argsort(values)[:REFINED]]
    return min(_descended(outer, inner, u) for u in best)


def _descended(outer: Ellipsoid, inner: Ellipsoid, start: Array) -> float:
    from scipy.optimize import minimize

    def objective(v: Array) -> tuple[float, Array]:
        length = float(np.linalg.norm(v))
        u = v / length
        value = float(outer.support(u) - inner.support(u))
        slope = outer.support_points(u) - inner.support_points(u)
        return value, (slope - value * u) / length

    found = minimize(objective, start, jac=True, method="BFGS", options={"gtol": 1e-12})
    return float(min(found.fun, objective(start)[0]))
