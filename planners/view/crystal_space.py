"""Packed cells in space: shaded bodies in parallel projection."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from planners.view import crystal_colours as palette
from planners.view.camera import Camera, frame
from planners.view.crystal_plane import halo
from planners.view.ray_image import NOBODY, RayImage

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from ellipsoid_planning.crystal.packing.copies import Copy
    from planners.view.crystal_cell import DrawnCell

    Array = NDArray[np.float64]

AZIMUTH = math.radians(32.0)  # of the viewer: the ends of all three axes point outwards
EDGE = 0.005  # half the width of the home cell's edges, as a part of the window's width
ROOM = 0.07  # around everything, likewise
FINE = 1800  # pixels of the larger views' longer side, shown at about half of them
LETTER = 0.035  # how far beyond its axis' end a letter stands, as a part of the window's width
OUTLINES = 900  # pixels a pixel of outline


def oblique(cell: DrawnCell) -> Camera:
    """A camera that looks at the cells from a corner, c upwards."""
    return frame(cell.corners(cell.low, cell.high), AZIMUTH)


def along(cell: DrawnCell, axis: int) -> Camera:
    """A camera that looks down an axis of the cell; of the others, the next one points right."""
    basis = cell.model.cell.basis
    back = basis[:, axis] / np.linalg.norm(basis[:, axis])
    following = basis[:, (axis + 1) % 3]
    right = following - back * (following @ back)
    right /= np.linalg.norm(right)
    corners = cell.corners(cell.low, cell.high)
    centre = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
    return Camera(centre, right, np.cross(back, right), back, 1.0)


def window(cell: DrawnCell, camera: Camera) -> tuple[Array, Array]:
    """The corners (2,) of a rectangle of the image plane that holds all cells and copies."""
    seen = camera.axes(cell.corners(cell.low, cell.high))[:, :2]
    plane = np.array([camera.right, camera.up])
    bodies = [body for copy in cell.copies for body in copy.bodies]
    centres = camera.axes(np.array([body.centre for body in bodies]))[:, :2]
    reach = np.array([np.linalg.norm(plane @ body.matrix, axis=1) for body in bodies])
    low = np.minimum(seen.min(axis=0), (centres - reach).min(axis=0))
    high = np.maximum(seen.max(axis=0), (centres + reach).max(axis=0))
    room = ROOM * float(np.max(high - low))
    return low - room, high + room


def draw_space_cell(
    axes: Axes, cell: DrawnCell, camera: Camera, size: Array | None = None, pixels: int = FINE
) -> None:
    """Draw the copies, the cells' edges, and, over all of them, what overlaps in yellow.

    Args:
        axes: where to draw.
        cell: what to draw.
        camera: from where; `Camera.axes` gives the axes' data coordinates.
        size: (2,), of the window, if not as small as it can be.
        pixels: of its longer side.
    """
    low, high = window(cell, camera)
    if size is not None:
        low, high = 0.5 * (low + high - size), 0.5 * (low + high + size)
    image = rendered(cell, camera, low, high, pixels)
    axes.imshow(
        image.colours,
        origin="lower",
        extent=(low[0], high[0], low[1], high[1]),
        interpolation="antialiased",
    )
    _name_axes(axes, cell, camera, LETTER * float(np.max(high - low)))
    axes.set_aspect("equal", anchor="N")
    axes.set_axis_off()


def rendered(cell: DrawnCell, camera: Camera, low: Array, high: Array, pixels: int) -> RayImage:
    """The picture of the cells in a window of the image plane."""
    image = RayImage(camera, low, high, pixels)
    home = {(copy.operation, copy.lattice) for copy in cell.home}
    original = None
    for owner, copy in enumerate(cell.copies):
        at_home = (copy.operation, copy.lattice) in home
        original = owner if at_home and copy.operation == 0 else original
        _add_copy(image, cell, copy, owner, at_home)
    radius = EDGE * float(np.max(high - low)) / np.sqrt(max(cell.counts))
    for line in cell.neighbour_lines():
        image.add_line(line, 0.4 * radius, palette.NEIGHBOUR_CELLS)
    for line in cell.home_edges():
        image.add_line(line, radius, palette.CELL)
    thickness = max(1, round(pixels / OUTLINES))
    image.outline(thickness)
    image.outline(2 * thickness, original)
    _put_overlaps(image, cell, pixels)
    return image


def _add_copy(image: RayImage, cell: DrawnCell, copy: Copy, owner: int, at_home: bool) -> None:
    hue = cell.hues[copy.operation]
    shades = palette.part_shades(cell.model, hue if at_home else palette.faded(hue))
    for body, shade in zip(copy.bodies, shades, strict=True):
        image.add(body, shade, owner)


def _put_overlaps(image: RayImage, cell: DrawnCell, pixels: int) -> None:
    """They are inside two bodies, and shown through these, but through no others."""
    if not cell.overlaps:
        return
    inside = RayImage(image.camera, image.low, image.high, pixels)
    owner_of = {id(body): owner for owner, copy in enumerate(cell.copies) for body in copy.bodies}
    owners = []
    for index, overlap in enumerate(cell.overlaps):
        inside.add_common(overlap.first, overlap.second, palette.OVERLAP, index)
        owners.append([owner_of.get(id(body), NOBODY) for body in overlap[:2]])
    shown = np.isfinite(inside.depths)
    seen_through = np.array(owners)[inside.owners]
    shown &= image.owners != NOBODY
    shown &= np.any(image.owners[..., None] == seen_through, axis=-1)
    inside.outline(max(1, round(pixels / OUTLINES)))
    image.put_over(inside, shown)


def _name_axes(axes: Axes, cell: DrawnCell, camera: Camera, beyond: float) -> None:
    basis = cell.model.cell.basis
    corner = cell.model.cell.cartesian(cell.origin)
    for name, column in zip("abc", basis.T, strict=True):
        first, last = camera.axes(np.array([corner, corner + column]))[:, :2]
        length = float(np.linalg.norm(last - first))
        if length < 0.1 * np.linalg.norm(column):
            continue
        x, y = last + beyond * (last - first) / length
        axes.text(
            x,
            y,
            name,
            ha="center",
            va="center",
            style="italic",
            fontsize=12,
            zorder=6,
            path_effects=halo(),
        )
