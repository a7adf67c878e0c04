"""A scenario and its path as a list of meshcat's drawing commands.

The commands are recorded, not sent: no server is started, no socket is opened and nothing is
printed. `meshcat_page` puts them into a file.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry import Ellipsoid
from planners.view import colours
from planners.view.camera import FIELD_OF_VIEW_DEG, Camera, frame, side_view
from planners.view.embedding import (
    ABOVE,
    FLOOR,
    SOLID,
    Embedding,
    Slab,
    outline,
)
from planners.view.surfaces import triangles, tube_patches
from planners.view.trajectory import Trajectory, follow

if TYPE_CHECKING:
    from ellipsoid_planning.result import PlanResult
    from ellipsoid_planning.roadmap.graph import RoadmapGraph
    from ellipsoid_planning.scenario import Scenario

ROOT = "scenario"
ANIMATION_SECONDS = 8.0
PAUSE_SECONDS = 1.0
FRAMES_PER_SECOND = 30.0
REPETITIONS = 1_000_000
THICKNESS = 0.012  # of a planar body, as a part of the scene's size
TUBE = 0.005  # radius of the path, as a part of the scene's size
BACK_SIDE = 1  # three.js: draw the far wall only, so that the inside is visible


class CommandRecorder:
    """Stands in for the window of a meshcat `Visualizer` and keeps its commands.

    Attributes:
        commands: the packed commands, in the order in which they were given.
    """

    def __init__(self) -> None:
        self.commands: list[bytes] = []

    def send(self, command: Any) -> None:
        """Keep a command of meshcat's."""
        import umsgpack

        self.commands.append(umsgpack.packb(command.lower()))


@dataclass(frozen=True, eq=False)
class Scene:
    """What a page shows.

    Attributes:
        commands: meshcat's drawing commands, packed.
        camera: the camera that the commands set, in the scenario's coordinates.
        embedding: how planar bodies became solids.
        folders: the names of the switchable groups, each with its colour, in drawing order.
        hidden: those of the folders that are hidden at first.
    """

    commands: tuple[bytes, ...]
    camera: Camera
    embedding: Embedding
    folders: tuple[tuple[str, str], ...]
    hidden: tuple[str, ...]


def build_scene(
    scenario: Scenario,
    result: PlanResult | None = None,
    roadmap: RoadmapGraph | None = None,
    show_roadmap: bool = False,
) -> Scene:
    """Draw a scenario, with the path of a result and with a roadmap where they are given."""
    return _SceneBuilder(scenario).build(result, roadmap, show_roadmap)


