"""The robot's motion along a path as a meshcat animation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from planners.view.links import hung_poses

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from ellipsoid_planning.robots import Robot
    from planners.view.embedding import Embedding
    from planners.view.trajectory import Trajectory

SECONDS = 8.0
PAUSE_SECONDS = 1.0  # at the goal, before it starts again
FRAMES_PER_SECOND = 30.0
REPETITIONS = 1_000_000
SAME = 1e-12  # numbers of a pose that differ by less do not move


def animate(
    nodes: Mapping[str, Any], robot: Robot, trajectory: Trajectory, embedding: Embedding
) -> None:
    """Let a robot follow a trajectory again and again, time in proportion to OMPL's metric.

    The key frames are the trajectory's samples, which OMPL's interpolation gave. Between them
    meshcat interpolates in the same way: positions linearly, rotations by the shortest slerp,
    each link against the one that it hangs on.

    Args:
        nodes: of the links, by name, each within that of the link that it hangs on.
        robot: whose links they are.
        trajectory: what is followed.
        embedding: how the robot is drawn.
    """
    from meshcat.animation import Animation

    animation = Animation(default_framerate=FRAMES_PER_SECOND)
    frames = trajectory.fractions * SECONDS * FRAMES_PER_SECOND
    times = [*frames.tolist(), float(frames[-1]) + PAUSE_SECONDS * FRAMES_PER_SECOND]
    samples = [hung_poses(robot, q) for q in trajectory.configurations]
    for link, node in nodes.items():
        poses = [embedding.pose(*sample[link]) for sample in samples]
        positions = np.array([position for position, _ in poses])
        quaternions = np.array([quaternion for _, quaternion in poses])
        node.set_transform(_matrix(positions[0], embedding, samples[0][link][1]))
        _add_track(animation, node, "position", "vector3", times, positions)
        _add_track(animation, node, "quaternion", "quaternion", times, quaternions)
    if animation.clips:
        nodes[robot.root].set_animation(animation, repetitions=REPETITIONS)


def _add_track(
    animation: Any,
    node: Any,
    name: str,
    kind: str,
    times: list[float],
    values: NDArray[np.float64],
) -> None:
    """Add key frames, the last of them for the pause too, unless nothing moves."""
    if np.all(np.abs(values - values[0]) < SAME * max(1.0, np.abs(values).max())):
        return
    for time, value in zip(times, [*values.tolist(), values[-1].tolist()], strict=True):
        animation.at_frame(node, time).set_property(name, kind, value)


def _matrix(
    position: NDArray[np.float64], embedding: Embedding, rotation: NDArray[np.float64]
) -> NDArray[np.float64]:
    matrix = np.eye(4)
    matrix[: embedding.dimension, : embedding.dimension] = rotation
    matrix[:3, 3] = position
    return matrix
