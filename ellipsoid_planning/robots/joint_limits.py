"""What a joint's limits mean: a range, none at all, or a value that it is fixed at.

Simulators write limits such as 1e16 or 1.8e308 for a joint that has none, and equal ones for a
joint that does not move.
"""

from __future__ import annotations

import math

from ellipsoid_planning.sizes import MOST_LENGTH

UNLIMITED = 1000.0 * 2.0 * math.pi
"""Limits of a revolute joint that are both this far from 0 [rad], a thousand turns, mean none."""
NEGLIGIBLE = 1e-12
"""A joint with a range of no more [rad or length] does not move."""

_DEGREES = f"{math.degrees(UNLIMITED):g} deg"


def is_unlimited(lower: float, upper: float) -> bool:
    """Whether limits of a revolute joint [rad] mean that it has none."""
    return lower <= -UNLIMITED and upper >= UNLIMITED


def revolute_problem(lower: float, upper: float) -> str | None:
    """What is wrong with limits of a revolute joint [rad] that are not unlimited; None if fine."""
    if max(abs(lower), abs(upper)) <= UNLIMITED:
        return None
    return (
        f"expected both limits within a thousand turns ({_DEGREES}), or both beyond, which means "
        f"none, got {math.degrees(lower):g} and {math.degrees(upper):g} deg; "
        "correct them or make the joint continuous"
    )


def shift_problem(lower: float, upper: float) -> str | None:
    """What is wrong with limits of a prismatic joint [length]; None if fine."""
    if max(abs(lower), abs(upper)) <= MOST_LENGTH:
        return None
    return (
        f"expected the limits of a prismatic joint within {MOST_LENGTH:g}, got {lower:g} and "
        f"{upper:g}; give the lengths that it can move by"
    )


def unlimited_notice(lower: float, upper: float) -> str:
    """What a user is told of a revolute joint that became continuous."""
    return (
        f"limits of {math.degrees(lower):g} and {math.degrees(upper):g} deg mean none: "
        "it is taken for continuous"
    )


def fixed_notice(lower: float, upper: float) -> str:
    """What a user is told of a joint that became fixed [rad or length]."""
    return (
        f"its limits leave a range of {upper - lower:g}, below rounding: it is fixed at {lower:g}"
    )


def about(axis: tuple[float, ...], angle: float) -> list[list[float]]:
    """The rotation (3, 3) by an angle [rad] about a unit vector (Rodrigues' formula)."""
    x, y, z = axis
    c, s = math.cos(angle), math.sin(angle)
    t = 1.0 - c
    return [
        [c + t * x * x, t * x * y - s * z, t * x * z + s * y],
        [t * x * y + s * z, c + t * y * y, t * y * z - s * x],
        [t * x * z - s * y, t * y * z + s * x, c + t * z * z],
    ]
