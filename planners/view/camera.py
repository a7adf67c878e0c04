"""Where the viewer stands, and where it sees a point."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

SAFE_ASPECT = 4.0 / 3.0  # a window at least this wide shows the whole scene
MARGIN = 1.12
FIELD_OF_VIEW_DEG = 30.0
ELEVATION_DEG = 32.0
DEFAULT_AZIMUTH_DEG = -60.0


@dataclass(frozen=True, eq=False)
class Camera:
    """A perspective camera that looks at the centre of a scene, world z (2-D: y) upwards.

    Attributes:
        centre: (3,), the point looked at, in the scene's coordinates.
        right, up, back: unit vectors (3,) of the image plane and from the scene to the viewer.
        distance: from `centre` to the viewer, in the scene's unit of length.
    """

    centre: NDArray[np.float64]
    right: NDArray[np.float64]
    up: NDArray[np.float64]
    back: NDArray[np.float64]
    distance: float

    @property
    def eye(self) -> NDArray[np.float64]:
        """The viewer's place, (3,)."""
        return self.centre + self.distance * self.back

    def axes(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return points (m, 3) as (right, up, towards the viewer) of the centre, (m, 3)."""
        return np.asarray((points - self.centre) @ np.array([self.right, self.up, self.back]).T)

    def pixels(self, points: NDArray[np.float64], width: int, height: int) -> NDArray[np.float64]:
        """Return where points (m, 3) appear, (m, 2), counted right and down from a corner."""
        seen = self.axes(points)
        focal = 0.5 * height / math.tan(math.radians(FIELD_OF_VIEW_DEG) / 2.0)
        plane = focal * seen[:, :2] / (self.distance - seen[:, 2:])
        return np.asarray(plane * [1.0, -1.0] + [width / 2.0, height / 2.0])


def frame(points: NDArray[np.float64], azimuth: float | None) -> Camera:
    """Return the nearest camera that shows all points (m, 3).

    `azimuth` [rad] is the viewer's compass direction; None looks straight down.
    """
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    right, up, back = _looking_down() if azimuth is None else _looking_from(azimuth)
    seen = (points - centre) @ np.array([right, up, back]).T
    tangent = math.tan(math.radians(FIELD_OF_VIEW_DEG) / 2.0)
    reach = np.maximum(np.abs(seen[:, 1]), np.abs(seen[:, 0]) / SAFE_ASPECT) * MARGIN / tangent
    return Camera(centre, right, up, back, float(np.max(seen[:, 2] + reach)))


def side_view(start: NDArray[np.float64], goal: NDArray[np.float64]) -> float:
    """Return the azimuth [rad] from which the way from start to goal runs left to right.

    Both are positions (3,).
    """
    way = goal - start
    if math.hypot(way[0], way[1]) <= 1e-6 * float(np.linalg.norm(way)) + 1e-12:
        return math.radians(DEFAULT_AZIMUTH_DEG)
    # Turned a little from the exact side, so that boxes and rings do not look flat.
    return math.atan2(way[1], way[0]) - math.pi / 2.0 + math.radians(20.0)


def _looking_down() -> tuple[NDArray[np.float64], ...]:
    return tuple(np.eye(3))


def _looking_from(azimuth: float) -> tuple[NDArray[np.float64], ...]:
    elevation = math.radians(ELEVATION_DEG)
    flat = np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
    back = math.cos(elevation) * flat + math.sin(elevation) * np.array([0.0, 0.0, 1.0])
    right = np.array([-flat[1], flat[0], 0.0])
    return right, np.cross(back, right), back
