"""Ellipsoids in parallel projection, pixel by pixel: exact silhouettes and exact intersections."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from planners.view.colours import rgb
from planners.view.figures_space import LIGHT

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ellipsoid_planning.geometry import Ellipsoid
    from planners.view.camera import Camera

    Array = NDArray[np.float64]

DARKEST, BRIGHTEST = 0.6, 1.2
NOBODY = -1
OUTLINE = np.array([0.15, 0.15, 0.15])


class RayImage:
    """A picture of a window of the image plane, white where nothing is.

    Attributes:
        low, high: (2,), the window's corners, right and up of the camera's centre.
        colours: (rows, columns, 3) in [0, 1], the first row at the bottom.
        depths: (rows, columns), of what is seen, towards the viewer.
        owners: (rows, columns), whose body is seen; outlines are drawn between owners.
    """

    def __init__(self, camera: Camera, low: Array, high: Array, pixels: int) -> None:
        """The longer side of the window gets ``pixels`` pixels."""
        self.camera, self.low, self.high = camera, low, high
        self.spacing = float(np.max(high - low)) / pixels
        columns, rows = np.maximum(np.rint((high - low) / self.spacing).astype(int), 1)
        self.colours = np.ones((rows, columns, 3))
        self.depths = np.full((rows, columns), -np.inf)
        self.owners = np.full((rows, columns), NOBODY)

    def add(self, body: Ellipsoid, colour: str, owner: int) -> None:
        """Add a body, seen where it is nearer than what is there."""
        self._add([body], colour, owner)

    def add_common(self, first: Ellipsoid, second: Ellipsoid, colour: str, owner: int) -> None:
        """Add the common region of two bodies."""
        self._add([first, second], colour, owner)

    def add_line(self, ends: Array, radius: float, colour: str) -> None:
        """Add a straight line between two points (2, 3), ``radius`` thick to either side."""
        first, last = self.camera.axes(ends)
        reach = np.array([radius, radius])
        window = self._window(
            np.minimum(first, last)[:2] - reach, np.maximum(first, last)[:2] + reach
        )
        across, up = self._places(window)
        way = last - first
        square = float(way[:2] @ way[:2])
        share = (across - first[0]) * way[0] + (up - first[1]) * way[1]
        share = np.clip(share / square, 0.0, 1.0) if square > 1e-12 * (way @ way) else 0.0 * share
        off = np.hypot(across - first[0] - share * way[0], up - first[1] - share * way[1])
        depth = first[2] + share * way[2] if square > 0.0 else np.maximum(first[2], last[2])
        depth = np.where(off <= radius, depth + radius, -np.inf)
        self._put(window, depth, np.broadcast_to(rgb(colour), (*depth.shape, 3)), NOBODY)

    def outline(self, thickness: int, only: int | None = None) -> None:
        """Darken the pixels at the borders between owners; at those of ``only`` one, if given."""
        border = np.zeros(self.owners.shape, dtype=bool)
        for rows, columns in ((1, 0), (0, 1)):
            here = self.owners[: len(self.owners) - rows, : self.owners.shape[1] - columns]
            there = self.owners[rows:, columns:]
            differ = here != there
            if only is not None:
                differ &= (here == only) | (there == only)
            border[: len(here), : here.shape[1]] |= differ
        for shift in range(1, thickness):
            border[shift:] |= border[:-shift].copy()
            border[:, shift:] |= border[:, :-shift].copy()
        # Lines belong to nobody and are seen as they are.
        border &= ~((self.owners == NOBODY) & np.isfinite(self.depths))
        self.colours[border] = OUTLINE

    def put_over(self, other: RayImage, shown: NDArray[np.bool_]) -> None:
        """Put those pixels of another picture of the same window over this one's."""
        self.colours[shown] = other.colours[shown]

    def _add(self, bodies: list[Ellipsoid], colour: str, owner: int) -> None:
        axes = np.array([self.camera.right, self.camera.up, self.camera.back])
        centres = self.camera.axes(np.array([body.centre for body in bodies]))
        maps = [axes @ body.matrix for body in bodies]
        reaches = np.array([np.linalg.norm(matrix, axis=1)[:2] for matrix in maps])
        low = np.max(centres[:, :2] - reaches, axis=0)
        high = np.min(centres[:, :2] + reaches, axis=0)
        if np.any(low >= high):
            return
        window = self._window(low, high)
        across, up = self._places(window)
        near, far = np.full(across.shape, np.inf), np.full(across.shape, -np.inf)
        light = np.zeros(across.shape)
        for centre, matrix in zip(centres, maps, strict=True):
            front, back, shade = _seen(centre, matrix, across, up)
            # Of a common region the body that begins last is seen.
            later = front < near
            near, light = np.where(later, front, near), np.where(later, shade, light)
            far = np.maximum(far, back)
        depth = np.where(near >= far, near, -np.inf)
        shades = np.clip(light[..., None] * rgb(colour), 0.0, 1.0)
        self._put(window, depth, shades, owner)

    def _window(self, low: Array, high: Array) -> tuple[slice, slice]:
        """Rows and columns of the pixels within a rectangle."""
        first = np.floor((low - self.low) / self.spacing - 0.5).astype(int)
        last = np.ceil((high - self.low) / self.spacing - 0.5).astype(int) + 1
        (left, bottom), (right, top) = np.maximum(first, 0), np.maximum(last, 0)
        return slice(bottom, top), slice(left, right)

    def _places(self, window: tuple[slice, slice]) -> tuple[Array, Array]:
        rows, columns = (
            np.arange(*part.indices(count))
            for part, count in zip(window, self.depths.shape, strict=True)
        )
        across = self.low[0] + (columns + 0.5) * self.spacing
        up = self.low[1] + (rows + 0.5) * self.spacing
        return np.broadcast_to(across, (len(rows), len(columns))), np.broadcast_to(
            up[:, None], (len(rows), len(columns))
        )

    def _put(self, window: tuple[slice, slice], depth: Array, shades: Array, owner: int) -> None:
        nearer = depth > self.depths[window]
        self.depths[window][nearer] = depth[nearer]
        self.colours[window][nearer] = shades[nearer]
        self.owners[window][nearer] = owner


def _seen(centre: Array, matrix: Array, across: Array, up: Array) -> tuple[Array, Array, Array]:
    """Depths of the front and the back of a body, and the light on its front.

    Where the ray misses the body, the front is behind the back.
    """
    inverse = np.linalg.inv(matrix)
    form = inverse.T @ inverse
    x, y = across - centre[0], up - centre[1]
    half = (form[0, 2] * x + form[1, 2] * y) / form[2, 2]
    flat = form[0, 0] * x * x + 2.0 * form[0, 1] * x * y + form[1, 1] * y * y - 1.0
    square = half * half - flat / form[2, 2]
    root = np.sqrt(np.maximum(square, 0.0))
    hit = square >= 0.0
    z = root - half
    normal = np.stack([x, y, z], axis=-1) @ form
    facing = normal @ LIGHT / np.maximum(np.linalg.norm(normal, axis=-1), 1e-300)
    # Light that reaches around the body ("half Lambert") keeps the dark side readable.
    shade = DARKEST + (BRIGHTEST - DARKEST) * np.maximum(0.5 + 0.5 * facing, 0.0) ** 1.5
    front = np.where(hit, centre[2] + z, -np.inf)
    return front, np.where(hit, centre[2] - half - root, np.inf), shade
