"""Grids of rotations by name, with a count or a resolution."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups.finite_groups import (
    FiniteGroup,
    icosahedral,
    octahedral,
    tetrahedral,
)
from ellipsoid_planning.groups.group_grids import (
    double_coset_grid,
    group_grid,
    icosahedral_cosets,
    lattice_counts,
    nearest_counts,
    wedge_grid,
)
from ellipsoid_planning.groups.rotation_grid import RotationGrid
from ellipsoid_planning.groups.six_hundred_cell import (
    six_hundred_cell_count,
    six_hundred_cell_grid,
)
from ellipsoid_planning.groups.standard_grids import (
    euler_grid,
    hopf_count,
    hopf_grid,
    random_grid,
    super_fibonacci_grid,
)
from ellipsoid_planning.groups.voronoi import ALL_ROTATIONS, VoronoiCell

MOST_ROTATIONS = 20_000_000


@dataclass(frozen=True)
class GridFamily:
    """Grids of one kind.

    Attributes:
        name: as :func:`grid_by_name` takes it.
        summary: one line about it.
        counts: reachable counts around a wanted one, at least one on each side where there is one.
        make: the grid of a reachable count.
    """

    name: str
    summary: str
    counts: Callable[[int], list[int]]
    make: Callable[[int], RotationGrid]


def grid_by_name(
    name: str, *, count: int | None = None, resolution_deg: float | None = None, seed: int = 0
) -> RotationGrid:
    """The grid called ``name`` with ``count`` rotations, or as fine as ``resolution_deg``.

    Args:
        name: one of :func:`grid_names`.
        count: how many rotations there shall be, or
        resolution_deg: the edge [degree] of a cube with a node's share of all rotations: the
            smallest grid of the kind that has at least that many nodes is taken.
        seed: of random rotations.

    Raises:
        GridError: there is no such grid, or none with that count (the message says the nearest).
    """
    families = _families(seed)
    if name not in families:
        raise GridError(f"unknown grid {name!r}; known are {', '.join(families)}")
    family = families[name]
    if resolution_deg is not None and count is None:
        return family.make(_count_of_resolution(family, resolution_deg))
    if count is None or resolution_deg is not None:
        raise GridError("a grid needs either a count or a resolution")
    if not 1 <= count <= MOST_ROTATIONS:
        raise GridError(f"a grid has 1 to {MOST_ROTATIONS:,} rotations, not {count}")
    reachable = family.counts(count)
    if count not in reachable:
        near = nearest_counts(count, reachable)
        raise GridError(f"the grid {name} cannot have {count} rotations; {near}")
    return family.make(count)


def grid_names() -> dict[str, str]:
    """The names of all grids, each with one line about it."""
    return {name: family.summary for name, family in _families(0).items()}


def _count_of_resolution(family: GridFamily, resolution_deg: float) -> int:
    least = math.degrees((ALL_ROTATIONS / MOST_ROTATIONS) ** (1.0 / 3.0))
    if not least <= resolution_deg <= 180.0:
        raise GridError(f"a resolution is from {least:.2f}° to 180°, not {resolution_deg:g}°")
    wanted = math.ceil(ALL_ROTATIONS / math.radians(resolution_deg) ** 3 * (1.0 - 1e-9))
    enough = [c for c in family.counts(wanted) if c >= wanted]
    if not enough:
        most = max(family.counts(wanted))
        raise GridError(f"the grid {family.name} has no more than {most} rotations")
    return min(enough)


def _families(seed: int) -> dict[str, GridFamily]:
    families = [
        _of_sizes(
            "600-cell",
            "tetrahedra of the 600-cell, divided evenly: the most even grid here",
            six_hundred_cell_count,
            six_hundred_cell_grid,
        ),
        *(_lattice(group(), lattice) for group in _PLATONIC for lattice in ("cubic", "bcc")),
        _double("cubic"),
        _double("bcc"),
        GridFamily(
            "icosahedral-double",
            "centres of the double cosets of the icosahedral group and a conjugate",
            lambda _: [3600],
            lambda _: double_coset_grid(),
        ),
        GridFamily(
            "icosahedral-wedge",
            "centres of the wedges of the icosahedral group's cells",
            lambda _: [3600],
            lambda _: wedge_grid(),
        ),
        _of_sizes("hopf", "Hopf coordinates over HEALPix", hopf_count, hopf_grid),
        _of_sizes("euler", "Euler angles, cosine rule", lambda k: 4 * k**3, _euler),
        _any("super-fibonacci", "super-Fibonacci spirals", super_fibonacci_grid),
        _any("random", "uniformly random rotations", lambda count: random_grid(count, seed)),
    ]
    return {family.name: family for family in families}


_PLATONIC = (icosahedral, octahedral, tetrahedral)


def _euler(size: int) -> RotationGrid:
    return euler_grid(2 * size, size, 2 * size)


def _any(name: str, summary: str, make: Callable[[int], RotationGrid]) -> GridFamily:
    return GridFamily(name, summary, lambda count: [count], make)


def _of_sizes(
    name: str, summary: str, count_of: Callable[[int], int], make: Callable[[int], RotationGrid]
) -> GridFamily:
    def size_below(count: int) -> int:
        low, high = 1, 2
        while count_of(high) <= count:
            low, high = high, 2 * high
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if count_of(middle) <= count else (low, middle)
        return low

    def counts(count: int) -> list[int]:
        return [count_of(size_below(count)), count_of(size_below(count) + 1)]

    return GridFamily(name, summary, counts, lambda count: make(size_below(count)))


def _lattice(group: FiniteGroup, lattice: str) -> GridFamily:
    return GridFamily(
        group.name if lattice == "cubic" else f"{group.name}-{lattice}",
        f"{lattice} lattice in the cells of the {group.name} group",
        lambda count: lattice_counts(VoronoiCell.of_group(group), lattice, len(group), count),
        lambda count: group_grid(group, lattice, count=count),
    )


def _double(lattice: str) -> GridFamily:
    return GridFamily(
        f"icosahedral-double-{lattice}",
        f"{lattice} lattice in the double cosets of the icosahedral group and a conjugate",
        lambda count: lattice_counts(icosahedral_cosets().cell, lattice, 3600, count),
        lambda count: double_coset_grid(lattice=lattice, count=count),
    )
