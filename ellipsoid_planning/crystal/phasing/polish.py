"""Local refinement: least squares on the magnitudes, within bounds, that ends with room to live."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.phasing.trace import Trace
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.kernels import molecule as kernels

Array = NDArray[np.float64]

EVALUATIONS = 200
# Relative steps, and gains, that end it; near the target of exact data each step's gain is huge.
STEP, GAIN = 1e-13, 1e-8
# A cost below this share of an empty cell's is nothing but rounding.
ROUNDING = 1e-14
# How often the way from a free arrangement to a better one that collides is halved.
HALVINGS = 30
# What a range of no width (a coordinate that the search holds fixed) may move: nothing, nearly.
FIXED = 1e-12
# Sines of the angle between two axes below this are not divided by.
POLE = 1e-3


@dataclass(frozen=True, eq=False)
class Polished:
    """What a local refinement came to.

    Attributes:
        configuration: (K,), the free arrangement with the lowest cost that was met; where none
            was free, simply the one with the lowest cost.
        cost: its FCF.
        free: whether it is proved free.
        trace: what was looked at, with the costs.
    """

    configuration: Array
    cost: float
    free: bool
    trace: Trace


def polish(
    cost: FourierCost,
    start: ArrayLike,
    reach: ArrayLike | None = None,
    evaluations: int = EVALUATIONS,
) -> Polished:
    """Follow FCF down from ``start`` (K,), and come back to a free arrangement if need be.

    Args:
        cost: the Fourier cost.
        start: where to begin.
        reach: (K,), how far each coordinate may go to either side; :func:`neighbourhood` if None.
        evaluations: of the magnitudes and their derivatives, at most.

    Raises:
        CrystalError: if a size is wrong, the start not finite, or a reach negative.
    """
    from scipy.optimize import least_squares

    first = np.array(start, dtype=float)
    cost.structure.checked(first[None])
    sizes = np.maximum(checked_reach(cost.model, reach, first), FIXED)
    task = _Task(cost)
    try:
        found = least_squares(
            task.residuals,
            first,
            task.jacobian,
            bounds=(first - sizes, first + sizes),
            x_scale=sizes,
            max_nfev=evaluations,
            xtol=STEP,
            ftol=GAIN,
            gtol=None,
        )
    except _BottomError as bottom:
        return _freed(cost, bottom.configuration, task.trace)
    return _freed(cost, np.asarray(found.x, dtype=float), task.trace)


def neighbourhood(
    model: PackingModel, steps: float = 2.0, around: ArrayLike | None = None
) -> Array:
    """(K,), so many steps of the model's grid; for coordinates it holds fixed, nothing.

    Near the pole of Euler angles (``around`` (K,) tells) a small rotation can need large first and
    third angles: these may go farther there, up to half a turn.
    """
    reach = np.array([steps * one.step for one in model.grid.ranges])
    first, last = model.grid.shift_count, model.grid.base_count - 1
    if around is None or last - first != 2:
        return reach
    molecule = model.molecule
    frames = molecule.frames(around)
    lines = np.empty((len(frames), 6))
    kernels.motion_axes(molecule.axes, frames, lines)
    sine = float(np.linalg.norm(np.cross(lines[first, :3], lines[last, :3])))
    for k in (first, last):
        reach[k] = min(reach[k] / max(sine, POLE), max(reach[k], np.pi))
    return reach


def checked_reach(
    model: PackingModel, reach: ArrayLike | None, around: ArrayLike | None = None
) -> Array:
    """A reach (K,) of coordinates, two grid steps if None.

    Raises:
        CrystalError: if its size is wrong, or a number negative or not finite.
    """
    if reach is None:
        return neighbourhood(model, around=around)
    given = np.array(reach, dtype=float)
    size = (len(model.grid.ranges),)
    if given.shape != size or not np.all((given >= 0.0) & np.isfinite(given)):
        raise CrystalError(
            f"reach: expected {size[0]} finite numbers of 0 or more, got {given.tolist()}"
        )
    return given


class _BottomError(Exception):
    """Where no way leads down: least squares would divide by zero there."""

    def __init__(self, configuration: Array) -> None:
        super().__init__()
        self.configuration = configuration


class _Task:
    """Residuals and derivatives, computed together and kept, and what was seen on the way."""

    def __init__(self, cost: FourierCost) -> None:
        self._cost = cost
        self._at: Array | None = None
        self._residuals = self._jacobian = np.zeros(0)
        self.trace = Trace()

    def residuals(self, configuration: Array) -> Array:
        self._look(configuration)
        return self._residuals

    def jacobian(self, configuration: Array) -> Array:
        self._look(configuration)
        return self._jacobian

    def _look(self, configuration: Array) -> None:
        if self._at is not None and np.array_equal(self._at, configuration):
            return
        self._at = configuration.copy()
        both = self._cost.residuals_and_jacobian(configuration)
        self._residuals, self._jacobian = both
        value = float(np.linalg.norm(self._residuals))
        self.trace.add(configuration, value)
        if value <= ROUNDING * self._cost.norm or not np.any(self._residuals @ self._jacobian):
            raise _BottomError(self._at)


def _freed(cost: FourierCost, end: Array, trace: Trace) -> Polished:
    """The best free arrangement of a trace, or between it and the better ``end`` that collides."""
    model = cost.model
    value = cost.value(end)
    if model.is_free(end):
        return Polished(end, value, True, trace)
    seen = trace.configurations
    free = np.flatnonzero(model.are_free(seen))
    if not len(free):
        return Polished(end, value, False, trace)
    best = free[np.argmin(trace.costs[free])]
    at, lowest = seen[best], float(trace.costs[best])
    inside, outside = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (inside + outside)
        between = seen[best] + middle * (end - seen[best])
        if not model.is_free(between):
            outside = middle
            continue
        inside = middle
        if (here := cost.value(between)) < lowest:
            at, lowest = between, here
    trace.add(at, lowest)
    return Polished(at, lowest, True, trace)
