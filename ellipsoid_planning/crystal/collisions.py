"""Which arrangements keep all copies of the molecule apart: one by one, or a whole grid."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.model import PackingModel
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.kernels import layout, molecule, packing, packing_search

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

# Room for this many arrangements is made at a time, or for those of one base pose.
FOUND_AT_ONCE = 1 << 18


FARTHEST = 100.0  # cells that a shift may go beyond its range
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
            shapes.append(self._shapes(parts))
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
        grid = (
            np.stack(np.meshgrid(*values, indexing="ij"), -1).reshape(-1, len(chain))
            if chain
            else np.zeros((1, 0))
        )
        found = np.zeros((len(grid), molecule.FRAME))
        found[:, [0, 4, 8]] = 1.0
        if not chain:
            return found
        for row, digits in zip(found, grid, strict=True):
            configuration = np.zeros(len(whole.coordinates))
            configuration[[base + joint for joint in chain]] = digits
            row[:] = whole.frames(configuration)[frame]
        return found

    def _shapes(self, parts: Integers) -> Array:
        return _shape_rows(self.model, parts)

    @cached_property
    def own(self) -> NDArray[np.bool_]:
        """(P, P), which two parts of one molecule must keep apart; limb by limb, as in `tables`."""
        frames = self.model.molecule.part_frames
        order = np.concatenate([np.flatnonzero(frames == frame) for frame in self.limb_frames])
        watched = _watched(self.model)
        return np.ascontiguousarray((watched | watched.T)[np.ix_(order, order)])

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


def watched_pairs(model: PackingModel) -> list[tuple[int, int]]:
    """Parts of one molecule that must keep apart: not in one limb, nor joined, nor ignored."""
    robot = model.molecule.robot
    frames = model.molecule.part_frames
    joined = {frozenset((joint.parent, joint.child)) for joint in robot.joints}
    free = joined | robot.ignored
    links = robot.part_links
    return [
        (i, j)
        for j in range(len(links))
        for i in range(j)
        if frames[i] != frames[j] and frozenset((links[i], links[j])) not in free
    ]


def _check_shifts(model: PackingModel, configurations: Array) -> None:
    """Refuse shifts so far beyond the grid's ranges that rounding would decide."""
    edge = float(model.cell.lengths.max())
    for place, (range_, of) in enumerate(
        zip(model.grid.ranges, model.molecule.coordinates, strict=True)
    ):
        most = max(abs(range_.lower), abs(range_.upper)) + FARTHEST * edge
        values = np.abs(configurations[:, place]) if not of.turns else np.zeros(0)
        if np.any(values > most):
            raise CrystalError(
                f"{model.name}: {of.name} = {values.max():.6g} is far from the cell; expected at "
                f"most {most:.6g}: take lattice vectors off"
            )


def _watched(model: PackingModel) -> NDArray[np.bool_]:
    """(P, P), whether :func:`watched_pairs` has the pair [i, j], i < j."""
    count = len(model.molecule.parts)
    pairs = np.zeros((count, count), bool)
    for i, j in watched_pairs(model):
        pairs[i, j] = True
    return pairs


def _shape_rows(model: PackingModel, parts: Integers) -> Array:
    """Rows (m, BODY) of parts in their coordinates' frames, for kernels.packing."""
    rows = np.zeros((len(parts), layout.BODY))
    posed = model.molecule.parts[parts]
    rows[:, layout.BODY_CENTRE : layout.BODY_CENTRE + 12] = posed
    for row, matrix in zip(rows, posed[:, 3:].reshape(-1, 3, 3), strict=True):
        axes = np.linalg.norm(matrix, axis=0)
        # A = R diag(a) has the inverse diag(1/a²) Aᵀ, exact for needles, too.
        row[layout.BODY_INVERSE : layout.BODY_INVERSE + 9] = (matrix / axes**2).T.ravel()
        used = axes[: model.dimension]
        row[layout.BODY_RADIUS], row[packing.INSCRIBED] = used.max(), used.min()
    return rows


@lru_cache(maxsize=8)
def _tables_of(model: PackingModel) -> tuple[Array, NDArray[np.bool_]]:
    """Shapes of all parts, and which pairs of them are watched: planners ask state by state."""
    return _shape_rows(model, np.arange(len(model.molecule.parts))), _watched(model)


def arrangements_free(model: PackingModel, configurations: Array) -> NDArray[np.bool_]:
    """Whether each arrangement (m, K) is free; True is proved.

    Raises:
        CrystalError: if the shape is another, or a value is not finite.
    """
    whole = model.molecule
    size = len(whole.coordinates)
    if configurations.ndim != 2 or configurations.shape[1] != size:
        raise CrystalError(
            f"{model.name}: expected configurations of shape (m, {size}) "
            f"({', '.join(model.keys)}), got shape {configurations.shape}"
        )
    if not np.all(np.isfinite(configurations)):
        raise CrystalError(f"{model.name}: expected configurations of finite numbers")
    _check_shifts(model, configurations)
    shapes, watched = _tables_of(model)
    free = np.empty(len(configurations), bool)
    packing.arrangements_free(
        whole.kinds,
        whole.parents,
        whole.origins,
        whole.axes,
        whole.part_frames,
        shapes,
        watched,
        model.crystal,
        model.required,
        np.ascontiguousarray(configurations),
        free,
    )
    return free
