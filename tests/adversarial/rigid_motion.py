"""Where a rigid robot's parts are along OMPL's motions, in long double, and how close they come.

Written anew from the description of the motion; nothing of the kernels is used.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import Scenario
from tests.adversarial.judge import (
    Wide,
    are_closer,
    gaps,
    room_along,
    rooms,
    sticking_out,
    wide,
)
from tests.motion_oracle import local_minima

# OMPL does not turn by less than about 9e-5 rad; up to 1e-4 a proof must hold for either way.
HELD = 1e-4
# Headings and quaternions whose difference is this close to a half turn may go either way.
TIE = 1e-12
_TURN = 2 * np.arctan2(np.longdouble(0), np.longdouble(-1))


class Track(NamedTuple):
    """A motion: from ``position`` by ``move``, turned by up to ``angle`` about ``axis``."""

    position: Wide
    move: Wide
    frame: Wide
    axis: Wide
    angle: np.longdouble

    def at(self, s: NDArray[np.floating]) -> tuple[Wide, Wide]:
        """Base positions (m, n) and rotations (m, n, n) at ``s`` (m,)."""
        t, n = wide(s), len(self.position)
        turns = _about(self.axis, t * self.angle)[:, :n, :n] @ self.frame[:n, :n]
        return self.position + t[:, None] * self.move, turns


class Closest(NamedTuple):
    """The least gap to an obstacle, or room to an arena, of all tracks, and where it is."""

    gap: float
    track: Track
    s: float
    part: int
    body: int
    is_arena: bool
    normal: Wide


def _about(axis: Wide, angles: Wide) -> Wide:
    """Rotations (m, 3, 3) by angles (m,) about a unit axis (3,)."""
    x, y, z = axis
    cross = wide([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    # 1 − cos as a product keeps its digits at small angles.
    half = np.sin(angles / 2)
    return (
        wide(np.eye(3))
        + np.sin(angles)[:, None, None] * cross
        + (2 * half * half)[:, None, None] * (cross @ cross)
    )


def _spatial(q: NDArray[np.float64]) -> Wide:
    """The rotation (3, 3) of a quaternion of any length."""
    v, w = wide(q[:3]), np.longdouble(q[3])
    square = (v * v).sum() + w * w
    cross = wide([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return wide(np.eye(3)) + 2 / square * (w * cross + cross @ cross)


def tracks(robot: RigidRobot, first: NDArray[np.float64], last: NDArray[np.float64]) -> list[Track]:
    """All motions that OMPL may make of a pair of configurations (d,)."""
    n = robot.dimension
    position, move = wide(first[:n]), wide(last[:n]) - wide(first[:n])
    still, up = np.longdouble(0), wide([0, 0, 1])
    if not robot.rotates:
        return [Track(position, move, wide(robot.orientation), up, still)]
    if n == 2:
        begin = np.longdouble(first[2])
        angle = np.longdouble(last[2]) - begin
        angle = angle - _TURN * np.rint(angle / _TURN)
        frame = _about(up, wide([begin]))[0]
        return [Track(position, move, frame, up, a) for a in _ways(angle)]
    p, q = wide(first[3:]), wide(last[3:])
    p, q = p / np.sqrt((p * p).sum()), q / np.sqrt((q * q).sum())
    v = p[3] * q[:3] - q[3] * p[:3] + np.cross(p[:3], q[:3])
    sine, cosine = np.sqrt((v * v).sum()), (p * q).sum()
    axis = v / sine if sine > 0 else up
    angle = 2 * np.arctan2(sine, cosine)
    angle = angle - _TURN * np.rint(angle / _TURN)
    frame = _spatial(first[3:])
    found = [Track(position, move, frame, axis, a) for a in _ways(angle)]
    if abs(angle) < HELD:
        found.append(Track(position, move, frame, axis, still))
        found.append(Track(position + move, 0 * move, _spatial(last[3:]), axis, still))
    return found


def _ways(angle: np.longdouble) -> list[np.longdouble]:
    """The angle, and at a half turn the other way round too."""
    if abs(angle) < _TURN / 2 - TIE:
        return [angle]
    return [angle, angle - _TURN * np.sign(angle)]


def closest(
    scenario: Scenario,
    first: NDArray[np.float64],
    last: NDArray[np.float64],
    hints: tuple[float, ...] = (),
    count: int = 49,
    *,
    zoom: bool = True,
) -> Closest:
    """The place where all that OMPL may do between two configurations comes closest to a body.

    Gaps are sampled and, to ``zoom``, narrowed down about the lowest samples; ``hints`` are looked
    at too.
    """
    s = np.unique(np.concatenate([np.linspace(0, 1, count), hints]))
    found = [
        place
        for track in tracks(scenario.robot, first, last)
        for pair in _pairs(scenario)
        for place in _lowest(scenario, track, pair, s, zoom)
    ]
    return min(found, key=lambda place: place.gap)


def _pairs(scenario: Scenario) -> Iterator[tuple[int, int, bool]]:
    for i in range(len(scenario.robot.parts)):
        yield from ((i, j, False) for j in range(len(scenario.world.obstacles)))
        yield from ((i, j, True) for j in range(len(scenario.world.arenas)))


def values(
    scenario: Scenario, track: Track, pair: tuple[int, int, bool], s: NDArray[np.floating]
) -> tuple[Wide, Wide]:
    """Gaps or rooms (m,) of a pair at ``s`` (m,), with unit normals (m, n).

    Normals point from obstacles to the part, and out of arenas. The room of a scenario without
    clearance is in units of the arena's smallest semi-axis, as an extent tells best whether a thin
    part sticks out, and has no normal; else it is the distance from the wall.
    """
    i, j, is_arena = pair
    body = (scenario.world.arenas if is_arena else scenario.world.obstacles)[j]
    c, matrices = _relative(scenario, track, i, body, s)
    own = wide(body.matrix)
    if not is_arena:
        return gaps(c, np.broadcast_to(own, matrices.shape), matrices)
    if scenario.clearance > 0.0:
        return rooms(own, c, matrices)
    return (1 - sticking_out(own, c, matrices)) * body.semi_axes.min(), np.zeros_like(c)


def _relative(scenario, track, i, body, s):
    """Centres (m, n) of part ``i`` relative to a body's, and its matrices (m, n, n), at ``s``."""
    part = scenario.robot.parts[i]
    positions, turns = track.at(s)
    return positions - wide(body.centre) + turns @ wide(part.centre), turns @ wide(part.matrix)


