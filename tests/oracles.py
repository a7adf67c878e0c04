"""Small, obvious and slow twins of the kernels.

They share nothing with the package: bodies are plain arrays (`Body`), any dimension n works
without embedding, and every answer about a distance comes as a pair of bounds, one from a
separating direction and one from a pair of points, so that an oracle that has not converged
shows it.  `tests.exact` decides contact where float64 cannot; `tests.motion_oracle` handles
motions.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize, minimize_scalar

Array = NDArray[np.float64]


class Body(NamedTuple):
    """The ellipsoid {centre + matrix @ z : |z| <= 1}; centre (n,), matrix (n, n)."""

    centre: Array
    matrix: Array


def body_of(ellipsoid: Any) -> Body:
    """The arrays of one of the package's ellipsoids."""
    return Body(np.array(ellipsoid.centre), np.array(ellipsoid.matrix))


def sphere_grid(count: int, dimension: int) -> Array:
    """About `count` unit vectors (count, n), evenly spread (Fibonacci's spiral in 3-D)."""
    k: Array = np.arange(count, dtype=np.float64)
    if dimension == 2:
        turn = 2 * np.pi * k / count
        return np.stack([np.cos(turn), np.sin(turn)], axis=1)
    z = 1 - (2 * k + 1) / count
    angle = np.pi * (1 + 5**0.5) * k
    flat = np.sqrt(1 - z * z)
    return np.stack([flat * np.cos(angle), flat * np.sin(angle), z], axis=1)


def support_gap(first: Body, second: Body, directions: Any) -> Any:
    """u.(c2 - c1) - |A1^T u| - |A2^T u| for directions (..., n), in the directions' own dtype.

    For a unit vector u this is a lower bound of the distance.
    """
    u = np.asarray(directions)
    kind = u.dtype
    c = second.centre.astype(kind) - first.centre.astype(kind)
    r1 = np.sqrt(((u @ first.matrix.astype(kind)) ** 2).sum(-1))
    r2 = np.sqrt(((u @ second.matrix.astype(kind)) ** 2).sum(-1))
    return u @ c - r1 - r2


def combination(first: Body, second: Body, steps: int = 70) -> tuple[float, Array]:
    """max over w in (0, 1) of c^T (S1/w + S2/(1-w))^-1 c, and the direction it belongs to.

    The square of the gauge of the Minkowski sum at c: above 1 iff the bodies are disjoint.
    """
    value, y = combinations(
        (second.centre - first.centre)[None], first.matrix[None], second.matrix[None], steps
    )
    return float(value[0]), y[0]


def combinations(c: Array, a1: Array, a2: Array, steps: int = 60) -> tuple[Array, Array]:
    """`combination` for offsets (m, n) and matrices (m, n, n), by bisection on the derivative."""
    s1, s2 = a1 @ np.swapaxes(a1, 1, 2), a2 @ np.swapaxes(a2, 1, 2)
    low, high = np.zeros(len(c)), np.ones(len(c))
    y: NDArray[Any] = c
    for _ in range(steps):
        w = 0.5 * (low + high)
        matrix = s1 / w[:, None, None] + s2 / (1 - w)[:, None, None]
        y = np.linalg.solve(matrix, c[:, :, None])[:, :, 0]
        r1 = np.linalg.norm(np.einsum("mij,mi->mj", a1, y), axis=1)
        r2 = np.linalg.norm(np.einsum("mij,mi->mj", a2, y), axis=1)
        right = r1 * (1 - w) > r2 * w
        low, high = np.where(right, w, low), np.where(right, high, w)
    return (y * c).sum(1), y


def signed_gaps(c: Array, a1: Array, a2: Array) -> tuple[Array, Array]:
    """Largest u.c - |A1^T u| - |A2^T u| over unit vectors u near contact's, and that u.

    Offsets (m, n), matrices (m, n, n); values (m,), directions (m, n).  Positive: the distance.
    Negative: minus the depth along a locally best direction, which is all that its sign needs.
    """
    _, u = combinations(c, a1, a2, 45)
    length = np.linalg.norm(u, axis=1, keepdims=True)
    u = np.where(length > 0, u / np.where(length > 0, length, 1), np.eye(c.shape[1])[0])
    value, _, _ = _slope(c, a1, a2, u)
    for _ in range(25):
        before = value
        u, value = ascended(c, a1, a2, u, value)
        if np.all(value <= before):
            break
    return value, u


def _slope(c: Array, a1: Array, a2: Array, u: Array) -> tuple[Array, Array, Array]:
    """Value, gradient and negated curvature of the support gap at unit vectors u (m, n)."""
    gradient, curvature = c.copy(), np.zeros_like(a1)
    for a in (a1, a2):
        back = np.einsum("mij,mi->mj", a, u)
        r = np.linalg.norm(back, axis=1)
        x = np.einsum("mij,mj->mi", a, back) / r[:, None]
        gradient -= x
        shape = a @ np.swapaxes(a, 1, 2)
        curvature = curvature + (shape - x[:, :, None] * x[:, None, :]) / r[:, None, None]
    return (gradient * u).sum(1), gradient, curvature


