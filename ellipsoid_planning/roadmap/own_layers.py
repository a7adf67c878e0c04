"""The layers and columns that a level of the roadmap begins with, whatever is asked of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.roadmap.joint_layers import spread_layers
from ellipsoid_planning.roadmap.layer_grids import MOST_LAYERS, grid_layers
from ellipsoid_planning.roadmap.orientations import random_turn, spread_orientations
from ellipsoid_planning.roadmap.parameters import RoadmapParameters

Array = NDArray[np.float64]

# A finer level has this many times the layers.
_MORE_LAYERS = 2.5


def only_column(cspace: CSpace, axis: int) -> Array:
    """The column (1, 3) of a robot whose base cannot move."""
    home = np.zeros(cspace.robot.configuration_size)
    column = cspace.poses(home[None])[:, :3].copy()
    column[0, axis] = 0.0
    return column


def own_layers(
    cspace: CSpace,
    parameters: RoadmapParameters,
    refinement: int,
    axis: int,
    stored: Array | None,
) -> tuple[Array, NDArray[np.int64] | None]:
    """The layers of a level (L, 4 + V), and a grid's own neighbours (L, K) or None.

    Args:
        cspace: what is planned in.
        parameters: of the roadmap.
        refinement: how many coarser levels there are.
        axis: the swept axis.
        stored: the layers, if they are known already.

    Raises:
        PlannerError: orientations were chosen for a robot with joints.
    """
    if isinstance(cspace, ArticulatedCSpace):
        if parameters.orientations is not None:
            raise PlannerError("orientations: robots with joints have layers of their own")
        return _joint_layers(cspace, parameters, refinement) if stored is None else stored, None
    if not cspace.rotates:
        return np.empty((0, 4)), None
    dimension, near, finer = cspace.dimension, None, _MORE_LAYERS**refinement
    if parameters.orientations is not None:
        layers, near = grid_layers(dimension, parameters.orientations, finer)
    else:
        count = min(round(parameters.layer_count(dimension) * finer), MOST_LAYERS)
        layers = spread_orientations(dimension, count)
    if stored is not None:
        return stored, near
    if refinement == 0:
        return layers, near
    # By the level alone: the order in which queries make levels must not matter.
    random = np.random.default_rng([parameters.seed, refinement, axis])
    return random_turn(layers, dimension, random), near


def _joint_layers(
    cspace: ArticulatedCSpace, parameters: RoadmapParameters, refinement: int
) -> Array:
    """The layers of a level for an articulated robot; finer levels go on with other ones."""
    count = parameters.layer_count(cspace.dimension, articulated=True)
    counts = [min(round(count * _MORE_LAYERS**k), MOST_LAYERS) for k in range(refinement + 1)]
    return spread_layers(cspace, counts[-1], sum(counts[:-1]))
