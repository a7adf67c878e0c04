"""How fine a table is: as asked for, or the finest that fits a budget, both errors balanced."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import TableError
from ellipsoid_planning.safety.orientation_grid import (
    NOTHING,
    OrientationGrid,
    smallest_grid,
)
from ellipsoid_planning.safety.shapes import Shape

Array = NDArray[np.float64]

BYTES_PER_LINE = 14
"""Four for its place, four for each of about two and a half intervals."""
DEFAULT_MEMORY = {2: 1 << 18, 3: 1 << 20}
"""Bytes of one table by dimension: larger ones answer hardly more, and leave the fast caches."""
_MOST_LINES = 1 << 28
_FINE_ENOUGH = 2e-3
"""Tables are made no finer than an inflation of this share of the link's size."""


@dataclass(frozen=True)
class TableParameters:
    """The resolution of tables; whatever is None is chosen.

    Attributes:
        orientations: at least so many cells of orientations.
        lines: at least about so many sweep lines for each of them.
        memory: what one table may take [bytes], about, where the two do not settle it.

    Raises:
        TableError: a number is not positive.
    """

    orientations: int | None = None
    lines: int | None = None
    memory: int | None = None

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is not None and not (isinstance(value, int) and 0 < value <= 1 << 40):
                raise TableError(f"{name}: expected a positive whole number, got {value!r}")


@dataclass(frozen=True, eq=False)
class LineGrid:
    """Sweep lines through a box: cells of equal size, a line in the middle of each.

    Attributes:
        low, high: (3,), corners of the box; planar boxes have a middle plane z = 0.
        axis: along which the lines run.
        counts: (3,), number of lines along each dimension, 1 along ``axis``.
        dimension: 2 or 3.
    """

    low: Array
    high: Array
    axis: int
    counts: tuple[int, int, int]
    dimension: int

    @property
    def count(self) -> int:
        """The number of lines."""
        return math.prod(self.counts)

    @property
    def spacing(self) -> Array:
        """(3,), the sides of a cell."""
        return (self.high - self.low) / self.counts

    @property
    def radius(self) -> float:
        """The farthest that a place in a cell is from its line."""
        sides = [self.spacing[k] for k in range(self.dimension) if k != self.axis]
        return 0.5 * math.hypot(*sides)


@dataclass(frozen=True, eq=False)
class Resolution:
    """The grids of a table, and the distance that covers what lies between their points."""

    orientations: OrientationGrid
    lines: LineGrid
    inflation: float


def line_grid(low: Array, high: Array, dimension: int, count: int) -> LineGrid:
    """About ``count`` lines along the longest side of a box (3,), (3,), evenly far apart."""
    sides = (high - low)[:dimension]
    axis = int(np.argmax(sides))
    across = [k for k in range(dimension) if k != axis]
    spacing = (math.prod(sides[k] for k in across) / count) ** (1.0 / len(across))
    counts = [1, 1, 1]
    for k in across:
        counts[k] = max(1, math.ceil(sides[k] / spacing - 1e-9))
    return LineGrid(low, high, axis, (counts[0], counts[1], counts[2]), dimension)


def resolution_of(
    shape: Shape, low: Array, high: Array, dimension: int, parameters: TableParameters
) -> Resolution:
    """The grids of a shape's table over a box (3,), (3,) of places of its middle.

    Raises:
        TableError: they would have more than 2^28 lines together.
    """
    budget = DEFAULT_MEMORY[dimension] if parameters.memory is None else parameters.memory
    total = max(1, budget // BYTES_PER_LINE)
    best: Resolution | None = None
    for grid in _candidates(shape, total, parameters.orientations):
        lines = _lines(shape, grid, low, high, dimension, parameters, total)
        found = _resolution(shape, grid, lines)
        if best is None or found.inflation < best.inflation:
            best = found
        if best.inflation <= _FINE_ENOUGH * shape.radius or found.inflation > 1.3 * best.inflation:
            break
    assert best is not None  # noqa: S101 (there is a grid of one cell at least)
    if best.orientations.count * best.lines.count > _MOST_LINES:
        raise TableError(
            f"expected at most {_MOST_LINES} lines in a table, got {best.orientations.count} "
            f"orientations of {best.lines.count}; lower orientations or lines"
        )
    return best


def _candidates(shape: Shape, total: int, asked: int | None) -> Iterator[OrientationGrid]:
    """Grids to choose from, the coarsest first; finer ones than the best are worse and worse."""
    if asked is not None or shape.vector == NOTHING:
        yield smallest_grid(shape.vector, shape.faces, asked or 1)
        return
    cells = 1
    while cells == 1 or OrientationGrid(shape.vector, shape.faces, cells).count <= total:
        yield OrientationGrid(shape.vector, shape.faces, cells)
        cells += 1


def _lines(
    shape: Shape,
    grid: OrientationGrid,
    low: Array,
    high: Array,
    dimension: int,
    parameters: TableParameters,
    total: int,
) -> LineGrid:
    if parameters.lines is not None:
        return line_grid(low, high, dimension, parameters.lines)
    sides = np.sort((high - low)[:dimension])[:-1]
    finest = _FINE_ENOUGH * shape.radius / math.sqrt(len(sides))
    most = math.prod(max(1.0, float(side) / finest) for side in sides)
    return line_grid(low, high, dimension, max(1, int(min(total // grid.count, most))))


def _resolution(shape: Shape, grid: OrientationGrid, lines: LineGrid) -> Resolution:
    own = shape.lever * grid.radius() + lines.radius
    return Resolution(grid, lines, own * (1.0 + 1e-9) + shape.slack)
