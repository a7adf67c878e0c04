"""Chords: where a line of base positions meets a C-obstacle, or stays inside an arena.

In whitened coordinates (see whitening) two families of ellipsoids (Kurzhanski and Vályi 1997), one
around the sum and one inside the difference, along p(t) = p₀ + t w are Σ m_k p_k(t)² ≤ 1 with

- obstacle: m_k = λ(1−λ)/((1−λ) + s_k λ); the blocked interval is the intersection over λ;
- arena: μ + Σ p_k² μ/(μ − s_k) ≤ 1; the free interval is the union over μ.

Each end of a blocked interval is replaced by the point where a supporting plane of the Minkowski
sum crosses the line, computed from the bodies themselves: an outer end, whatever λ was found.
"""

import math

from .compile import inlined, kernel
from .layout import (
    BODY_CENTRE,
    BODY_EXTENT,
    BODY_MATRIX,
    PLACED_CENTRE,
    PLACED_EXTENT,
    PLACED_MATRIX,
)
from .linear import norm, shape_matrix, solve_positive, times, transposed_times
from .whitening import WHITEN_MATRIX, WHITEN_SQUARES

_STEPS = 60
# Roundings of s and p change the arena's family by about this many roundings of 1 at most.
_TRUSTED_PULL = 4.0
MISS = 0
HIT = 1


@inlined
def _section(table, row, lam, p0, p1, p2, w0, w1, w2):
    """Coefficients (α, β, γ) of αt² + 2βt + γ for E_λ, with the centre at the origin."""
    alpha, beta, gamma = 0.0, 0.0, 0.0
    mu = 1.0 - lam
    m0 = lam * mu / (mu + table[row, WHITEN_SQUARES] * lam)
    m1 = lam * mu / (mu + table[row, WHITEN_SQUARES + 1] * lam)
    m2 = lam * mu / (mu + table[row, WHITEN_SQUARES + 2] * lam)
    alpha = m0 * w0 * w0 + m1 * w1 * w1 + m2 * w2 * w2
    beta = m0 * w0 * p0 + m1 * w1 * p1 + m2 * w2 * p2
    gamma = m0 * p0 * p0 + m1 * p1 * p1 + m2 * p2 * p2
    return alpha, beta, gamma


@kernel
def _norms(table, row, lam, p0, p1, p2):
    """(inner, outer): |A₁ᵀy| and |A₂ᵀy| over λ(1−λ) for y = M⁻¹c at the point p of the line.

    The best λ has λ/(1−λ) = inner/outer.
    """
    mu = 1.0 - lam
    s0 = table[row, WHITEN_SQUARES]
    s1 = table[row, WHITEN_SQUARES + 1]
    s2 = table[row, WHITEN_SQUARES + 2]
    d0, d1, d2 = p0 / (mu + s0 * lam), p1 / (mu + s1 * lam), p2 / (mu + s2 * lam)
    inner = math.sqrt(d0 * d0 + d1 * d1 + d2 * d2)
    outer = math.sqrt(s0 * d0 * d0 + s1 * d1 * d1 + s2 * d2 * d2)
    return inner, outer


@kernel
def _normal(table, row, lam, p0, p1, p2):
    """Outward normal, in the world, of E_λ's level set through p (any length)."""
    mu = 1.0 - lam
    v0 = p0 / (mu + table[row, WHITEN_SQUARES] * lam)
    v1 = p1 / (mu + table[row, WHITEN_SQUARES + 1] * lam)
    v2 = p2 / (mu + table[row, WHITEN_SQUARES + 2] * lam)
    return transposed_times(table, row, WHITEN_MATRIX, v0, v1, v2)


@kernel
def _tightest(table, row, lam, sign, p0, p1, p2, w0, w1, w2):
    """Best λ for the end ``sign`` of the chord: (λ, t, hit); no hit: t is the closest point.

    A bracketed secant in the odds κ = λ/(1−λ) for κ = inner/outer; the fixed point κ ← inner/outer
    starts it, and bisection of the odds takes over where the secant leaves the bracket.
    """
    low, high = 0.0, math.inf
    odds = lam / (1.0 - lam)
    last_odds, last_error = 0.0, 0.0
    t, hit = 0.0, False
    for step in range(_STEPS):
        lam = odds / (1.0 + odds)
        mu = 1.0 / (1.0 + odds)
        alpha, beta, gamma = _section(table, row, lam, p0, p1, p2, w0, w1, w2)
        root = beta * beta - alpha * (gamma - 1.0)
        hit = root >= 0.0
        t = -beta / alpha
        if hit:
            t = (sign * math.sqrt(root) - beta) / alpha
        inner, outer = _norms(table, row, lam, p0 + t * w0, p1 + t * w1, p2 + t * w2)
        a, b = mu * inner, lam * outer
        if not hit and lam * a * (a - 1.0) + mu * b * (b - 1.0) > 1e-6:
            break
        error = odds - inner / outer
        if not abs(error) > 1e-8 * odds:
            break
        if error < 0.0:
            low = odds
        else:
            high = odds
        trial = odds - error
        if step > 0 and error != last_error:
            trial = odds - error * (odds - last_odds) / (error - last_error)
        last_odds, last_error = odds, error
        if step % 4 == 3 or not (trial > low and trial < high):
            trial = _between(low, high)
        odds = trial
    return lam, t, hit