def ascended(c: Array, a1: Array, a2: Array, u: Array, value: Array) -> tuple[Array, Array]:
    """One Newton step on the sphere, halved until it does not lose; else the step is dropped."""
    _, gradient, curvature = _slope(c, a1, a2, u)
    tangent = gradient - value[:, None] * u
    matrix = curvature + np.maximum(value, 0)[:, None, None] * np.eye(c.shape[1])
    matrix = matrix + u[:, :, None] * u[:, None, :]
    step = np.linalg.solve(matrix, tangent[:, :, None])[:, :, 0]
    for scale in (1.0, 0.1):
        trial = u + scale * step
        trial /= np.linalg.norm(trial, axis=1, keepdims=True)
        found, _, _ = _slope(c, a1, a2, trial)
        better = found > value
        u, value = np.where(better[:, None], trial, u), np.where(better, found, value)
    return u, value


def distance_bounds(first: Body, second: Body) -> tuple[float, float]:
    """Two proved bounds of the distance of disjoint ellipsoids, up to long double rounding."""
    c = (second.centre - first.centre)[None]
    _, direction = signed_gaps(c, first.matrix[None], second.matrix[None])
    u = direction[0].astype(np.longdouble)
    u /= np.sqrt((u * u).sum())
    points = []
    for body, sign in ((first, 1), (second, -1)):
        a = body.matrix.astype(np.longdouble)
        back = a.T @ u
        points.append(body.centre + sign * (a @ back) / np.sqrt((back * back).sum()))
    apart = points[1] - points[0]
    return float(support_gap(first, second, u)), float(np.sqrt((apart * apart).sum()))


def signed_gap_by_search(first: Body, second: Body, count: int = 4000) -> float:
    """The same as `signed_gaps` by brute force: a grid of directions and a local polish."""
    grid = sphere_grid(count, len(first.centre))
    values = support_gap(first, second, grid)
    best = float(values.max())
    for start in grid[np.argsort(values)[-4:]]:
        found = minimize(
            lambda v: -float(support_gap(first, second, v / np.linalg.norm(v))),
            start,
            method="Nelder-Mead",
            options={"xatol": 1e-12, "fatol": 1e-15, "maxiter": 2000, "maxfev": 4000},
        )
        best = max(best, -float(found.fun))
    return best


def distance_by_points(first: Body, second: Body) -> float:
    """Distance by alternating projections of two points, each on its own body (slow)."""
    x, y = np.array(first.centre, dtype=float), np.array(second.centre, dtype=float)
    for _ in range(20000):
        new_x = projection(first, y)
        new_y = projection(second, new_x)
        if np.array_equal(new_x, x) and np.array_equal(new_y, y):
            break
        x, y = new_x, new_y
    return float(np.linalg.norm(x - y))


def projection(body: Body, point: Array) -> Array:
    """The point of an ellipsoid nearest to a given point, by the secular equation."""
    left, axes, _ = np.linalg.svd(body.matrix)
    p = left.T @ (point - body.centre)
    if (p / axes) @ (p / axes) <= 1:
        return point
    high = float(np.linalg.norm(axes * p))

    def excess(t: float) -> float:
        scaled = axes * p / (axes**2 + t)
        return float(scaled @ scaled - 1)

    t = brentq(excess, 0.0, high, xtol=1e-300, rtol=1e-15)
    return np.asarray(body.centre + left @ (axes**2 * p / (axes**2 + t)))


# --------------------------------------------------------------------------- containment


def containment_value(arena: Body, part: Body) -> float:
    """Largest z^T Sa^-1 z over the part (arena-centred), by the secular equation.

    The value is attained at an explicit point, so it never exceeds the truth but by rounding.
    """
    b = np.linalg.solve(arena.matrix, part.matrix)
    d = np.linalg.solve(arena.matrix, part.centre - arena.centre)
    left, sigma, _ = np.linalg.svd(b)
    p = left.T @ d
    top, push = sigma[0] ** 2, sigma * p
    easy = sigma < sigma[0] * (1 - 1e-14)
    rest = np.where(easy, push / np.where(easy, top - sigma**2, 1), 0)
    tiny = 1e-15 * sigma[0] * (sigma[0] + np.linalg.norm(p))
    if np.all(np.abs(push[~easy]) < tiny) and rest @ rest <= 1:  # the hard case
        z = rest.copy()
        z[0] = np.sqrt(1 - rest @ rest)
    else:
        z = _secular_point(sigma**2, push)
    reached = p + sigma * z
    return float(reached @ reached)


