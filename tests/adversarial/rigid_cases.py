"""Kinds of motions of rigid robots, each aimed at another place where a proof may cancel.

A kind makes scenarios whose motion is that from start to goal. Those of one case differ by hairs
only, so that some of them lie where a number is all rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.scenario import Scenario
from tests import random_scenes
from tests.adversarial.rigid_grazes import (
    beside,
    centred,
    grazed_point,
    passing,
    point_on,
    small_body,
    surface_point,
)
from tests.adversarial.rigid_motion import closest, tracks
from tests.adversarial.rigid_proofs import aimed, put_in_the_way
from tests.adversarial.rigid_setups import Setup, ellipsoid, lever_past_a_post, margin, setup
from tests.random_scenes import Rng

Array = NDArray[np.float64]


class Case(NamedTuple):
    """Scenarios that differ by hairs, where to look for contacts, and what has to be certified.

    ``free`` says of each scenario whether it is free by more than the tolerance by construction;
    None leaves that to the judge.
    """

    scenarios: tuple[Scenario, ...]
    hints: tuple[float, ...] = ()
    free: bool | None = None


# --------------------------------------------------------------------------- grazes


def _hairs(rng: Rng, scenario: Scenario) -> list[float]:
    """Gaps to graze with: what proofs need, plus and minus anything from 1e-19 to 1e-6."""
    needed, size = margin(scenario), margin(scenario) / 1e-14
    levels = needed + size * 10 ** rng.uniform(-19, -13, 4)
    wide = size * 10 ** rng.uniform(-15, -6, 3)
    return [*(scenario.clearance + levels), *(scenario.clearance + wide), scenario.clearance]


def grazing(rng: Rng, case: Setup, start: float, ratio: float = 10.0) -> Case:
    """An obstacle grazes the part at ``start`` and is met later on."""
    found = grazed_point(rng, case, start)
    if found is None:
        return Case(())
    _, normal, where = found
    point, body = surface_point(case, start, normal), small_body(rng, case, ratio)
    plain = case.scenario((beside(body, point, normal, case.clearance),))
    scenarios = [case.scenario((beside(body, point, normal, gap),)) for gap in _hairs(rng, plain)]
    return Case(tuple(scenarios), (start, where))


def _dimension(rng: Rng) -> int:
    return int(rng.choice([2, 3]))


def graze_in_the_middle(rng: Rng) -> Case:
    """The first proof of a motion starts half-way."""
    return grazing(rng, setup(rng, _dimension(rng)), 0.5)


def graze_at_an_end(rng: Rng) -> Case:
    """Start or goal is valid by a hair only."""
    return grazing(rng, setup(rng, _dimension(rng)), float(rng.integers(2)))


def graze_in_a_piece(rng: Rng) -> Case:
    """Where later proofs start, and anywhere."""
    start = rng.choice([0.25, 0.75, 0.125, 0.625, rng.uniform()])
    return grazing(rng, setup(rng, _dimension(rng)), float(start))


def graze_by_a_needle(rng: Rng) -> Case:
    """Part and obstacle have axis ratios of up to a million."""
    ratio = 10 ** rng.uniform(2, 6)
    case = setup(rng, _dimension(rng), ratio=ratio)
    return grazing(rng, case, float(rng.choice([0.0, 0.5, 1.0, rng.uniform()])), ratio)


def graze_on_a_lever(rng: Rng) -> Case:
    """The part is up to a thousand of its sizes away from the base."""
    lever = 10 ** rng.uniform(0.5, 3)
    angle = rng.choice([rng.uniform(0.2, 3.1), 2.0 / lever])
    case = setup(rng, _dimension(rng), lever=lever, angle=float(angle))
    return grazing(rng, case, float(rng.choice([0.0, 0.5, 1.0, rng.uniform()])))


def graze_far_away(rng: Rng) -> Case:
    """Everything is up to ten million sizes away from the origin."""
    case = setup(rng, _dimension(rng), far=10 ** rng.uniform(2, 7))
    return grazing(rng, case, float(rng.choice([0.0, 0.5, 1.0, rng.uniform()])))


def graze_with_clearance(rng: Rng) -> Case:
    """A clearance has to be kept, from a millionth of the part's size to three times it."""
    case = setup(rng, _dimension(rng), clearance=10 ** rng.uniform(-6, 0.5))
    return grazing(rng, case, float(rng.choice([0.0, 0.5, 1.0, rng.uniform()])))


def graze_at_a_half_turn(rng: Rng) -> Case:
    """Half a turn, or nearly: OMPL may go round either way."""
    angle = np.pi - rng.choice([0.0, 10 ** rng.uniform(-17, -6)])
    case = setup(rng, _dimension(rng), angle=float(angle))
    return grazing(rng, case, float(rng.choice([0.0, 0.5, 1.0, rng.uniform()])))


