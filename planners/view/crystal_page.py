"""A self-contained page with a packed cell to turn about."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ellipsoid_planning.geometry.directions import unit_directions
from planners.view import crystal_colours as palette
from planners.view import meshcat_shapes
from planners.view.camera import frame
from planners.view.crystal_cell import DrawnCell, drawn_cell
from planners.view.crystal_space import AZIMUTH
from planners.view.embedding import LINES, SOLID, Embedding, Slab
from planners.view.meshcat_page import page_of_scene
from planners.view.meshcat_robot import named
from planners.view.meshcat_scene import THICKNESS, Scene
from planners.view.meshcat_surroundings import ROOT, set_surroundings
from planners.view.surfaces import fan_patches, grid_patches, triangles

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from ellipsoid_planning.crystal.packing.copies import Copy
    from ellipsoid_planning.crystal.packing.model import PackingModel
    from ellipsoid_planning.crystal.packing.overlaps import Overlap

    Array = NDArray[np.float64]

MOST_FOLDERS = 12  # operations that have a switch each; more share one
DIVISION_SLASH = "\u2215"  # meshcat divides paths at the other one
CELL, MOLECULE, COPIES, OVERLAPS = "cell", "molecule", "copies", "overlaps"
ROOM = 1.1  # for the caption
EDGE = 0.004  # radius of the home cell's edges, as a part of the scene's size
ABOVE = Slab(2.0, 2.4)  # overlaps of planar bodies
LEVEL = 0.25  # by which each part of a planar molecule is lower, lest their tops flicker
OUTLINE_POINTS = 64
DRAWN_LAST = {"transparent": True, "opacity": 0.9, "depthTest": False}


def page_of_cell(
    model: PackingModel,
    configuration: ArrayLike,
    cells: Sequence[int] | None = None,
    title: str = "",
    lines: Sequence[str] = (),
) -> str:
    """Return a page with the copies of a molecule in one cell or several.

    Args:
        model: the molecule and its crystal.
        configuration: (K,), angles [rad].
        cells: (n,), how many cells along each axis; by default 3 x 3 in the plane, one in space.
        title: the model's name by default.
        lines: of text below the title, before the group and the cell.

    Raises:
        CrystalError: if the configuration or the cells do not fit the model.
    """
    cell = drawn_cell(model, configuration, cells)
    text = [*lines, cell.headline(), cell.values()]
    return page_of_scene(crystal_scene(cell), title or model.name, text)


def crystal_scene(cell: DrawnCell) -> Scene:
    """Draw the cells' edges, the molecule, its copies by operation, and what overlaps."""
    builder = _CrystalBuilder(cell)
    builder.draw_edges()
    builder.draw_copies()
    builder.draw_overlaps()
    return Scene(
        tuple(builder.recorder.commands),
        builder.camera,
        builder.embedding,
        tuple(builder.folders.items()),
        (),
    )


class _CrystalBuilder:
    def __init__(self, cell: DrawnCell) -> None:
        self.cell = cell
        points = np.concatenate(
            [
                cell.corners(cell.low, cell.high),
                *(body.surface_points(100) for copy in cell.copies for body in copy.bodies),
            ]
        )
        self.size = float(np.max(np.ptp(points, axis=0)))
        self.embedding = Embedding(cell.model.dimension, THICKNESS * self.size)
        azimuth = None if cell.model.dimension == 2 else AZIMUTH
        near = frame(self.embedding.points(points, SOLID), azimuth)
        self.camera = replace(near, distance=ROOM * near.distance)
        self.recorder = meshcat_shapes.CommandRecorder()
        visualizer = meshcat_shapes.recorded_visualizer(self.recorder)
        set_surroundings(visualizer, self.camera, cell.model.dimension)
        self.root = visualizer["/" + ROOT]
        self.folders: dict[str, str] = {}

    def draw_edges(self) -> None:
        self.folders[CELL] = palette.CELL
        kinds = (
            ("edge", self.cell.home_edges(), palette.CELL, EDGE),
            ("neighbour", self.cell.neighbour_lines(), palette.NEIGHBOUR_CELLS, 0.4 * EDGE),
        )
        for name, edges, colour, radius in kinds:
            look = meshcat_shapes.material(colour)
            for index, edge in enumerate(edges):
                tube = meshcat_shapes.tube(self.embedding.points(edge, LINES), radius * self.size)
                self.root[f"{CELL}/{name} {index}"].set_object(tube, look)

    def draw_copies(self) -> None:
        home = {(copy.operation, copy.lattice) for copy in self.cell.home}
        for copy in self.cell.copies:
            at_home = (copy.operation, copy.lattice) in home
            folder = self._folder(copy, at_home)
            hue = self.cell.hues[copy.operation]
            self._draw_copy(folder, copy, hue if at_home else palette.faded(hue))

    def draw_overlaps(self) -> None:
        if self.cell.overlaps:
            self.folders[OVERLAPS] = palette.OVERLAP
        for index, overlap in enumerate(self.cell.overlaps):
            look = meshcat_shapes.material(palette.OVERLAP, **DRAWN_LAST)
            self.root[f"{OVERLAPS}/{index}"].set_object(self._overlap(overlap), look)

    def _folder(self, copy: Copy, at_home: bool) -> str:
        """The molecule has its own, and so have few operations."""
        if at_home and copy.operation == 0:
            name, colour = MOLECULE, self.cell.hues[0]
        elif self.cell.model.group.order > MOST_FOLDERS:
            name, colour = COPIES, self.cell.hues[1]
        else:
            name = self.cell.operations[copy.operation].replace("/", DIVISION_SLASH)
            colour = self.cell.hues[copy.operation]
            if copy.operation == 0:
                colour = palette.faded(colour)
        self.folders.setdefault(name, colour)
        return name

    def _draw_copy(self, folder: str, copy: Copy, hue: str) -> None:
        place = " ".join(map(str, (copy.operation, *copy.lattice)))
        taken: set[str] = set()
        shades = palette.part_shades(self.cell.model, hue)
        for level, ((body, name), shade) in enumerate(
            zip(named(copy.bodies, taken), shades, strict=True)
        ):
            node = self.root[f"{folder}/{place}/{name}"]
            slab = Slab(SOLID.bottom, SOLID.top - min(level * LEVEL, 1.5))
            node.set_object(
                meshcat_shapes.unit_shape(self.embedding.dimension), meshcat_shapes.material(shade)
            )
            node.set_transform(self.embedding.matrix(body, slab))

    def _overlap(self, overlap: Overlap) -> Any:
        from meshcat.geometry import TriangularMeshGeometry

        if self.embedding.dimension == 3:
            patches = grid_patches(overlap.surface(32, 8))
        else:
            outline = overlap.boundary(unit_directions(2, OUTLINE_POINTS))
            patches = fan_patches(self.embedding.points(outline, ABOVE))
        return TriangularMeshGeometry(*triangles(patches))
