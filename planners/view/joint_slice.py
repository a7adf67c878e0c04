"""A slice through the joint space of a robot whose base is fixed, ready to be drawn.

Such a robot does not translate and has no layers. All its joints but two, or but one, are held;
the configuration space of the others is a rectangle, or a line.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.robots.joint import BALL

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
    from ellipsoid_planning.robots import Joint

SHOWN = 2
CELLS = 240


@dataclass(frozen=True, eq=False)
class JointSlice:
    """The values of two joints, or of one, the others held as a configuration has them.

    Attributes:
        cspace: of the robot.
        configuration: (d,), whose joints are held.
        path: (m, d); the joints that it moves farthest, in OMPL's metric, are shown.
    """

    cspace: ArticulatedCSpace
    configuration: NDArray[np.float64]
    path: NDArray[np.float64]

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """The joints shown: at most two, and no ball joints."""
        robot = self.cspace.articulated
        weights = dict(zip(robot.joint_names, robot.joint_weights, strict=True))
        single = [joint for joint in robot.moving_joints if joint.type != BALL]
        moved = [weights[joint.name] * np.ptp(self._values(self.path, joint)) for joint in single]
        farthest = sorted(np.argsort(np.negative(moved), kind="stable")[:SHOWN])
        return tuple(single[i] for i in farthest)

    @property
    def point(self) -> NDArray[np.float64]:
        """The values of the joints shown, (k,), [rad] where they turn."""
        return np.array([self._values(self.configuration, joint) for joint in self.joints])

    def free(self, cells: int = CELLS) -> NDArray[np.bool_]:
        """Which middles of even cells between the limits are proved free.

        Returns:
            (cells, cells), the first joint's values along the columns; (cells,) for one joint.
        """
        part = (np.arange(cells) + 0.5) / cells
        along = [joint.lower + part * (joint.upper - joint.lower) for joint in self.joints]
        grid = np.meshgrid(*along)
        configurations = np.tile(self.configuration, (grid[0].size, 1))
        for joint, values in zip(self.joints, grid, strict=True):
            configurations[:, self.cspace.articulated.joint_slices[joint.name]] = values.reshape(
                -1, 1
            )
        return self.cspace.are_valid(configurations).reshape(grid[0].shape)

    def _values(self, configurations: NDArray[np.float64], joint: Joint) -> NDArray[np.float64]:
        column = self.cspace.articulated.joint_slices[joint.name].start
        return np.asarray(configurations[..., column])
