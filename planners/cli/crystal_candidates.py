"""Candidates of a packing model by either method, with progress, kept where that is wished."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from planners.cli.crystal_runs import Workplace, session

if TYPE_CHECKING:
    from ellipsoid_planning.crystal.model import PackingModel

DEFAULT_SPREAD = 0.2


@dataclass(frozen=True, eq=False)
class Candidates:
    """Free arrangements, in the method's order.

    Attributes:
        model: whose they are.
        looked_at: how many arrangements or cells were looked at.
        numbers: (m,), of the arrangements, or of the cells they are in.
        seconds: time of the search [s].
        points: (m, K), the arrangements that are no nodes of the grid; None for nodes.
        potentials: (m,), theirs; None for a grid's.
    """

    model: PackingModel
    looked_at: int
    numbers: NDArray[np.int64]
    seconds: float
    points: NDArray[np.float64] | None = None
    potentials: NDArray[np.float64] | None = None

    def __len__(self) -> int:
        return len(self.numbers)

    @property
    def shown(self) -> int:
        """The one to draw: the best, or one from the middle of a grid."""
        return len(self) // 2 if self.points is None else 0

    def configurations(self, which: slice) -> NDArray[np.float64]:
        """Some of the arrangements (., K), angles [rad]."""
        if self.points is not None:
            return self.points[which]
        return self.model.grid.configurations(self.numbers[which])

    def columns(self, which: slice) -> Mapping[str, NDArray[Any]]:
        """What else there is to say about them."""
        given: dict[str, NDArray[Any]] = {"number": self.numbers[which]}
        if self.potentials is not None:
            given["potential"] = self.potentials[which]
        return given


def by_grid(model: PackingModel, workplace: Workplace) -> Candidates:
    """The free arrangements of the grid, ascending."""
    from ellipsoid_planning.crystal.run_store import run_settings
    from ellipsoid_planning.crystal.runs import FreeArrangements, piece_size, search_pieces

    size = piece_size(model.grid)
    pieces = search_pieces(model.grid, size)
    with session(workplace, lambda: run_settings(model, "pack", piece=size)) as working:
        began = time.perf_counter()
        title = f"Searching {model.grid.count:,} arrangements"
        found = list(working.results(title, FreeArrangements(model), pieces))
    numbers = np.concatenate(found)
    return Candidates(model, model.grid.count, numbers, time.perf_counter() - began)
