"""Coordinates in which a body is the unit ball and the part's axes are the coordinate axes.

With B the body's matrix and A the part's, Qᵀ(B⁻¹A) has orthogonal rows for some rotation Q; then
W = QᵀB⁻¹ gives WBBᵀWᵀ = I and WAAᵀWᵀ = diag(s). Q comes from one-sided Jacobi rotations, which keep
the relative accuracy of small s (needles, discs).
"""

import math

from .compile import kernel
from .layout import BODY_WHITEN, PLACED_MATRIX
from .linear import times

WHITEN_MATRIX = 0
WHITEN_SQUARES = 9
WHITEN = 12

_SWEEPS = 12


@kernel
def _rotate_rows(rows, r, p, q, cosine, sine, first):
    for k in range(3):
        a, b = rows[r, first + 3 * p + k], rows[r, first + 3 * q + k]
        rows[r, first + 3 * p + k] = cosine * a - sine * b
        rows[r, first + 3 * q + k] = sine * a + cosine * b


@kernel
def whiten(bodies, j, placed, i, scratch, out, row):
    """Write W (row-major) and s of body ``j`` and part ``i`` to ``out[row]``.

    ``scratch`` has shape (1, 9) and holds the part in the body's coordinates.
    """
    for k in range(9):
        out[row, WHITEN_MATRIX + k] = bodies[j, BODY_WHITEN + k]
    m = PLACED_MATRIX
    for k in range(3):
        x, y, z = times(
            bodies, j, BODY_WHITEN, placed[i, m + k], placed[i, m + 3 + k], placed[i, m + 6 + k]
        )
        scratch[0, k], scratch[0, 3 + k], scratch[0, 6 + k] = x, y, z
    for _ in range(_SWEEPS):
        turned = False
        for pair in range(3):
            p = 0 if pair < 2 else 1
            q = 1 if pair == 0 else 2
            pp, pq, qq = 0.0, 0.0, 0.0
            for k in range(3):
                a, b = scratch[0, 3 * p + k], scratch[0, 3 * q + k]
                pp += a * a
                pq += a * b
                qq += b * b
            if abs(pq) <= 1e-15 * math.sqrt(pp * qq) or pq == 0.0:
                continue
            turned = True
            cotangent = (qq - pp) / (2.0 * pq)
            tangent = 1.0 / (abs(cotangent) + math.sqrt(1.0 + cotangent * cotangent))
            if cotangent < 0.0:
                tangent = -tangent
            cosine = 1.0 / math.sqrt(1.0 + tangent * tangent)
            _rotate_rows(scratch, 0, p, q, cosine, cosine * tangent, 0)
            _rotate_rows(out, row, p, q, cosine, cosine * tangent, WHITEN_MATRIX)
        if not turned:
            break
    for k in range(3):
        a, b, c = scratch[0, 3 * k], scratch[0, 3 * k + 1], scratch[0, 3 * k + 2]
        out[row, WHITEN_SQUARES + k] = a * a + b * b + c * c
