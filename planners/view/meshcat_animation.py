"""The robot's motion along a path as a meshcat animation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from planners.view.embedding import Embedding
    from planners.view.trajectory import Trajectory

SECONDS = 8.0
PAUSE_SECONDS = 1.0  # at the goal, before it starts again
FRAMES_PER_SECOND = 30.0
REPETITIONS = 1_000_000


def animate(node: Any, trajectory: Trajectory, embedding: Embedding) -> None:
    """Let a node follow a trajectory again and again, time in proportion to OMPL's metric.

    The key frames are the trajectory's samples, which OMPL's interpolation gave. Between them
    meshcat interpolates in the same way: positions linearly, rotations by the shortest slerp.
    """
    from meshcat.animation import Animation

    animation = Animation(default_framerate=FRAMES_PER_SECOND)
    frames = trajectory.fractions * SECONDS * FRAMES_PER_SECOND
    for frame, configuration in zip(frames, trajectory.configurations, strict=True):
        key = animation.at_frame(node, float(frame))
        key.set_property("position", "vector3", _position(configuration, embedding))
        quaternion = embedding.quaternion(configuration)
        if quaternion is not None:
            key.set_property("quaternion", "quaternion", quaternion.tolist())
    end = float(frames[-1]) + PAUSE_SECONDS * FRAMES_PER_SECOND
    last = _position(trajectory.configurations[-1], embedding)
    animation.at_frame(node, end).set_property("position", "vector3", last)
    node.set_animation(animation, repetitions=REPETITIONS)


def _position(configuration: np.ndarray, embedding: Embedding) -> list[float]:
    position = np.zeros(3)
    position[: embedding.dimension] = configuration[: embedding.dimension]
    return [float(coordinate) for coordinate in position]