@kernel
def _between(low, high):
    """Middle of a bracket of odds, on a logarithmic scale."""
    if high == math.inf:
        return max(1.0, 10.0 * low)
    if low <= 0.0:
        return 0.1 * high
    return math.sqrt(low * high)


@kernel
def crossing(bodies, j, placed, i, clearance, cx, cy, cz, axis, ux, uy, uz):
    """Parameter t where u·(c + t e) reaches the support of obstacle ⊕ part ⊕ ball, e the axis.

    Returns (t, slope) with slope = u·e for the unit vector u; t is meaningless if slope is 0.
    """
    length = norm(ux, uy, uz)
    ux, uy, uz = ux / length, uy / length, uz / length
    ax, ay, az = transposed_times(bodies, j, BODY_MATRIX, ux, uy, uz)
    bx, by, bz = transposed_times(placed, i, PLACED_MATRIX, ux, uy, uz)
    support = norm(ax, ay, az) + norm(bx, by, bz) + clearance
    slope = ux if axis == 0 else (uy if axis == 1 else uz)
    return (support - (ux * cx + uy * cy + uz * cz)) / slope, slope


@inlined
def _sharpen(bodies, j, placed, i, clearance, cx, cy, cz, axis, sign, ux, uy, uz):
    """Newton steps for the plane that crosses the line earliest (convex in u at fixed u·e)."""
    a0, a1, a2, a3, a4, a5 = shape_matrix(bodies, j, BODY_MATRIX)
    b0, b1, b2, b3, b4, b5 = shape_matrix(placed, i, PLACED_MATRIX)
    best, slope = crossing(bodies, j, placed, i, clearance, cx, cy, cz, axis, ux, uy, uz)
    for _ in range(12):
        length = norm(ux, uy, uz)
        ux, uy, uz = ux / length, uy / length, uz / length
        ax, ay, az = transposed_times(bodies, j, BODY_MATRIX, ux, uy, uz)
        bx, by, bz = transposed_times(placed, i, PLACED_MATRIX, ux, uy, uz)
        p, q = 1.0 / norm(ax, ay, az), 1.0 / max(norm(bx, by, bz), 1e-300)
        gx = p * (a0 * ux + a1 * uy + a2 * uz)
        gy = p * (a1 * ux + a3 * uy + a4 * uz)
        gz = p * (a2 * ux + a4 * uy + a5 * uz)
        hx = q * (b0 * ux + b1 * uy + b2 * uz)
        hy = q * (b1 * ux + b3 * uy + b4 * uz)
        hz = q * (b2 * ux + b4 * uy + b5 * uz)
        m0 = p * (a0 - gx * gx) + q * (b0 - hx * hx) + clearance * (1.0 - ux * ux)
        m1 = p * (a1 - gx * gy) + q * (b1 - hx * hy) - clearance * ux * uy
        m2 = p * (a2 - gx * gz) + q * (b2 - hx * hz) - clearance * ux * uz
        m3 = p * (a3 - gy * gy) + q * (b3 - hy * hy) + clearance * (1.0 - uy * uy)
        m4 = p * (a4 - gy * gz) + q * (b4 - hy * hz) - clearance * uy * uz
        m5 = p * (a5 - gz * gz) + q * (b5 - hz * hz) + clearance * (1.0 - uz * uz)
        # Residual of the point on the line: zero tangentially at the optimum.
        rx = cx - gx - hx - clearance * ux
        ry = cy - gy - hy - clearance * uy
        rz = cz - gz - hz - clearance * uz
        stiff = 1e6 * (m0 + m3 + m5)
        if axis == 0:
            m0 += stiff
            rx = 0.0
        elif axis == 1:
            m3 += stiff
            ry = 0.0
        else:
            m5 += stiff
            rz = 0.0
        dx, dy, dz, _, positive = solve_positive(m0, m1, m2, m3, m4, m5, rx, ry, rz)
        if not positive:
            break
        step = 1.0
        improved = False
        for _ in range(8):
            nx, ny, nz = ux + step * dx, uy + step * dy, uz + step * dz
            t, new_slope = crossing(bodies, j, placed, i, clearance, cx, cy, cz, axis, nx, ny, nz)
            if new_slope * sign > 0.0 and sign * t < sign * best:
                best, slope, improved = t, new_slope, True
                ux, uy, uz = nx, ny, nz
                break
            step *= 0.25
        if not improved or abs(dx) + abs(dy) + abs(dz) < 1e-9:
            break
    return best, slope


