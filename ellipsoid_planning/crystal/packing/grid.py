"""Grids of arrangements: poses of the base times values of the joints."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.packing.ranges import Range

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class ArrangementGrid:
    """All arrangements that a search looks at, numbered from 0.

    Arrangement = base pose · joint_count + joint values. Base poses run through the shifts
    fastest, joint values through the last joint.

    Attributes:
        ranges: one for each coordinate, the base's first.
        base_count: how many coordinates place the base.
        shift_count: how many of them are shifts; they come first.
        turns: None for the product of the ranges, else (r, 3) Euler angles [rad] to go through.
    """

    ranges: tuple[Range, ...]
    base_count: int
    shift_count: int
    turns: Array | None = None

    @cached_property
    def bases(self) -> Array:
        """(N, base_count): the base's coordinates of all its poses."""
        shifts = combinations([r.values for r in self.ranges[: self.shift_count]])
        turns = self.turns
        if turns is None:
            turns = combinations(
                [r.values for r in self.ranges[self.shift_count : self.base_count]]
            )
        whole = np.hstack([np.tile(shifts, (len(turns), 1)), np.repeat(turns, len(shifts), axis=0)])
        whole.setflags(write=False)
        return whole

    @property
    def base_poses(self) -> int:
        """N, the number of poses of the base."""
        ranges = self.ranges[: self.base_count if self.turns is None else self.shift_count]
        turns = 1 if self.turns is None else len(self.turns)
        return turns * math.prod(len(r.values) for r in ranges)

    @property
    def joint_values(self) -> tuple[Array, ...]:
        """The values of each joint."""
        return tuple(r.values for r in self.ranges[self.base_count :])

    @property
    def joint_counts(self) -> tuple[int, ...]:
        """How many values each joint has."""
        return tuple(len(values) for values in self.joint_values)

    @property
    def joint_count(self) -> int:
        """How many combinations of joint values there are."""
        return math.prod(self.joint_counts)

    @property
    def count(self) -> int:
        """How many arrangements there are."""
        return self.base_poses * self.joint_count

    def configurations(self, numbers: ArrayLike) -> Array:
        """The configurations (m, K) of arrangements by number (m,)."""
        base, joint = np.divmod(np.asarray(numbers, dtype=np.int64), self.joint_count)
        columns = [self.bases[base]]
        digits = np.unravel_index(joint, self.joint_counts) if self.joint_counts else ()
        for values, digit in zip(self.joint_values, digits, strict=True):
            columns.append(values[digit][:, None])
        return np.hstack(columns)


def combinations(values: list[Array]) -> Array:
    """All combinations (m, len(values)) of one of each, the last one varying fastest."""
    if not values:
        return np.zeros((1, 0))
    return np.stack(np.meshgrid(*values, indexing="ij"), axis=-1).reshape(-1, len(values))
