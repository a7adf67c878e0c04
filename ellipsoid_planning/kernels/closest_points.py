"""The direction between the closest points of two bodies, by their support points.

Gilbert, Johnson and Keerthi (1988): with the Minkowski sum's support points s(u), the
differences c − s(u) span a polytope inside the difference of the bodies; its point v nearest to
the origin is an upper bound |v| of the distance, and u = v/|v| proposes the next support point.
Newton's steps on the sphere stall at needles and discs, whose support functions bend within a
tiny angle; here the corner is reached in a few steps whatever its sharpness. As everywhere u is
only proposed: the gap along it is taken from the bodies themselves, so that no rounding here can
lengthen it.
"""

import math

import numpy as np

from .compile import kernel
from .layout import BODY_CENTRE, BODY_MATRIX, PLACED_CENTRE, PLACED_MATRIX
from .linear import cross, norm, times, transposed_times

_STEPS = 60
# Stop where the bounds of the distance agree to this share: Newton's steps end what is left.
_AGREEMENT = 1e-10


@kernel
def reach_along(rows, i, at, ux, uy, uz):
    """The support point A Aᵀu / |Aᵀu| of the body whose matrix stands at column ``at``."""
    px, py, pz = transposed_times(rows, i, at, ux, uy, uz)
    length = norm(px, py, pz)
    if length <= 0.0:
        return 0.0, 0.0, 0.0
    return times(rows, i, at, px / length, py / length, pz / length)


@kernel
def difference_point(bodies, j, placed, i, ux, uy, uz):
    """The point c − s(u) of the difference of part ``i`` and obstacle ``j`` that u supports."""
    ax, ay, az = reach_along(bodies, j, BODY_MATRIX, ux, uy, uz)
    bx, by, bz = reach_along(placed, i, PLACED_MATRIX, ux, uy, uz)
    return (
        placed[i, PLACED_CENTRE] - bodies[j, BODY_CENTRE] - ax - bx,
        placed[i, PLACED_CENTRE + 1] - bodies[j, BODY_CENTRE + 1] - ay - by,
        placed[i, PLACED_CENTRE + 2] - bodies[j, BODY_CENTRE + 2] - az - bz,
    )


@kernel
def _dot(points, a, b):
    return points[a, 0] * points[b, 0] + points[a, 1] * points[b, 1] + points[a, 2] * points[b, 2]


@kernel
def _nearest_on_segment(points, a, b, weights):
    """Weights of the point of a segment nearest to the origin."""
    dx, dy, dz = (
        points[b, 0] - points[a, 0],
        points[b, 1] - points[a, 1],
        points[b, 2] - points[a, 2],
    )
    square = dx * dx + dy * dy + dz * dz
    along = -(points[a, 0] * dx + points[a, 1] * dy + points[a, 2] * dz)
    t = min(max(along / square, 0.0), 1.0) if square > 0.0 else 0.0
    weights[a] += 1.0 - t
    weights[b] += t


@kernel
def _square_of(points, weights, count):
    """|v|² of the point with these weights."""
    total = 0.0
    for m in range(3):
        entry = 0.0
        for k in range(count):
            entry += weights[k] * points[k, m]
        total += entry * entry
    return total


@kernel
def _try_segment(points, a, b, count, weights, trial, best):
    trial[:] = 0.0
    _nearest_on_segment(points, a, b, trial)
    square = _square_of(points, trial, count)
    if square < best:
        weights[:] = trial
        return square
    return best


@kernel
def _try_triangle(points, a, b, c, count, weights, trial, best):
    """Take the triangle's inside if the origin's foot lies there and is nearer."""
    nx, ny, nz = cross(
        points[b, 0] - points[a, 0],
        points[b, 1] - points[a, 1],
        points[b, 2] - points[a, 2],
        points[c, 0] - points[a, 0],
        points[c, 1] - points[a, 1],
        points[c, 2] - points[a, 2],
    )
    square = nx * nx + ny * ny + nz * nz
    if not square > 0.0:
        return best
    trial[:] = 0.0
    total = 0.0
    for first, second, third in ((a, b, c), (b, c, a), (c, a, b)):
        x, y, z = cross(
            points[second, 0],
            points[second, 1],
            points[second, 2],
            points[third, 0],
            points[third, 1],
            points[third, 2],
        )
        trial[first] = x * nx + y * ny + z * nz
        if trial[first] < 0.0:
            return best
        total += trial[first]
    if not total > 0.0:
        return best
    for k in range(count):
        trial[k] /= total
    square = _square_of(points, trial, count)
    if square < best:
        weights[:] = trial
        return square
    return best


@kernel
def _nearest(points, count, weights, trial):
    """Weights of the polytope's boundary point nearest to the origin: the best of all its faces."""
    best = math.inf
    for a in range(count):
        square = _dot(points, a, a)
        if square < best:
            weights[:] = 0.0
            weights[a] = 1.0
            best = square
    for a in range(count):
        for b in range(a):
            best = _try_segment(points, a, b, count, weights, trial, best)
    for a in range(count):
        for b in range(a):
            for c in range(b):
                best = _try_triangle(points, a, b, c, count, weights, trial, best)
    return best


@kernel
def closest_direction(bodies, j, placed, i, ux, uy, uz):
    """Unit vector from obstacle ``j`` to part ``i`` between their closest points.

    ``u`` is where to begin. Where the bodies meet, the direction is of no use.
    """
    points, weights, trial = np.empty((4, 3)), np.empty(4), np.empty(4)
    vx, vy, vz = difference_point(bodies, j, placed, i, ux, uy, uz)
    points[0, 0], points[0, 1], points[0, 2] = vx, vy, vz
    count, length = 1, norm(vx, vy, vz)
    for _ in range(_STEPS):
        if not length > 0.0:
            break
        ux, uy, uz = vx / length, vy / length, vz / length
        wx, wy, wz = difference_point(bodies, j, placed, i, ux, uy, uz)
        if ux * wx + uy * wy + uz * wz >= (1.0 - _AGREEMENT) * length:
            break
        points[count, 0], points[count, 1], points[count, 2] = wx, wy, wz
        count += 1
        nearer = _nearest(points, count, weights, trial)
        if not nearer < length * length:
            break
        kept = 0
        for k in range(count):
            if weights[k] > 0.0:
                points[kept] = points[k]
                weights[kept] = weights[k]
                kept += 1
        count = kept
        vx, vy, vz = 0.0, 0.0, 0.0
        for k in range(count):
            vx += weights[k] * points[k, 0]
            vy += weights[k] * points[k, 1]
            vz += weights[k] * points[k, 2]
        length = norm(vx, vy, vz)
        if count == 4:
            break
    return ux, uy, uz
