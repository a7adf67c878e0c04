"""Layers whose orientations are a grid of rotations, with the grid's own neighbours.

``orientations: {grid: 600-cell, resolution_deg: 30}`` among a planner's parameters names one of
:func:`ellipsoid_planning.groups.catalogue.grid_names`, in the plane ``headings``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GridError, PlannerError
from ellipsoid_planning.groups.catalogue import grid_by_name, grid_names
from ellipsoid_planning.roadmap.orientations import headings

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

HEADINGS = "headings"
MOST_LAYERS = 100_000
# Neighbours are as near as this, in units of the edge of a cube with a node's share of rotations:
# the nearest ones of the usual lattices (1 to 1.26), but not the next (1.41 and more).
_NEAR = 1.35
_KEYS = ("grid", "count", "resolution_deg")


def check_orientations(value: Any) -> None:
    """Check the parameter ``orientations``.

    Raises:
        PlannerError: it is no mapping of a grid and either a count or a resolution.
    """
    expected = "expected {grid: NAME, count: N} or {grid: NAME, resolution_deg: D}"
    if not isinstance(value, Mapping) or not isinstance(value.get("grid"), str):
        raise PlannerError(f"orientations: {expected}, got {value!r}")
    for key in value:
        if key not in _KEYS:
            raise PlannerError(f"orientations: unknown key {key!r}; {expected}")
    sizes = [key for key in _KEYS[1:] if key in value]
    if len(sizes) != 1:
        raise PlannerError(f"orientations: {expected}, got {' and '.join(sizes) or 'neither'}")
    number, whole = value[sizes[0]], sizes[0] == "count"
    kind = int if whole else (int, float)
    if not isinstance(number, kind) or isinstance(number, bool) or not 0 < number < math.inf:
        raise PlannerError(f"orientations.{sizes[0]}: expected a positive number, got {number!r}")
    if value["grid"] not in (HEADINGS, *grid_names()):
        known = ", ".join((HEADINGS, *grid_names()))
        raise PlannerError(f"orientations.grid: expected one of {known}, got {value['grid']!r}")


def grid_layers(
    dimension: int, orientations: Mapping[str, Any], finer: float
) -> tuple[Array, Indices]:
    """Quaternions (L, 4) of a grid's layers and their neighbours (L, K), filled up with −1.

    ``finer`` is how many times as many layers there shall be as are asked for, about.

    Raises:
        PlannerError: there is no such grid in this dimension, or none of that size.
    """
    name, most = orientations["grid"], MOST_LAYERS / _count_of(dimension, orientations)
    finer = min(finer, max(most, 1.0))
    if (dimension == 2) != (name == HEADINGS):
        word = f"'{HEADINGS}' in the plane" if dimension == 2 else "a grid of rotations in space"
        raise PlannerError(f"orientations.grid: expected {word}, got {name!r}")
    if dimension == 2:
        return _planar(orientations, finer)
    try:
        grid = _spatial(name, orientations, finer)
    except GridError as error:
        raise PlannerError(f"orientations: {error}") from None
    lists = grid.neighbour_lists(_NEAR * grid.spacing)
    table = np.full((len(grid), max(1, int(np.diff(lists.starts).max()))), -1, dtype=np.int64)
    for node in range(len(grid)):
        near = lists[node]
        table[node, : len(near)] = near
    return grid.quaternions(), table


def _count_of(dimension: int, orientations: Mapping[str, Any]) -> float:
    """How many layers are asked for, about."""
    if "count" in orientations:
        return float(orientations["count"])
    step = math.radians(float(orientations["resolution_deg"]))
    return 2.0 * math.pi / step if dimension == 2 else 8.0 * math.pi**2 / step**3


def _spatial(name: str, orientations: Mapping[str, Any], finer: float) -> Any:
    if finer <= 1.0 and "count" in orientations:
        return grid_by_name(name, count=orientations["count"])
    if "count" in orientations:
        share = 8.0 * math.pi**2 / (orientations["count"] * finer)
        degrees = math.degrees(share ** (1.0 / 3.0))
    else:
        degrees = float(orientations["resolution_deg"]) / finer ** (1.0 / 3.0)
    try:
        return grid_by_name(name, resolution_deg=degrees)
    except GridError:
        if finer <= 1.0:
            raise
        # Some grids come in one size only: a finer level has the same one, turned.
        return _spatial(name, orientations, 1.0)


def _planar(orientations: Mapping[str, Any], finer: float) -> tuple[Array, Indices]:
    count = orientations.get("count")
    if count is None:
        count = math.ceil(360.0 / float(orientations["resolution_deg"]) - 1e-9)
    count = max(1, round(count * finer))
    index = np.arange(count)
    around = np.column_stack([(index - 1) % count, (index + 1) % count])
    return headings(count), around if count > 2 else np.full((count, 1), -1, dtype=np.int64)
