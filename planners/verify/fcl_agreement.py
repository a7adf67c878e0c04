"""A second opinion: FCL looks at the samples that are not too close for it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.scenario import Scenario

Array = NDArray[np.float64]

SMALLEST_CLEARANCE = 1e-5
"""As a fraction of the scene's size; what is shallower, FCL may miss."""

_CLOSEST = 400
_EVENLY = 600


def fcl_contacts(
    scenario: Scenario, configurations: Array, lower: Array, size: float, itself: bool = False
) -> tuple[int, int]:
    """How many configurations (k, d) FCL tested, and in how many it sees a hit.

    A hit of an obstacle or, if ``itself`` is asked for, of one part by another.

    The ones tested are the closest and an even choice of the others, as far as their
    clearances ``lower`` (k,) exceed what FCL resolves in a scene of this ``size``.
    """
    chosen = np.flatnonzero(lower > SMALLEST_CLEARANCE * size)
    closest = chosen[np.argsort(lower[chosen])][:_CLOSEST]
    evenly = chosen[:: max(1, len(chosen) // _EVENLY)]
    chosen = np.unique(np.concatenate([closest, evenly]))
    if not len(chosen) or not (itself or scenario.world.obstacles):
        return 0, 0
    from planners.fcl import FclBodies

    bodies = FclBodies(scenario.cspace())
    contacts = 0
    for row in configurations[chosen]:
        bodies.place_at(row)
        contacts += bodies.meets_itself() if itself else bodies.meets_obstacle()
    return len(chosen), contacts
