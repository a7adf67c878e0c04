"""Containment of a robot part in an arena ellipsoid, with its margin (thesis 5.2.2).

In the arena's own coordinates (v ↦ A_a⁻¹v, the arena becomes the unit ball) the part is w + Ez,
|z| ≤ 1. For any μ above the largest eigenvalue of S = EEᵀ,

    g(μ) = μ + μ wᵀ(μI − S)⁻¹w  ≥  max |w + Ez|²,

with equality at the best μ (the S-lemma is lossless), so any μ errs on the safe side. With
v = (μI − S)⁻¹w the slope of g is 1 − vᵀSv: the secular equation of a trust region.

A clearance r is asked for in two ways, of which either suffices: the part grown to
(1 + 1/p)Σ + (1 + p)r²I, which encloses part ⊕ ball for every p > 0 and touches it at the normal u
where p = |Aᵀu|/r; or the arena shrunk to an ellipsoid inside arena ⊖ ball (BODY_WHITEN).

*Rounding.* Entries of S and the solution for μI − S are off by as much as if μI − S were, by some
20 ε μ: trace S < 3μ, and LDLᵀ is backward stable. A matrix that is off by δ lies between those of
μ − δ and μ + δ, and any μ is safe: so g is safe up to the factor 1 + 20 ε, however thin the part
and however near μ is to an eigenvalue (4 ROUNDING = 128 ε are added). w and E are off by some
10 ε |A_a⁻¹| S_c with S_c the scene's scale, and g by twice that (6 ROUNDING = 192 ε are added).
"""

import math

from .compile import kernel
from .layout import (
    BODY_CENTRE,
    BODY_INVERSE,
    BODY_WHITEN,
    PLACED_CENTRE,
    PLACED_MATRIX,
    ROUNDING,
)
from .linear import gram, norm, solve_positive, times, transposed_times

_STEPS = 80
GROW_PART = 0
SHRINK_ARENA = 1


@kernel
def _secular(s0, s1, s2, s3, s4, s5, wx, wy, wz, converge):
    """Smallest g(μ) found: (g, v_x, v_y, v_z) with v = (μI − S)⁻¹w, rounding included in g.

    Unless ``converge``, stops as soon as g ≤ 1 or a point outside the unit ball is known.
    """
    trace = s0 + s3 + s5
    root = math.sqrt(trace)
    low = max(s0, max(s3, s5))
    high = root * (root + norm(wx, wy, wz)) * (1.0 + 1e-12) + 1e-300
    mu = high
    best, bx, by, bz = math.inf, 0.0, 0.0, 0.0
    for _ in range(_STEPS):
        d0, d3, d5 = mu - s0, mu - s3, mu - s5
        vx, vy, vz, form, positive = solve_positive(d0, -s1, -s2, d3, -s4, d5, wx, wy, wz)
        if not positive:
            low = mu
            mu = 0.5 * (low + high)
            if high - low <= 1e-15 * high:
                break
            continue
        g = mu * (1.0 + form) * (1.0 + 4.0 * ROUNDING)
        if g < best:
            best, bx, by, bz = g, vx, vy, vz
        tx = s0 * vx + s1 * vy + s2 * vz
        ty = s1 * vx + s3 * vy + s4 * vz
        tz = s2 * vx + s4 * vy + s5 * vz
        zz = vx * tx + vy * ty + vz * tz
        if not converge:
            # w + Ez for z = Eᵀv/|Eᵀv| is a point of the part.
            scale = 1.0 / math.sqrt(zz) if zz > 0.0 else 0.0
            outside = norm(wx + scale * tx, wy + scale * ty, wz + scale * tz) > 1.0 + 1e-9
            if g <= 1.0 - 1e-9 or outside:
                break
        if abs(zz - 1.0) <= 1e-14 or high - low <= 1e-15 * high:
            break
        if zz > 1.0:
            low = mu
        else:
            high = mu
        # Newton for 1/|z(μ)| = 1, where d(zz)/dμ = −2 (Sv)·(μI − S)⁻¹v.
        gx, gy, gz, _, _ = solve_positive(d0, -s1, -s2, d3, -s4, d5, vx, vy, vz)
        slope = tx * gx + ty * gy + tz * gz
        step = mu
        if slope > 0.0:
            step = mu + (math.sqrt(zz) - 1.0) * zz / slope
        if not (step > low and step < high):
            step = 0.5 * (low + high)
        mu = step
    return best, bx, by, bz


@kernel
def _in_arena(arenas, a, placed, i, inverse):
    """(E row-major, w) of part ``i`` in the coordinates of arena ``a``."""
    cx = placed[i, PLACED_CENTRE] - arenas[a, BODY_CENTRE]
    cy = placed[i, PLACED_CENTRE + 1] - arenas[a, BODY_CENTRE + 1]
    cz = placed[i, PLACED_CENTRE + 2] - arenas[a, BODY_CENTRE + 2]
    wx, wy, wz = times(arenas, a, inverse, cx, cy, cz)
    m = PLACED_MATRIX
    e0, e3, e6 = times(arenas, a, inverse, placed[i, m], placed[i, m + 3], placed[i, m + 6])
    e1, e4, e7 = times(arenas, a, inverse, placed[i, m + 1], placed[i, m + 4], placed[i, m + 7])
    e2, e5, e8 = times(arenas, a, inverse, placed[i, m + 2], placed[i, m + 5], placed[i, m + 8])
    return e0, e1, e2, e3, e4, e5, e6, e7, e8, wx, wy, wz


