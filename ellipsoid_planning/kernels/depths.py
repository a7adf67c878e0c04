"""How deep bodies reach into each other, and out of arenas.

Both are the largest value of a difference of support functions over unit vectors where it has
several local maxima. They are sought from many directions, so that a depth is never understated by
the value of a direction that was looked at; a deeper one (out of an arena), or a shallower one (of
two bodies), may exist. No decision rests on them: they say how far a state is from being free.
"""

import math

from .closest_points import reach_along
from .compile import kernel
from .layout import BODY_CENTRE, BODY_MATRIX, PLACED_CENTRE, PLACED_MATRIX
from .linear import norm
from .separation import CONVERGE, polish

_ROUNDS = 60
_STARTS = 13  # the axes, edges and corners of a cube, and their opposites


@kernel
def _unit(x, y, z):
    length = norm(x, y, z)
    return x / length, y / length, z / length


@kernel
def _start(k, planar):
    """The direction of number ``k`` < 2 _STARTS towards an axis, edge or corner of a cube."""
    sign = 1.0 if k < _STARTS else -1.0
    k = k % _STARTS + 14
    x, y, z = k % 3 - 1.0, (k // 3) % 3 - 1.0, k // 9 - 1.0
    if planar:
        angle = math.pi * (k - 14) / _STARTS
        x, y, z = math.cos(angle), math.sin(angle), 0.0
    x, y, z = _unit(x, y, z)
    return sign * x, sign * y, sign * z


@kernel
def least_depth(bodies, j, placed, i, ux, uy, uz, planar):
    """Minus the shallowest penetration found of obstacle ``j`` and part ``i`` that meet.

    ``u`` is a direction that is tried as well. The value belongs to a direction along which the
    bodies come apart, so that it bounds the depth from above.
    """
    best = polish(bodies, j, placed, i, ux, uy, uz, math.inf, CONVERGE)[0]
    for k in range(2 * _STARTS):
        x, y, z = _start(k, planar)
        best = max(best, polish(bodies, j, placed, i, x, y, z, math.inf, CONVERGE)[0])
    return best


@kernel
def _reach_out(arenas, a, placed, i, ux, uy, uz):
    """Support of part ``i`` beyond arena ``a`` along u, and its gradient."""
    bx, by, bz = reach_along(placed, i, PLACED_MATRIX, ux, uy, uz)
    ax, ay, az = reach_along(arenas, a, BODY_MATRIX, ux, uy, uz)
    gx = placed[i, PLACED_CENTRE] - arenas[a, BODY_CENTRE] + bx - ax
    gy = placed[i, PLACED_CENTRE + 1] - arenas[a, BODY_CENTRE + 1] + by - ay
    gz = placed[i, PLACED_CENTRE + 2] - arenas[a, BODY_CENTRE + 2] + bz - az
    return gx * ux + gy * uy + gz * uz, gx, gy, gz


@kernel
def _climb(arenas, a, placed, i, ux, uy, uz):
    """Gradient ascent on the sphere with halved steps: the largest value on the way."""
    value, gx, gy, gz = _reach_out(arenas, a, placed, i, ux, uy, uz)
    step = 1.0
    for _ in range(_ROUNDS):
        tx, ty, tz = gx - value * ux, gy - value * uy, gz - value * uz
        slope = norm(tx, ty, tz)
        if not slope > 0.0 or step < 1e-9:
            break
        x, y, z = _unit(ux + step * tx / slope, uy + step * ty / slope, uz + step * tz / slope)
        trial, hx, hy, hz = _reach_out(arenas, a, placed, i, x, y, z)
        if trial > value:
            value, gx, gy, gz = trial, hx, hy, hz
            ux, uy, uz = x, y, z
            step *= 1.5
        else:
            step *= 0.4
    return value


@kernel
def depth_outside(arenas, a, placed, i, planar):
    """The farthest found that part ``i`` sticks out of arena ``a``, along a normal of its wall.

    A lower bound of how far the part has to move inwards.
    """
    best = -math.inf
    for k in range(2 * _STARTS):
        x, y, z = _start(k, planar)
        best = max(best, _climb(arenas, a, placed, i, x, y, z))
    return best
