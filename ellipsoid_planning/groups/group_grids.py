"""The thesis' grids: lattices in cells of cosets, double cosets and wedges, replicated."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups.cosets import BEST_CONJUGATION, DoubleCosets, Wedge, single_coset
from ellipsoid_planning.groups.distortion import distortion
from ellipsoid_planning.groups.finite_groups import FiniteGroup, icosahedral
from ellipsoid_planning.groups.group_grid import GroupGrid
from ellipsoid_planning.groups.lattices import (
    LatticeLevels,
    lattice_levels,
    lattice_nodes,
    points_per_cube,
)
from ellipsoid_planning.groups.quaternions import IDENTITY, inverse, product
from ellipsoid_planning.groups.voronoi import VoronoiCell

Array = NDArray[np.float64]


def group_grid(
    group: FiniteGroup,
    lattice: str = "cubic",
    *,
    count: int | None = None,
    resolution: float | None = None,
) -> GroupGrid:
    """A lattice in the exponential coordinates of a group's centre cell, replicated (thesis 4.3).

    Args:
        group: the group.
        lattice: ``cubic`` or ``bcc``.
        count: how many rotations, or
        resolution: the edge [rad] of a cube with one lattice point, the cubic lattice's step.

    Raises:
        GridError: the lattice is unknown, or has no such count (the message says the nearest).
    """
    cell = VoronoiCell.of_group(group)
    nodes = _lattice(cell, lattice, len(group), count, resolution)
    return GroupGrid(f"{group.name}-{lattice}", group, nodes, distortion(cell.circumradius))


def double_coset_grid(
    cosets: DoubleCosets | None = None,
    lattice: str = "centres",
    *,
    count: int | None = None,
    resolution: float | None = None,
) -> GroupGrid:
    """The centres of double cosets' cells, or a lattice in the centre cell, replicated (4.12).

    Without ``cosets``, those of the icosahedral group and its best known conjugate, 3600 cells.

    Raises:
        GridError: as :func:`group_grid`.
    """
    cosets = icosahedral_cosets() if cosets is None else cosets
    cells = len(cosets.left) * len(cosets.right)
    if lattice == "centres":
        _check_count(count, [cells], "the cells' centres")
        nodes = IDENTITY[None]
    else:
        nodes = _lattice(cosets.cell, lattice, cells, count, resolution)
    every = product(nodes[None], cosets.right.quaternions[:, None]).reshape(-1, 4)
    in_cell = single_coset(cosets.left, every).rotations
    name = f"{cosets.left.name}-double-{lattice}"
    return GroupGrid(name, cosets.left, in_cell, distortion(cosets.cell.circumradius))


def icosahedral_cosets() -> DoubleCosets:
    """The double cosets of the icosahedral group and its best known conjugate."""
    return DoubleCosets(icosahedral(), icosahedral().conjugate(BEST_CONJUGATION))


def wedge_grid(
    group: FiniteGroup | None = None,
    *,
    corners: bool = False,
    resolution: float | None = None,
) -> GroupGrid:
    """The centres of the wedges of a group's cells (thesis 4.3.2), with their corners if asked.

    Args:
        group: tetrahedral, octahedral or icosahedral (the default).
        corners: whether the wedges' corners are nodes too.
        resolution: instead, a cubic lattice of this step [rad] in the wedge.

    Raises:
        GridError: the group has no wedges.
    """
    group = icosahedral() if group is None else group
    wedge = Wedge.of_group(group)
    if resolution is not None:
        nodes = lattice_nodes(wedge.cell, "cubic", _checked(resolution))
        nodes = nodes[wedge.contains(nodes)]
    else:
        nodes = np.vstack([wedge.centre, wedge.vertices]) if corners else wedge.centre[None]
    turns = group.quaternions[:, None]
    every = product(product(turns, nodes[None]), inverse(turns)).reshape(-1, 4)
    bound = distortion(wedge.cell.circumradius) if resolution is not None else None
    return GroupGrid(f"{group.name}-wedge", group, every, bound)


def lattice_counts(cell: VoronoiCell, lattice: str, cells: int, count: int) -> list[int]:
    """Counts of rotations that a lattice in ``cells`` cells can have, from below to above one."""
    levels = lattice_levels(cell, lattice, -(-count // cells))
    return [int(c) * cells for c in levels.counts]


def _lattice(
    cell: VoronoiCell, lattice: str, cells: int, count: int | None, resolution: float | None
) -> Array:
    per_cube = points_per_cube(lattice)
    if resolution is not None and count is None:
        return lattice_nodes(cell, lattice, _checked(resolution) * per_cube ** (1.0 / 3.0))
    if count is None or resolution is not None:
        raise GridError("a grid needs either a count or a resolution")
    levels: LatticeLevels = lattice_levels(cell, lattice, max(1, -(-count // cells)))
    counts = [int(c) * cells for c in levels.counts]
    _check_count(count, counts, f"a {lattice} lattice")
    even = (cell.volume * per_cube * cells / count) ** (1.0 / 3.0)
    return lattice_nodes(cell, lattice, levels.step(count // cells, even))


def _checked(resolution: float) -> float:
    if not 0.005 <= resolution <= np.pi:
        raise GridError(f"a resolution is from 0.3° to 180°, not {np.degrees(resolution):g}°")
    return resolution


def _check_count(count: int | None, counts: list[int], what: str) -> None:
    if count is not None and count not in counts:
        raise GridError(f"{what} cannot have {count} rotations; {nearest_counts(count, counts)}")


def nearest_counts(count: int, counts: list[int]) -> str:
    """The sentence that says which of ``counts`` are nearest to ``count``."""
    below = max((c for c in counts if c < count), default=None)
    above = min((c for c in counts if c > count), default=None)
    near = [str(c) for c in (below, above) if c is not None]
    return f"the nearest that it can have: {' or '.join(near)}"
