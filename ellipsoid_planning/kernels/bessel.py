"""Transforms of the unit disc and unit ball, and their slopes, to rounding.

The ball's transform at the frequency s is 4π j₁(w)/w, the disc's 2π J₁(w)/w, w = 2π|s|; the slope
is the derivative by w over w: −4π j₂(w)/w² and −2π J₂(w)/w². All are even, smooth functions of w.

Bessel functions: Chebyshev series in w² up to w = 8, beyond it Hankel's form
J_n(w) = √(2/πw) (P_n cos χ − Q_n sin χ), χ = w − (2n + 1)π/4, with P_n and w Q_n as Chebyshev
series in (8/w)²; coefficients computed with 40 digits. The error is about 1e-15 of the largest
value of J_n up to w = 8, and of the envelope √(2/πw) beyond.

Nothing branches, so that loops over many w are vectorised.
"""

import math

import numpy as np

from .compile import inlined
from .sines import sine_cosine

NEAR = 8.0  # up to here the series in w²
SERIES = 2.0  # up to here the ball's power series, which loses no digits


def _spherical(n: int) -> np.ndarray:
    """Coefficients of j_n(w)/wⁿ in w²; at `SERIES` the first one left out is below 1e-18."""
    terms = [1.0 / math.prod(range(1, 2 * n + 2, 2))]
    for k in range(1, 13):
        terms.append(-terms[-1] / (2.0 * k * (2.0 * (n + k) + 1.0)))
    return np.array(terms)


BALL, BALL_SLOPE = _spherical(1), _spherical(2)

# J₁(w)/w and J₂(w)/w² as series in w²/32 − 1; P_n and w Q_n as series in 2 (8/w)² − 1.

NEAR_1 = np.array(
    [
        0.08104484632565812,
        -0.1489751450676521,
        0.1609992623572097,
        -0.08268049176681791,
        0.022213639654966037,
        -0.003646940600769276,
        0.0004050337728354822,
        -3.255554866857259e-05,
        1.9858774049915165e-06,
        -9.521984756750436e-08,
        3.687133759097148e-09,
        -1.178026622695885e-10,
        3.160154580348003e-12,
        -7.221755239651773e-14,
        1.4232144003513942e-15,
        -2.4441972916190464e-17,
        3.6912682997929334e-19,
    ]
)
NEAR_2 = np.array(
    [
        0.0259675044055018,
        -0.051662401237476965,
        0.033313115677547085,
        -0.011412585648174543,
        0.0023079312649903717,
        -0.00030576582069152526,
        2.8593389509574438e-05,
        -1.9904910649136225e-06,
        1.0728442457342493e-07,
        -4.613659922105544e-09,
        1.620960599825292e-10,
        -4.7427232341091315e-12,
        1.173993618450466e-13,
        -2.491363587126523e-15,
        4.5839200705273085e-17,
        -7.383865115828454e-19,
    ]
)
P_1 = np.array(
    [
        1.0009030408600137,
        0.0008989898330859408,
        -3.987284300488908e-06,
        6.177633960644299e-08,
        -1.8718907491063067e-09,
        8.816898659582339e-11,
        -5.704863640395645e-12,
        4.699195515230542e-13,
        -4.6842237839904895e-14,
        5.452674896044717e-15,
        -7.221180842274018e-16,
        1.0667689114335412e-16,
        -1.7312313216116335e-17,
        3.0492991197665872e-18,
    ]
)
Q_1 = np.array(
    [
        0.3742222965562826,
        -0.0007702178839325664,
        7.3108922063643636e-06,
        -1.676782510726674e-07,
        6.583354662120443e-09,
        -3.749090950541556e-10,
        2.8121750359748866e-11,
        -2.61145253946232e-12,
        2.8774212663332235e-13,
        -3.649001916061838e-14,
        5.206626366226707e-15,
        -8.215318025458595e-16,
        1.4141084390211833e-16,
        -2.626761589838529e-17,
        5.2192649196714085e-18,
        -1.1012617187879591e-18,
    ]
)
P_2 = np.array(
    [
        0.993619143291045,
        -0.006371767892414043,
        8.979589301354712e-06,
        -1.0625375052356995e-07,
        2.840696860729831e-09,
        -1.2443511863465101e-10,
        7.678239316053257e-12,
        -6.116031011133012e-13,
        5.945703794214546e-14,
        -6.7875396793595506e-15,
        8.849501765008156e-16,
        -1.2906024352403025e-16,
        2.0719807754369248e-17,
        -3.615982396240833e-18,
    ]
)
Q_2 = np.array(
    [
        1.8773592448773313,
        0.0023450612615808137,
        -1.3906167329826334e-05,
        2.673323371966379e-07,
        -9.56131424770567e-09,
        5.139477255651459e-10,
        -3.7063706648764365e-11,
        3.3447552033274734e-12,
        -3.6059073050560394e-13,
        4.494715011405312e-14,
        -6.324180273766843e-15,
        9.863240999109688e-16,
        -1.6811314814725784e-16,
        3.096455062892369e-17,
        -6.107376960884007e-18,
    ]
)


