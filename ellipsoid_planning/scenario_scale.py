"""Do the sizes of a scenario's things go together?"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.joint import PRISMATIC
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario_origin import Origin, Path
from ellipsoid_planning.sizes import MOST_RATIO, MOST_SHIFT
from ellipsoid_planning.world import World


def check_scale(world: World, robot: RigidRobot | ArticulatedRobot, origin: Origin) -> None:
    """Check that the smallest body and the largest lengths of a scenario are comparable.

    Raises:
        ScenarioError: naming the thinnest body, or a prismatic joint that moves out of all
            proportion.
    """
    bodies = [*world.obstacles, *world.arenas, *robot.parts]
    axes = np.array([body.semi_axes for body in bodies])
    extent = max(
        float(np.max(np.abs([world.low, world.high]))),
        float(np.max(axes)),
        float(np.max(np.abs([body.centre for body in bodies]))),
        *(float(np.max(np.abs(joint.position))) for joint in robot.joints),
    )
    _check_shifts(robot, extent, origin)
    thinnest = int(np.argmin(np.min(axes, axis=1)))
    least = float(np.min(axes))
    if extent > MOST_RATIO * least:
        raise origin.error(
            (*_path(world, robot, thinnest), "semi_axes"),
            f"{bodies[thinnest].name!r} has a semi-axis of {least:g} in a scene of size "
            f"{extent:g}; expected at least a {1.0 / MOST_RATIO:g}th of it, or rounding hides the "
            "body; give lengths that belong together",
        )


def _check_shifts(robot: RigidRobot | ArticulatedRobot, extent: float, origin: Origin) -> None:
    for index, joint in enumerate(robot.joints):
        farthest = max(abs(joint.lower), abs(joint.upper))
        if joint.type == PRISMATIC and farthest > MOST_SHIFT * extent:
            raise origin.error(
                ("robot", "joints", index, "limit"),
                f"joint {joint.name!r} moves by {farthest:g} in a scene of size {extent:g}; "
                f"expected at most {MOST_SHIFT:g} times the size; give the lengths that it can "
                "move by",
            )


def _path(world: World, robot: RigidRobot | ArticulatedRobot, index: int) -> Path:
    """Where a body stands in the scenario's document; all are counted through."""
    lists: list[tuple[Path, Sequence[Ellipsoid]]] = [
        (("obstacles",), world.obstacles),
        (("arena",), world.arenas),
    ]
    if isinstance(robot, RigidRobot):
        lists.append((("robot", "parts"), robot.parts))
    else:
        lists += [
            (("robot", "links", place, "parts"), link.parts)
            for place, link in enumerate(robot.links)
        ]
    for path, bodies in lists:
        if index < len(bodies):
            return (*path, index)
        index -= len(bodies)
    raise IndexError(index)
