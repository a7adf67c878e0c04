"""Questions about a scenario that need geometry: does the robot fit, are start and goal free?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GeometryError, ScenarioError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.minkowski import check_fits
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.joint import FIXED, PRISMATIC
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.robots.robot import Robot
from ellipsoid_planning.robots.tree import joints_in_order
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.scenario_origin import Path

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.contacts import Contact
    from ellipsoid_planning.cspace.space import CSpace

ROUNDING = 1e-12
MOST_CONTACTS = 3


def check_endpoints(scenario: Scenario, cspace: CSpace | None = None) -> None:
    """Check that the robot can fit its arenas and that start and goal are valid.

    Args:
        scenario: the scenario to check.
        cspace: its configuration space, if there is one already.

    Raises:
        ScenarioError: naming start or goal, the part, what it hits, leaves or is too close to; also
            when parts of the robot hit each other.
    """
    check_fit(scenario)
    space = scenario.cspace() if cspace is None else cspace
    for which in ("start", "goal"):
        contacts = space.explain(getattr(scenario, which))
        if contacts:
            raise scenario.origin.error((which,), _contacts_problem(which, contacts, scenario))


def check_fit(scenario: Scenario) -> None:
    """Check that every part can lie in every arena with the clearance asked for, somewhere.

    Only what is certain is refused: a part that fits nowhere at any orientation that the
    robot can take. Whether all parts fit together is left to the checks of start and goal.

    Raises:
        ScenarioError: naming the part, the arena, and by how much the part is too large.
    """
    robot = scenario.robot
    rotations, paths = _fixed_rotations(robot), _part_paths(robot)
    for part, link, path in zip(robot.parts, robot.part_links, paths, strict=True):
        for arena in scenario.world.arenas:
            if link in rotations:
                turned = rotations[link] @ part.rotation
                _check_fixed_part(scenario, part, turned, arena, path)
            else:
                _check_turning_part(scenario, part, arena, path)


def _fixed_rotations(robot: Robot) -> dict[str, NDArray[np.float64]]:
    """Rotations (n, n), to world, of the links that never turn, by name."""
    if robot.orientation is None:
        return {}
    rotations = {robot.root: robot.orientation}
    for joint in joints_in_order(robot.joints, robot.root):
        if joint.parent in rotations and joint.type in (PRISMATIC, FIXED):
            rotations[joint.child] = rotations[joint.parent] @ joint.rotation
    return rotations


def _part_paths(robot: RigidRobot | ArticulatedRobot) -> list[Path]:
    """Where each part stands in a scenario's document, in the order of the robot's parts."""
    if isinstance(robot, RigidRobot):
        return [("robot", "parts", index) for index in range(len(robot.parts))]
    return [
        ("robot", "links", index, "parts", own)
        for index, link in enumerate(robot.links)
        for own in range(len(link.parts))
    ]


def _check_turning_part(scenario: Scenario, part: Ellipsoid, arena: Ellipsoid, path: Path) -> None:
    """A part fits at some orientation iff its sorted semi-axes are at most the arena's.

    Necessary, since an ellipsoid inside another has the smaller sorted semi-axes (their shape
    matrices are ordered); sufficient, since the axes can be aligned. The set within the
    clearance of a part contains the ellipsoid whose semi-axes are longer by the clearance.
    """
    needed = np.sort(part.semi_axes) + scenario.clearance
    given = np.sort(arena.semi_axes)
    excess = needed - given
    worst = int(np.argmax(excess))
    if excess[worst] > ROUNDING * given[-1]:
        ordinal = (
            ("smallest", "middle", "largest") if part.dimension == 3 else ("smaller", "larger")
        )
        raise _too_large(
            scenario,
            path,
            f"the {ordinal[worst]} semi-axis {_with_clearance(scenario)}of part {part.name!r} is "
            f"{needed[worst]:g}, that of arena {arena.name!r} is {given[worst]:g}: the part is "
            f"too large by {excess[worst]:.6g} at every orientation",
        )


def _check_fixed_part(
    scenario: Scenario,
    part: Ellipsoid,
    rotation: NDArray[np.float64],
    arena: Ellipsoid,
    path: Path,
) -> None:
    grown = Ellipsoid(np.zeros_like(part.centre), rotation, part.semi_axes + scenario.clearance)
    centred = Ellipsoid(np.zeros_like(arena.centre), arena.rotation, arena.semi_axes)
    try:
        check_fits(
            centred.with_name(f"arena {arena.name!r}"), grown.with_name(f"part {part.name!r}")
        )
    except GeometryError as error:
        raise _too_large(scenario, path, f"{_with_clearance(scenario)}{error}") from None


def _with_clearance(scenario: Scenario) -> str:
    return f"(with the clearance {scenario.clearance:g}) " if scenario.clearance else ""


def _too_large(scenario: Scenario, path: Path, problem: str) -> ScenarioError:
    return scenario.origin.error(
        path, f"the robot cannot fit the arena: {problem}; shrink the part or enlarge the arena"
    )


def _contacts_problem(which: str, contacts: tuple[Contact, ...], scenario: Scenario) -> str:
    texts = [contact.message for contact in contacts[:MOST_CONTACTS]]
    rest = len(contacts) - len(texts)
    if rest > 0:
        texts.append(f"{rest} more")
    wanted = f" with the clearance {scenario.clearance:g}" if scenario.clearance else ""
    return f"expected a free {which}{wanted}, but {'; '.join(texts)}; move the {which}"