def _lowest(scenario, track, pair, s, zoom):
    """The lowest places of one pair along one track."""
    found, normals = values(scenario, track, pair, s)
    places = []
    for k in local_minima(found)[: 3 if zoom else 1]:
        low, high = s[max(k - 1, 0)], s[min(k + 1, len(s) - 1)]
        best = found[k], s[k], normals[k]
        for _ in range(7 if zoom else 0):
            near = np.linspace(low, high, 11)
            trial, directions = values(scenario, track, pair, near)
            j = int(trial.argmin())
            if trial[j] < best[0]:
                best = trial[j], near[j], directions[j]
            low, high = near[max(j - 1, 0)], near[min(j + 1, 10)]
        places.append(Closest(float(best[0]), track, float(best[1]), *pair, best[2]))
    return places


def is_proved_closer(scenario: Scenario, place: Closest) -> bool:
    """Whether the scenario's clearance is proved to be missed at a place."""
    bodies = scenario.world.arenas if place.is_arena else scenario.world.obstacles
    body = bodies[place.body]
    c, matrices = _relative(scenario, place.track, place.part, body, np.array([place.s]))
    own = wide(body.matrix)
    if place.is_arena and scenario.clearance == 0.0:
        return bool(sticking_out(own, c, matrices)[0] > 1)
    if place.is_arena:
        return bool(room_along(own, c, matrices, place.normal[None])[0] < scenario.clearance)
    return are_closer(c[0], own, matrices[0], place.normal, scenario.clearance)
