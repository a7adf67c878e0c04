"""Candidates by potential: where GCF is smallest in each cell of a grid (thesis 3.4.2, Fig. 3.5).

A cell may hold several minima, many of them on its boundary. GCF is looked at on a fine grid in
the cell, its boundary included, and L-BFGS-B goes down from every node that is no higher than
those next to it, without leaving the cell; the lowest end counts. Cells are independent of each
other, so the result does not depend on how many threads share them.

The thesis' 48 candidates (30° cells, m_b = 0.2) depend on how many lattice copies count: with all
of them there are 80, with a block of ``copies=3`` and the descent from the lowest node alone
(``starts=1``) 48. From m_b = 1 on the copies beyond the neighbours do not matter.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import minimum_filter
from scipy.optimize import minimize

from ellipsoid_planning.crystal.packing.gaussian_mixture import GaussianMixture
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.packing.potential import GaussianPotential
from ellipsoid_planning.crystal.packing.ranges import FITS
from ellipsoid_planning.errors import CrystalError

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]

# Cells are given to threads so many at a time.
CELLS_AT_ONCE = 16
# Nodes a side for as many coordinates at most.
NODES = ((3, 7), (5, 3))
UNIT = [(0.0, 1.0)]
TOL = {"ftol": 1e-12, "gtol": 1e-8, "maxiter": 200}
# A minimum takes a millisecond at the least.
MOST_CELLS = 2_000_000


@dataclass(frozen=True, eq=False)
class PotentialCandidates:
    """The minimum of each cell; arrays are read-only.

    Attributes:
        configurations: (C, K), angles [rad].
        potentials: (C,), GCF there.
        cells: (C,) int64, the cells' numbers, as arrangements are numbered in the model's grid.
        free: (C,), whether no two molecules meet there.
    """

    configurations: Array
    potentials: Array
    cells: NDArray[np.int64]
    free: NDArray[np.bool_]

    @property
    def kept(self) -> Array:
        """The free minima (m, K), smallest potential first, then by cell."""
        chosen = np.flatnonzero(self.free)
        return self.configurations[chosen[np.argsort(self.potentials[chosen], kind="stable")]]


def cells_of(model: PackingModel, step: float | None = None) -> Array:
    """The bounds (C, K, 2) of all cells of the model's grid.

    They are numbered like its arrangements: turns before shifts before joints, the last fastest.

    Args:
        model: its grid's ranges are cut.
        step: width of the cells along all angles [rad] instead of the grid's own; where it does
            not divide a range, the last cell is narrower.

    Raises:
        CrystalError: if the orientations come from a grid of rotations, which has no such cells,
            there are too many cells, or the step is not positive.
    """
    grid = model.grid
    if grid.turns is not None:
        raise CrystalError(
            "the model's orientations are a grid of rotations, which has no box-shaped cells; give "
            "search.orientation ranges of angles to look for minima of the potential"
        )
    if step is not None and not step > 0.0:
        raise CrystalError(f"expected a step > 0, got {step:g}; the thesis takes 30 degrees")
    shifts, base = grid.shift_count, grid.base_count
    order = [*range(shifts, base), *range(shifts), *range(base, len(grid.ranges))]
    sides, count = [], 1
    for k in order:
        coordinate, values = model.molecule.coordinates[k], grid.ranges[k]
        cut = step if coordinate.turns and values.upper > values.lower else None
        count *= len(values.cells) if cut is None else _steps(values.upper - values.lower, cut)
        _check_count(count)  # before they are made
        sides.append(values.cells if cut is None else _cut(values.lower, values.upper, cut))
    cells = np.array(list(itertools.product(*sides))).reshape(-1, len(order), 2)
    return np.asarray(cells[:, np.argsort(order)])


def _check_count(count: int) -> None:
    if not count <= MOST_CELLS:
        raise CrystalError(
            f"the grid has {count:,} cells or more, and a minimum is looked for in each: expected "
            f"at most {MOST_CELLS:,}; make the cells larger by a step along the angles, or the "
            "grid coarser"
        )


def _steps(width: float, step: float) -> int:
    return max(1, math.ceil(min(width / step * (1.0 - FITS), 2.0 * MOST_CELLS)))


def _cut(lower: float, upper: float, step: float) -> Array:
    edges = np.append(lower + step * np.arange(_steps(upper - lower, step)), upper)
    return np.stack([edges[:-1], edges[1:]], axis=1)


@dataclass(frozen=True, eq=False)
class CellSearch:
    """The search for the minimum of GCF in each cell of a model's grid.

    Attributes:
        model: the molecule, its crystal and its grid.
        mixture: what stands for an ellipsoid in GCF.
        own_pairs, copies, step, nodes, starts: see `candidates_by_potential`.

    Raises:
        CrystalError: if nodes or starts are less than 1.
    """

    model: PackingModel
    mixture: GaussianMixture
    own_pairs: bool = True
    copies: int | None = None
    step: float | None = None
    nodes: int | None = None
    starts: int | None = None

    def __post_init__(self) -> None:
        for name, given in (("nodes", self.nodes), ("starts", self.starts)):
            if given is not None and given < 1:
                raise CrystalError(f"expected {name} >= 1, got {given}")

    @cached_property
    def cells(self) -> Array:
        """(C, K, 2), see `cells_of`."""
        return cells_of(self.model, self.step)

    @cached_property
    def potential(self) -> GaussianPotential:
        """GCF."""
        return GaussianPotential(self.model, self.mixture, self.own_pairs, copies=self.copies)

    def minima(self, first: int, last: int) -> tuple[Array, Array]:
        """The minima (m, K) of the cells ``first`` to ``last`` - 1, and GCF there (m,)."""
        cells = self.cells[first:last]
        points = _nodes(self.cells[0, :, 1] > self.cells[0, :, 0], self.nodes)
        found, values = np.empty(cells.shape[:2]), np.empty(len(cells))
        for k, cell in enumerate(cells):
            found[k], values[k] = _minimum(self.potential, cell, points, self.starts)
        return found, values


def candidates_by_potential(
    model: PackingModel,
    mixture: GaussianMixture,
    *,
    own_pairs: bool = True,
    copies: int | None = None,
    step: float | None = None,
    nodes: int | None = None,
    starts: int | None = None,
    threads: int = 1,
    on_progress: Progress | None = None,
) -> PotentialCandidates:
    """Return the minimum of GCF in each cell of the model's grid, and which of them are free.

    Args:
        model: the molecule, its crystal and its grid.
        mixture: what stands for an ellipsoid in GCF.
        own_pairs: whether parts of the same molecule push each other away.
        copies: None for all copies that matter, or a block of them, see `GaussianPotential`.
        step: see `cells_of`.
        nodes: how many nodes each side of a cell has; 1 is its centre only. The default is 7 for up
            to three coordinates, 3 for up to five, else 1, because there are nodes^K of them.
        starts: from how many of them, at most, L-BFGS-B goes down; the lowest come first. None for
            all that are no higher than those next to them: the smallest minimum of the cell, in
            all likelihood.
        threads: how many share the cells.
        on_progress: told the number of cells done and of all.

    Raises:
        CrystalError: see `cells_of`; if there is no start or no thread.
    """
    if threads < 1:
        raise CrystalError(f"expected threads >= 1, got {threads}")
    search = CellSearch(
        model, mixture, own_pairs=own_pairs, copies=copies, step=step, nodes=nodes, starts=starts
    )
    cells = search.cells
    found, values = np.empty(cells.shape[:2]), np.empty(len(cells))

    def work(first: int) -> int:
        chosen = slice(first, min(first + CELLS_AT_ONCE, len(cells)))
        found[chosen], values[chosen] = search.minima(chosen.start, chosen.stop)
        return chosen.stop - chosen.start

    with ThreadPoolExecutor(threads) as pool:
        done = 0
        for count in pool.map(work, range(0, len(cells), CELLS_AT_ONCE)):
            done += count
            if on_progress is not None:
                on_progress(done, len(cells))
    numbers = np.arange(len(cells), dtype=np.int64)
    return PotentialCandidates(*map(_frozen, (found, values, numbers, model.are_free(found))))


def candidate_counts(
    model: PackingModel,
    spreads: NDArray[np.float64],
    steps: NDArray[np.float64],
    *,
    own_pairs: bool = True,
    copies: int | None = None,
    threads: int = 1,
) -> NDArray[np.int64]:
    """How many free candidates each grid (s,) [rad] has for each m_b (b,): (s, b), Fig. 3.6."""
    counts = [
        [
            candidates_by_potential(
                model,
                GaussianMixture(float(spread)),
                own_pairs=own_pairs,
                copies=copies,
                step=float(step),
                threads=threads,
            ).free.sum()
            for spread in spreads
        ]
        for step in steps
    ]
    return np.array(counts, dtype=np.int64)


def _nodes(moving: NDArray[np.bool_], nodes: int | None) -> Array:
    """The nodes (..., K) of a grid in the unit cube, one along coordinates that do not move."""
    if nodes is None:
        nodes = next((m for most, m in NODES if moving.sum() <= most), 1)
    side = np.linspace(0.0, 1.0, nodes) if nodes > 1 else np.array([0.5])
    sides = [side if moves else side[:1] for moves in moving]
    return np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1)


def _lowest(values: Array) -> NDArray[np.int64]:
    """Which nodes (flat) are no higher than all next to them, lowest first."""
    least = minimum_filter(values, size=3, mode="nearest")
    found = np.flatnonzero(values <= least)
    return found[np.argsort(values.ravel()[found], kind="stable")]


def _minimum(
    potential: GaussianPotential, cell: Array, nodes: Array, starts: int | None
) -> tuple[Array, float]:
    """The smallest minimum found in a cell (K, 2), and GCF there."""
    low, widths = cell[:, 0], cell[:, 1] - cell[:, 0]
    points = nodes.reshape(-1, len(cell))
    values, gradients = potential.values_and_gradients(low + points * widths)
    # GCF varies little about a large mean: in units of its slope across the cell it is of order 1.
    reference, scale = float(values[0]), float(np.abs(gradients * widths).max(initial=0.0))
    if scale == 0.0:
        return low + points[0] * widths, reference

    def scaled(point: Array) -> tuple[float, Array]:
        value, slope = potential.value_and_gradient(low + point * widths)
        return (value - reference) / scale, slope * widths / scale

    best, least = points[0], math.inf
    for start in points[_lowest(values.reshape(nodes.shape[:-1]))[:starts]]:
        run = minimize(
            scaled, start, jac=True, method="L-BFGS-B", bounds=UNIT * len(low), options=TOL
        )
        if run.fun < least:
            best, least = run.x, float(run.fun)
    configuration = np.clip(low + best * widths, cell[:, 0], cell[:, 1])
    return configuration, reference + least * scale


def _frozen(array: NDArray) -> NDArray:  # type: ignore[type-arg]
    array.setflags(write=False)
    return array
