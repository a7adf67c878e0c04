"""The links of a robot as they are drawn: each with its colour, hung on its parent."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.robots.tree import joints_in_order
from planners.view import colours

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from ellipsoid_planning.robots import Joint, Robot

MOST_DIFFERENCE = 0.5  # whiteness of the last link where one colour is shaded
GHOSTS_A_JOINT = 1
LEVEL_DROP = 0.3  # of the last link's top against the first's, in units of thickness


def link_names(robot: Robot) -> tuple[str, ...]:
    """The names of the links that have parts, in the order of the parts."""
    return tuple(dict.fromkeys(robot.part_links))


def link_colours(robot: Robot) -> dict[str, str]:
    """The colour of each link of the moving robot, by name; few links have one each."""
    hues = colours.LINKS
    return {name: hues[i % len(hues)] for i, name in enumerate(link_names(robot))}


def link_shades(robot: Robot, colour: str) -> dict[str, str]:
    """Shades of one colour by link, from itself at the first link to a light one at the last."""
    names = link_names(robot)
    step = MOST_DIFFERENCE / max(len(names) - 1, 1)
    return {name: colours.tint(colour, i * step) for i, name in enumerate(names)}


def link_levels(robot: Robot) -> dict[str, float]:
    """How much lower each link of a planar robot is drawn, lest their tops flicker."""
    names = link_names(robot)
    return {name: LEVEL_DROP * i / len(names) for i, name in enumerate(names)}


def parents(robot: Robot) -> dict[str, str]:
    """Each link but the root with the link that it hangs on, parents first."""
    return {joint.child: joint.parent for joint in _in_order(robot)}


def hung_poses(
    robot: Robot, configuration: NDArray[np.float64]
) -> dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Position (n,) and rotation (n, n) of each link in its parent's frame; the root's in world.

    In the parent's frame a joint turns its child about a fixed point or shifts it along a line,
    so that a slerp or a straight line between two poses is the joint's own motion.
    """
    world = robot.link_poses(configuration)
    poses = {robot.root: world[robot.root]}
    for child, parent in parents(robot).items():
        (from_, back), (position, rotation) = world[parent], world[child]
        poses[child] = (back.T @ (position - from_), back.T @ rotation)
    return poses


def followed_points(robot: Robot, configurations: NDArray[np.float64]) -> NDArray[np.float64]:
    """The points (m, n) whose way is drawn, one a configuration (m, d).

    They are the base's positions; where the base is fixed, the centre of the part that most
    joints move.
    """
    if robot.base_size:
        return np.asarray(configurations)[:, : robot.dimension]
    depths = {robot.root: 0}
    for child, parent in parents(robot).items():
        depths[child] = depths[parent] + 1
    last = max(range(len(robot.parts)), key=lambda i: (depths[robot.part_links[i]], i))
    return np.array([robot.bodies_at(q)[last].centre for q in configurations])


def ghost_count(robot: Robot, least: int) -> int:
    """How many poses along a path to draw: a few more for each joint."""
    return least + GHOSTS_A_JOINT * len(robot.joint_slices)


def _in_order(robot: Robot) -> Iterable[Joint]:
    return joints_in_order(robot.joints, robot.root)
