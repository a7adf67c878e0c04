"""Ranges of the parameters of OMPL's planners, most of which OMPL takes as they come."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.numbers_shown import shown
from ellipsoid_planning.sizes import MOST_LENGTH

MOST_SAMPLES = 10_000_000
"""Of what a planner keeps at once: ten million states take gigabytes."""

RANGES: Mapping[str, tuple[float, float]] = {
    "range": (0, MOST_LENGTH),
    "goal_bias": (0, 1),
    "border_fraction": (0, 1),
    "min_valid_path_fraction": (0, 1),
    "failed_expansion_score_factor": (0, 1),
    "max_nearest_neighbors": (1, 100_000),
    "rewire_factor": (0, 1e6),
    "prune_threshold": (0, 1),
    "prune_threshold_as_fractional_cost_change": (0, 1),
    "ordering_batch_size": (1, MOST_SAMPLES),
    "number_sampling_attempts": (1, MOST_SAMPLES),
    "samples_per_batch": (1, MOST_SAMPLES),
    "num_samples": (1, MOST_SAMPLES),
    "radius_multiplier": (0, 1e6),
    "free_space_volume": (0, MOST_LENGTH**3),
}


def check_ranges(planner: str, values: Mapping[str, Any]) -> None:
    """Check the numbers among a bound planner's parameters.

    Raises:
        PlannerError: naming the first that is out of its range.
    """
    for name, value in values.items():
        least, most = RANGES.get(name, (value, value))
        if not least <= value <= most:
            highest = most if isinstance(most, int) else f"{most:g}"
            raise PlannerError(
                f"{planner}.{name}: expected a number from {least} to {highest}, got {shown(value)}"
            )
