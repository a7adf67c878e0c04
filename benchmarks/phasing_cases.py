"""Targets to phase: those of the thesis' Table 3.2, arrangements of a grid, and random ones."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ellipsoid_planning.crystal.packing.grid import ArrangementGrid
from ellipsoid_planning.crystal.packing.grid_search import GridSearch
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.packing.ranges import Range

# θ₁, θ₂, θ₃ of the targets [degree], and the mean of the final errors that the thesis prints.
TABLE_3_2 = (
    ((100.82, -72.21, -3.03), (0.79, 2.14, 0.19)),
    ((42.29, 64.37, -69.25), (0.67, 0.08, 2.08)),
    ((136.67, -68.70, -67.33), (1.09, 1.16, 1.06)),
    ((114.21, -63.46, -51.42), (2.22, 1.25, 1.72)),
    ((54.83, -49.51, -70.41), (1.00, 0.86, 1.04)),
    ((159.67, 47.67, -2.65), (1.08, 3.15, 3.08)),
    ((101.63, -67.65, 12.06), (2.09, 2.55, 1.02)),
    ((113.89, -73.69, 30.76), (1.17, 1.11, 1.06)),
    ((66.41, 27.29, -76.94), (3.21, 3.49, 1.55)),
    ((97.19, -1.59, -86.46), (2.83, 1.30, 2.93)),
)


def table_3_2(model: PackingModel) -> np.ndarray:
    """The ten targets (10, 3) as configurations of the planar rabbit; θ₃ is minus its left ear."""
    rows = [
        model.configuration({"yaw_deg": a, "right_ear_deg": b, "left_ear_deg": -c})
        for (a, b, c), _ in TABLE_3_2
    ]
    return np.array(rows)


def random_targets(model: PackingModel, count: int, seed: int) -> np.ndarray:
    """Free arrangements (count, K), uniform in the model's ranges."""
    rng = np.random.default_rng(seed)
    lower = np.array([one.lower for one in model.grid.ranges])
    upper = np.array([one.upper for one in model.grid.ranges])
    found: list[np.ndarray] = []
    while sum(map(len, found)) < count:
        drawn = rng.uniform(lower, upper, (1000, len(lower)))
        found.append(drawn[model.are_free(drawn)])
    return np.vstack(found)[:count]


def grid_targets(model: PackingModel, numbers: np.ndarray, count: int, seed: int) -> np.ndarray:
    """Some of the grid's free arrangements (count, K)."""
    chosen = np.random.default_rng(seed).choice(numbers, size=count, replace=False)
    return model.grid.configurations(chosen)


def with_step(model: PackingModel, step_deg: float) -> PackingModel:
    """The model with another grid of its angles, without prescribed turns."""
    ranges = tuple(
        Range.of(one.lower, one.upper, math.radians(step_deg))
        if coordinate.turns and one.step > 0.0
        else one
        for one, coordinate in zip(model.grid.ranges, model.molecule.coordinates, strict=True)
    )
    grid = ArrangementGrid(ranges, model.grid.base_count, model.grid.shift_count)
    return replace(model, grid=grid)


def free_numbers(model: PackingModel) -> tuple[GridSearch, np.ndarray]:
    """The search of the model's grid, and all arrangements it finds free."""
    search = GridSearch(model)
    return search, search.free(0, model.grid.base_poses)
