"""A second opinion: FCL looks at the samples that are not too close for it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.scenario import Scenario
from planners.verify.motion import placements

Array = NDArray[np.float64]

SMALLEST_CLEARANCE = 1e-5
"""As a fraction of the scene's size; what is shallower, FCL may miss."""

_CLOSEST = 400
_EVENLY = 600


def fcl_contacts(
    scenario: Scenario, configurations: Array, lower: Array, size: float
) -> tuple[int, int]:
    """How many configurations (k, d) FCL tested, and in how many it sees an obstacle hit.

    The ones tested are the closest and an even choice of the others, as far as their
    clearances ``lower`` (k,) exceed what FCL resolves in a scene of this ``size``.
    """
    chosen = np.flatnonzero(lower > SMALLEST_CLEARANCE * size)
    closest = chosen[np.argsort(lower[chosen])][:_CLOSEST]
    evenly = chosen[:: max(1, len(chosen) // _EVENLY)]
    chosen = np.unique(np.concatenate([closest, evenly]))
    if not len(chosen) or not scenario.world.obstacles:
        return 0, 0
    from planners.fcl import FclBodies

    bodies = FclBodies(scenario.cspace())
    n = scenario.dimension
    positions, rotations = placements(scenario.robot, configurations[chosen])
    contacts = 0
    for position, rotation in zip(positions, rotations, strict=True):
        placed, turned = np.zeros(3), np.eye(3)
        placed[:n], turned[:n, :n] = position, rotation
        bodies.place(turned, placed)
        contacts += bodies.collide()
    return len(chosen), contacts
