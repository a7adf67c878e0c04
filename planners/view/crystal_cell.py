"""What a picture of a packed cell shows: cells, copies, overlaps, and the words beside them."""

from __future__ import annotations

import itertools
import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.crystal.packing.copies import Copy, copies, middle_of
from ellipsoid_planning.crystal.packing.overlaps import Overlap, overlaps
from ellipsoid_planning.errors import CrystalError
from planners.view.crystal_colours import operation_colours

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from ellipsoid_planning.crystal.packing.model import PackingModel

    Array = NDArray[np.float64]

SCREW = re.compile(r"^([2346])([1-5])")
LOWERED = str.maketrans("12345", "₁₂₃₄₅")
MOST_COPIES = 3000  # that a picture still shows in reasonable time


@dataclass(frozen=True, eq=False)
class DrawnCell:
    """A molecule's arrangement, and the cells around it that are drawn.

    Attributes:
        model: the molecule and its crystal.
        configuration: (K,), angles [rad].
        counts: (n,), how many cells along each axis; the home cell is the middle one.
        origin: (n,), the home cell's corner in fractional coordinates. Where the group has the
            identity alone, the origin is any point, and the molecule is put into the middle.
    """

    model: PackingModel
    configuration: Array
    counts: tuple[int, ...]
    origin: Array

    @cached_property
    def low(self) -> Array:
        """(n,), the corner of the drawn range of cells, fractional."""
        return self.origin - [(count - 1) // 2 for count in self.counts]

    @cached_property
    def high(self) -> Array:
        """(n,), the opposite corner."""
        return self.low + self.counts

    @cached_property
    def copies(self) -> list[Copy]:
        """All copies whose middle lies in the range."""
        return copies(self.model, self.configuration, self.low, self.high)

    @cached_property
    def home(self) -> list[Copy]:
        """Those whose middle lies in the home cell, one for each operation."""
        return copies(self.model, self.configuration, self.origin, self.origin + 1.0)

    @cached_property
    def neighbours(self) -> list[Copy]:
        """The others."""
        home = {(copy.operation, copy.lattice) for copy in self.home}
        return [c for c in self.copies if (c.operation, c.lattice) not in home]

    @cached_property
    def overlaps(self) -> list[Overlap]:
        """Where the drawn copies overlap each other or copies beside them."""
        middle = middle_of(self.model, self.configuration)
        bodies = self.model.molecule.bodies(self.configuration)
        reach = max(np.linalg.norm(b.centre - middle) + b.semi_axes.max() for b in bodies)
        cells = np.ceil(2.0 * reach * np.linalg.norm(self.model.cell.reciprocal, axis=0))
        wide = copies(self.model, self.configuration, self.low - cells, self.high + cells)
        drawn = {(copy.operation, copy.lattice) for copy in self.copies}
        others = [copy for copy in wide if (copy.operation, copy.lattice) not in drawn]
        return overlaps(self.model, self.copies, others)

    @cached_property
    def hues(self) -> tuple[str, ...]:
        """The colour of each operation."""
        return operation_colours(self.model.group.order)

    @cached_property
    def operations(self) -> list[str]:
        """The operations as triplets."""
        return [operation.triplet() for operation in self.model.group.operations]

    def corners(self, low: Array, high: Array) -> Array:
        """The corners (2ⁿ, n) in the world of a box in fractional coordinates."""
        ends = np.array(list(itertools.product(*zip(low, high, strict=True))))
        return self.model.cell.cartesian(ends)

    def neighbour_lines(self) -> list[Array]:
        """The edges of the drawn cells but the home cell's, each as points (2, n)."""
        home = {_place(edge) for edge in self._edges(self.origin, self.origin + 1.0)}
        edges = self._edges(self.low, self.high)
        return [self.model.cell.cartesian(edge) for edge in edges if _place(edge) not in home]

    def home_edges(self) -> list[Array]:
        """The edges of the home cell, each as points (2, n)."""
        edges = self._edges(self.origin, self.origin + 1.0)
        return [self.model.cell.cartesian(edge) for edge in edges]

    def _edges(self, low: Array, high: Array) -> list[Array]:
        """The edges (2, n) of all cells in a range, one cell long each, fractional."""
        counts = np.rint(high - low).astype(int).tolist()
        found = []
        for axis in range(len(counts)):
            steps = [range(k + (i != axis)) for i, k in enumerate(counts)]
            for place in itertools.product(*steps):
                start = low + np.array(place)
                found.append(np.array([start, start + np.eye(len(counts))[axis]]))
        return found

    def values(self) -> str:
        """The coordinates, angles in degrees."""
        turns = [coordinate.turns for coordinate in self.model.molecule.coordinates]
        shown = np.where(turns, np.degrees(self.configuration), self.configuration).tolist()
        return ", ".join(
            f"{coordinate.name.replace('_', ' ')} {value:.4g}{'°' if coordinate.turns else ''}"
            for coordinate, value in zip(self.model.molecule.coordinates, shown, strict=True)
        )

    def headline(self) -> str:
        """The group, the cell, and whether the arrangement is free."""
        cell = self.model.cell
        names = "abc"[: cell.dimension]
        lengths = ", ".join(f"{n} = {v:.5g}" for n, v in zip(names, cell.lengths, strict=True))
        angles = _angles(cell.angles_deg)
        free = "free of" if self.model.is_free(self.configuration) else "with"
        free += " overlaps"
        if self.model.overlap > 0.0:
            free += f" deeper than {self.model.overlap:.3g}"
        return f"{pretty_group(self.model)}  ·  {lengths}{angles}  ·  {free}"


def drawn_cell(
    model: PackingModel,
    configuration: ArrayLike,
    cells: Sequence[int] | None = None,
    origin: Array | None = None,
) -> DrawnCell:
    """What to draw of an arrangement.

    Args:
        model: the molecule and its crystal.
        configuration: (K,), angles [rad].
        cells: (n,), how many cells along each axis; by default 3 x 3 in the plane, one in space.
        origin: (n,), the home cell's corner in fractional coordinates, see `DrawnCell`.

    Raises:
        CrystalError: if the configuration or the cells do not fit the model.
    """
    values = np.array(configuration, dtype=float)
    if origin is None:
        origin = np.zeros(model.dimension)
        middle = middle_of(model, values)
        if model.group.order == 1:
            origin = model.cell.fractional(middle) - 0.5
    return DrawnCell(model, values, _checked_cells(model, cells), np.asarray(origin, dtype=float))


def _checked_cells(model: PackingModel, cells: Sequence[int] | None) -> tuple[int, ...]:
    n = model.dimension
    if cells is None:
        return (3, 3) if n == 2 else (1, 1, 1)
    counts = tuple(int(count) for count in cells)
    if len(counts) != n or min(counts) < 1:
        raise CrystalError(
            f"cells to draw: expected {n} whole numbers from 1 on, got "
            f"{', '.join(map(str, cells))}; write {','.join('2' * n)}, say"
        )
    count = int(np.prod(counts)) * model.group.order
    if count > MOST_COPIES:
        raise CrystalError(
            f"cells to draw: {' x '.join(map(str, counts))} of them hold {count} copies of the "
            f"molecule, more than {MOST_COPIES}; draw fewer"
        )
    return counts


def pretty_group(model: PackingModel) -> str:
    """The group's name as it is printed: screw axes with subscripts."""
    name = model.group.name
    if model.dimension == 2 or model.group.number is None:
        return name
    from ellipsoid_planning.crystal.symmetry.catalogue import gemmi

    found = gemmi().find_spacegroup_by_name(name)
    # In gemmi's symbols spaces part the axes: P 4 3 2 and P 43 3 2.
    parts = found.hm.split() if found is not None else [name]
    return "".join(SCREW.sub(lambda axis: axis[1] + axis[2].translate(LOWERED), p) for p in parts)


def _place(edge: Array) -> tuple[int, ...]:
    """The same for the same edge in spite of rounding."""
    return tuple(np.rint(1e6 * edge).astype(int).ravel().tolist())


def _angles(angles_deg: Sequence[float]) -> str:
    """Those that are no right ones."""
    names = ("gamma",) if len(angles_deg) == 1 else ("alpha", "beta", "gamma")
    shown = [(n, v) for n, v in zip(names, angles_deg, strict=True) if abs(v - 90.0) > 1e-9]
    return "".join(f", {name} = {value:.5g}°" for name, value in shown)