@kernel
def obstacle_chord(bodies, j, placed, i, table, row, clearance, tolerance, axis, x, y, z):
    """Blocked interval of the line (x, y, z) + t e: (MISS or HIT, t_low, t_high), outer.

    ``placed`` holds the part with the base at the origin, ``table[row]`` the whitening of the
    pair. Outside the interval the gap is at least ``clearance`` + ``tolerance``.
    """
    cx = x + placed[i, PLACED_CENTRE] - bodies[j, BODY_CENTRE]
    cy = y + placed[i, PLACED_CENTRE + 1] - bodies[j, BODY_CENTRE + 1]
    cz = z + placed[i, PLACED_CENTRE + 2] - bodies[j, BODY_CENTRE + 2]
    keep = clearance + tolerance
    first = bodies[j, BODY_EXTENT + axis]
    second = placed[i, PLACED_EXTENT + axis]
    along = cx if axis == 0 else (cy if axis == 1 else cz)
    widest = first + second + keep
    p0, p1, p2 = times(table, row, WHITEN_MATRIX, cx, cy, cz)
    w0 = table[row, WHITEN_MATRIX + axis]
    w1 = table[row, WHITEN_MATRIX + 3 + axis]
    w2 = table[row, WHITEN_MATRIX + 6 + axis]
    start = min(max((first + clearance) / (first + second + clearance), 1e-6), 1.0 - 1e-6)
    ends_low, ends_high = -along - widest, -along + widest
    for k in range(2):
        sign = 1.0 if k == 0 else -1.0
        lam, t, hit = _tightest(table, row, start, sign, p0, p1, p2, w0, w1, w2)
        ux, uy, uz = _normal(table, row, lam, p0 + t * w0, p1 + t * w1, p2 + t * w2)
        if not hit:
            if _misses(bodies, j, placed, i, keep, cx, cy, cz, axis, ux, uy, uz):
                return MISS, 0.0, 0.0
            continue
        end, slope = crossing(bodies, j, placed, i, keep, cx, cy, cz, axis, ux, uy, uz)
        if clearance > 0.0 and slope * sign > 0.0:
            end, slope = _sharpen(bodies, j, placed, i, keep, cx, cy, cz, axis, sign, ux, uy, uz)
        if slope * sign > 0.0:
            if k == 0:
                ends_high = min(ends_high, end)
            else:
                ends_low = max(ends_low, end)
        start = lam
        if clearance > 0.0:
            start = min(max(start, 1e-6), 1.0 - 1e-6)
    if ends_low > ends_high:
        return MISS, 0.0, 0.0
    return HIT, ends_low, ends_high


@inlined
def _misses(bodies, j, placed, i, keep, cx, cy, cz, axis, ux, uy, uz):
    """Whether a plane parallel to the line separates it from the C-obstacle by ``keep``."""
    if axis == 0:
        ux = 0.0
    elif axis == 1:
        uy = 0.0
    else:
        uz = 0.0
    length = norm(ux, uy, uz)
    if not (length > 0.0 and length < math.inf):
        return False
    ux, uy, uz = ux / length, uy / length, uz / length
    ax, ay, az = transposed_times(bodies, j, BODY_MATRIX, ux, uy, uz)
    bx, by, bz = transposed_times(placed, i, PLACED_MATRIX, ux, uy, uz)
    return ux * cx + uy * cy + uz * cz - norm(ax, ay, az) - norm(bx, by, bz) >= keep


@kernel
def _member(mu, p0, p1, p2, w0, w1, w2, s0, s1, s2):
    """The arena's family at μ along p + t w: (least value, its t, curvature α).

    Its value at t′ is least + α (t′ − t)²: sums of positive terms, which do not cancel where μ
    comes close to an s.
    """
    d0, d1, d2 = mu / (mu - s0), mu / (mu - s1), mu / (mu - s2)
    alpha = d0 * w0 * w0 + d1 * w1 * w1 + d2 * w2 * w2
    t = -(d0 * w0 * p0 + d1 * w1 * p1 + d2 * w2 * p2) / alpha
    q0, q1, q2 = p0 + t * w0, p1 + t * w1, p2 + t * w2
    return mu + d0 * q0 * q0 + d1 * q1 * q1 + d2 * q2 * q2, t, alpha


