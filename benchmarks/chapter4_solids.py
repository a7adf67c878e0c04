"""Cells of rotations drawn in exponential coordinates, with their faces as curved as they are."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LightSource
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from ellipsoid_planning.groups import VoronoiCell, Wedge
from ellipsoid_planning.groups.quaternions import from_rodrigues, logarithm, rodrigues
from planners.view import colours

FINE = 5  # how often each triangle's edges are divided
LIGHT = LightSource(azdeg=225.0, altdeg=45.0)


def new_space(drawn: Figure, place: tuple[int, int, int], reach: float) -> Axes:
    """Three axes of exponential coordinates [rad] from -reach to reach."""
    axes = drawn.add_subplot(*place, projection="3d")
    axes.set_box_aspect((1, 1, 1))
    for name in "xyz":
        getattr(axes, f"set_{name}lim")(-reach, reach)
        getattr(axes, f"set_{name}ticks")([-0.5, 0.0, 0.5] if reach < 1.0 else [-1.0, 0.0, 1.0])
    axes.tick_params(labelsize=7)
    return axes


def curved_faces(cell: VoronoiCell) -> list[np.ndarray]:
    """The cell's faces in exponential coordinates, each as small triangles (k, 3, 3)."""
    on = np.abs(cell.vertices @ cell.normals.T - cell.offsets) < 1e-8
    return [_fan(cell.vertices[on[:, k]], cell.normals[k]) for k in range(len(cell.normals))]


def wedge_faces(wedge: Wedge) -> list[np.ndarray]:
    """The faces of the tetrahedron between a wedge's corners."""
    corners = rodrigues(wedge.vertices)
    faces = []
    for left_out in range(len(corners)):
        triangle = np.delete(corners, left_out, axis=0)
        faces.append(_fan(triangle, np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])))
    return faces


def _fan(corners: np.ndarray, normal: np.ndarray) -> np.ndarray:
    middle = corners.mean(axis=0)
    side = corners[0] - middle
    across = np.cross(normal, side)
    around = np.argsort(np.arctan2((corners - middle) @ across, (corners - middle) @ side))
    ring = corners[around]
    triangles = [
        piece
        for first, second in zip(ring, np.roll(ring, -1, axis=0), strict=True)
        for piece in _divided(np.array([middle, first, second]))
    ]
    return logarithm(from_rodrigues(np.array(triangles)))


def _divided(triangle: np.ndarray) -> list[np.ndarray]:
    def at(i: int, j: int) -> np.ndarray:
        return np.array([FINE - i - j, i, j]) @ triangle / FINE

    up = [(i, j) for i in range(FINE) for j in range(FINE - i)]
    pieces = [np.array([at(i, j), at(i + 1, j), at(i, j + 1)]) for i, j in up]
    down = [(i, j) for i, j in up if i + j < FINE - 1]
    return pieces + [np.array([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]) for i, j in down]


def draw_solid(axes: Axes, faces: list[np.ndarray], hue: str, opacity: float) -> None:
    """Draw faces of small triangles, shaded, with the faces' borders."""
    triangles = np.concatenate(faces)
    shade = Poly3DCollection(
        triangles, facecolors=hue, edgecolors=None, shade=True, lightsource=LIGHT, alpha=opacity
    )
    shade.set_linewidth(0.0)
    axes.add_collection3d(shade)
    for face in faces:
        for edge in _border(face):
            axes.plot(*edge.T, color=colours.PATH, linewidth=0.5, alpha=min(1.0, 2.0 * opacity))


def _border(triangles: np.ndarray) -> list[np.ndarray]:
    """The edges that belong to one triangle only."""
    edges: dict[frozenset[tuple[float, ...]], list[np.ndarray]] = {}
    for triangle in triangles:
        for i in range(3):
            edge = triangle[[i, (i + 1) % 3]]
            key = frozenset(tuple(np.round(point, 9) + 0.0) for point in edge)
            edges.setdefault(key, []).append(edge)
    return [found[0] for found in edges.values() if len(found) == 1]


def draw_prism(axes: Axes, polygon: np.ndarray, half_height: float, hue: str) -> None:
    """Draw a polygon (k, 2) of translations times headings up to ``half_height`` [rad]."""
    low = np.column_stack([polygon, np.full(len(polygon), -half_height)])
    high = np.column_stack([polygon, np.full(len(polygon), half_height)])
    sides = np.stack([low, np.roll(low, -1, 0), np.roll(high, -1, 0), high], axis=1)
    style = {"facecolors": hue, "edgecolors": colours.PATH, "linewidths": 0.7, "alpha": 0.35}
    axes.add_collection3d(Poly3DCollection([low, high, *sides], **style))
    axes.set_box_aspect((1.0, 1.0, 1.6))
    axes.set_xlim(-0.75, 0.75)
    axes.set_ylim(-0.75, 0.75)
    axes.set_zlim(-np.pi, np.pi)
    axes.set_zticks([-np.pi, 0.0, np.pi], ["-π", "0", "π"])
    axes.set_xticks([-0.5, 0.0, 0.5])
    axes.set_yticks([-0.5, 0.0, 0.5])
    axes.tick_params(labelsize=7)