@inlined
def chebyshev(coefficients, y):
    """The sum of coefficient · T_k(y) by Clenshaw's recurrence."""
    first = second = 0.0
    for k in range(coefficients.size - 1, 0, -1):
        first, second = 2.0 * y * first - second + coefficients[k], first
    return y * first - second + coefficients[0]


@inlined
def disc(w):
    """The transform of the unit disc, 2π J₁(w)/w, for w ≥ 0."""
    inner = min(w, NEAR)
    outer = max(w, NEAR)
    near = chebyshev(NEAR_1, inner * inner / 32.0 - 1.0)
    y = 2.0 * (NEAR / outer) ** 2 - 1.0
    s, c = sine_cosine(outer)
    # √2 cos χ = s − c and √2 sin χ = −s − c.
    far = chebyshev(P_1, y) * (s - c) + chebyshev(Q_1, y) / outer * (s + c)
    far /= math.sqrt(math.pi * outer) * outer
    return 2.0 * math.pi * (near if w <= NEAR else far)


@inlined
def disc_slope(w):
    """The derivative of `disc` over w, −2π J₂(w)/w²."""
    inner = min(w, NEAR)
    outer = max(w, NEAR)
    near = chebyshev(NEAR_2, inner * inner / 32.0 - 1.0)
    y = 2.0 * (NEAR / outer) ** 2 - 1.0
    s, c = sine_cosine(outer)
    # √2 cos χ = −s − c and √2 sin χ = c − s.
    far = -chebyshev(P_2, y) * (s + c) - chebyshev(Q_2, y) / outer * (c - s)
    far /= math.sqrt(math.pi * outer) * outer * outer
    return -2.0 * math.pi * (near if w <= NEAR else far)


@inlined
def ball(w):
    """The transform of the unit ball, 4π (sin w − w cos w)/w³, for w ≥ 0."""
    near = horner(BALL, min(w, SERIES) ** 2)
    outer = max(w, SERIES)
    s, c = sine_cosine(outer)
    far = (s - outer * c) / (outer * outer * outer)
    return 4.0 * math.pi * (near if w < SERIES else far)


@inlined
def ball_slope(w):
    """The derivative of `ball` over w, −4π j₂(w)/w²."""
    near = horner(BALL_SLOPE, min(w, SERIES) ** 2)
    outer = max(w, SERIES)
    square = outer * outer
    s, c = sine_cosine(outer)
    far = ((3.0 - square) * s - 3.0 * outer * c) / (square * square * outer)
    return -4.0 * math.pi * (near if w < SERIES else far)


@inlined
def horner(coefficients, x):
    """The sum of coefficient · xᵏ."""
    total = coefficients[coefficients.size - 1]
    for k in range(coefficients.size - 2, -1, -1):
        total = total * x + coefficients[k]
    return total
