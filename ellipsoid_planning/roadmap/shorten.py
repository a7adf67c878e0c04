"""Shortening a path by proved shortcuts between random points of it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels.shortcut import shortcut
from ellipsoid_planning.metric import path_length, segment_lengths

Array = NDArray[np.float64]

_ATTEMPTS = 200


def shorten(
    cspace: CSpace, path: Array, random: np.random.Generator, should_stop: Callable[[], bool]
) -> Array:
    """A path of poses (m, 7) with the same ends, at most as long in OMPL's metric.

    Tries 200 shortcuts between points drawn along the path; each is taken if it is shorter and
    all of its motions are proved.
    """
    current = cspace.configurations(path)
    for _ in range(_ATTEMPTS):
        if should_stop():
            break
        trial = _with_shortcut(cspace, current, *np.sort(random.random(2)))
        if trial is not None:
            current = trial
    return cspace.poses(current)


def without_detours(cspace: CSpace, configurations: Array) -> Array:
    """Those states of a certified path (m, d), its ends among them, that proved shortcuts leave.

    A path whose ends or motions do not stand the rounding stays as it is.
    """
    path = cspace.poses(configurations)
    kept = np.zeros(len(path), dtype=np.bool_)
    shortcut(cspace.model, path, kept)
    rows = configurations[kept]
    return rows if bool(cspace.are_motions_valid(rows[:-1], rows[1:]).all()) else configurations


def _with_shortcut(cspace: CSpace, path: Array, first: float, last: float) -> Array | None:
    """The path with its piece between two fractions of its length replaced, or None."""
    robot = cspace.robot
    ends = np.concatenate([[0.0], np.cumsum(segment_lengths(robot, path))])
    i, a = _point_at(cspace, path, ends, first * ends[-1])
    j, b = _point_at(cspace, path, ends, last * ends[-1])
    if i == j:
        return None
    trial = np.vstack([path[: i + 1], a, b, path[j + 1 :]])
    if not path_length(robot, trial) < (1.0 - 1e-9) * ends[-1]:
        return None
    # The cut motions are proved anew: a part of a slerp is the same motion up to rounding only.
    first_rows = np.array([path[i], a, b])
    last_rows = np.array([a, b, path[j + 1]])
    return trial if bool(cspace.are_motions_valid(first_rows, last_rows).all()) else None


def _point_at(cspace: CSpace, path: Array, ends: Array, length: float) -> tuple[int, Array]:
    k = min(int(np.searchsorted(ends, length, side="right")) - 1, len(path) - 2)
    span = ends[k + 1] - ends[k]
    s = (length - ends[k]) / span if span > 0.0 else 0.0
    return k, cspace.interpolate(path[k], path[k + 1], s)
