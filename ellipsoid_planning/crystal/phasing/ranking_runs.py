"""The ranking of a grid's free arrangements as pieces of work, see `runs`."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.diffraction.ranking import Ranker, Ranking, merged
from ellipsoid_planning.crystal.packing.fingerprint import received_model, sent_model
from ellipsoid_planning.crystal.packing.grid_search import GridSearch
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.phasing.runs import Piece

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RankedArrangements:
    """The work of searching and ranking: the best of a piece's free arrangements.

    It is pickled as the model's document and the magnitudes; a process makes the tables once.

    Attributes:
        cost: FCF of the model against the target.
        best: how many to keep.
    """

    cost: FourierCost
    best: int

    def __call__(self, piece: Piece) -> Array:
        """(1 + B, 2): how many are free, then number and cost of the best; see `ranking_of`."""
        ranker = _ranker(self.cost)
        found = ranker.rank(ranker.search.free(piece.first, piece.last), self.best)
        # Numbers are exact as floats: a grid has fewer than 2⁵³ arrangements.
        rows = np.column_stack([found.numbers.astype(float), found.costs])
        return np.vstack([[found.looked_at, 0.0], rows])

    def __reduce__(self) -> tuple[Any, ...]:
        magnitudes = pickle.dumps(self.cost.magnitudes)
        return _received, (sent_model(self.cost.model), magnitudes, self.cost.scaled, self.best)


@lru_cache(maxsize=4)
def _ranker(cost: FourierCost) -> Ranker:
    return Ranker(GridSearch(cost.model), cost)


Sent = tuple[str, str]


def _received(sent: Sent, magnitudes: bytes, scaled: bool, best: int) -> RankedArrangements:
    return RankedArrangements(_cost(sent, magnitudes, scaled), best)


@lru_cache(maxsize=4)
def _cost(sent: Sent, magnitudes: bytes, scaled: bool) -> FourierCost:
    return FourierCost(received_model(sent), pickle.loads(magnitudes), scaled)  # noqa: S301  ours


def ranking_of(model: PackingModel, results: Iterable[Array], best: int) -> Ranking:
    """The ranking of a whole grid from the results of its pieces."""
    return merged((_ranking(model, result) for result in results), best)


def _ranking(model: PackingModel, result: Array) -> Ranking:
    numbers = result[1:, 0].astype(np.int64)
    costs = np.ascontiguousarray(result[1:, 1])
    return Ranking(numbers, model.grid.configurations(numbers), costs, int(result[0, 0]))


def target_digest(cost: FourierCost) -> str:
    """A fingerprint of what a cost compares with."""
    digest = hashlib.sha256(b"scaled" if cost.scaled else b"absolute")
    for array in (cost.magnitudes.indices, cost.magnitudes.values):
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()