class _SceneBuilder:
    def __init__(self, scenario: Scenario) -> None:
        from meshcat import Visualizer

        self.scenario = scenario
        self.world, self.robot = scenario.world, scenario.robot
        extent = _extent(scenario)
        self.size = float(np.max(np.ptp(extent, axis=0)))
        self.embedding = Embedding(self.world.dimension, THICKNESS * self.size)
        self.camera = self._framed(extent)
        self.recorder = CommandRecorder()
        self.visualizer = Visualizer(window=self.recorder)["/" + ROOT]
        self.folders: list[tuple[str, str]] = []

    def build(
        self, result: PlanResult | None, roadmap: RoadmapGraph | None, show_roadmap: bool
    ) -> Scene:
        self._surroundings()
        self._world()
        self._still_robot("start", self.scenario.start, colours.START)
        self._still_robot("goal", self.scenario.goal, colours.GOAL)
        if roadmap is not None and len(roadmap.configurations):
            self._roadmap(roadmap, show_roadmap)
        if result is not None and result.path is not None:
            self._motion(follow(self.scenario.cspace(), result.path.configurations))
        hidden = ("roadmap",) if not show_roadmap else ()
        names = [name for name, _ in self.folders]
        return Scene(
            tuple(self.recorder.commands),
            self.camera,
            self.embedding,
            tuple(self.folders),
            tuple(name for name in hidden if name in names),
        )

    def _framed(self, extent: NDArray[np.float64]) -> Camera:
        n = self.world.dimension
        azimuth = None if n == 2 else side_view(self.scenario.start[:n], self.scenario.goal[:n])
        return frame(self.embedding.points(extent, SOLID), azimuth)

    def _surroundings(self) -> None:
        """Scale the scene to the size of meshcat's own lights, and set camera and background.

        The centre of the scene becomes the origin, about which meshcat's mouse controls turn.
        """
        scale = 2.0 / self.camera.distance
        matrix = np.eye(4) * [scale, scale, scale, 1.0]
        matrix[:3, 3] = -scale * self.camera.centre
        self.visualizer.set_transform(matrix)
        for name in ("/Grid", "/Axes"):
            self.visualizer[name].set_property("visible", False)
        self.visualizer["/Background"].set_property("top_color", [1.0, 1.0, 1.0])
        self.visualizer["/Background"].set_property("bottom_color", [0.93, 0.95, 0.97])
        x, y, z = (float(v) for v in scale * self.camera.distance * self.camera.back)
        # Straight above, the mouse controls would not know which way is up.
        tilt = 1e-4 if self.world.dimension == 2 else 0.0
        node = self.visualizer["/Cameras/default/rotated/<object>"]
        node.set_property("fov", FIELD_OF_VIEW_DEG)
        node.set_property("near", 0.02)
        node.set_property("position", [x, z, -y + tilt])  # this node counts y upwards

    def _world(self) -> None:
        if self.world.arenas:
            self._arenas()
        else:
            self._bounds()
        if self.world.obstacles:
            self._bodies("obstacles", self.world.obstacles, colours.OBSTACLE, SOLID)

    def _arenas(self) -> None:
        flat = self.world.dimension == 2
        look = {"opacity": 0.25 if flat else 0.3, "depthWrite": False}
        if not flat:
            look["side"] = BACK_SIDE
        self._bodies("arena", self.world.arenas, colours.ARENA, FLOOR, **look)
        if flat:
            for arena, name in _named(self.world.arenas, "arena"):
                ring = self.embedding.points(outline(arena), FLOOR)
                self._tube(f"arena/{name} boundary", ring, colours.ARENA, closed=True, radius=0.6)

    def _bounds(self) -> None:
        self.folders.append(("bounds", colours.FRAME))
        for index, edge in enumerate(_box_edges(self.world.low, self.world.high)):
            points = self.embedding.points(edge, SOLID)
            self._tube(f"bounds/edge {index}", points, colours.FRAME, radius=0.3)

    def _still_robot(self, name: str, configuration: NDArray[np.float64], colour: str) -> None:
        # Pushed back a little in depth, so that the moving robot covers it without flicker.
        behind = {"polygonOffset": True, "polygonOffsetFactor": 1.0, "polygonOffsetUnits": 2.0}
        self._bodies(name, self.robot.bodies_at(configuration), colour, SOLID, **behind)

    def _motion(self, trajectory: Trajectory) -> None:
        n = self.world.dimension
        points = self.embedding.points(_simplified(trajectory.configurations[:, :n]))
        self.folders.append(("path", colours.PATH))
        self._tube("path", points, colours.PATH, radius=1.0 if n == 3 else 0.6)
        fixed = np.eye(n) if self.robot.orientation is None else self.robot.orientation
        parts = [part.transform(fixed, np.zeros(n)) for part in self.robot.parts]
        self._bodies("robot", parts, colours.ROBOT, ABOVE)
        self._animate(trajectory)

    def _animate(self, trajectory: Trajectory) -> None:
        from meshcat.animation import Animation

        animation = Animation(default_framerate=FRAMES_PER_SECOND)
        n = self.world.dimension
        frames = trajectory.fractions * ANIMATION_SECONDS * FRAMES_PER_SECOND
        for at, configuration in zip(frames, trajectory.configurations, strict=True):
            frame_view = animation.at_frame(self.visualizer["robot"], float(at))
            position = np.zeros(3)
            position[:n] = configuration[:n]
            frame_view.set_property("position", "vector3", position.tolist())
            quaternion = self.embedding.quaternion(configuration)
            if quaternion is not None:
                frame_view.set_property("quaternion", "quaternion", quaternion.tolist())
        end = float(frames[-1]) + PAUSE_SECONDS * FRAMES_PER_SECOND
        animation.at_frame(self.visualizer["robot"], end).set_property(
            "position", "vector3", position.tolist()
        )
        self.visualizer.set_animation(animation, repetitions=REPETITIONS)

    def _roadmap(self, roadmap: RoadmapGraph, visible: bool) -> None:
        from meshcat.geometry import LineBasicMaterial, LineSegments, PointsGeometry, PointsMaterial

        points = self.embedding.points(roadmap.configurations[:, : self.world.dimension])
        points = points.astype(np.float32)
        node = self.visualizer["roadmap"]
        if len(roadmap.edges):
            ends = points[np.asarray(roadmap.edges).reshape(-1)]
            material = LineBasicMaterial(colours.as_integer(colours.ROADMAP))
            node["edges"].set_object(LineSegments(PointsGeometry(ends.T), material))
        channels = np.tile(np.array(colours.rgb(colours.ROADMAP), np.float32), (len(points), 1))
        dots = PointsMaterial(size=4.0 * TUBE * self.size * 2.0 / self.camera.distance)
        node["nodes"].set_object(PointsGeometry(points.T, channels.T), dots)
        node.set_property("visible", visible)
        self.folders.append(("roadmap", colours.ROADMAP))

    def _bodies(
        self, folder: str, bodies: Sequence[Ellipsoid], colour: str, slab: Slab, **look: Any
    ) -> None:
        self.folders.append((folder, colour))
        material = _material(colour, **look)
        for body, name in _named(bodies, folder):
            node = self.visualizer[f"{folder}/{name}"]
            node.set_object(_unit_shape(self.world.dimension), material)
            node.set_transform(self.embedding.matrix(body, slab))

    def _tube(
        self,
        path: str,
        points: NDArray[np.float64],
        colour: str,
        closed: bool = False,
        radius: float = 1.0,
    ) -> None:
        from meshcat.geometry import TriangularMeshGeometry

        line = np.concatenate([points, points[:1]]) if closed else points
        patches = tube_patches(line, radius * TUBE * self.size, sides=8)
        self.visualizer[path].set_object(
            TriangularMeshGeometry(*triangles(patches)), _material(colour)
        )


