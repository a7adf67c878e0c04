"""Where a meshcat page's viewer stands, and what is around the scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from planners.view.camera import FIELD_OF_VIEW_DEG

if TYPE_CHECKING:
    from planners.view.camera import Camera

ROOT = "scenario"
EYE_DISTANCE = 2.0  # at which meshcat's own lights suit the scene


def set_surroundings(visualizer: Any, camera: Camera, dimension: int) -> None:
    """Scale the scene to the reach of meshcat's lights, and set camera and background.

    The centre of the scene becomes the origin, about which meshcat's mouse controls turn.
    """
    scale = EYE_DISTANCE / camera.distance
    matrix = np.diag([scale, scale, scale, 1.0])
    matrix[:3, 3] = -scale * camera.centre
    visualizer["/" + ROOT].set_transform(matrix)
    for name in ("/Grid", "/Axes"):
        visualizer[name].set_property("visible", False)
    visualizer["/Background"].set_property("top_color", [1.0, 1.0, 1.0])
    visualizer["/Background"].set_property("bottom_color", [0.93, 0.95, 0.97])
    x, y, z = (float(coordinate) for coordinate in EYE_DISTANCE * camera.back)
    # Straight above, the mouse controls would not know which way is up.
    tilt = 1e-4 if dimension == 2 else 0.0
    eye = visualizer["/Cameras/default/rotated/<object>"]
    eye.set_property("fov", FIELD_OF_VIEW_DEG)
    eye.set_property("near", 0.02)
    eye.set_property("position", [x, z, -y + tilt])  # this node counts y upwards
