"""Separation of two ellipsoids: a proved gap with its direction.

For obstacle Σ₁ = A₁A₁ᵀ, part Σ₂ = A₂A₂ᵀ and c the difference of centres, every unit vector u gives
the lower bound u·c − |A₁ᵀu| − |A₂ᵀu| of their distance. The scalar λ only proposes u: with
y = (Σ₁/λ + Σ₂/(1−λ))⁻¹c, a = |A₁ᵀy|/λ and b = |A₂ᵀy|/(1−λ),

- λa(a−1) + (1−λ)b(b−1) > 0 proves separation along y,
- a ≤ 1 and b ≤ 1 proves that the point c₁ + Σ₁y/λ lies in both bodies,
- a > b says that the best λ is larger.

Perram and Wertheim (1985) gave the function of λ; its second derivative serves Newton's steps.
"""

import math

from .closest_points import closest_direction, difference_point
from .compile import kernel
from .layout import BODY_CENTRE, BODY_INVERSE, BODY_MATRIX, PLACED_CENTRE, PLACED_MATRIX
from .linear import gram, norm, shape_matrix, solve_positive, times, transposed_times

_STEPS = 40
_POLISH_STEPS = 30
_AGREEMENT = 1e-9  # share of the distance to which its bounds are brought together
DECIDE = 0  # stop as soon as the gap exceeds what is required
AIM = 1  # go on until the direction is good for its neighbourhood too
CONVERGE = 2  # the distance itself


@kernel
def gap_along(bodies, j, placed, i, ux, uy, uz):
    """The bound u·c − |A₁ᵀu| − |A₂ᵀu| for a unit vector u from obstacle ``j`` to part ``i``."""
    cx = placed[i, PLACED_CENTRE] - bodies[j, BODY_CENTRE]
    cy = placed[i, PLACED_CENTRE + 1] - bodies[j, BODY_CENTRE + 1]
    cz = placed[i, PLACED_CENTRE + 2] - bodies[j, BODY_CENTRE + 2]
    px, py, pz = transposed_times(bodies, j, BODY_MATRIX, ux, uy, uz)
    qx, qy, qz = transposed_times(placed, i, PLACED_MATRIX, ux, uy, uz)
    return ux * cx + uy * cy + uz * cz - norm(px, py, pz) - norm(qx, qy, qz)


@kernel
def next_weight(lam, low, high, slope, curvature):
    """Newton's step for F′(λ) = 0 kept inside its bracket, else bisection."""
    step = lam - slope / curvature
    width = high - low
    if step > low + 1e-3 * width and step < high - 1e-3 * width:
        return step
    # Bisect the odds λ : (1−λ) rather than λ itself where the bracket reaches an end.
    if low <= 0.0 and lam < 0.5:
        return 0.1 * high
    if high >= 1.0 and lam > 0.5:
        return 1.0 - 0.1 * (1.0 - low)
    return 0.5 * (low + high)


