"""All that is known about the Minkowski sum or difference of two ellipsoids, in one place."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.approximations import (
    Approximation,
    gaussian_difference,
    gaussian_sum,
    kurzhanski_difference,
    kurzhanski_sum,
    offset_difference,
    offset_sum,
)
from ellipsoid_planning.geometry.bound import Bound
from ellipsoid_planning.geometry.difference_bounds import difference_volume_bounds
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.rolling import RollingCondition, rolls_freely
from ellipsoid_planning.geometry.sum_bounds import sum_volume_bounds
from ellipsoid_planning.geometry.sum_volume import UNIT_BALL


@dataclass(frozen=True, eq=False)
class MinkowskiSummary:
    """A Minkowski sum or difference of two ellipsoids.

    Attributes:
        first, second: the bodies; of a difference the arena and the part.
        difference: which it is.
        volumes: the exact volume (area), every bound and estimate, by name; "lower" and "upper"
            are there for both, for a difference the best ones.
        approximations: ellipsoids inside and around; those that do not exist are left out.
        rolling: for a difference, whether the part rolls freely in the arena.
    """

    first: Ellipsoid
    second: Ellipsoid
    difference: bool
    volumes: dict[str, Bound]
    approximations: tuple[Approximation, ...]
    rolling: RollingCondition | None

    @property
    def exact(self) -> float:
        """The exact volume (area)."""
        return float(self.volumes["exact"])

    def to_dict(self) -> dict[str, Any]:
        """Return the numbers as data for JSON."""
        rolling = self.rolling
        return {
            "operation": "difference" if self.difference else "sum",
            "bodies": [
                {"semi_axes": body.semi_axes.tolist(), "rotation": body.rotation.tolist()}
                for body in (self.first, self.second)
            ],
            "volume": {name: float(bound) for name, bound in self.volumes.items()},
            "kinds": {name: bound.kind for name, bound in self.volumes.items()},
            "approximations": [
                {
                    "name": one.name,
                    "kind": one.kind,
                    "semi_axes": one.ellipsoid.semi_axes.tolist(),
                    "rotation": one.ellipsoid.rotation.tolist(),
                    "volume": volume_of(one.ellipsoid),
                }
                for one in self.approximations
            ],
            "rolling": None
            if rolling is None
            else {
                "holds": rolling.holds,
                "margin": rolling.margin,
                "direction": rolling.direction.tolist(),
            },
        }


def minkowski_summary(
    first: Ellipsoid, second: Ellipsoid, *, difference: bool = False
) -> MinkowskiSummary:
    """Return what is known about first ⊕ second, or first ⊖ second.

    Raises:
        GeometryError: if the dimensions differ or the difference is empty.
    """
    if not difference:
        bodies = (
            offset_sum(first, second),
            gaussian_sum(first, second),
            kurzhanski_sum(first, second, "trace"),
            kurzhanski_sum(first, second, "volume"),
        )
        volumes = sum_volume_bounds(first, second)
        return MinkowskiSummary(first, second, False, volumes, bodies, None)
    volumes = difference_volume_bounds(first, second)
    lower = max(float(b) for b in volumes.values() if b.kind == "lower")
    upper = min(float(b) for b in volumes.values() if b.kind == "upper")
    volumes = volumes | {
        "lower": Bound(np.asarray(lower), "lower", "the best of them"),
        "upper": Bound(np.asarray(upper), "upper", "the best of them"),
    }
    approximations = _differences(first, second)
    rolling = rolls_freely(first, second)
    return MinkowskiSummary(first, second, True, volumes, approximations, rolling)


def volume_of(body: Ellipsoid) -> float:
    """The volume (area) of an ellipsoid."""
    return float(UNIT_BALL[body.dimension] * np.prod(body.semi_axes))


def _differences(arena: Ellipsoid, part: Ellipsoid) -> tuple[Approximation, ...]:
    makers: tuple[Callable[[], Approximation], ...] = (
        lambda: offset_difference(arena, part),
        lambda: gaussian_difference(arena, part),
        lambda: kurzhanski_difference(arena, part, "trace"),
        lambda: kurzhanski_difference(arena, part, "volume"),
    )
    return tuple(one for one in map(_if_there, makers) if one is not None)


def _if_there(make: Callable[[], Approximation]) -> Approximation | None:
    """What ``make`` gives; None if it would be flat, or there is none of its kind."""
    try:
        return make()
    except GeometryError:
        return None
