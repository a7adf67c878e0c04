"""Candidates of a packing model by either method, with progress, kept where that is wished."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ellipsoid_planning.crystal.packing.model import PackingModel
    from ellipsoid_planning.crystal.packing.potential_candidates import CellSearch
    from planners.cli.crystal_runs import Session

DEFAULT_SPREAD = 0.2


class Method(str, Enum):
    """How candidates are found."""

    grid = "grid"
    potential = "potential"


Chosen = Annotated[
    Method,
    typer.Option(
        help="grid: the free arrangements of the model's grid. potential: where a potential of "
        "Gaussians is smallest in each cell of the grid, if that is free."
    ),
]
Spread = Annotated[
    float | None,
    typer.Option(
        metavar="M_B", help="Of the potential: m_b, the larger, the narrower; 0.2 without it."
    ),
]
StepDeg = Annotated[
    float | None,
    typer.Option(
        metavar="D",
        help="Of the potential: width of the cells along angles, instead of the grid's steps.",
    ),
]
Starts = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        help="Of the potential: from how many points of a cell it goes down; without it from all "
        "that may matter.",
    ),
]


@dataclass(frozen=True)
class Choice:
    """A method with its options.

    Attributes:
        method: grid or potential.
        spread: m_b.
        step_deg: width of the cells [degree].
        starts: in each cell.

    Raises:
        CrystalError: an option belongs to the other method, or is out of its range.
    """

    method: Method
    spread: float | None = None
    step_deg: float | None = None
    starts: int | None = None

    def __post_init__(self) -> None:
        from ellipsoid_planning.errors import CrystalError

        options = {"spread": self.spread, "step-deg": self.step_deg, "starts": self.starts}
        for name, value in options.items():
            if value is None:
                continue
            if self.method is Method.grid:
                raise CrystalError(
                    f"--{name} {value}: it belongs to --method potential; add that or remove it"
                )
            if not (math.isfinite(value) and value > 0.0):
                raise CrystalError(f"--{name}: expected a positive number, got {value}")

    def settings(self, model: PackingModel) -> dict[str, Any]:
        """What the pieces of work depend on, as data for JSON."""
        from ellipsoid_planning.crystal.phasing.runs import piece_size

        if self.method is Method.grid:
            return {"method": "grid", "piece": piece_size(model.grid)}
        given = {"spread": self.spread or DEFAULT_SPREAD, "starts": self.starts}
        return {"method": "potential", "step_deg": self.step_deg, **given}

    def search(self, model: PackingModel) -> CellSearch | None:
        """The search of the potential's cells, None for a grid.

        Raises:
            CrystalError: the grid has no cells, or too many.
        """
        from ellipsoid_planning.crystal.phasing.potential_runs import cell_search

        if self.method is Method.grid:
            return None
        step = None if self.step_deg is None else math.radians(self.step_deg)
        return cell_search(model, self.spread or DEFAULT_SPREAD, step, self.starts)


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


def by_grid(model: PackingModel, working: Session) -> Candidates:
    """The free arrangements of the grid, ascending."""
    import numpy as np

    from ellipsoid_planning.crystal.phasing.runs import FreeArrangements, search_pieces

    began = time.perf_counter()
    title = f"Searching {model.grid.count:,} arrangements"
    found = list(working.results(title, FreeArrangements(model), search_pieces(model.grid)))
    return Candidates(model, model.grid.count, np.concatenate(found), time.perf_counter() - began)


def by_potential(search: CellSearch, working: Session) -> Candidates:
    """The free minima of the cells, smallest potential first."""
    import numpy as np

    from ellipsoid_planning.crystal.phasing.potential_runs import (
        PotentialMinima,
        candidates_of,
        cell_pieces,
    )

    began = time.perf_counter()
    count = len(search.cells)
    results = working.results(
        f"Minimising in {count:,} cells", PotentialMinima(search), cell_pieces(search)
    )
    found = candidates_of(results)
    free = np.flatnonzero(found.free)
    order = free[np.argsort(found.potentials[free], kind="stable")]
    return Candidates(
        search.model,
        count,
        order,
        time.perf_counter() - began,
        found.configurations[order],
        found.potentials[order],
    )