@kernel
def separation(bodies, j, placed, i, lam, required, mode):
    """Gap of obstacle ``j`` and part ``i``: (value, u_x, u_y, u_z, λ).

    ``value`` is a lower bound of the distance, valid for the unit vector u. It exceeds
    ``required`` whenever that can be proved; otherwise the bodies are closer than that, or meet
    (then ``value`` is negative, and −value bounds the penetration depth from above).

    The iteration runs where the obstacle is the unit ball, v ↦ A₁⁻¹v: there Σ₁ = I, which keeps
    its accuracy for parallel needles. Gaps are always taken from the bodies themselves.
    """
    cx, cy, cz = times(
        bodies,
        j,
        BODY_INVERSE,
        placed[i, PLACED_CENTRE] - bodies[j, BODY_CENTRE],
        placed[i, PLACED_CENTRE + 1] - bodies[j, BODY_CENTRE + 1],
        placed[i, PLACED_CENTRE + 2] - bodies[j, BODY_CENTRE + 2],
    )
    m = PLACED_MATRIX
    e0, e3, e6 = times(bodies, j, BODY_INVERSE, placed[i, m], placed[i, m + 3], placed[i, m + 6])
    e1, e4, e7 = times(
        bodies, j, BODY_INVERSE, placed[i, m + 1], placed[i, m + 4], placed[i, m + 7]
    )
    e2, e5, e8 = times(
        bodies, j, BODY_INVERSE, placed[i, m + 2], placed[i, m + 5], placed[i, m + 8]
    )
    s0, s1, s2, s3, s4, s5 = gram(e0, e1, e2, e3, e4, e5, e6, e7, e8)
    low, high = 0.0, 1.0
    best, ux, uy, uz = -math.inf, 1.0, 0.0, 0.0
    yx, yy, yz = cx, cy, cz
    meet = cx == 0.0 and cy == 0.0 and cz == 0.0
    for _ in range(_STEPS):
        p, q = 1.0 / lam, 1.0 / (1.0 - lam)
        d0, d1, d2 = p + q * s0, q * s1, q * s2
        d3, d4, d5 = p + q * s3, q * s4, p + q * s5
        yx, yy, yz, form, positive = solve_positive(d0, d1, d2, d3, d4, d5, cx, cy, cz)
        if meet or not positive:
            break
        first = norm(yx, yy, yz)
        second = norm(
            e0 * yx + e3 * yy + e6 * yz, e1 * yx + e4 * yy + e7 * yz, e2 * yx + e5 * yy + e8 * yz
        )
        a, b = p * first, q * second
        even = abs(a - b) < 0.05 * (a + b)
        if form > first + second and (mode == DECIDE or even):
            vx, vy, vz = transposed_times(bodies, j, BODY_INVERSE, yx, yy, yz)
            length = norm(vx, vy, vz)
            ux, uy, uz = vx / length, vy / length, vz / length
            best = gap_along(bodies, j, placed, i, ux, uy, uz)
            if best > required:
                break
        if a <= 1.0 and b <= 1.0:
            meet = True
            break
        if abs(a - b) <= 1e-7 * (a + b):
            break
        if a > b:
            low = lam
        else:
            high = lam
        # N = I/λ² − S/(1−λ)²; F″ = 2 (Ny·M⁻¹Ny − a²/λ − b²/(1−λ)).
        wx = p * p * yx - q * q * (s0 * yx + s1 * yy + s2 * yz)
        wy = p * p * yy - q * q * (s1 * yx + s3 * yy + s4 * yz)
        wz = p * p * yz - q * q * (s2 * yx + s4 * yy + s5 * yz)
        _, _, _, bend, _ = solve_positive(d0, d1, d2, d3, d4, d5, wx, wy, wz)
        bend = 2.0 * (bend - p * a * a - q * b * b)
        lam = next_weight(lam, low, high, a * a - b * b, bend)
    if best > required and mode != CONVERGE:
        return best, ux, uy, uz, lam
    vx, vy, vz = transposed_times(bodies, j, BODY_INVERSE, yx, yy, yz)
    length = norm(vx, vy, vz)
    if length > 0.0 and length < math.inf:
        ux, uy, uz = vx / length, vy / length, vz / length
    best = gap_along(bodies, j, placed, i, ux, uy, uz)
    if meet and mode != CONVERGE:
        return best, ux, uy, uz, lam
    best, ux, uy, uz = polish(bodies, j, placed, i, ux, uy, uz, required, mode)
    if best > required and mode != CONVERGE:
        return best, ux, uy, uz, lam
    vx, vy, vz = difference_point(bodies, j, placed, i, ux, uy, uz)
    most = norm(vx, vy, vz)
    # |c − s(u)| bounds the distance from above: the search goes on only where it could be larger
    # than what is known, and than what is asked for.
    if (most <= required and mode != CONVERGE) or (best > 0.0 and most - best <= _AGREEMENT * most):
        return best, ux, uy, uz, lam
    vx, vy, vz = closest_direction(bodies, j, placed, i, ux, uy, uz)
    value, vx, vy, vz = polish(bodies, j, placed, i, vx, vy, vz, required, mode)
    if value > best:
        best, ux, uy, uz = value, vx, vy, vz
    return best, ux, uy, uz, lam