def hit_while_held(rng: Rng) -> Case:
    """Below 9e-5 rad OMPL holds the first orientation to the end: then the part hits something."""
    angle = 10 ** rng.uniform(-9, np.log10(8.9e-5))
    step = float(rng.choice([0.0, angle, 1.0])) * 10 ** rng.uniform(-1, 1)
    lever = float(rng.choice([1.0, 1.0 / angle]))
    case = setup(rng, 3, ratio=10 ** rng.uniform(0, 5), lever=lever, angle=angle, step=step)
    held = tracks(case.robot, case.first, case.last)[-2]
    normal, start = random_scenes.unit_vector(rng, 3), float(rng.choice([1.0, rng.uniform()]))
    point = point_on(case.robot.parts[0], held, start, normal)
    body = small_body(rng, case, 10.0)
    size = margin(case.scenario()) / 1e-14
    gaps = [0.0, *(-size * 10 ** rng.uniform(-16, -6, 5))]
    return Case(tuple(case.scenario((beside(body, point, normal, g),)) for g in gaps), (start,))


# --------------------------------------------------------------------------- proofs


def hairy_proof(rng: Rng) -> Case:
    """A motion that collides, one of whose proofs rests on a value of next to nothing."""
    clearance = float(rng.choice([0.0, 0.0, 10 ** rng.uniform(-4, 0)]))
    ratio, far = (
        10 ** rng.uniform(0, rng.choice([1, 1, 4])),
        10 ** rng.uniform(-1, rng.choice([1, 5])),
    )
    step = float(rng.choice([rng.uniform(0, 2), rng.uniform(0, 20)]))
    case = setup(rng, _dimension(rng), ratio=ratio, far=float(far), clearance=clearance, step=step)
    body = put_in_the_way(rng, case, small_body(rng, case, ratio))
    return Case(aimed(case, body, int(rng.choice([0, 0, 1, 2, 3]))))


def pass_with_a_hairy_proof(rng: Rng) -> Case:
    """The part passes an obstacle half-way and hits it later; the first proof is all hairs."""
    ratio = 10 ** rng.uniform(0, rng.choice([1, 3]))
    case = setup(rng, _dimension(rng), ratio=ratio, angle=float(rng.uniform(1.0, 3.1)))
    found = passing(rng, case)
    if found is None:
        return Case(())
    piece, point, room = found
    size = room * float(case.robot.parts[0].semi_axes.min()) * rng.uniform(0.1, 1.0)
    body = ellipsoid(rng, case.dimension, float(rng.choice([1.0, 10.0])), size, point)
    piece = centred(piece, body)
    return Case(aimed(piece, body, int(rng.choice([0, 0, 0, 1]))), (0.5,))


def post_with_a_hairy_proof(rng: Rng) -> Case:
    """A hand on a lever passes a thin post and hits it later; the first proof is all hairs."""
    return Case(aimed(*lever_past_a_post(rng), 0), (0.5,))


# --------------------------------------------------------------------------- tuned least gaps


def _tolerance(scenario: Scenario, ratio: float) -> float:
    """The gap that has to be certified: ten times what the package says it may refuse."""
    scale = margin(scenario) / 1.4e-14
    return 1e-11 * scale * max(1.0, ratio / 1e4)


def least_gap(rng: Rng) -> Case:
    """An obstacle beside the motion, at a least gap of plus the tolerance."""
    n, ratio = _dimension(rng), 10 ** rng.uniform(0, 1.5)
    clearance = float(rng.choice([0.0, 10 ** rng.uniform(-4, 0)]))
    case = setup(rng, n, ratio=ratio, clearance=clearance)
    body = small_body(rng, case, ratio)
    normal = random_scenes.unit_vector(rng, n)
    body = beside(body, surface_point(case, rng.uniform(), normal), normal, clearance)
    return _tuned(case, body, ratio)


def least_gap_far_away(rng: Rng) -> Case:
    """The same a long way from the origin, on a lever."""
    case = setup(rng, _dimension(rng), far=10 ** rng.uniform(2, 6), lever=10 ** rng.uniform(0, 2))
    normal = random_scenes.unit_vector(rng, case.dimension)
    body = small_body(rng, case, 10.0)
    body = beside(body, surface_point(case, rng.uniform(), normal), normal, 0.0)
    return _tuned(case, body, 10.0)


def _tuned(case: Setup, body: Ellipsoid, ratio: float) -> Case:
    target = case.clearance + _tolerance(case.scenario((body,)), ratio)
    for _ in range(12):
        scenario = case.scenario((body,))
        place = closest(scenario, scenario.start, scenario.goal)
        missing = target - place.gap
        if abs(missing) < 0.02 * (target - case.clearance):
            return Case((scenario,), (place.s,), free=True)
        # From the body to the part: moving against it widens the gap.
        centre = body.centre - missing * np.asarray(place.normal, dtype=float)
        body = Ellipsoid(centre, body.rotation, body.semi_axes, body.name)
    return Case(())


# --------------------------------------------------------------------------- arenas


