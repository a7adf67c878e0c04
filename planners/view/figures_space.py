"""The workspace of a spatial scenario: shaded bodies, painted from back to front."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from planners.view import colours
from planners.view.camera import Camera, frame, side_view
from planners.view.joint_markers import joint_markers
from planners.view.links import followed_points, ghost_count, link_colours, link_shades
from planners.view.surfaces import ellipsoid_patches, path_radius, tube_patches

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from ellipsoid_planning.geometry import Ellipsoid
    from ellipsoid_planning.robots import Robot
    from ellipsoid_planning.scenario import Scenario
    from planners.view.trajectory import Trajectory

SWEPT_POSES = 9
SEEN_THROUGH = 0.4  # opacity
MOST_HIDDEN = 0.2  # share of the robot's bodies that an obstacle may hide before it is seen through
SAME = 1e-4  # difference of bodies in one place, as a part of their size
LIGHT = np.array([-0.37, 0.74, 0.56])  # to the right, up, towards the viewer


class Painting:
    """Collects coloured patches and paints them on a pair of axes, the farthest first."""

    def __init__(self, camera: Camera) -> None:
        self.camera = camera
        self._patches: list[NDArray[np.float64]] = []
        self._colours: list[NDArray[np.float64]] = []

    def add(
        self,
        patches: NDArray[np.float64],
        colour: str,
        inside: bool = False,
        alpha: float = 1.0,
    ) -> None:
        """Add patches (m, 4, 3) of a convex surface: the side that faces the viewer.

        `inside` adds the far side instead, of which one sees the inner face, dimly shaded.
        """
        darkest, brightest = (0.85, 1.0) if inside else (0.55, 1.3)
        seen = self.camera.axes(patches.reshape(-1, 3)).reshape(-1, 4, 3)
        normals = np.cross(seen[:, 2] - seen[:, 0], seen[:, 3] - seen[:, 1])
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = normals / np.where(length > 0.0, length, 1.0)
        if inside:
            normals = -normals
        facing = normals[:, 2] > 0.0
        # Light that reaches around the body ("half Lambert") keeps the dark side readable.
        lit = (0.5 + 0.5 * (normals[facing] @ LIGHT)) ** 1.5
        light = darkest + (brightest - darkest) * lit
        self._patches.append(seen[facing])
        shades = np.clip(light[:, None] * colours.rgb(colour), 0.0, 1.0)
        self._colours.append(np.column_stack([shades, np.full(len(shades), alpha)]))

    def paint(self, axes: Axes, zorder: float) -> None:
        """Paint everything added so far, and forget it."""
        from matplotlib.collections import PolyCollection

        patches, shades = np.concatenate(self._patches), np.concatenate(self._colours)
        order = np.argsort(patches[:, :, 2].mean(axis=1), kind="stable")
        shades = shades[order]
        opaque = shades[:, 3] == 1.0
        # Opaque patches get an edge of their own colour, or the background shows between them.
        edges = shades * opaque[:, None]
        axes.add_collection(
            PolyCollection(
                list(patches[order, :, :2]),
                facecolors=shades,
                edgecolors=edges,
                linewidths=0.4,
                zorder=zorder,
                antialiaseds=opaque,
            )
        )
        self._patches, self._colours = [], []


def workspace_camera(scenario: Scenario) -> Camera:
    """Return the camera of `draw_workspace`; axes(points)[:, :2] are its data coordinates."""
    world, robot = scenario.world, scenario.robot
    still = [*robot.bodies_at(scenario.start), *robot.bodies_at(scenario.goal)]
    bodies = [*world.arenas, *world.obstacles, *still]
    points = np.concatenate([body.surface_points(200) for body in bodies])
    ends = followed_points(robot, np.array([scenario.start, scenario.goal]))
    return frame(points, side_view(*ends))


def draw_workspace(axes: Axes, scenario: Scenario, trajectory: Trajectory | None) -> None:
    """Draw arena, obstacles, the robot at start and goal, and swept along the path if given.

    The view is a parallel projection along `workspace_camera`; the arena is open to the viewer.
    """
    world = scenario.world
    painting = Painting(workspace_camera(scenario))
    axes.set_title("Workspace", loc="left", fontsize=11)
    if world.arenas:
        alpha = 1.0 if len(world.arenas) == 1 else 0.5
        for arena in world.arenas:
            wall = ellipsoid_patches(arena, 96, 48)
            painting.add(wall, colours.tint(colours.ARENA, 0.65), inside=True, alpha=alpha)
        painting.paint(axes, 1)
    else:
        _draw_floor(axes, painting.camera, scenario)
    for obstacle in world.obstacles:
        hides = _hidden_share(painting.camera, obstacle, scenario, trajectory) > MOST_HIDDEN
        alpha = SEEN_THROUGH if hides else 1.0
        painting.add(ellipsoid_patches(obstacle, 96, 48), colours.OBSTACLE, alpha=alpha)
    drawn = _add_ends(painting, scenario)
    if trajectory is not None:
        _add_swept(painting, scenario, trajectory, drawn)
    painting.paint(axes, 3)
    axes.set_aspect("equal", anchor="N")
    axes.autoscale_view()
    axes.set_axis_off()


def _hidden_share(
    camera: Camera, obstacle: Ellipsoid, scenario: Scenario, trajectory: Trajectory | None
) -> float:
    """Which share of the robot's bodies, at its ends and along the path, an obstacle hides."""
    rows = [scenario.start, scenario.goal]
    if trajectory is not None:
        count = len(trajectory.configurations)
        picked = np.linspace(0, count - 1, min(count, SWEPT_POSES)).astype(int)
        rows += list(trajectory.configurations[picked])
    robot = scenario.robot
    points = np.array([body.centre for row in rows for body in robot.bodies_at(row)])
    inverse = np.linalg.inv(obstacle.matrix)
    from_centre, ahead = (points - obstacle.centre) @ inverse.T, inverse @ camera.back
    nearest = np.maximum(-(from_centre @ ahead) / (ahead @ ahead), 0.0)
    return float(np.mean(np.linalg.norm(from_centre + np.outer(nearest, ahead), axis=1) < 1.0))


