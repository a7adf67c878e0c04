"""Candidates beside their target, row by row (thesis tables 3.4 and 3.6)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ellipsoid_planning.errors import CrystalError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray
    from rich.table import Table

    from ellipsoid_planning.crystal.packing.model import PackingModel

    Array = NDArray[np.float64]

TARGET = "target"


class Rows(NamedTuple):
    """A table of text: the columns' titles, and the rows; each begins with its own name."""

    titles: list[str]
    rows: list[list[str]]


def candidates_rows(
    model: PackingModel,
    configurations: ArrayLike,
    costs: ArrayLike,
    target: ArrayLike | None = None,
    errors: Mapping[str, Sequence[float]] | None = None,
    cost_name: str = "FCF",
) -> Rows:
    """Coordinates, costs and errors of the target and its candidates; angles in degrees.

    Raises:
        CrystalError: if there are not as many costs or errors as candidates, or they are none of
            the model's configurations.
    """
    candidates, found = checked_candidates(model, configurations, costs)
    columns = [(cost_name, found.tolist())]
    columns += [(name, list(values)) for name, values in (errors or {}).items()]
    for name, values in columns:
        if len(values) != len(candidates):
            raise CrystalError(
                f"{name}: expected {len(candidates)} values, one a candidate, got {len(values)}"
            )
    coordinates = model.molecule.coordinates
    titles = [f"{c.name.replace('_', ' ')}{' [°]' if c.turns else ''}" for c in coordinates]
    rows = [
        [str(i + 1), *_shown(model, q), *(f"{values[i]:.4g}" for _, values in columns)]
        for i, q in enumerate(candidates)
    ]
    if target is not None:
        rows.insert(0, [TARGET, *_shown(model, target), *("" for _ in columns)])
    return Rows(["candidate", *titles, *(name for name, _ in columns)], rows)


def candidates_table(
    model: PackingModel,
    configurations: ArrayLike,
    costs: ArrayLike,
    target: ArrayLike | None = None,
    errors: Mapping[str, Sequence[float]] | None = None,
    title: str = "",
    cost_name: str = "FCF",
) -> Table:
    """The rows of `candidates_rows` for a terminal."""
    from rich.box import SIMPLE_HEAD
    from rich.markup import escape
    from rich.table import Table

    titles, rows = candidates_rows(model, configurations, costs, target, errors, cost_name)
    table = Table(title=escape(title or model.name), title_justify="left", box=SIMPLE_HEAD)
    for index, name in enumerate(titles):
        # Narrow columns: a word a line.
        heading = escape(name).replace(" ", "\n")
        table.add_column(heading, justify="right" if index else "left", vertical="bottom")
    for row in rows:
        table.add_row(*map(escape, row), style="bold" if row[0] == TARGET else "")
        if row[0] == TARGET:
            table.add_section()
    return table


def error_columns(
    model: PackingModel, configurations: ArrayLike, target: ArrayLike
) -> dict[str, list[float]]:
    """E_h, MAE, E_max and, where the molecule shifts, MAE₂ of candidates (m, K), by title."""
    from ellipsoid_planning.crystal.phasing.arrangement_errors import arrangement_errors

    found = [arrangement_errors(model, one, target) for one in np.asarray(configurations)]
    columns = {
        "E_h": [one.motion for one in found],
        "MAE [°]": [one.mae_deg for one in found],
        "E_max [°]": [one.e_max_deg for one in found],
    }
    shifts = [one.mean_shift for one in found if one.mean_shift is not None]
    return {**columns, "MAE₂": shifts} if len(shifts) == len(found) else columns


def checked_candidates(
    model: PackingModel, configurations: ArrayLike, costs: ArrayLike
) -> tuple[Array, Array]:
    """Configurations (m, K) and costs (m,).

    Raises:
        CrystalError: if they have other shapes.
    """
    candidates, found = np.asarray(configurations, dtype=float), np.asarray(costs, dtype=float)
    size = len(model.keys)
    if candidates.ndim != 2 or candidates.shape[1] != size or found.shape != candidates.shape[:1]:
        raise CrystalError(
            f"expected candidates (m, {size}) with their costs (m,), got shapes "
            f"{candidates.shape} and {found.shape}"
        )
    return candidates, found


def _shown(model: PackingModel, configuration: ArrayLike) -> list[str]:
    return [f"{round(value, 2) + 0.0:.2f}" for value in model.values_of(configuration).values()]