@kernel
def polish(bodies, j, placed, i, ux, uy, uz, required, mode):
    """Damped Newton on the unit sphere for the largest gap along u: (value, u_x, u_y, u_z).

    At the best u, c − s(u) = value · u where s(u) is the support point of the Minkowski sum; the
    support function's Hessian gives the tangential steps.
    """
    cx = placed[i, PLACED_CENTRE] - bodies[j, BODY_CENTRE]
    cy = placed[i, PLACED_CENTRE + 1] - bodies[j, BODY_CENTRE + 1]
    cz = placed[i, PLACED_CENTRE + 2] - bodies[j, BODY_CENTRE + 2]
    a0, a1, a2, a3, a4, a5 = shape_matrix(bodies, j, BODY_MATRIX)
    b0, b1, b2, b3, b4, b5 = shape_matrix(placed, i, PLACED_MATRIX)
    value = gap_along(bodies, j, placed, i, ux, uy, uz)
    damping = 0.0
    for _ in range(_POLISH_STEPS):
        if value > required and mode != CONVERGE:
            break
        sx, sy, sz = transposed_times(bodies, j, BODY_MATRIX, ux, uy, uz)
        tx, ty, tz = transposed_times(placed, i, PLACED_MATRIX, ux, uy, uz)
        first, second = norm(sx, sy, sz), norm(tx, ty, tz)
        if second <= 0.0:
            second = 1e-300
        p, q = 1.0 / first, 1.0 / second
        gx = p * (a0 * ux + a1 * uy + a2 * uz)
        gy = p * (a1 * ux + a3 * uy + a4 * uz)
        gz = p * (a2 * ux + a4 * uy + a5 * uz)
        hx = q * (b0 * ux + b1 * uy + b2 * uz)
        hy = q * (b1 * ux + b3 * uy + b4 * uz)
        hz = q * (b2 * ux + b4 * uy + b5 * uz)
        rx = cx - gx - hx - value * ux
        ry = cy - gy - hy - value * uy
        rz = cz - gz - hz - value * uz
        m0 = p * (a0 - gx * gx) + q * (b0 - hx * hx)
        m1 = p * (a1 - gx * gy) + q * (b1 - hx * hy)
        m2 = p * (a2 - gx * gz) + q * (b2 - hx * hz)
        m3 = p * (a3 - gy * gy) + q * (b3 - hy * hy)
        m4 = p * (a4 - gy * gz) + q * (b4 - hy * hz)
        m5 = p * (a5 - gz * gz) + q * (b5 - hz * hz)
        trace = m0 + m3 + m5
        shift = max(value, 0.0) + damping * trace
        # The Hessian vanishes along u; the trace there makes the matrix regular.
        dx, dy, dz, _, positive = solve_positive(
            m0 + shift + trace * ux * ux,
            m1 + trace * ux * uy,
            m2 + trace * ux * uz,
            m3 + shift + trace * uy * uy,
            m4 + trace * uy * uz,
            m5 + shift + trace * uz * uz,
            rx,
            ry,
            rz,
        )
        if not positive:
            if damping > 1e3:
                break
            damping = max(10.0 * damping, 1e-6)
            continue
        nx, ny, nz = ux + dx, uy + dy, uz + dz
        length = norm(nx, ny, nz)
        if not (length > 0.0 and length < math.inf):
            break
        nx, ny, nz = nx / length, ny / length, nz / length
        trial = gap_along(bodies, j, placed, i, nx, ny, nz)
        if trial > value:
            settled = abs(dx) + abs(dy) + abs(dz) < 1e-9
            value, ux, uy, uz = trial, nx, ny, nz
            damping *= 0.1
            if damping < 1e-8:
                damping = 0.0
            if settled:
                break
        elif abs(dx) + abs(dy) + abs(dz) < 1e-9 or damping > 1e3:
            break
        else:
            damping = max(10.0 * damping, 1e-6)
    return value, ux, uy, uz
