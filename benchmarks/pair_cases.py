"""Cases on pairs of ellipsoids: distance, overlap, containment, chord."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import fcl
import numpy as np
from numpy.typing import NDArray

from benchmarks import dense, loops
from benchmarks.scenes import distant_pairs, nested_pairs, pairs
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.rows import body_row, placed_row
from ellipsoid_planning.kernels import whitening

Fields = tuple[str, str, int, Callable[[], Any]]
Pair = tuple[Ellipsoid, Ellipsoid]

LINE_SAMPLES = 100
"""Places that a sampled chord looks at: OMPL's default resolution along a whole extent."""
_LINE = (-4.0, 4.0)


def pair_cases() -> list[Fields]:
    """(topic, method, operations, run) of everything that concerns two bodies."""
    apart, mixed, nested = distant_pairs(), pairs(), nested_pairs()
    return [
        *_distance(apart),
        *_overlap(mixed),
        *_containment(nested),
        *_chord(mixed),
    ]


def _rows(given: list[Pair]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    bodies = np.array([body_row(first) for first, _ in given])
    return bodies, np.array([placed_row(second) for _, second in given])


def _objects(given: list[Pair]) -> list[tuple[Any, Any]]:
    return [(_object(first), _object(second)) for first, second in given]


def _object(body: Ellipsoid) -> Any:
    shape = fcl.Ellipsoid(*body.semi_axes.tolist())
    return fcl.CollisionObject(shape, fcl.Transform(body.rotation, body.centre))


def _distance(given: list[Pair]) -> list[Fields]:
    topic, out = "distance of two ellipsoids", np.empty(len(given))
    bodies, placed = _rows(given)
    objects, directions = _objects(given), dense.sphere()

    def ours() -> Any:
        loops.converged_gaps(bodies, placed, out)
        return out > 0.0

    def by_fcl() -> Any:
        request = fcl.DistanceRequest()
        return [fcl.distance(a, b, request, fcl.DistanceResult()) > 0.0 for a, b in objects]

    def by_numpy() -> Any:
        return [dense.gap(a, b, directions) > 0.0 for a, b in given]

    return _methods(topic, len(given), ours, by_fcl, by_numpy)


def _overlap(given: list[Pair]) -> list[Fields]:
    topic, out = "do two ellipsoids meet", np.empty(len(given))
    bodies, placed = _rows(given)
    objects, directions = _objects(given), dense.sphere()

    def ours() -> Any:
        loops.decided_gaps(bodies, placed, out)
        return out <= 0.0

    def by_fcl() -> Any:
        request = fcl.CollisionRequest()
        return [fcl.collide(a, b, request, fcl.CollisionResult()) > 0 for a, b in objects]

    def by_numpy() -> Any:
        return [dense.gap(a, b, directions) <= 0.0 for a, b in given]

    return _methods(topic, len(given), ours, by_fcl, by_numpy)


def _methods(
    topic: str,
    count: int,
    ours: Callable[[], Any],
    by_fcl: Callable[[], Any],
    by_numpy: Callable[[], Any],
) -> list[Fields]:
    return [
        (topic, "this project", count, ours),
        (topic, "python-fcl", count, by_fcl),
        (topic, f"numpy, {dense.DIRECTIONS} directions", count, by_numpy),
    ]


def _containment(given: list[Pair]) -> list[Fields]:
    topic, out = "is an ellipsoid inside another", np.empty(len(given))
    bodies, placed = _rows([(arena, part) for part, arena in given])
    directions = dense.sphere()

    def ours() -> Any:
        loops.extents(bodies, placed, out)
        return out <= 1.0

    def by_numpy() -> Any:
        return [dense.is_inside(part, arena, directions) for part, arena in given]

    return [
        (topic, "this project", len(given), ours),
        (topic, f"numpy, {dense.DIRECTIONS} points", len(given), by_numpy),
    ]


def _chord(given: list[Pair]) -> list[Fields]:
    topic = "where a line is blocked by one C-obstacle"
    bodies, placed = _rows(given)
    table, scratch = np.empty((len(given), whitening.WHITEN)), np.empty((1, 9))
    for k in range(len(given)):
        whitening.whiten(bodies, k, placed, k, scratch, table, k)
    found, counts = np.empty((len(given), 3)), np.empty(len(given))
    objects, places = _objects(given), np.linspace(*_LINE, LINE_SAMPLES)

    def ours() -> Any:
        loops.chords(bodies, placed, table, found)
        return found[:, 0]

    def by_states() -> Any:
        loops.sampled_chords(bodies, placed, *_LINE, LINE_SAMPLES, counts)
        return counts

    def by_fcl() -> Any:
        return [_fcl_hits(*pair, places) for pair in objects]

    return [
        (topic, "this project", len(given), ours),
        (topic, f"our own check at {LINE_SAMPLES} places", len(given), by_states),
        (topic, f"python-fcl at {LINE_SAMPLES} places", len(given), by_fcl),
    ]


def _fcl_hits(first: Any, second: Any, places: NDArray[np.float64]) -> int:
    request, hits, own = fcl.CollisionRequest(), 0, second.getTranslation()
    for place in places:
        second.setTranslation(own + np.array([place, 0.0, 0.0]))
        hits += fcl.collide(first, second, request, fcl.CollisionResult()) > 0
    second.setTranslation(own)
    return hits
