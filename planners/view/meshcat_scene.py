"""A scenario and its path as a list of meshcat's drawing commands.

The commands are recorded, not sent: no server is started, no socket is opened and nothing is
printed. `meshcat_page` puts them into a file.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from planners.view import colours, meshcat_shapes
from planners.view.camera import Camera, frame, side_view
from planners.view.embedding import (
    ABOVE,
    FLOOR,
    JOINTS,
    SOLID,
    STILL_JOINTS,
    Embedding,
    Slab,
    outline,
)
from planners.view.links import followed_points, link_colours, link_shades
from planners.view.meshcat_animation import animate
from planners.view.meshcat_robot import hang_robot, named, place_robot
from planners.view.meshcat_surroundings import EYE_DISTANCE, ROOT, set_surroundings
from planners.view.surfaces import path_radius
from planners.view.trajectory import Trajectory, follow

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ellipsoid_planning.geometry import Ellipsoid
    from ellipsoid_planning.result import PlanResult
    from ellipsoid_planning.roadmap.graph import RoadmapGraph
    from ellipsoid_planning.scenario import Scenario

THICKNESS = 0.012  # of a planar body, as a part of the scene's size
FRAME_RADIUS = 0.0015  # of an arena's outline or the bounds' edges, likewise
PATH_TOLERANCE = 0.02  # how far the drawn path may be off, in its own radii
DOT = 0.01  # size of a roadmap's node, as a part of the eye's distance
BACK_SIDE = 1  # three.js: draw the far wall only, so that the inside is visible


@dataclass(frozen=True, eq=False)
class Scene:
    """What a page shows.

    Attributes:
        commands: meshcat's drawing commands, packed.
        camera: the camera that the commands set, in the scenario's coordinates.
        embedding: how planar bodies became solids.
        folders: the names of the switchable groups, each with its colour, in drawing order.
        links: the names of the moving robot's links, each with its colour; none if it is rigid.
        hidden: those of the folders that are hidden at first.
    """

    commands: tuple[bytes, ...]
    camera: Camera
    embedding: Embedding
    folders: tuple[tuple[str, str], ...]
    hidden: tuple[str, ...]
    links: tuple[tuple[str, str], ...] = ()


def build_scene(
    scenario: Scenario,
    result: PlanResult | None = None,
    roadmap: RoadmapGraph | None = None,
    show_roadmap: bool = False,
) -> Scene:
    """Draw a scenario, with the path of a result and with a roadmap where they are given."""
    builder = _SceneBuilder(scenario)
    builder.draw_world()
    builder.draw_still_robot("start", scenario.start, colours.START)
    builder.draw_still_robot("goal", scenario.goal, colours.GOAL)
    hidden: tuple[str, ...] = ()
    if roadmap is not None and len(roadmap.configurations):
        builder.draw_roadmap(roadmap, show_roadmap)
        hidden = () if show_roadmap else ("roadmap",)
    if result is not None and result.path is not None:
        builder.draw_motion(follow(scenario.cspace(), result.path.configurations))
    return Scene(
        tuple(builder.recorder.commands),
        builder.camera,
        builder.embedding,
        tuple(builder.folders),
        hidden,
        tuple(builder.links),
    )


class _SceneBuilder:
    def __init__(self, scenario: Scenario) -> None:
        self.world, self.robot = scenario.world, scenario.robot
        still = _still_points(scenario)
        self.size = float(np.max(np.ptp(still, axis=0)))
        self.embedding = Embedding(self.world.dimension, THICKNESS * self.size)
        ends = followed_points(self.robot, np.array([scenario.start, scenario.goal]))
        azimuth = None if scenario.dimension == 2 else side_view(*ends)
        self.camera = frame(self.embedding.points(still, SOLID), azimuth)
        self.recorder = meshcat_shapes.CommandRecorder()
        self.visualizer = meshcat_shapes.recorded_visualizer(self.recorder)
        self.root = self.visualizer["/" + ROOT]
        self.folders: list[tuple[str, str]] = []
        self.links: list[tuple[str, str]] = []
        set_surroundings(self.visualizer, self.camera, self.world.dimension)

    def draw_world(self) -> None:
        if self.world.arenas:
            self._draw_arenas()
        else:
            self._draw_bounds()
        if self.world.obstacles:
            self._draw_bodies("obstacles", self.world.obstacles, colours.OBSTACLE, SOLID)

    def draw_still_robot(self, name: str, configuration: NDArray[np.float64], colour: str) -> None:
        # Pushed back a little in depth, so that the moving robot covers it without flicker.
        behind = {"polygonOffset": True, "polygonOffsetFactor": 1.0, "polygonOffsetUnits": 2.0}
        self.folders.append((name, colour))
        shades, slabs = link_shades(self.robot, colour), (SOLID, STILL_JOINTS)
        place_robot(
            self.root[name], self.robot, configuration, self.embedding, shades, slabs, **behind
        )

    def draw_motion(self, trajectory: Trajectory) -> None:
        radius = path_radius(self.robot.parts, self.size)
        points = followed_points(self.robot, trajectory.configurations)
        corners = _simplified(points, PATH_TOLERANCE * radius)
        self.folders.append(("path", colours.PATH))
        self._draw_tube("path", self.embedding.points(corners), colours.PATH, radius)
        self.folders.append(("robot", colours.ROBOT))
        shades, slabs = link_colours(self.robot), (ABOVE, JOINTS)
        nodes = hang_robot(self.root["robot"], self.robot, self.embedding, shades, slabs)
        self.links = list(shades.items()) if self.robot.joints else []
        animate(nodes, self.robot, trajectory, self.embedding)

    def draw_roadmap(self, roadmap: RoadmapGraph, visible: bool) -> None:
        points = self.embedding.points(roadmap.configurations[:, : self.world.dimension])
        node = self.root["roadmap"]
        if len(roadmap.edges):
            lines = meshcat_shapes.segments(points[np.asarray(roadmap.edges)], colours.ROADMAP)
            node["edges"].set_object(lines)
        node["nodes"].set_object(meshcat_shapes.dots(points, colours.ROADMAP, DOT * EYE_DISTANCE))
        node.set_property("visible", visible)
        self.folders.append(("roadmap", colours.ROADMAP))

    def _draw_arenas(self) -> None:
        look: dict[str, Any] = {"opacity": 0.25, "depthWrite": False}
        if self.world.dimension == 3:
            look = {"opacity": 0.3, "depthWrite": False, "side": BACK_SIDE}
        self._draw_bodies("arena", self.world.arenas, colours.ARENA, FLOOR, **look)
        if self.world.dimension == 2:
            for arena, name in named(self.world.arenas, set()):
                ring = self.embedding.points(outline(arena), FLOOR)
                closed = np.concatenate([ring, ring[:1]])
                self._draw_tube(
                    f"arena/{name} boundary", closed, colours.ARENA, 2.0 * FRAME_RADIUS * self.size
                )

    def _draw_bounds(self) -> None:
        self.folders.append(("bounds", colours.FRAME))
        for index, edge in enumerate(_box_edges(self.world.low, self.world.high)):
            points = self.embedding.points(edge, SOLID)
            self._draw_tube(f"bounds/edge {index}", points, colours.FRAME, FRAME_RADIUS * self.size)

    def _draw_bodies(
        self, folder: str, bodies: Sequence[Ellipsoid], colour: str, slab: Slab, **look: Any
    ) -> None:
        self.folders.append((folder, colour))
        shared = meshcat_shapes.material(colour, **look)
        for body, name in named(bodies, set()):
            node = self.root[f"{folder}/{name}"]
            node.set_object(meshcat_shapes.unit_shape(self.world.dimension), shared)
            node.set_transform(self.embedding.matrix(body, slab))

    def _draw_tube(
        self, path: str, points: NDArray[np.float64], colour: str, radius: float
    ) -> None:
        self.root[path].set_object(
            meshcat_shapes.tube(points, radius), meshcat_shapes.material(colour)
        )


def _still_points(scenario: Scenario) -> NDArray[np.float64]:
    """Return points (m, n) whose hull holds, nearly, everything that stands still."""
    world, robot = scenario.world, scenario.robot
    still = [*robot.bodies_at(scenario.start), *robot.bodies_at(scenario.goal)]
    points = [body.surface_points(400) for body in (*world.arenas, *world.obstacles, *still)]
    if not world.arenas:
        points.append(_box_corners(world.low, world.high))
    return np.concatenate(points)


def _box_corners(low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
    n = len(low)
    return np.array([np.where([i >> k & 1 for k in range(n)], high, low) for i in range(2**n)])


def _box_edges(low: NDArray[np.float64], high: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    corners, n = _box_corners(low, high), len(low)
    return [corners[[i, i | 1 << k]] for i in range(2**n) for k in range(n) if not i >> k & 1]


def _simplified(positions: NDArray[np.float64], tolerance: float) -> NDArray[np.float64]:
    """Return some of the points (m, n); the others are within the tolerance of the line drawn."""
    keep = [0]
    for index in range(1, len(positions) - 1):
        first, last = positions[keep[-1]], positions[index + 1]
        if _farthest(positions[keep[-1] + 1 : index + 1], first, last) > tolerance:
            keep.append(index)
    if len(positions) > 1:
        keep.append(len(positions) - 1)
    return positions[keep]


def _farthest(
    points: NDArray[np.float64], first: NDArray[np.float64], last: NDArray[np.float64]
) -> float:
    """The largest distance of points (m, n) from a segment."""
    way = last - first
    square = float(way @ way)
    along = np.clip((points - first) @ way / square, 0.0, 1.0) if square else np.zeros(len(points))
    return float(np.linalg.norm(points - first - along[:, None] * way, axis=1).max())