@kernel
def inverse_size(arenas, a, inverse):
    """Frobenius norm of the map into the arena's coordinates: longest image of a unit vector."""
    total = 0.0
    for k in range(9):
        total += arenas[a, inverse + k] ** 2
    return math.sqrt(total)


@kernel
def extent_in_arena(arenas, a, placed, i, scale, inverse, converge):
    """g of part ``i`` as it is: (g, u_x, u_y, u_z), an upper bound of its largest |·|² inside.

    The part lies in the arena if g ≤ 1; (u) is the outward normal, in the world, at the part's
    point that reaches farthest.
    """
    e0, e1, e2, e3, e4, e5, e6, e7, e8, wx, wy, wz = _in_arena(arenas, a, placed, i, inverse)
    s0, s1, s2, s3, s4, s5 = gram(e0, e1, e2, e3, e4, e5, e6, e7, e8)
    error = 2.0 * ROUNDING * (1.0 + inverse_size(arenas, a, inverse) * scale)
    reach = norm(wx, wy, wz) + math.sqrt(s0 + s3 + s5)
    if not converge and reach + error <= 1.0:
        return (reach + error) ** 2, 0.0, 0.0, 0.0
    g, vx, vy, vz = _secular(s0, s1, s2, s3, s4, s5, wx, wy, wz, converge)
    # μv = w + Sv is the farthest point; its gradient, taken back to the world, is the normal.
    ux, uy, uz = transposed_times(arenas, a, inverse, vx, vy, vz)
    return g + 3.0 * error, ux, uy, uz


@kernel
def extent_with_clearance(arenas, a, placed, i, scale, clearance, planar, converge):
    """g of part ``i`` grown by ``clearance``: an upper bound over the best p of a few."""
    e0, e1, e2, e3, e4, e5, e6, e7, e8, wx, wy, wz = _in_arena(arenas, a, placed, i, BODY_INVERSE)
    s0, s1, s2, s3, s4, s5 = gram(e0, e1, e2, e3, e4, e5, e6, e7, e8)
    k = BODY_INVERSE
    # The ball of a planar body is a disc: no column for z.
    flat = 0.0 if planar else 1.0
    i0, i1, i2 = arenas[a, k], arenas[a, k + 1], flat * arenas[a, k + 2]
    i3, i4, i5 = arenas[a, k + 3], arenas[a, k + 4], flat * arenas[a, k + 5]
    i6, i7, i8 = arenas[a, k + 6], arenas[a, k + 7], flat * arenas[a, k + 8]
    error = 2.0 * ROUNDING * (1.0 + inverse_size(arenas, a, BODY_INVERSE) * scale)
    total = 0.0
    for m in range(9):
        total += placed[i, PLACED_MATRIX + m] ** 2
    p = math.sqrt(total / (2.0 if planar else 3.0)) / clearance
    best, ux, uy, uz = math.inf, 0.0, 0.0, 0.0
    for _ in range(8):
        f, q = 1.0 + 1.0 / p, (1.0 + p) * clearance * clearance
        g, vx, vy, vz = _secular(
            f * s0 + q * (i0 * i0 + i1 * i1 + i2 * i2),
            f * s1 + q * (i0 * i3 + i1 * i4 + i2 * i5),
            f * s2 + q * (i0 * i6 + i1 * i7 + i2 * i8),
            f * s3 + q * (i3 * i3 + i4 * i4 + i5 * i5),
            f * s4 + q * (i3 * i6 + i4 * i7 + i5 * i8),
            f * s5 + q * (i6 * i6 + i7 * i7 + i8 * i8),
            wx,
            wy,
            wz,
            converge,
        )
        g += 3.0 * error
        tx, ty, tz = transposed_times(arenas, a, BODY_INVERSE, vx, vy, vz)
        length = norm(tx, ty, tz)
        if g < best:
            best, ux, uy, uz = g, tx, ty, tz
        if (best <= 1.0 and not converge) or not (length > 0.0):
            break
        hx, hy, hz = transposed_times(placed, i, PLACED_MATRIX, tx, ty, tz)
        ratio = max(norm(hx, hy, hz) / (length * clearance), 1e-12)
        if abs(ratio - p) <= 1e-9 * p:
            break
        p = ratio
    return best, ux, uy, uz


@kernel
def arena_extent(arenas, a, placed, i, scale, clearance, planar, way, converge):
    """g of part ``i`` in arena ``a`` at the asked clearance: the part keeps it if g ≤ 1.

    ``way`` is GROW_PART or SHRINK_ARENA; the margin 1 − √g is in the norm of the arena, shrunk or
    not accordingly.
    """
    if clearance <= 0.0:
        return extent_in_arena(arenas, a, placed, i, scale, BODY_INVERSE, converge)[0]
    if way == SHRINK_ARENA:
        return extent_in_arena(arenas, a, placed, i, scale, BODY_WHITEN, converge)[0]
    return extent_with_clearance(arenas, a, placed, i, scale, clearance, planar, converge)[0]
