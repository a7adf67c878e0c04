"""The narrowest openings of a world: between two bodies, three, or a body and an arena's wall.

They are gates (`roadmap.gates`), looked at for what they are rather than where to plan through.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.fitting import narrowest_directions, width
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.clearance import inner_clearance
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.geometry.dual import containment_of, gap
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.kernels import centring
from ellipsoid_planning.roadmap.gates import GateFinder, only_translates, probe

Array = NDArray[np.float64]

MOST_BODIES = 400
# A body bounds an opening if its distance from what fills it differs by no more than this.
_EVEN = 3e-3
_DIRECTIONS = 2000


@dataclass(frozen=True, eq=False)
class Opening:
    """A narrowest place between bodies.

    Attributes:
        bodies: their names; "the boundary of" an arena is one.
        point: where it is (n,): for robots that turn the middle, else the base's position.
        gap: the width between two bodies, or the diameter of the largest ball among three; for
            a robot that only translates what it fills of that, and the play.
        width: the robot's least width; among three bodies the diameter of the largest ball that
            a part holds. For robots that only translate, the width across the opening.
        play: gap less width and twice the clearance asked for; negative: it cannot get through.
    """

    bodies: tuple[str, ...]
    point: Array
    gap: float
    width: float
    play: float


def narrowest_openings(
    cspace: CSpace, count: int = 5, should_stop: Callable[[], bool] | None = None
) -> list[Opening]:
    """Return the narrowest openings, by their play, at most ``count``.

    Openings that another body fills are left out and, for robots that only translate, those at
    arenas' walls.
    Only the ``MOST_BODIES`` obstacles nearest to the middle of the bounds are looked at.

    Args:
        cspace: of a robot whose base moves.
        count: how many to return.
        should_stop: asked again and again; what was found until then is returned.
    """
    stop = should_stop if should_stop is not None else _never
    found: list[Opening] = []
    widest, size = cspace.reach, float(np.max(cspace.world.high - cspace.world.low))
    # Narrow ones first: there are so many more pairs and triples of bodies farther apart.
    while len(found) < count and not stop():
        found = _openings(cspace, widest, stop)
        if widest >= size:
            break
        widest *= 4.0
    return sorted(found, key=lambda one: one.play)[:count]


def load_kernels(cspace: CSpace) -> None:
    """Load or compile what looking for openings calls, so that a time limit is its own."""
    work = centring.new_workspace(cspace.scene)
    GateFinder(cspace, *probe(cspace), 1.0, work).compile_kernels()
    ball = Ellipsoid.from_semi_axes(np.ones(cspace.dimension))
    gap(ball, ball)
    containment_of(ball, ball)


def least_width(cspace: CSpace) -> float:
    """The least width of the robot over all directions, a lower bound of it if it has joints."""
    if isinstance(cspace, ArticulatedCSpace):
        return 2.0 * max(float(part.semi_axes.min()) for part in cspace.articulated.parts)
    return float(width(cspace.robot, narrowest_directions(cspace.robot)[:1])[0])


def until(seconds: float) -> Callable[[], bool]:
    """A `should_stop` that says so after some time."""
    end = time.perf_counter() + seconds
    return lambda: time.perf_counter() >= end


def _openings(cspace: CSpace, widest: float, should_stop: Callable[[], bool]) -> list[Opening]:
    """Openings that leave the probe no more than ``widest`` on each side, one for any bodies."""
    parts, placed = probe(cspace)
    finder = GateFinder(cspace, parts, placed, widest, centring.new_workspace(cspace.scene))
    bodies, probes = _bodies(cspace), _probes(cspace, placed)
    middle = np.zeros(3)
    middle[: cspace.dimension] = 0.5 * (cspace.world.low + cspace.world.high)
    walls = _at_walls(cspace, bodies, 2.0 * widest, should_stop)
    found = {one.bodies: one for one in walls}
    for gate in finder.gates(bodies, middle, middle):
        if should_stop():
            break
        if gate is None:
            continue
        opening = _opening(cspace, probes, gate.point, gate.gap, gate.normals)
        if opening is not None:
            known = found.get(opening.bodies, opening)
            found[opening.bodies] = min(known, opening, key=lambda one: one.play)
    return list(found.values())


def _never() -> bool:
    return False


def _bodies(cspace: CSpace) -> list[int]:
    centres = np.array([body.centre for body in cspace.world.obstacles])
    if len(centres) <= MOST_BODIES:
        return list(range(len(centres)))
    away = np.linalg.norm(centres - 0.5 * (cspace.world.low + cspace.world.high), axis=1)
    return sorted(np.argsort(away, kind="stable")[:MOST_BODIES].tolist())


def _probes(cspace: CSpace, placed: Array) -> list[Ellipsoid]:
    """What gates are looked for with, as bodies: a ball, or the parts of a translating robot."""
    n = cspace.dimension
    if not only_translates(cspace):
        return [Ellipsoid.from_semi_axes(np.full(n, placed[0, 3]), np.zeros(n))]
    pose = np.zeros(cspace.robot.configuration_size)
    return list(cspace.robot.bodies_at(pose))


def _opening(
    cspace: CSpace, probes: list[Ellipsoid], point: Array, room: float, normals: Array
) -> Opening | None:
    """The opening of a gate, None if other bodies fill it or walls do."""
    n = cspace.dimension
    at = point[:n]
    identity = np.eye(n)
    moved = [body.transform(identity, at) for body in probes]
    if not _inside(cspace, moved):
        return None
    size = max(float(body.semi_axes.max()) for body in moved)
    slack = _EVEN * max(room, size)
    names = []
    for obstacle in cspace.world.obstacles:
        if not _is_near(obstacle, moved, room + slack):
            continue
        distance = min(gap(obstacle, body).value for body in moved)
        if distance < room - slack:
            return None
        if distance <= room + slack:
            names.append(obstacle.name)
    if len(names) < len(normals):
        return None
    return _measured(cspace, tuple(names[: len(normals)]), at, room, normals[0, :n])


def _measured(
    cspace: CSpace, names: tuple[str, ...], at: Array, room: float, normal: Array
) -> Opening:
    clearance = 2.0 * cspace.clearance_required
    if only_translates(cspace):
        robot = cspace.robot
        across = normal if robot.orientation is None else normal @ robot.orientation
        filled = float(width(robot, across[None])[0])
        return Opening(names, at, filled + 2.0 * room, filled, 2.0 * room - clearance)
    ball = 2.0 * max(float(part.semi_axes.min()) for part in cspace.robot.parts)
    opening = ball + 2.0 * room
    needed = least_width(cspace) if len(names) == 2 else ball
    return Opening(names, at, opening, needed, opening - needed - clearance)


def _at_walls(
    cspace: CSpace,
    bodies: list[int],
    longest: float,
    should_stop: Callable[[], bool],
) -> list[Opening]:
    """Where obstacles come nearest to the boundary of an arena, if they do not cross it."""
    if only_translates(cspace):
        return []
    found: list[Opening] = []
    needed, clearance = least_width(cspace), 2.0 * cspace.clearance_required
    for arena in cspace.world.arenas:
        for index in bodies:
            if should_stop():
                return found
            obstacle = cspace.world.obstacles[index]
            if containment_of(obstacle, arena).extent >= 1.0:
                continue
            room = inner_clearance(arena, obstacle)
            if 0.0 < room < longest:
                names = (obstacle.name, f"the boundary of {arena.name}")
                at = _beside(obstacle, arena)
                found.append(Opening(names, at, room, needed, room - needed - clearance))
    return found


def _beside(obstacle: Ellipsoid, arena: Ellipsoid) -> Array:
    """About the middle of the narrowest place between an obstacle and the arena's boundary."""
    u = unit_directions(obstacle.dimension, _DIRECTIONS)
    room = arena.support(u) - obstacle.support(u)
    k = int(np.argmin(room))
    return np.asarray(obstacle.support_points(u[k : k + 1])[0] + 0.5 * room[k] * u[k])


def _inside(cspace: CSpace, moved: list[Ellipsoid]) -> bool:
    world = cspace.world
    return all(
        containment_of(body, arena).extent <= 1.0 for body in moved for arena in world.arenas
    )


def _is_near(obstacle: Ellipsoid, moved: list[Ellipsoid], distance: float) -> bool:
    reach = float(obstacle.semi_axes.max()) + distance
    return any(
        float(np.linalg.norm(obstacle.centre - body.centre)) <= reach + float(body.semi_axes.max())
        for body in moved
    )
