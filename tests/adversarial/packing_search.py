"""Arrangements whose copies touch by a hair, in flat cells and far from them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World
from tests.adversarial import packing_judge as judge
from tests.adversarial.outcome import Counterexample, Outcome
from tests.crystal.packings import model_from, one_body_text

GROUPS = {2: ("p1", "p2", "pg", "pmg"), 3: ("P1", "P-1", "P21", "C2", "P212121", "P31")}
TOLERANCE = 1e-9


def drawn(rng: np.random.Generator, n: int) -> tuple[str, Any]:
    """The text of a model of one body, and the model."""
    group = str(rng.choice(GROUPS[n]))
    lengths = rng.uniform(2.5, 5.0, size=n).round(3)
    angles = [90.0] if n == 2 else [90.0, 90.0, 90.0]
    flat = float(rng.uniform(15, 165)) if rng.uniform() < 0.5 else float(rng.uniform(60, 120))
    if group in ("p1", "p2"):
        angles = [flat]
    elif group in ("P1", "P-1"):
        angles = [90.0, flat, 90.0]
    elif group in ("P21", "C2"):
        angles[1] = flat
    elif group == "P31":
        lengths[1], angles = lengths[0], [90.0, 90.0, 120.0]
    axes = rng.uniform(0.05, 0.6, size=n).tolist()
    shifts = "xyz"[:n]
    # The search's ranges are far smaller than what arrangements may be asked about.
    search = ", ".join(f"{k}: {{lower: 0, upper: 1, step: 1}}" for k in shifts)
    text = one_body_text(
        group,
        f"{{lengths: {lengths.tolist()}, angles_deg: {angles}}}",
        axes,
        f"{{position: {{{search}}}}}",
        rng.uniform(-0.3, 0.3, size=n).tolist(),
    )
    return text, model_from(text)


def _touching(rng: np.random.Generator, model: Any, far: bool) -> Any:
    """An arrangement (K,) moved along its first axis until the least gap is a hair."""
    cells = 95.0 if far else 0.2
    values = rng.uniform(-cells, cells, size=len(model.keys)) * float(model.cell.lengths.max())
    hair = float(rng.choice([-1, 1])) * 10.0 ** rng.uniform(-15, -11)
    hair = TOLERANCE if rng.uniform() < 0.2 else hair

    def gap(x: float) -> Any:
        return judge.least_gap(model, [x, *values[1:]]) - hair

    # From places all along the axis to the root between two of them.
    places = values[0] + np.linspace(0.0, 1.0, 9) * float(model.cell.lengths[0])
    found = [gap(x) for x in places]
    for k in range(8):
        if found[k] * found[k + 1] < 0:
            low, high, (g, h) = *map(float, places[k : k + 2]), found[k : k + 2]
            x = low
            for _ in range(60):  # the Illinois method
                if h == g:
                    break
                x = low - float(g * (high - low) / (h - g))
                at = gap(x)
                if at == 0 or not low < x < high:
                    break
                if (at > 0) == (h > 0):
                    high, h, g = x, at, g / 2
                else:
                    low, g, h = x, at, h / 2
            return np.array([x, *values[1:]])
    return None


def search(n: int, far: bool, seed: int, count: int = 6) -> Outcome:
    """Some arrangements of one model."""
    rng, total = np.random.default_rng([seed, n, int(far)]), Outcome()
    text, model = drawn(rng, n)
    for _ in range(count):
        arrangement = _touching(rng, model, far)
        if arrangement is not None:
            total += _outcome(text, model, arrangement)
    return total


def _outcome(text: str, model: Any, arrangement: Any) -> Outcome:
    free, gap = model.is_free(arrangement), float(judge.least_gap(model, arrangement))
    false, refused = free and gap < 0, not free and gap > 0.5 * TOLERANCE
    if not (false or refused):
        return Outcome(1, int(free))
    what = f"gap {gap:.3g} but free is {free} at {arrangement.tolist()} of {text!r}"
    wrong = (Counterexample(what, _as_world(model, arrangement)),)
    return Outcome(1, int(free), wrong if false else (), wrong if refused else ())


def _as_world(model: Any, arrangement: Any) -> Scenario:
    """The body as a robot at the origin, and its closest copies as obstacles."""
    n = model.dimension
    (body,), away = model.molecule.bodies(arrangement), []
    for turn, shift in zip(*model.group.cartesian(model.cell), strict=True):
        centre = turn @ body.centre + shift - body.centre
        for lattice in model.cell.lattice_within(centre, 2.1 * float(body.semi_axes.max())):
            at = centre + model.cell.cartesian(lattice)
            if np.linalg.norm(at) > 1e-9:
                away.append(Ellipsoid(at, turn @ body.rotation, body.semi_axes))
    robot = RigidRobot((Ellipsoid(np.zeros(n), body.rotation, body.semi_axes),), False)
    box = np.full(n, float(model.cell.lengths.max()))
    return Scenario("arrangement", World(-box, box, tuple(away)), robot, np.zeros(n), np.zeros(n))


SEARCHES: dict[str, Callable[[int], Outcome]] = {
    f"packing: {n}-D{', far from the cell' if far else ''}": lambda seed, n=n, far=far: search(
        n, far, seed
    )
    for n in (2, 3)
    for far in (False, True)
}
"""Searches by name: each decides one case of a seed."""
