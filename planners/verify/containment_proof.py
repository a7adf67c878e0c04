"""Proofs that parts lie inside arenas with room to spare: upper bounds of how far out they reach.

In the frame where the arena is the unit ball a part is {d + B y : |y| <= 1}. For every m larger
than the greatest squared singular value b_1^2 of B, the S-lemma gives

    max |d + B y|^2  <=  m + sum_k m d_k^2 / (m - b_k^2),

d_k along the left singular vectors. The smallest of these bounds is the maximum itself.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_BISECTIONS = 70
_SMALLEST_LOG = -80.0  # of (m - b_1^2) / (1 - b_1^2)
_LARGEST_SHARE = 1.0 - 1e-6  # of a ball in a sum with a part
_ROUNDING = 16.0 * np.finfo(float).eps


def is_inside(
    state: tuple[Array, ...], room: Array, directions: Array, doubt: Array
) -> NDArray[np.bool_]:
    """Whether parts (k,) provably keep ``room`` (k,) to the boundaries of the arenas around them.

    A part and a ball of radius ``room`` have a sum that lies in an ellipsoid, which touches it
    in a chosen direction; it is that ellipsoid which must be inside. Where the arena's thinnest
    axis allows, the part's own room in the arena's norm does as well.

    Args:
        state: matrices A = R diag(a) (k, n, n) of the arenas, of the parts, and the offsets
            (k, n) of the parts' centres from the arenas'.
        room: (k,), not negative.
        directions: (k, n), unit vectors along which the room is small.
        doubt: (k,), rounding of the offset, as a length.
    """
    arenas, parts, offset = state
    inverse = np.linalg.inv(arenas)
    thinnest = np.linalg.norm(inverse, ord=2, axis=(1, 2))
    wide = np.linalg.norm(np.einsum("kji,kj->ki", parts, directions), axis=1)
    share = np.minimum(room / np.where(wide + room > 0.0, wide + room, 1.0), _LARGEST_SHARE)
    grown = _grown(parts, share, room)
    centre = np.einsum("kij,kj->ki", inverse, offset)
    rounding = _ROUNDING + (doubt + _ROUNDING * np.linalg.norm(parts, axis=(1, 2))) * thinnest
    one = furthest_out(inverse @ grown, centre) + rounding
    two = furthest_out(inverse @ parts, centre) + rounding + room * thinnest
    return np.minimum(one, two) <= 1.0


def _grown(parts: Array, share: Array, room: Array) -> Array:
    """Matrices of ellipsoids around the sums of parts and balls, for a ball's share in (0, 1)."""
    left, axes, _ = np.linalg.svd(parts)
    some = room > 0.0
    ball = np.where(some, room * room / np.where(some, share, 1.0), 0.0)
    grown = np.sqrt(axes * axes / (1.0 - share)[:, None] + ball[:, None])
    return left * grown[:, None, :]


def furthest_out(shapes: Array, centres: Array) -> Array:
    """Upper bounds (k,) of max |d + B y| over |y| <= 1, for B (k, n, n) and d (k, n).

    Infinite where B alone reaches out of the unit ball.
    """
    left, axes, _ = np.linalg.svd(shapes)
    along = np.einsum("kji,kj->ki", left, centres)
    squares = axes * axes
    most = squares[:, 0]
    fits = most < 1.0
    low = np.full(len(most), _SMALLEST_LOG)
    high = np.zeros(len(most))
    below = most[:, None] - squares  # not negative: how far b_1^2 is above the others
    spare = np.where(fits, 1.0 - most, 1.0)
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        over = below + (spare * np.exp(middle))[:, None]
        rising = np.sum((along * axes / over) ** 2, axis=1) < 1.0
        low, high = np.where(rising, low, middle), np.where(rising, middle, high)
    more = spare * np.exp(high)
    m = most + more
    over = below + more[:, None]
    # A difference of squares is off by their rounding, which counts where it is small.
    blur = 1.0 + _ROUNDING * m[:, None] / over
    bound = m + np.sum(m[:, None] * along * along / over * blur, axis=1)
    return np.where(fits, np.sqrt(bound * (1.0 + _ROUNDING)), np.inf)