def _material(colour: str, **look: Any) -> Any:
    from meshcat.geometry import MeshLambertMaterial

    return MeshLambertMaterial(color=colours.as_integer(colour), **look)


def _unit_shape(dimension: int) -> Any:
    """Return the unit ball, or the cylinder of radius and height 1, smooth to the eye."""
    from meshcat.geometry import Cylinder, Sphere

    if dimension == 3:
        return _finer(Sphere(1.0), widthSegments=64, heightSegments=32)
    return _finer(Cylinder(1.0, 1.0), radialSegments=96)


def _finer(geometry: Any, **segments: int) -> Any:
    coarse = geometry.lower
    geometry.lower = lambda object_data: {**coarse(object_data), **segments}
    return geometry


def _named(bodies: Iterable[Ellipsoid], kind: str) -> list[tuple[Ellipsoid, str]]:
    """Return each body with a name that is unique in its folder and holds no slash."""
    seen: dict[str, int] = {}
    named = []
    for index, body in enumerate(bodies, start=1):
        name = (body.name or f"{kind} {index}").replace("/", "-")
        seen[name] = seen.get(name, 0) + 1
        named.append((body, name if seen[name] == 1 else f"{name} ({seen[name]})"))
    return named


def _extent(scenario: Scenario) -> NDArray[np.float64]:
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


def _simplified(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Drop the points (m, n) that lie on the straight line between their neighbours."""
    keep = [0]
    for index in range(1, len(positions) - 1):
        before, after = (
            positions[index] - positions[keep[-1]],
            positions[index + 1] - positions[index],
        )
        product = np.linalg.norm(before) * np.linalg.norm(after)
        if before @ after < (1.0 - 1e-12) * product:
            keep.append(index)
    return positions[[*keep, len(positions) - 1]]
