"""Obstacles that a part grazes once and meets later: tiny gaps that at first grow quickly."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from tests import oracles, random_scenes
from tests.adversarial.judge import Wide, wide
from tests.adversarial.rigid_motion import Track, tracks, values
from tests.adversarial.rigid_setups import Setup, ellipsoid
from tests.random_scenes import Rng

Array = NDArray[np.float64]

_POINTS = 96
_SAMPLES = np.linspace(0.0, 1.0, 65)
_SOON = 1e-3


def grazed_point(rng: Rng, case: Setup, start: float) -> tuple[Array, Array, float] | None:
    """A point on the part's surface at ``start`` that it leaves and later covers again.

    Returns the point (n,), the part's outward normal there and the parameter at which the point is
    deepest inside; None if no such point is found.
    """
    part, n = case.robot.parts[0], case.dimension
    track = tracks(case.robot, case.first, case.last)[0]
    ball = oracles.sphere_grid(_POINTS, n) @ random_scenes.rotation(rng, n).T
    normals = (ball / part.semi_axes) @ part.rotation.T
    positions, turns = _at(track, np.array([start]))
    points = positions[0] + (part.centre + ball @ part.matrix.T) @ turns[0].T
    s = np.concatenate([_SAMPLES, [start - _SOON, start + _SOON]])
    positions, turns = _at(track, s)
    own = np.einsum("sji,skj->ski", turns, points[None] - positions[:, None]) - part.centre
    sizes = np.linalg.norm(own @ part.rotation / part.semi_axes, axis=2)
    best: list[tuple[float, int, float]] = []
    for side, soon in ((start > _SAMPLES, sizes[-2]), (start < _SAMPLES, sizes[-1])):
        if side.any():
            later = sizes[:-2][side]
            deepest = later.min(axis=0)
            where = _SAMPLES[side][later.argmin(axis=0)]
            best += [
                (float(deepest[k]), int(k), float(where[k]))
                for k in np.flatnonzero((soon > 1.0) & (deepest < 0.95))
            ]
    if not best:
        return None
    _, k, where = sorted(best)[int(rng.integers(min(len(best), 8)))]
    normal = turns[0] @ normals[k]
    return points[k], normal / np.linalg.norm(normal), where


def passing(rng: Rng, case: Setup) -> tuple[Setup, Array, float] | None:
    """A piece of the motion in whose middle the part passes a point that it hits on one side.

    Returns the piece, the point (n,) and how far from the part it stays till the middle, in units
    of the part's smallest semi-axis; None if no such point is found.
    """
    part, n = case.robot.parts[0], case.dimension
    track, s = tracks(case.robot, case.first, case.last)[0], np.linspace(0.0, 1.0, 129)
    positions, turns = _at(track, s)
    k = rng.integers(len(s), size=1500)
    ball = rng.normal(size=(1500, n))
    ball *= (rng.uniform(1.0, 1.1, 1500) / np.linalg.norm(ball, axis=1))[:, None]
    points = positions[k] + np.einsum("kij,kj->ki", turns[k], part.centre + ball @ part.matrix.T)
    own = np.einsum("sji,skj->ski", turns, points[None] - positions[:, None]) - part.centre
    sizes = np.linalg.norm(own @ part.rotation / part.semi_axes, axis=2)
    lowest = (sizes[1:-1] < sizes[:-2]) & (sizes[1:-1] < sizes[2:])
    lowest &= (sizes[1:-1] > 1.0005) & (sizes[1:-1] < 1.1)
    for i, which in rng.permutation(np.argwhere(lowest)):
        middle = int(i) + 1
        half = min(middle, len(s) - 1 - middle)
        before = sizes[middle - half : middle + 1, which].min()
        after = sizes[middle : middle + half + 1, which].min()
        if min(before, after) < 0.9 and max(before, after) > 1.0:
            ends = [_configuration(track, s[middle + m * half]) for m in (-1, 1)]
            piece = Setup(case.robot, *ends, case.clearance).scenario()
            room = float(sizes[middle, which]) - 1.0
            return (
                case._replace(first=piece.start, last=piece.goal),
                points[which],
                min(room, float(max(before, after)) - 1.0),
            )
    return None


def centred(case: Setup, body: Ellipsoid) -> Setup:
    """The piece of the motion in whose middle the gap is least of those near its middle."""
    for width in (0.05, 1e-3, 2e-5):
        track = tracks(case.robot, case.first, case.last)[0]
        s = 0.5 + width * np.linspace(-1.0, 1.0, 31)
        found, _ = values(case.scenario((body,)), track, (0, 0, False), s)
        middle = s[int(found.argmin())]
        half = min(middle, 1.0 - middle)
        ends = [_configuration(track, middle + m * half) for m in (-1, 1)]
        piece = Setup(case.robot, *ends, case.clearance).scenario()
        case = case._replace(first=piece.start, last=piece.goal)
    return case


def _configuration(track: Track, s: float) -> Array:
    """The configuration (d,) of a robot that rotates, at ``s``."""
    positions, turns = _at(track, np.array([s]))
    if len(positions[0]) == 2:
        return np.append(positions[0], np.arctan2(turns[0, 1, 0], turns[0, 0, 0]))
    return np.append(positions[0], Rotation.from_matrix(turns[0]).as_quat())


def _at(track: Track, s: Array) -> tuple[Array, Array]:
    positions, turns = track.at(s)
    return np.asarray(positions, dtype=float), np.asarray(turns, dtype=float)


def beside(body: Ellipsoid, point: Array | Wide, normal: Array, gap: float) -> Ellipsoid:
    """The body where it is ``gap`` away from the point that has this outward normal."""
    u = wide(normal)
    u = u / np.sqrt((u * u).sum())
    centre = wide(point) + np.longdouble(gap) * u + random_scenes.boundary_point(body.matrix, u)
    return Ellipsoid(np.asarray(centre, dtype=float), body.rotation, body.semi_axes, body.name)


def surface_point(case: Setup, start: float, normal: Array) -> Wide:
    """The point of the part at ``start`` that has this outward normal."""
    return point_on(
        case.robot.parts[0], tracks(case.robot, case.first, case.last)[0], start, normal
    )


def point_on(part: Ellipsoid, track: Track, start: float, normal: Array) -> Wide:
    """The point of a part at ``start`` of a track that has this outward normal."""
    positions, turns = track.at(np.array([start]))
    back = turns[0].T @ wide(normal)
    own = wide(part.centre) + random_scenes.boundary_point(part.matrix, back)
    return positions[0] + turns[0] @ own


def small_body(rng: Rng, case: Setup, ratio: float) -> Ellipsoid:
    """An obstacle of any size up to the part's."""
    size = float(case.robot.parts[0].semi_axes.max()) * 10 ** rng.uniform(-2.5, 0.0)
    return ellipsoid(rng, case.dimension, ratio, size)
