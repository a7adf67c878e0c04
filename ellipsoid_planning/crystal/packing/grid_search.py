"""The search of a whole grid for the arrangements that keep all copies of the molecule apart."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.packing.collisions import shape_rows, watched
from ellipsoid_planning.crystal.packing.grid import combinations
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.kernels import molecule, packing, packing_search

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

# Room for this many arrangements is made at a time, or for those of one base pose.
FOUND_AT_ONCE = 1 << 18

MOST_POSES = 10**6  # of a limb: a table has them all
MOST_COMBINATIONS = 10**8  # of all joints' values, of pairs of limbs' poses


@dataclass(frozen=True, eq=False)
class GridSearch:
    """The tables of a model that the search of its grid reads (see kernels.packing_search)."""

    model: PackingModel

    @cached_property
    def limb_frames(self) -> tuple[int, ...]:
        """The coordinate that carries each limb: the base's first, others as they are settled."""
        base = self.model.molecule.base_count - 1
        used = sorted({int(frame) for frame in self.model.molecule.part_frames} - {base})
        return (base, *used)

    def chain(self, frame: int) -> list[int]:
        """The joints, numbered from 0, that carry a frame, outermost last."""
        found = []
        base = self.model.molecule.base_count
        while frame >= base:
            found.append(frame - base)
            frame = int(self.model.molecule.parents[frame])
        return found[::-1]

    @cached_property
    def tables(self) -> tuple[Integers, Array, Array, Integers, Integers, Integers]:
        """limbs, shapes, placements, strides, levels and counts for the kernel.

        Raises:
            CrystalError: if the joints have so many values together that no table has room.
        """
        self._check_room()
        counts = self.model.grid.joint_counts
        strides = np.zeros((len(self.limb_frames), len(counts)), np.int64)
        limbs = np.zeros((len(self.limb_frames), 5), np.int64)
        levels = np.full(len(self.limb_frames), -1, np.int64)
        placements: list[Array] = []
        shapes: list[Array] = []
        rows = 0
        for limb, frame in enumerate(self.limb_frames):
            chain = self.chain(frame)
            poses = 1
            for joint in reversed(chain):
                strides[limb, joint] = poses
                poses *= counts[joint]
            parts = np.flatnonzero(self.model.molecule.part_frames == frame)
            before = sum(len(p) for p in placements), sum(len(s) for s in shapes)
            limbs[limb] = before[0], poses, before[1], len(parts), rows
            levels[limb] = max(chain, default=-1)
            placements.append(self._placements(chain, frame))
            shapes.append(shape_rows(self.model, parts))
            rows += poses * len(parts)
        return (
            limbs,
            np.vstack(shapes),
            np.vstack(placements),
            strides,
            levels,
            np.array(counts, np.int64),
        )

    def _check_room(self) -> None:
        counts = self.model.grid.joint_counts
        poses = [math.prod(counts[j] for j in self.chain(frame)) for frame in self.limb_frames]
        pairs = sum(a * b for a, b in itertools.combinations(poses[1:], 2))
        combinations = self.model.grid.joint_count
        if max(poses) > MOST_POSES or max(combinations, pairs) > MOST_COMBINATIONS:
            raise CrystalError(
                f"{self.model.name}: the joints have {combinations:.3g} combinations of values, "
                f"a limb has {max(poses):.3g} poses, and two limbs together {pairs:.3g}; expected "
                f"at most {MOST_POSES:.0e} poses and {MOST_COMBINATIONS:.0e} combinations: choose "
                "larger steps for the joints"
            )

    def _placements(self, chain: list[int], frame: int) -> Array:
        """(poses, FRAME) of a frame against the base for all values of its chain."""
        base = self.model.molecule.base_count
        whole = self.model.molecule
        values = [self.model.grid.joint_values[joint] for joint in chain]
        grid = combinations(values)
        found = np.zeros((len(grid), molecule.FRAME))
        if not chain:
            found[:, [0, 4, 8]] = 1.0
            return found
        for row, digits in zip(found, grid, strict=True):
            configuration = np.zeros(len(whole.coordinates))
            configuration[[base + joint for joint in chain]] = digits
            row[:] = whole.frames(configuration)[frame]
        return found

    @cached_property
    def own(self) -> NDArray[np.bool_]:
        """(P, P), which two parts of one molecule must keep apart; limb by limb, as in `tables`."""
        frames = self.model.molecule.part_frames
        order = np.concatenate([np.flatnonzero(frames == frame) for frame in self.limb_frames])
        pairs = watched(self.model)
        return np.ascontiguousarray((pairs | pairs.T)[np.ix_(order, order)])

    def free(self, first: int, last: int) -> Integers:
        """Numbers of the free arrangements whose base poses are ``first`` to ``last`` - 1."""
        return np.concatenate([np.zeros(0, np.int64), *self._pieces(first, last)])

    def _pieces(self, first: int, last: int) -> Iterator[Integers]:
        limbs, shapes, placements, strides, levels, counts = self.tables
        found = np.empty(max(FOUND_AT_ONCE, self.model.grid.joint_count), np.int64)
        bases = self._bases(first, last)
        at = 0
        while at < len(bases):
            written, at = packing_search.search_grid(
                bases,
                at,
                len(bases),
                limbs,
                shapes,
                placements,
                strides,
                levels,
                counts,
                self.own,
                self.model.crystal,
                self.model.required - self.model.slack,
                found,
            )
            yield found[:written] + first * self.model.grid.joint_count

    def _bases(self, first: int, last: int) -> Array:
        return base_frames(self.model, self.model.grid.bases[first:last])


def base_frames(model: PackingModel, poses: Array) -> Array:
    """Frames (m, FRAME) of the molecule's base for its coordinates (m, base_count)."""
    whole = model.molecule
    frames = np.zeros((len(poses), molecule.FRAME))
    frames[:, [0, 4, 8]] = 1.0
    if whole.base_count:
        arrays = (whole.kinds, whole.parents, whole.origins, whole.axes)
        packing.base_frames(*(array[: whole.base_count] for array in arrays), poses, frames)
    return frames
