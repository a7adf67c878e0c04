"""Separation of two ellipsoids: a proved gap with its direction (design 3.1).

For obstacle Σ₁ = A₁A₁ᵀ, part Σ₂ = A₂A₂ᵀ and c the difference of centres, every unit vector u gives
the lower bound u·c − |A₁ᵀu| − |A₂ᵀu| of their distance. The scalar λ only proposes u: with
y = (Σ₁/λ + Σ₂/(1−λ))⁻¹c, a = |A₁ᵀy|/λ and b = |A₂ᵀy|/(1−λ),

- λa(a−1) + (1−λ)b(b−1) > 0 proves separation along y,
- a ≤ 1 and b ≤ 1 proves that the point c₁ + Σ₁y/λ lies in both bodies,
- a > b says that the best λ is larger.

Perram and Wertheim (1985) gave the function of λ; its second derivative serves Newton's steps.
"""

import math

from .compile import kernel
from .layout import BODY_CENTRE, BODY_MATRIX, PLACED_CENTRE, PLACED_MATRIX
from .linear import norm, shape_matrix, solve, transposed_times

_STEPS = 40
_POLISH_STEPS = 30
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
    """
    cx = placed[i, PLACED_CENTRE] - bodies[j, BODY_CENTRE]
    cy = placed[i, PLACED_CENTRE + 1] - bodies[j, BODY_CENTRE + 1]
    cz = placed[i, PLACED_CENTRE + 2] - bodies[j, BODY_CENTRE + 2]
    a0, a1, a2, a3, a4, a5 = shape_matrix(bodies, j, BODY_MATRIX)
    b0, b1, b2, b3, b4, b5 = shape_matrix(placed, i, PLACED_MATRIX)
    low, high = 0.0, 1.0
    best, ux, uy, uz = -math.inf, 1.0, 0.0, 0.0
    meet = False
    for _ in range(_STEPS):
        p, q = 1.0 / lam, 1.0 / (1.0 - lam)
        m0, m1, m2 = p * a0 + q * b0, p * a1 + q * b1, p * a2 + q * b2
        m3, m4, m5 = p * a3 + q * b3, p * a4 + q * b4, p * a5 + q * b5
        yx, yy, yz, det = solve(m0, m1, m2, m3, m4, m5, cx, cy, cz)
        length = norm(yx, yy, yz)
        if not (det > 0.0 and length > 0.0 and length < math.inf):
            meet = cx == 0.0 and cy == 0.0 and cz == 0.0
            break
        sx, sy, sz = transposed_times(bodies, j, BODY_MATRIX, yx, yy, yz)
        tx, ty, tz = transposed_times(placed, i, PLACED_MATRIX, yx, yy, yz)
        first, second = norm(sx, sy, sz), norm(tx, ty, tz)
        value = (yx * cx + yy * cy + yz * cz - first - second) / length
        if value > best:
            best, ux, uy, uz = value, yx / length, yy / length, yz / length
        a, b = p * first, q * second
        if value > required and (mode == DECIDE or abs(a - b) < 0.05 * (a + b)):
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
        # N = Σ₁/λ² − Σ₂/(1−λ)²; F″ = 2 (Ny·M⁻¹Ny − a²/λ − b²/(1−λ)).
        wx = p * p * (a0 * yx + a1 * yy + a2 * yz) - q * q * (b0 * yx + b1 * yy + b2 * yz)
        wy = p * p * (a1 * yx + a3 * yy + a4 * yz) - q * q * (b1 * yx + b3 * yy + b4 * yz)
        wz = p * p * (a2 * yx + a4 * yy + a5 * yz) - q * q * (b2 * yx + b4 * yy + b5 * yz)
        vx, vy, vz, det = solve(m0, m1, m2, m3, m4, m5, wx, wy, wz)
        bend = 2.0 * (wx * vx + wy * vy + wz * vz - p * a * a - q * b * b)
        lam = next_weight(lam, low, high, a * a - b * b, bend)
    if mode != CONVERGE and (meet or best > required):
        return best, ux, uy, uz, lam
    if meet and mode != CONVERGE:
        return best, ux, uy, uz, lam
    best, ux, uy, uz = polish(bodies, j, placed, i, ux, uy, uz, required, mode)
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
        dx, dy, dz, det = solve(
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
