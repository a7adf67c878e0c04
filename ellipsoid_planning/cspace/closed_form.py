"""The closed form of free motion (thesis 5.5.2) as bounds of a whole C-space's free volume.

The thesis has one ellipsoid in one ellipsoidal arena. Whatever keeps the whole robot free keeps
each part free in each arena, so that every such pair gives an upper bound; parts of a body that
turns are measured alike, wherever they sit on it (the measure of motions is invariant). Where
there is no arena the bounds of the base take its place.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.layer_sequence import whole_measure
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.free_motion import free_motion_volume
from ellipsoid_planning.geometry.motion_volume import meeting_motions
from ellipsoid_planning.geometry.rotation_ranges import single_rotation

NAMED = 3
# Obstacles that are subtracted, the largest; conditions are on pairs of them.
MOST_OBSTACLES = 100
MOST_OF_SEVERAL = 30


@dataclass(frozen=True)
class ClosedForm:
    """Bounds of the free volume of a C-space.

    Attributes:
        kind: "exact" if ``lower`` and ``upper`` are the volume, else "bounds".
        lower: contained less all blocked motions, at least 0; it counts what is blocked twice
            twice. None where the formula does not apply.
        upper: an upper bound, in the units of `whole_measure`.
        reasons: why they are not the volume itself; empty if they are.
    """

    kind: Literal["exact", "bounds"]
    lower: float | None
    upper: float
    reasons: tuple[str, ...]


def closed_form(cspace: CSpace) -> ClosedForm:
    """Return the closed form's bounds of a C-space's free volume (thesis 5.5.2)."""
    parts = _parts(cspace)
    whole = whole_measure(cspace)
    if parts is None:
        reason = "joints turn parts in a way that no kinematic formula covers"
        return ClosedForm("bounds", None, whole, (reason,))
    world = cspace.world
    if not world.arenas:
        return _in_bounds(cspace, parts, whole)
    joints = whole / _base_measure(cspace)
    pairs = [(arena, part) for part in parts for arena in world.arenas]
    obstacles = _largest(
        world.obstacles, MOST_OBSTACLES if len(pairs) == 1 else MOST_OF_SEVERAL // len(pairs) + 1
    )
    found = [
        free_motion_volume(arena, obstacles, part, rotates=cspace.rotates) for arena, part in pairs
    ]
    upper = min(whole, *(joints * one.upper for one in found))
    reasons = _general_reasons(cspace, parts)
    if len(pairs) == 1 and len(obstacles) < len(world.obstacles):
        reasons += (f"only the {len(obstacles)} largest obstacles are subtracted",)
    lower = None
    if not reasons:
        lower = min(found[0].value, upper)
        reasons += tuple(
            f"{c.first} and {c.second} are {max(c.distance, 0.0):.4g} apart, but the robot "
            f"reaches over {c.needed:.4g}"
            for c in found[0].failing[:NAMED]
        )
        if len(found[0].failing) > NAMED:
            reasons += (f"and {len(found[0].failing) - NAMED} more such pairs",)
    return ClosedForm("bounds" if reasons else "exact", lower, upper, reasons)


def _largest(obstacles: tuple[Ellipsoid, ...], count: int) -> list[Ellipsoid]:
    """The largest obstacles by volume, in their order; less subtracted still bounds from above."""
    volumes = [float(np.prod(body.semi_axes)) for body in obstacles]
    chosen = np.argsort(-np.array(volumes), kind="stable")[:count]
    return [obstacles[index] for index in sorted(chosen.tolist())]


def _general_reasons(cspace: CSpace, parts: list[Ellipsoid]) -> tuple[str, ...]:
    """What keeps the formula from being more than an upper bound, pairs of bodies aside."""
    world = cspace.world
    reasons = []
    if isinstance(cspace, ArticulatedCSpace):
        reasons.append("the robot has joints")
    if len(parts) > 1:
        reasons.append(f"the robot has {len(parts)} parts, not one")
    if len(world.arenas) > 1:
        reasons.append(f"there are {len(world.arenas)} arenas, not one")
    if cspace.clearance_required > 0.0:
        reasons.append("a clearance is asked for")
    if len(parts) == 1 and len(world.arenas) == 1 and not _holds_arena(cspace, parts[0]):
        reasons.append("the bounds of the base cut off a part of the arena")
    return tuple(reasons)


def _in_bounds(cspace: CSpace, parts: list[Ellipsoid], whole: float) -> ClosedForm:
    """Without an arena: the bounds' volume less what each part and obstacle block."""
    rotations = None if cspace.rotates else single_rotation(np.eye(cspace.dimension))
    joints = whole / _base_measure(cspace)
    blocked = [
        joints * meeting_motions(obstacle, part, rotations).value
        for part in parts
        for obstacle in cspace.world.obstacles
    ]
    reasons = ["there is no arena, so that motions beyond the bounds count as blocked"]
    if not blocked and not isinstance(cspace, ArticulatedCSpace):
        return ClosedForm("exact", whole, whole, ())
    usable = cspace.clearance_required == 0.0 and not isinstance(cspace, ArticulatedCSpace)
    if not usable:
        reasons += _general_reasons(cspace, parts[:1])
    return ClosedForm(
        "bounds", max(whole - sum(blocked), 0.0) if usable else None, whole, tuple(reasons)
    )


def _parts(cspace: CSpace) -> list[Ellipsoid] | None:
    """The parts at the orientation they are measured at; None if that varies with joints."""
    if isinstance(cspace, ArticulatedCSpace):
        return list(cspace.articulated.parts) if cspace.rotates else None
    parts = list(cspace.robot.parts)
    if cspace.rotates or cspace.robot.orientation is None:
        return parts
    still = np.zeros(cspace.dimension)
    return [part.transform(cspace.robot.orientation, still) for part in parts]


def _base_measure(cspace: CSpace) -> float:
    """The measure of the base's motions within the bounds."""
    from ellipsoid_planning.geometry.kinematic import ALL_ROTATIONS

    volume = float(np.prod(cspace.world.high - cspace.world.low))
    return volume * (ALL_ROTATIONS[cspace.dimension] if cspace.rotates else 1.0)


def _holds_arena(cspace: CSpace, part: Ellipsoid) -> bool:
    """Whether every base position with the part in the arena surely lies in the bounds."""
    arena, world = cspace.world.arenas[0], cspace.world
    n = cspace.dimension
    axes = np.eye(n)
    if cspace.rotates:
        # The part's centre is this far inside, and the base at most its offset away from it.
        room = arena.support(axes) - arena.centre - float(np.min(part.semi_axes))
        room = room + float(np.linalg.norm(part.centre))
        centre = arena.centre
    else:
        turned = Ellipsoid.from_semi_axes(part.semi_axes, np.zeros(n), part.rotation)
        room = arena.support(axes) - arena.centre - turned.support(axes)
        centre = arena.centre - part.centre
    slack = 1e-9 * float(np.max(world.high - world.low))
    low, high = centre - room, centre + room
    return bool(np.all(low >= world.low - slack) and np.all(high <= world.high + slack))