@kernel
def _pull(mu, q0, q1, q2, s0, s1, s2):
    """Σ q_k² s_k/(μ − s_k)²: above 1 a larger μ lowers the family's value at the point q."""
    e0, e1, e2 = q0 / (mu - s0), q1 / (mu - s1), q2 / (mu - s2)
    return s0 * e0 * e0 + s1 * e1 * e1 + s2 * e2 * e2


@inlined
def _deepest(limit, p0, p1, p2, w0, w1, w2, s0, s1, s2):
    """Some (found, μ, t) where the family is at most ``limit`` on the line.

    The least value over t is convex in μ, and every μ above 1 is useless: bisection on its
    slope, which ends early where the tangent shows that nothing can be found.
    """
    low, high = max(s0, max(s1, s2)), 1.0
    if not low < high:
        return False, 0.0, 0.0
    mu = math.sqrt(max(low, 1e-4))
    for _ in range(_STEPS):
        value, t, _ = _member(mu, p0, p1, p2, w0, w1, w2, s0, s1, s2)
        pull = _pull(mu, p0 + t * w0, p1 + t * w1, p2 + t * w2, s0, s1, s2)
        if value <= limit and pull <= _TRUSTED_PULL:
            return True, mu, t
        slope = 1.0 - pull
        if slope > 0.0:
            high = mu
            if value + slope * (low - mu) > limit:
                break
        else:
            low = mu
            if value + slope * (high - mu) > limit:
                break
        mu = 0.5 * (low + high)
    return False, 0.0, 0.0


@kernel
def arena_chord(bodies, j, placed, i, table, row, tolerance, axis, x, y, z):
    """Free interval of the line (x, y, z) + t e in arena ``j``: (hit, t_low, t_high), inner.

    The arena is the one whose inverse stands in BODY_WHITEN: shrunk by the clearance, if any.
    ``tolerance`` is in the arena's norm: within the interval 1 − g is at least that.
    """
    cx = x + placed[i, PLACED_CENTRE] - bodies[j, BODY_CENTRE]
    cy = y + placed[i, PLACED_CENTRE + 1] - bodies[j, BODY_CENTRE + 1]
    cz = z + placed[i, PLACED_CENTRE + 2] - bodies[j, BODY_CENTRE + 2]
    s0 = table[row, WHITEN_SQUARES]
    s1 = table[row, WHITEN_SQUARES + 1]
    s2 = table[row, WHITEN_SQUARES + 2]
    p0, p1, p2 = times(table, row, WHITEN_MATRIX, cx, cy, cz)
    w0 = table[row, WHITEN_MATRIX + axis]
    w1 = table[row, WHITEN_MATRIX + 3 + axis]
    w2 = table[row, WHITEN_MATRIX + 6 + axis]
    limit = 1.0 - tolerance
    found, mu, t = _deepest(limit, p0, p1, p2, w0, w1, w2, s0, s1, s2)
    if not found:
        return False, 0.0, 0.0
    low = _arena_end(-1.0, mu, t, limit, p0, p1, p2, w0, w1, w2, s0, s1, s2)
    high = _arena_end(1.0, mu, t, limit, p0, p1, p2, w0, w1, w2, s0, s1, s2)
    return True, low, high


@kernel
def _arena_end(sign, mu, t, limit, p0, p1, p2, w0, w1, w2, s0, s1, s2):
    """Outermost inside point towards ``sign`` over all μ, from a μ and t that are inside.

    The end of μ's own interval is quasi-concave in μ; it grows with μ where the pull there is
    above 1. A bracketed secant on 1/√pull − 1, nearly linear as in trust regions.
    """
    low, high = max(s0, max(s1, s2)), 1.0
    inside = mu
    low_error, high_error = math.nan, math.nan
    for step in range(_STEPS):
        value, middle, alpha = _member(mu, p0, p1, p2, w0, w1, w2, s0, s1, s2)
        if value > limit:
            if mu < inside:
                low, low_error = mu, math.nan
            else:
                high, high_error = mu, math.nan
        else:
            end = middle + sign * math.sqrt((limit - value) / alpha)
            pull = _pull(mu, p0 + end * w0, p1 + end * w1, p2 + end * w2, s0, s1, s2)
            if pull <= _TRUSTED_PULL:
                t = max(t, end) if sign > 0.0 else min(t, end)
            error = 1.0 / math.sqrt(pull) - 1.0 if pull > 0.0 else 1.0
            if error < 0.0:
                low, low_error = mu, error
            else:
                high, high_error = mu, error
            if abs(error) < 1e-9:
                break
        if high - low <= 1e-15 * high:
            break
        mu = (low * high_error - high * low_error) / (high_error - low_error)
        if step % 3 == 2 or not (mu > low and mu < high):
            mu = 0.5 * (low + high)
    return t