def _add_ends(painting: Painting, scenario: Scenario) -> set[bytes]:
    """Add the robot at start and goal; return which bodies are drawn.

    Where a link has not moved in between it has the colour of the moving robot's.
    """
    robot, hues, drawn = scenario.robot, link_colours(scenario.robot), set[bytes]()
    ends = ((scenario.start, colours.START), (scenario.goal, colours.GOAL))
    first, last = ({_place(body) for body in robot.bodies_at(q)} for q, _ in ends)
    unmoved = first & last if robot.joints else set()
    for configuration, colour in ends:
        shades = link_shades(robot, colour)
        for body, link in zip(robot.bodies_at(configuration), robot.part_links, strict=True):
            hue = hues[link] if _place(body) in unmoved else shades[link]
            _add_once(painting, body, hue, 96, drawn)
        _add_joints(painting, robot, configuration)
    return drawn


def _add_once(
    painting: Painting,
    body: Ellipsoid,
    colour: str,
    fineness: int,
    drawn: set[bytes],
    alpha: float = 1.0,
) -> None:
    """Add a body unless it is drawn: of two in one place one would see a bit of each."""
    if _place(body) not in drawn:
        painting.add(ellipsoid_patches(body, fineness, fineness // 2), colour, alpha=alpha)
        drawn.add(_place(body))


def _place(body: Ellipsoid) -> bytes:
    """The same for bodies that look the same."""
    size = SAME * float(body.semi_axes.max())
    centre, shape = body.centre / size, body.shape_matrix / (size * body.semi_axes.max())
    return (np.round([*centre, *shape.ravel()]) + 0.0).tobytes()


def _add_joints(painting: Painting, robot: Robot, configuration: NDArray[np.float64]) -> None:
    poses = robot.link_poses(configuration)
    for marker in joint_markers(robot):
        painting.add(tube_patches(marker.placed(poses), marker.radius), colours.JOINT)


def _add_swept(
    painting: Painting, scenario: Scenario, trajectory: Trajectory, drawn: set[bytes]
) -> None:
    robot = scenario.robot
    shades = {link: colours.tint(hue, 0.3) for link, hue in link_colours(robot).items()}
    # On a fixed base all poses are in one place, and would hide the start and the goal.
    alpha = 1.0 if robot.base_size else SEEN_THROUGH
    for configuration in trajectory.evenly(ghost_count(robot, SWEPT_POSES))[1:-1]:
        for body, link in zip(robot.bodies_at(configuration), robot.part_links, strict=True):
            _add_once(painting, body, shades[link], 40, drawn, alpha)
    positions = followed_points(robot, trajectory.configurations)
    radius = path_radius(scenario.robot.parts, 0.5 * painting.camera.distance)
    painting.add(tube_patches(positions, radius, sides=6), colours.PATH)


def _draw_floor(axes: Axes, camera: Camera, scenario: Scenario) -> None:
    """Draw the bottom of the bounds, and the obstacles' shadows on it."""
    from matplotlib.patches import Polygon

    low, high = scenario.world.low, scenario.world.high
    corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
    floor = np.array([(x, y, low[2]) for x, y in corners])
    axes.add_patch(
        Polygon(camera.axes(floor)[:, :2], facecolor=colours.OUTSIDE, edgecolor=colours.FRAME)
    )
    for body in scenario.world.obstacles:
        # A shadow is the body pressed flat; its outline is the pressed outline seen from above.
        angle = np.linspace(0.0, 2.0 * np.pi, 96, endpoint=False)
        normals = np.column_stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)])
        shadow = np.clip(body.support_points(normals), low, high)
        shadow[:, 2] = low[2]
        fill = colours.tint(colours.OBSTACLE, 0.5)
        axes.add_patch(Polygon(camera.axes(shadow)[:, :2], facecolor=fill, linewidth=0, zorder=2))
