"""The minima of the potential in the cells of a grid as pieces of work, see `runs`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.packing.fingerprint import received_model, sent_model
from ellipsoid_planning.crystal.packing.gaussian_mixture import GaussianMixture
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.packing.potential_candidates import CellSearch, PotentialCandidates
from ellipsoid_planning.crystal.phasing.runs import MOST_PIECES, Piece, pieces

Array = NDArray[np.float64]

CELLS_AT_A_TIME = 4


@dataclass(frozen=True, eq=False)
class PotentialMinima:
    """The work of minimising the potential in a piece's cells.

    It is pickled as its model's document and its settings; a process makes the tables once.

    Attributes:
        search: of the cells.
    """

    search: CellSearch

    def __call__(self, piece: Piece) -> Array:
        """(m, K + 2): each minimum, the potential there, and whether it is free (1 or 0)."""
        found, values = self.search.minima(piece.first, piece.last)
        return np.column_stack([found, values, self.search.model.are_free(found)])

    def __reduce__(self) -> tuple[Any, ...]:
        given = self.search
        settings = given.mixture.spread, given.step, given.starts
        return _received, (sent_model(given.model), *settings)


def cell_search(
    model: PackingModel, spread: float, step: float | None = None, starts: int | None = None
) -> CellSearch:
    """The search of a model's cells; see `candidates_by_potential`.

    Raises:
        CrystalError: a setting is out of its range, or the grid has no cells, or too many.
    """
    search = CellSearch(model, GaussianMixture(spread), step=step, starts=starts)
    len(search.cells)  # complains now
    return search


@lru_cache(maxsize=4)
def _received(
    sent: tuple[str, str], spread: float, step: float | None, starts: int | None
) -> PotentialMinima:
    return PotentialMinima(cell_search(received_model(sent), spread, step, starts))


def cell_pieces(search: CellSearch) -> tuple[Piece, ...]:
    """The pieces of a search, in cells."""
    count = len(search.cells)
    return pieces("cells", count, max(CELLS_AT_A_TIME, -(-count // MOST_PIECES)))


def candidates_of(results: Iterable[Array]) -> PotentialCandidates:
    """The candidates of all cells from the results of their pieces."""
    rows = np.vstack(list(results))
    rows.setflags(write=False)
    cells = np.arange(len(rows), dtype=np.int64)
    cells.setflags(write=False)
    free = rows[:, -1] > 0.5
    free.setflags(write=False)
    return PotentialCandidates(rows[:, :-2], rows[:, -2], cells, free)
