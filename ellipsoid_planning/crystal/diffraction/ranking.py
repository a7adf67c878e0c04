"""The best arrangements of a grid search by their Fourier cost (thesis section 3.4.1)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.packing.grid_search import GridSearch, base_frames
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.kernels import ranking as kernels

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

# Costs are whole multiples of this share of the cost of an empty cell. Rounding errors are
# a thousand times smaller; costs that differ by less are equal, and the lower number goes first.
QUANTUM = 1e-10
# The unit is no less than this share of the largest cost that a model can have, lest the number
# of quanta be too large for an integer where target and model have scales of their own.
LEAST_UNIT = 1e-6

# Above so many numbers in the tables of limbs, arrangements are compared one by one.
LARGEST_TABLE = 1 << 27
PLAIN_AT_ONCE = 1 << 16

# About so many arrangements of the grid are searched and ranked at a time.
AT_ONCE = 1 << 21


@dataclass(frozen=True, eq=False)
class Ranking:
    """The best arrangements, best first.

    Of those with one cost only the lowest number is kept: symmetry and homometric twins make many
    that diffraction cannot tell apart, and all lead to one when they are refined.

    Attributes:
        numbers: (B,), of arrangements in the grid.
        configurations: (B, K), angles [rad].
        costs: (B,), FCF, rounded to 1e-10 of the target's norm.
        looked_at: how many arrangements these are the best of.
    """

    numbers: Integers
    configurations: Array
    costs: Array
    looked_at: int

    def __len__(self) -> int:
        return len(self.numbers)


def merged(rankings: Iterable[Ranking], best: int = 10) -> Ranking:
    """The ``best`` ones of several rankings of different arrangements, in whatever order.

    Raises:
        CrystalError: if there is no ranking, or ``best`` is less than 1.
    """
    given = list(rankings)
    if not given:
        raise CrystalError("expected one ranking or more to merge, got none")
    _check_best(best)
    numbers = np.concatenate([ranking.numbers for ranking in given])
    costs = np.concatenate([ranking.costs for ranking in given])
    order = _distinct(numbers, costs, best)
    configurations = np.vstack([ranking.configurations for ranking in given])[order]
    looked_at = sum(ranking.looked_at for ranking in given)
    return Ranking(numbers[order], configurations, costs[order], looked_at)


@dataclass(frozen=True, eq=False)
class Ranker:
    """Ranks arrangements of one grid against one target.

    Attributes:
        search: the grid's search, whose limbs it shares.
        cost: FCF against the target.

    Raises:
        CrystalError: if the cost is another model's.
    """

    search: GridSearch
    cost: FourierCost

    def __post_init__(self) -> None:
        if self.search.model is not self.cost.model:
            raise CrystalError("expected the search and the cost of one and the same model")

    def rank(self, numbers: Integers, best: int = 10) -> Ranking:
        """The ``best`` of the arrangements ``numbers`` (m,). Lets go of Python's lock.

        They are ranked fastest in ascending order. The result depends on no order.

        Raises:
            CrystalError: if ``best`` is less than 1, or a number is none of the grid's.
        """
        _check_best(best)
        numbers = np.ascontiguousarray(numbers, dtype=np.int64)
        grid = self.search.model.grid
        if len(numbers) and not 0 <= numbers.min() <= numbers.max() < grid.count:
            raise CrystalError(f"expected numbers of arrangements from 0 to {grid.count - 1}")
        if self._table_size > LARGEST_TABLE:
            return self._one_by_one(numbers, best)
        found = np.full(best, kernels.NOTHING), np.full(best, kernels.NOTHING)
        kernels.rank_arrangements(numbers, *self._tables, found)
        kept = found[0][found[1] != kernels.NOTHING]
        costs = found[1][: len(kept)] * self._quantum
        return Ranking(kept, grid.configurations(kept), costs, len(numbers))

    def _one_by_one(self, numbers: Integers, best: int) -> Ranking:
        """As `rank` without tables, for limbs of too many poses."""
        grid = self.search.model.grid
        pieces = np.array_split(np.sort(numbers), len(numbers) // PLAIN_AT_ONCE + 1)
        parts = []
        for piece in pieces:
            whole = grid.configurations(piece)
            listed = rank_listed(self.cost, whole, best)
            places = piece[listed.numbers]
            parts.append(Ranking(places, listed.configurations, listed.costs, len(piece)))
        return merged(parts, best)

    @property
    def _table_size(self) -> int:
        spots, reflections = self.cost.structure.table[0].shape[1], len(self.cost.magnitudes)
        return 2 * len(self.search.tables[2]) * (spots + reflections)

    @cached_property
    def _quantum(self) -> float:
        return quantum_of(self.cost)

    @cached_property
    def _tables(self) -> tuple[object, ...]:
        """All but the numbers and the best that `kernels.rank_arrangements` reads."""
        limbs, _, placements, strides, _, counts = self.search.tables
        structure = self.cost.structure
        frames = structure.model.molecule.part_frames
        order = np.concatenate([np.flatnonzero(frames == f) for f in self.search.limb_frames])
        data = self.cost.magnitudes.values, self.cost.weights, self.cost.scaled, self._quantum
        return (
            self._turns,
            np.ascontiguousarray(limbs[:, :4]),
            structure.model.molecule.parts[order],
            structure.weights[order],
            structure.planar,
            placements,
            strides,
            counts,
            self._waves,
            structure.table,
            data,
        )

    @cached_property
    def _turns(self) -> Array:
        """The base's frames (N, FRAME) for its turns, its shifts left out."""
        grid = self.search.model.grid
        poses = grid.bases[:: self.shifts].copy()
        poses[:, : grid.shift_count] = 0.0
        return base_frames(self.search.model, poses)

    @property
    def shifts(self) -> int:
        """How many shifts of the base share a turn: base poses go through them first."""
        grid = self.search.model.grid
        return int(np.prod([len(r.values) for r in grid.ranges[: grid.shift_count]], dtype=int))

    @cached_property
    def _waves(self) -> tuple[Integers, NDArray[np.complex128]]:
        grid, molecule = self.search.model.grid, self.search.model.molecule
        values = [r.values for r in grid.ranges[: grid.shift_count]]
        spots = self.cost.structure.table[0]
        rows = [np.zeros((0, spots.shape[1]))]
        rows += [np.outer(v, axis @ spots) for v, axis in zip(values, molecule.axes, strict=False)]
        counts = np.array([len(v) for v in values], dtype=np.int64)
        return counts, np.exp(2j * np.pi * np.vstack(rows))


