"""Meshcat's shapes and materials, and a window that records instead of showing."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from planners.view import colours
from planners.view.surfaces import triangles, tube_patches

if TYPE_CHECKING:
    from numpy.typing import NDArray


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


def recorded_visualizer(recorder: CommandRecorder) -> Any:
    """Return a meshcat `Visualizer` that draws into the recorder; no server is started."""
    with warnings.catch_warnings():
        # meshcat's own server module imports something that pyzmq has deprecated.
        warnings.simplefilter("ignore", DeprecationWarning)
        from meshcat import Visualizer
    return Visualizer(window=recorder)


def material(colour: str, **look: Any) -> Any:
    """Return a matt material of a colour "#rrggbb" with further properties of three.js."""
    from meshcat.geometry import MeshLambertMaterial

    return MeshLambertMaterial(color=colours.as_integer(colour), **look)


def unit_shape(dimension: int) -> Any:
    """Return the unit ball (3-D) or the cylinder of radius and height 1 (2-D), finely divided."""
    from meshcat.geometry import Cylinder, Sphere

    if dimension == 2:
        return _divided(Cylinder(1.0, 1.0), radialSegments=96)
    return _divided(Sphere(1.0), widthSegments=64, heightSegments=32)


def tube(points: NDArray[np.float64], radius: float, sides: int = 8) -> Any:
    """Return a tube around a polyline (k, 3): three.js draws lines one pixel wide only."""
    from meshcat.geometry import TriangularMeshGeometry

    return TriangularMeshGeometry(*triangles(tube_patches(points, radius, sides)))


def segments(ends: NDArray[np.float64], colour: str) -> Any:
    """Return thin lines between the pairs of `ends`, (k, 2, 3)."""
    from meshcat.geometry import LineBasicMaterial, LineSegments, PointsGeometry

    positions = ends.reshape(-1, 3).T.astype(np.float32)
    return LineSegments(PointsGeometry(positions), LineBasicMaterial(colours.as_integer(colour)))


def dots(points: NDArray[np.float64], colour: str, size: float) -> Any:
    """Return square dots at points (m, 3), of the given size on a scale where the scene is 1."""
    from meshcat.geometry import PointCloud

    channels = np.tile(np.array(colours.rgb(colour), np.float32), (len(points), 1))
    return PointCloud(points.T.astype(np.float32), channels.T, size=size)


def _divided(geometry: Any, **segments: int) -> Any:
    coarse = geometry.lower
    geometry.lower = lambda object_data: {**coarse(object_data), **segments}
    return geometry
