"""Turning motions that keep any small gap: how many proofs do they take?"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.world import World

Array = NDArray[np.float64]
Motion = tuple[CSpace, Array, Array]

GAPS = tuple(10.0**-k for k in range(1, 9))
_TURN = (-1.2, 1.1)
"""Headings at the ends [rad]; not symmetric, so that no proof is lucky."""

_ellipsoid = Ellipsoid.from_semi_axes


def proofs(case: Callable[[float], Motion], gap: float) -> int:
    """Number of proofs of a case at ``gap``; negative if the motion was refused."""
    cspace, first, last = case(gap)
    return int(cspace.motion_proofs(first, last)[0])


def exponent(gaps: ArrayLike, counts: ArrayLike) -> float:
    """The slope p of count ~ gap^(−p), fitted."""
    return float(-np.polyfit(np.log(gaps), np.log(counts), 1)[0])


def _motion(
    part: Ellipsoid,
    obstacles: tuple[Ellipsoid, ...],
    arenas: tuple[Ellipsoid, ...] = (),
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0),
    move: ArrayLike = 0.0,
) -> Motion:
    """The part turns about the base at the origin, which moves from −``move`` to ``move``."""
    n = part.dimension
    world = World(np.full(n, -9.0), np.full(n, 9.0), obstacles, arenas)
    first, last = (
        np.concatenate([sign * np.broadcast_to(move, n), _orientation(n, angle, axis)])
        for sign, angle in zip((-1.0, 1.0), _TURN, strict=True)
    )
    return CSpace(world, RigidRobot((part,))), first, last


def _orientation(dimension: int, angle: float, axis: tuple[float, float, float]) -> Array:
    if dimension == 2:
        return np.array([angle])
    unit = np.array(axis) / np.linalg.norm(axis)
    return np.append(math.sin(0.5 * angle) * unit, math.cos(0.5 * angle))


def between_discs(gap: float, dimension: int = 2) -> Motion:
    """An ellipse turns between two discs, about a point off its centre; tight once."""
    part = _ellipsoid([1.0, 0.3, 0.2][:dimension], [0.2, 0.0, 0.0][:dimension])
    ball = np.full(dimension, 0.5)
    discs = (
        _ellipsoid(ball, [1.7 + gap, 0.0, 0.0][:dimension]),
        _ellipsoid(ball, [-1.3 - gap, 0.0, 0.0][:dimension]),
    )
    return _motion(part, discs)


def between_balls(gap: float) -> Motion:
    """The same in space."""
    return between_discs(gap, 3)


def round_a_disc(gap: float) -> Motion:
    """An ellipse goes round a disc, tight all the way."""
    return _motion(_ellipsoid([0.6, 0.3], [0.0, 2.0]), (_ellipsoid([1.7 - gap] * 2),))


def round_a_ball(gap: float) -> Motion:
    """An ellipsoid goes round a ball, about an axis that is none of its own."""
    part = _ellipsoid([0.6, 0.3, 0.4], [0.0, 2.0, 0.0])
    return _motion(part, (_ellipsoid([1.7 - gap] * 3),), axis=(0.3, 0.0, 1.0))


def needle_round_a_disc(gap: float) -> Motion:
    """A needle of axis ratio 1000 goes round a disc."""
    return _motion(_ellipsoid([0.6, 0.0006], [0.0, 2.0]), (_ellipsoid([1.9994 - gap] * 2),))


def in_a_ring(gap: float) -> Motion:
    """A disc goes round between a disc and a round arena: a curved tube."""
    part = _ellipsoid([0.3, 0.3], [2.0, 0.0])
    return _motion(part, (_ellipsoid([1.7 - gap] * 2),), (_ellipsoid([2.3 + gap] * 2),))


def in_a_disc(gap: float) -> Motion:
    """An ellipse turns in a round arena that it touches with both ends all the time."""
    return _motion(_ellipsoid([1.0, 0.3]), (), (_ellipsoid([1.0 + gap] * 2),))


def in_a_ball(gap: float) -> Motion:
    """The same in space, about a skew axis."""
    part = _ellipsoid([1.0, 0.3, 0.2])
    return _motion(part, (), (_ellipsoid([1.0 + gap] * 3),), axis=(1.0, 2.0, 3.0))


def screw_past_a_rod(gap: float) -> Motion:
    """An ellipsoid turns as it passes between two rods; tight in the middle."""
    part = _ellipsoid([1.0, 0.3, 0.2], [0.2, 0.0, 0.0])
    rods = (
        _ellipsoid([0.2, 0.3, 3.0], [1.4 + gap, 0.0, 0.0]),
        _ellipsoid([0.2, 0.3, 3.0], [-1.0 - gap, 0.0, 0.0]),
    )
    return _motion(part, rods, axis=(0.1, 0.2, 1.0), move=[0.0, 0.4, 0.3])


CASES = (
    between_discs,
    between_balls,
    screw_past_a_rod,
    round_a_disc,
    round_a_ball,
    needle_round_a_disc,
    in_a_ring,
    in_a_disc,
    in_a_ball,
)
