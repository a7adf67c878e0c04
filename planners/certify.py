"""Proofs of whole paths, whoever planned them."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.result import PathResult

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.space import CSpace

_SAMPLES = 33


def is_certified(cspace: CSpace, configurations: NDArray[np.float64]) -> bool:
    """Whether every state and every segment of a path (m, d) is proved free, in continuous time."""
    if len(configurations) == 1:
        return bool(cspace.is_valid(configurations[0]))
    pairs = pairwise(configurations)
    return all(cspace.is_motion_valid(first, second) for first, second in pairs)


def path_clearance(cspace: CSpace, configurations: NDArray[np.float64]) -> float:
    """Proved lower bound of the clearance along a path (m, d).

    Of a path that is not proved free, the least clearance of configurations along it, at most 0.
    """
    if len(configurations) == 1:
        return float(cspace.clearance(configurations[0]))
    pairs = list(pairwise(configurations))
    least = min(float(cspace.motion_clearance(first, second)) for first, second in pairs)
    return least if least > -math.inf else min(0.0, _sampled_clearance(cspace, pairs))


def _sampled_clearance(
    cspace: CSpace, pairs: list[tuple[NDArray[np.float64], NDArray[np.float64]]]
) -> float:
    steps = np.linspace(0.0, 1.0, _SAMPLES).tolist()
    return min(
        cspace.clearance(cspace.interpolate(first, second, s))
        for first, second in pairs
        for s in steps
    )


def path_result(cspace: CSpace, configurations: NDArray[np.float64]) -> PathResult:
    """A path (m, d) with its length, base travel, proved clearance and certificate."""
    return PathResult.from_configurations(
        cspace.robot,
        configurations,
        min_clearance=path_clearance(cspace, configurations),
        certified=is_certified(cspace, configurations),
    )
