"""The families by name."""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable
from dataclasses import dataclass

from ellipsoid_planning.errors import FamilyError
from ellipsoid_planning.families.bend import bend
from ellipsoid_planning.families.chain_of_gaps import chain_of_gaps
from ellipsoid_planning.families.draws import Draws
from ellipsoid_planning.families.gap import gap, turned_gap
from ellipsoid_planning.families.scene import FamilyScene, Layout, Request, place
from ellipsoid_planning.families.slot_3d import slot_3d
from ellipsoid_planning.families.tight_arena import tight_arena
from ellipsoid_planning.families.window_3d import window_3d
from ellipsoid_planning.scenario import Scenario

LARGEST_CLEARANCE = 1.0
SMALLEST_CLEARANCE = 1e-13


@dataclass(frozen=True)
class Family:
    """A family of scenarios with one parameter, the clearance of its passage.

    Attributes:
        layout: makes a scene.
        about: one sentence on what the robot meets.
        dimensions: that it comes in; the first is the usual one.
    """

    layout: Callable[[Request], Layout]
    about: str
    dimensions: tuple[int, ...] = (2, 3)


FAMILIES = {
    "gap": Family(gap, "a narrow gap in a wall, with start and goal turned to fit"),
    "turned-gap": Family(
        turned_gap, "a narrow gap at an odd angle that neither start nor goal is turned to fit"
    ),
    "window-3d": Family(
        window_3d, "a hole among three or four bodies that the robot must be turned for", (3,)
    ),
    "slot-3d": Family(
        slot_3d,
        "a slot three robot lengths long between long bodies, equally tight in three places",
        (3,),
    ),
    "bend": Family(
        bend, "a bend so tight that the robot must turn inside, with three equally tight places"
    ),
    "chain-of-gaps": Family(
        chain_of_gaps,
        "three gaps in a row, with a room between each and the next, that need three orientations",
    ),
    "tight-arena": Family(
        tight_arena,
        "half a turn in an arena that the robot can stand upright in only in the middle",
    ),
}


def family_names() -> tuple[str, ...]:
    """The names of all families."""
    return tuple(FAMILIES)


def make_family(
    name: str,
    clearance: float,
    dimension: int | None = None,
    seed: int | None = None,
    *,
    blocked: bool = False,
    without_passage: bool = False,
) -> Scenario:
    """Make a scenario of a family.

    Args:
        name: of the family.
        clearance: free play of the robot in the passage, at the orientation that fits best,
            divided by its width there; above 0 and at most 1.
        dimension: 2 or 3, as far as the family comes in it; its usual one by default.
        seed: draws sizes, clutter and a rigid motion of everything, the same at every
            clearance; without one, the scene is the canonical one.
        blocked: close the passage: it is narrower than the least width of the robot's main part
            by the fraction `clearance`, below 1, of that width.
        without_passage: leave the bodies out that form the passage.

    Raises:
        FamilyError: if there is no such family or not with these numbers.
    """
    return make_family_scene(
        name, clearance, dimension, seed, blocked=blocked, without_passage=without_passage
    ).scenario


def make_family_scene(
    name: str,
    clearance: float,
    dimension: int | None = None,
    seed: int | None = None,
    *,
    blocked: bool = False,
    without_passage: bool = False,
) -> FamilyScene:
    """Like `make_family`, with the gates, which a planner must not know."""
    family = _find_family(name)
    _check_clearance(clearance, blocked=blocked)
    if blocked and without_passage:
        raise FamilyError("expected a blocked passage or none, not both; leave one of them out")
    n = _checked_dimension(name, family, dimension)
    draws = Draws(name, _checked_seed(seed))
    request = Request(float(clearance), n, draws, blocked)
    layout = family.layout(request)
    variant = "blocked" if blocked else "without passage" if without_passage else ""
    title = f"{name} {n}-D, clearance {clearance:g}"
    title += f", seed {seed}" * (seed is not None) + f", {variant}" * bool(variant)
    text = _description(name, family, layout, request, seed, variant)
    return place(layout, draws, title, text, without_passage=without_passage)


def _find_family(name: str) -> Family:
    if name in FAMILIES:
        return FAMILIES[name]
    close = difflib.get_close_matches(name, FAMILIES, n=1)
    hint = f"did you mean {close[0]}?" if close else f"there are {', '.join(FAMILIES)}"
    raise FamilyError(f"unknown family {name!r}; {hint}")


def _check_clearance(clearance: float, *, blocked: bool) -> None:
    if not (math.isfinite(clearance) and 0.0 < clearance <= LARGEST_CLEARANCE):
        raise FamilyError(
            f"expected a clearance above 0 and at most {LARGEST_CLEARANCE:g}, got {clearance:g}: "
            "it is free play divided by the robot's width"
        )
    if clearance < SMALLEST_CLEARANCE:
        raise FamilyError(
            f"expected a clearance of at least {SMALLEST_CLEARANCE:g}, got {clearance:g}: less "
            "free play is lost in the rounding of the bodies' positions"
        )
    if blocked and clearance == 1.0:
        raise FamilyError(
            "expected a clearance below 1 for a blocked passage, got 1: it is the fraction of the "
            "robot's width by which the passage is too narrow"
        )


def _checked_dimension(name: str, family: Family, dimension: int | None) -> int:
    if dimension is None:
        return family.dimensions[0]
    if dimension not in family.dimensions:
        known = " or ".join(map(str, family.dimensions))
        raise FamilyError(f"family {name} comes in dimension {known}, got {dimension}")
    return dimension


def _checked_seed(seed: int | None) -> int | None:
    if seed is not None and seed < 0:
        raise FamilyError(f"expected a seed of zero or more, got {seed}")
    return seed


def _description(
    name: str, family: Family, layout: Layout, request: Request, seed: int | None, variant: str
) -> str:
    gate = layout.gates[0]
    drawn = "the canonical scene" if seed is None else f"seed {seed}"
    text = f"Family {name} ({drawn}): {family.about}. "
    if variant == "without passage":
        return text + "The bodies that form the passage are left out. "
    size = f"{request.clearance:g} of the robot's width {gate.width:.10g}"
    if variant == "blocked":
        return text + (
            f"The passage is closed: narrower than the main part at any orientation by {size}. "
        )
    return text + f"Clearance {request.clearance:g}: the free play in the passage is {size}. "
