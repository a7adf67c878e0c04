"""The exact safety function: dual kernels, link by link."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.safety.function import SafetyReport

_ROUNDS = 3


class ExactSafety:
    """Links are tested one after the other, against the obstacles that a broad phase leaves.

    The first unsafe link ends the test.

    Attributes:
        cspace: of a robot of links or a rigid one.
    """

    def __init__(self, cspace: CSpace) -> None:
        """Make the safety function of a C-space."""
        self.cspace = cspace

    def is_safe(self, configuration: ArrayLike) -> bool:
        """Whether a configuration (d,) is proved safe."""
        return self.cspace.is_valid(configuration)

    def are_safe(self, configurations: ArrayLike) -> NDArray[np.bool_]:
        """Whether each configuration (m, d) is proved safe, shape (m,)."""
        return self.cspace.are_valid(configurations)

    def report(self, configurations: ArrayLike | None = None) -> SafetyReport:
        """What it costs; measured on configurations (m, d), if given."""
        if configurations is None or not len(np.atleast_2d(np.asarray(configurations))):
            return SafetyReport("exact")
        values = np.atleast_2d(np.asarray(configurations, dtype=float))
        safe = self.are_safe(values)
        seconds = mean_time(lambda: self.are_safe(values), len(values))
        return SafetyReport(
            "exact",
            states=len(values),
            safe=float(safe.mean()),
            state_time=seconds,
            exact_time=seconds,
        )


def mean_time(run: Callable[[], object], count: int) -> float:
    """The least wall time [s] of a few calls that do ``count`` things each, for one of them."""
    times = []
    for _ in range(_ROUNDS):
        began = time.perf_counter()
        run()
        times.append(time.perf_counter() - began)
    return min(times) / count