def rank(search: GridSearch, numbers: Integers, cost: FourierCost, best: int = 10) -> Ranking:
    """The ``best`` of the arrangements ``numbers`` (m,) of a grid; see `Ranker`."""
    return Ranker(search, cost).rank(numbers, best)


def quantum_of(cost: FourierCost) -> float:
    """What costs are rounded to multiples of."""
    if cost.scaled:
        return QUANTUM * cost.norm
    volume = math.pi if cost.structure.planar else 4.0 * math.pi / 3.0
    content = cost.model.group.order * volume * float(cost.structure.weights.sum())
    return QUANTUM * max(cost.norm, LEAST_UNIT * content * math.sqrt(float(cost.weights.sum())))


def rank_listed(cost: FourierCost, configurations: ArrayLike, best: int = 10) -> Ranking:
    """The ``best`` of any configurations (m, K), such as minima of a potential.

    Their numbers are their places in the list.

    Raises:
        CrystalError: if ``best`` is less than 1, or the configurations have another size.
    """
    _check_best(best)
    whole = cost.structure.checked(configurations)
    quantum = quantum_of(cost)
    costs = np.round(cost.values(whole) / quantum) * quantum
    numbers = _distinct(np.arange(len(costs)), costs, best)
    return Ranking(numbers, whole[numbers], costs[numbers], len(costs))


def _distinct(numbers: Integers, costs: Array, best: int) -> Integers:
    """Places of the ``best`` costs, each with the lowest of the numbers that share it."""
    order = np.lexsort((numbers, costs)).astype(np.int64)
    first = np.ones(len(order), bool)
    first[1:] = costs[order][1:] != costs[order][:-1]
    return order[first][:best]


def rank_free(
    search: GridSearch,
    cost: FourierCost,
    best: int = 10,
    workers: int = 1,
    on_progress: Callable[[int, int], None] | None = None,
) -> Ranking:
    """Search the whole grid, and rank all that is free; the same for any number of ``workers``.

    Args:
        search: of the grid.
        cost: FCF against the target.
        best: how many to keep.
        workers: threads.
        on_progress: called after each chunk with the number of base poses done, and of all.
    """
    ranker = Ranker(search, cost)
    total = search.model.grid.base_poses
    parts: list[Ranking] = []
    with ThreadPoolExecutor(workers) as pool:

        def work(chunk: tuple[int, int]) -> tuple[int, Ranking]:
            return chunk[1], ranker.rank(search.free(*chunk), best)

        for last, found in pool.map(work, chunks(ranker)):
            parts.append(found)
            if on_progress is not None:
                on_progress(last, total)
    return merged(parts, best)


def chunks(ranker: Ranker, at_once: int = AT_ONCE) -> Iterator[tuple[int, int]]:
    """Ranges of base poses, whole turns, of about ``at_once`` arrangements together."""
    grid = ranker.search.model.grid
    step = max(1, at_once // (grid.joint_count * ranker.shifts)) * ranker.shifts
    for first in range(0, grid.base_poses, step):
        yield first, min(first + step, grid.base_poses)


def _check_best(best: int) -> None:
    if best < 1:
        raise CrystalError(f"expected to keep one arrangement or more, got {best}")
