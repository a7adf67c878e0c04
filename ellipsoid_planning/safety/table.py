"""The table of one link shape: where its middle may be, for each cell of orientations and lines."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.kernels import safety_table as layout
from ellipsoid_planning.safety.orientation_grid import NAMES
from ellipsoid_planning.safety.resolution import Resolution
from ellipsoid_planning.safety.shapes import Shape
from ellipsoid_planning.world import World

Array = NDArray[np.float64]

TICKS = 65535
"""Ends of intervals are whole numbers from 0 to this, from the box's low end to its high end."""
_NOWHERE = 1e300


@dataclass(frozen=True, eq=False)
class TablePlan:
    """What a table is made from.

    Attributes:
        world: bodies that the link must keep clear of, and be inside of.
        shape: the link's.
        clearance: what the link keeps.
        scale: what rounding is measured by (SCALE of kernels.layout), that of the whole robot:
            the link's frame comes from its kinematics, whose levers may be far longer than it.
        safe_low, safe_high: (3,), a box such that the link is safe if its middle is outside.
        resolution: the grids; None where the link's middle cannot be in any place that matters.
    """

    world: World
    shape: Shape
    clearance: float
    scale: float
    safe_low: Array
    safe_high: Array
    resolution: Resolution | None

    def key(self) -> str:
        """A hash of everything that decides what the table holds; names do not count."""
        bodies = (*self.world.obstacles, *self.world.arenas)
        rows = [np.concatenate([b.centre, b.rotation.ravel(), b.semi_axes]) for b in bodies]
        counts = [len(self.world.obstacles), len(self.world.arenas), self.world.dimension]
        numbers = [np.array([*counts, self.clearance, self.scale, layout.BEND, TICKS]), *rows]
        numbers += [self.shape.numbers(), self.safe_low, self.safe_high]
        if self.resolution is not None:
            grid, lines = self.resolution.orientations, self.resolution.lines
            sizes = [grid.vector, grid.faces, grid.cells, lines.axis, *lines.counts]
            numbers += [np.array([*sizes, self.resolution.inflation]), lines.low, lines.high]
        digest = hashlib.sha256()
        for array in numbers:
            # Adding zero makes −0 and 0 the same.
            digest.update((np.ascontiguousarray(array, dtype="<f8") + 0.0).tobytes())
            digest.update(b"|")
        return digest.hexdigest()

    def row(self) -> Array:
        """The table's row (TABLE,) in a book, but for where its offsets begin."""
        row = np.zeros(layout.TABLE)
        row[layout.SAFE_LOW : layout.SAFE_LOW + 3] = self.safe_low
        row[layout.SAFE_HIGH : layout.SAFE_HIGH + 3] = self.safe_high
        if self.resolution is None:
            row[layout.LOW : layout.LOW + 3], row[layout.VECTOR] = _NOWHERE, 1.0
            row[layout.HIGH : layout.HIGH + 3] = -_NOWHERE
            return row
        grid, lines = self.resolution.orientations, self.resolution.lines
        row[layout.VECTOR] = grid.vector
        row[layout.FACES], row[layout.CELLS] = grid.faces, grid.cells
        row[layout.AXIS], row[layout.SWEEP] = lines.axis, self.ticks_per_length
        row[layout.LOW : layout.LOW + 3] = lines.low
        row[layout.HIGH : layout.HIGH + 3] = lines.high
        row[layout.PER : layout.PER + 3] = 1.0 / lines.spacing
        row[layout.LINES : layout.LINES + 3] = lines.counts
        return row

    @property
    def ticks_per_length(self) -> float:
        """How many ticks a unit of length along the lines has."""
        assert self.resolution is not None  # noqa: S101
        lines = self.resolution.lines
        return TICKS / float(lines.high[lines.axis] - lines.low[lines.axis])

    @property
    def size(self) -> int:
        """The number of lines at all orientations."""
        if self.resolution is None:
            return 0
        return self.resolution.orientations.count * self.resolution.lines.count


@dataclass(frozen=True, eq=False)
class LinkTable:
    """A table that has been filled or loaded.

    Attributes:
        plan: what it was made from.
        offsets: (lines + 1,) int32, where the intervals of each line begin.
        intervals: (k, 2) uint16, in ticks.
        seconds: what filling or loading it took.
        loaded: whether it came from a file.
    """

    plan: TablePlan
    offsets: NDArray[np.int32]
    intervals: NDArray[np.uint16]
    seconds: float = 0.0
    loaded: bool = False

    @property
    def memory(self) -> int:
        """Bytes that it takes."""
        return self.offsets.nbytes + self.intervals.nbytes

    @property
    def description(self) -> str:
        """Such as "192 directions of the axis, 4,096 lines along y"."""
        found = self.plan.resolution
        if found is None:
            return "nothing to tell"
        grid, lines = found.orientations, found.lines
        name = NAMES[grid.vector]
        first = name if grid.count == 1 and name.startswith("one") else f"{grid.count:,} {name}"
        return f"{first}, {lines.count:,} lines along {'xyz'[lines.axis]}"