def _around(rng: Rng, case: Setup, ratio: float) -> Ellipsoid:
    """An arena about the place of the motion, of a size that does not matter yet."""
    n = case.dimension
    middle = 0.5 * (case.first[:n] + case.last[:n])
    size = 3.0 * (1.0 + float(np.linalg.norm(case.robot.parts[0].centre)))
    centre = middle + 0.3 * size * rng.uniform() * random_scenes.unit_vector(rng, n)
    return ellipsoid(rng, n, ratio, size, centre)


def _scaled(arena: Ellipsoid, factor: float) -> Ellipsoid:
    return Ellipsoid(arena.centre, arena.rotation, factor * arena.semi_axes, arena.name)


def _extent(case: Setup, arena: Ellipsoid, ends: bool) -> float:
    """How far the part reaches in the arena, at the ends or anywhere; 1 is its wall."""
    plain = case.scenario((), (arena,))
    hints = (0.0, 1.0)
    count = 2 if ends else 33
    place = closest(plain, plain.start, plain.goal, hints, count, zoom=not ends)
    return 1.0 - place.gap / float(arena.semi_axes.min())


def _arena_setup(rng: Rng, smallest: float = 1e-8) -> tuple[Setup, Ellipsoid]:
    ratio = float(rng.choice([3.0, 10 ** rng.uniform(0, 5)]))
    far = float(rng.choice([1.0, 10 ** rng.uniform(1, 6)]))
    angle = float(rng.choice([rng.uniform(0.2, 3.1), 10 ** rng.uniform(np.log10(smallest), -1)]))
    case = setup(rng, _dimension(rng), ratio=ratio, far=far, angle=angle)
    return case, _around(rng, case, float(rng.choice([2.0, 10 ** rng.uniform(0, 3)])))


def wall_at_the_ends(rng: Rng) -> Case:
    """Both ends are in the arena by a hair; between them the part may leave it."""
    case, arena = _arena_setup(rng)
    tight = _extent(case, arena, ends=True)
    hairs = [*(10 ** rng.uniform(-17, -13, 3)), *(10 ** rng.uniform(-13, -6, 3)), 0.0, -1e-15]
    arenas = [_scaled(arena, tight * (1.0 + hair)) for hair in hairs]
    return Case(tuple(case.scenario((), (a,)) for a in arenas), (0.0, 1.0))


def wall_by_a_hair(rng: Rng) -> Case:
    """The part leaves the arena by a hair somewhere on its way."""
    case, arena = _arena_setup(rng)
    tight = _extent(case, arena, ends=False)
    hairs = [*(10 ** rng.uniform(-15, -9, 4)), 1e-16]
    arenas = [_scaled(arena, tight * (1.0 - hair)) for hair in hairs]
    return Case(tuple(case.scenario((), (a,)) for a in arenas))


def wall_with_clearance(rng: Rng) -> Case:
    """At both ends, or all along, the part is the clearance away from the wall by a hair."""
    case, arena = _arena_setup(rng)
    arena = _scaled(arena, _extent(case, arena, ends=False) * (1.0 + 10 ** rng.uniform(-6, 1)))
    case = case._replace(clearance=1e-9)
    plain, ends = case.scenario((), (arena,)), rng.uniform() < 0.5
    place = closest(plain, plain.start, plain.goal, (0.0, 1.0), 2 if ends else 17, zoom=not ends)
    hairs = [0.0, *(10 ** rng.uniform(-15, -6, 3)), *(-(10 ** rng.uniform(-15, -9, 2)))]
    gaps = [place.gap * (1.0 - hair) for hair in hairs if place.gap > 0.0]
    scenarios = [case._replace(clearance=gap).scenario((), (arena,)) for gap in gaps]
    return Case(tuple(scenarios), (0.0, place.s, 1.0))


def room_at_the_wall(rng: Rng) -> Case:
    """The part stays in the arena by the tolerance."""
    # A smaller turn is certified only if it may also be left out.
    case, arena = _arena_setup(rng, 1e-3)
    tight = _extent(case, arena, ends=False)
    arena = _scaled(arena, tight)
    # Rounding is that of the scene's size in units of the arena's smallest semi-axis.
    plain = case.scenario((), (arena,))
    room = 1e-11 * (1.0 + margin(plain) / 1.4e-14 / float(arena.semi_axes.min()))
    return Case((case.scenario((), (_scaled(arena, 1.0 + room),)),), free=True)


GRAZES: tuple[Callable[[Rng], Case], ...] = (
    graze_in_the_middle,
    graze_at_an_end,
    graze_in_a_piece,
    graze_by_a_needle,
    graze_on_a_lever,
    graze_far_away,
    graze_with_clearance,
    graze_at_a_half_turn,
    hit_while_held,
    hairy_proof,
    pass_with_a_hairy_proof,
    post_with_a_hairy_proof,
)
WALLS: tuple[Callable[[Rng], Case], ...] = (wall_at_the_ends, wall_by_a_hair, wall_with_clearance)
FREE: tuple[Callable[[Rng], Case], ...] = (least_gap, least_gap_far_away, room_at_the_wall)


def kinds() -> Iterator[Callable[[Rng], Case]]:
    """All kinds, by name."""
    yield from GRAZES + WALLS + FREE