def _secular_point(squares: Array, push: Array) -> Array:
    """z of unit length with (nu - squares) z = push and nu above all the squares."""

    def excess(extra: float) -> float:
        z = push / (squares[0] - squares + extra)
        return float(z @ z - 1)

    high = float(np.linalg.norm(push)) * 1.01
    low = high
    while excess(low) < 0:
        low *= 0.1
    extra = brentq(excess, low, high, xtol=1e-300, rtol=1e-15)
    z = push / (squares[0] - squares + extra)
    return np.asarray(z / np.linalg.norm(z))


def containment_by_search(arena: Body, part: Body, count: int = 4000) -> float:
    """The same by brute force: a grid of the part's boundary points and a local polish."""
    inverse = np.linalg.inv(arena.matrix)

    def size(z: Array) -> Any:
        point = part.centre + z @ part.matrix.T - arena.centre
        return ((point @ inverse.T) ** 2).sum(-1)

    grid = sphere_grid(count, len(part.centre))
    best = 0.0
    for start in grid[np.argsort(size(grid))[-3:]]:
        found = minimize(
            lambda v: -float(size(v / np.linalg.norm(v))),
            start,
            method="Nelder-Mead",
            options={"xatol": 1e-12, "fatol": 1e-15, "maxiter": 2000, "maxfev": 4000},
        )
        best = max(best, -float(found.fun))
    return best


def arena_clearance(arena: Body, part: Body, count: int = 2000) -> float:
    """Distance of a contained part from the arena's outside: least difference of supports.

    Negative when the part sticks out.  It is not a convex problem: several starts.
    """

    grid = sphere_grid(count, len(part.centre))
    values = _room(arena, part, grid)
    best = float(values.min())
    for start in grid[np.argsort(values)[:6]]:
        found = minimize(
            lambda v: float(_room(arena, part, v / np.linalg.norm(v))),
            start,
            method="BFGS",
            options={"gtol": 1e-12},
        )
        best = min(best, float(found.fun))
    return best


def _room(arena: Body, part: Body, u: Array) -> Any:
    """Support of the arena minus support of the part, for unit vectors u (..., n)."""
    outer = np.linalg.norm(u @ arena.matrix, axis=-1)
    inner = np.linalg.norm(u @ part.matrix, axis=-1)
    return outer - inner - u @ (part.centre - arena.centre)


# --------------------------------------------------------------------------- chords


def sum_chord(
    obstacle: Body, part: Body, origin: Array, direction: Array
) -> tuple[float, float] | None:
    """Parameters t between which the part centred at origin + t * direction meets the obstacle."""

    def excess(t: float) -> float:
        moved = Body(origin + t * direction, part.matrix)
        return combination(obstacle, moved)[0] - 1

    return _interval(excess, obstacle, part, origin, direction)


def difference_chord(
    arena: Body, part: Body, origin: Array, direction: Array
) -> tuple[float, float] | None:
    """Parameters t between which the part centred at origin + t * direction is in the arena."""

    def excess(t: float) -> float:
        return containment_value(arena, Body(origin + t * direction, part.matrix)) - 1

    return _interval(excess, arena, part, origin, direction)


def _interval(
    excess: Any, fixed: Body, part: Body, origin: Array, direction: Array
) -> tuple[float, float] | None:
    """Where a convex function of t is negative, by its minimum and two roots."""
    middle = float((fixed.centre - origin) @ direction / (direction @ direction))
    size = np.linalg.norm(fixed.matrix, 2) + np.linalg.norm(part.matrix, 2)
    reach = float(2 * size / np.linalg.norm(direction))
    low, high = middle - reach, middle + reach
    found = minimize_scalar(excess, bounds=(low, high), method="bounded", options={"xatol": 1e-12})
    if found.fun >= 0:
        return None
    tight = {"xtol": 1e-300, "rtol": 1e-14}
    return float(brentq(excess, low, found.x, **tight)), float(
        brentq(excess, found.x, high, **tight)
    )


# --------------------------------------------------------------------------- FCL


def fcl_object(body: Body, thickness: float = 1.0) -> Any:
    """FCL's ellipsoid for a body; a planar one gets a third axis, which changes nothing."""
    import fcl

    n = len(body.centre)
    left, axes, _ = np.linalg.svd(body.matrix)
    if np.linalg.det(left) < 0:
        left[:, 0] *= -1
    rotation, radii, centre = np.eye(3), np.full(3, thickness), np.zeros(3)
    rotation[:n, :n], radii[:n], centre[:n] = left, axes, body.centre
    return fcl.CollisionObject(fcl.Ellipsoid(*radii), fcl.Transform(rotation, centre))


def fcl_collides(first: Body, second: Body) -> bool:
    """Whether FCL finds two ellipsoids in contact (it overlooks depths below 1e-6)."""
    import fcl

    request, result = fcl.CollisionRequest(), fcl.CollisionResult()
    return fcl.collide(fcl_object(first), fcl_object(second), request, result) > 0
