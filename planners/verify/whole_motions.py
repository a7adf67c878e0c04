"""Decides whole motions, between the samples too: what is proved, and what could not be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.scenario import Scenario
from planners.verify.arena_rooms import InsideArenas
from planners.verify.intervals import Places
from planners.verify.motion import speeds
from planners.verify.questions import Bodies, FromItself, FromObstacles
from planners.verify.resolution import Place, Resolution, resolve, undecided_share
from planners.verify.self_collision import self_pairs
from planners.verify.unrolled import Motions, unrolled

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class WholeMotions:
    """What is known of all that a path passes through.

    Attributes:
        contacts: places, one a kind, where bodies certainly meet.
        unproved: the place of the smallest gap that could not be proved, None if all were.
        nearest: the place nearest to an obstacle or an arena's boundary that was looked at.
        undecided: motions of which it is not known which way OMPL turns.
        resolved: the share of the path, by the robot's largest travel, that is proved.
    """

    contacts: tuple[Place, ...]
    unproved: Place | None
    nearest: Place | None
    undecided: tuple[int, ...]
    resolved: float

    @property
    def proved(self) -> bool:
        """Whether the whole path keeps apart from everything."""
        return not self.contacts and self.unproved is None and not self.undecided

    def contact(self, kind: str) -> Place | None:
        """The contact of a kind, if there is one."""
        return next((place for place in self.contacts if place.kind == kind), None)


def prove_motions(
    scenario: Scenario, path: Array, needed: float, *, itself: bool = True
) -> WholeMotions:
    """Prove that a path (m, d) keeps ``needed`` from what is around, and parts off each other.

    The latter only if ``itself`` is asked for.
    """
    robot, world = scenario.robot, scenario.world
    motions, n = unrolled(robot, path), scenario.dimension
    around = [_resolved(motions, FromObstacles, Bodies.of(world.obstacles, n), needed)]
    around.append(_resolved(motions, InsideArenas, Bodies.of(world.arenas, n), needed))
    found, pairs = [*around], self_pairs(robot) if itself else []
    if pairs:
        places = Places(motions, from_base=True)
        found.append(resolve(motions, places, FromItself(motions, pairs)))
    worst = [one.worst for one in found if one.worst is not None]
    return WholeMotions(
        tuple(place for place in worst if place.meet),
        min((p for p in worst if not p.meet), key=lambda place: place.gap, default=None),
        min(
            (one.nearest for one in around if one.nearest is not None),
            key=lambda place: place.distance,
            default=None,
        ),
        tuple(sorted(motions.undecided)),
        1.0 - max(undecided_share(one, _lengths(path, motions)) for one in found),
    )


def _resolved(
    motions: Motions,
    question: type[FromObstacles | InsideArenas],
    bodies: Bodies,
    needed: float,
) -> Resolution:
    if not bodies.names:
        return Resolution(None, None, np.zeros((0, 3)))
    return resolve(motions, Places(motions), question(motions, bodies, needed))


def _lengths(path: Array, motions: Motions) -> Array:
    """How far (M,) the robot travels in each motion."""
    second = np.vstack([path[1:], path[-1:]])
    return speeds(motions.robot, path, second)[motions.index]
