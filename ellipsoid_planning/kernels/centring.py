"""Centring: moving a robot to where its smallest gap is largest, in all of its C-space.

Each step maximises the smallest gap of the linear model (contact_model) less a proximal term
|step|²/(2 s). The dual is a small quadratic programme over the simplex,

    minimise over λ ≥ 0, Σλ = 1:  Σ λ_k g_k + s/2 |Σ λ_k ∇g_k|²,    step = s Σ λ_k ∇g_k,

solved pair by pair of weights. Sharp directions (translations between bodies) converge at once,
curved ones (turning to fit) like gradient ascent whose step s follows the success. With a
direction given, steps stay across it: that finds the saddle points of clearance, and follows
passages.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .compile import inlined, kernel
from .contact_model import (
    CAPACITY,
    GRADIENT,
    MODEL,
    contact_model,
    moved,
    smallest_gap,
)
from .layout import HIGH, LOW, new_placed
from .robot_model import reach_of, scene_of, step_size
from .simplex import SPARE_ACTIVE, minimise

# Largest proximal parameter s, in units of the robot's reach.
_LONGEST_STEPS = 100.0
# Pairs whose directions are remembered.
_REMEMBERED = 256


class Workspace(NamedTuple):
    """Arrays that centring works in; ``pairs`` (1,) counts the pairs of bodies looked at."""

    placed: NDArray[np.float64]
    first: NDArray[np.float64]
    second: NDArray[np.float64]
    matrix: NDArray[np.float64]
    active: NDArray[np.int64]
    weights: NDArray[np.float64]
    step: NDArray[np.float64]
    trial: NDArray[np.float64]
    ahead: NDArray[np.float64]
    across: NDArray[np.float64]
    slide: NDArray[np.float64]
    next_pose: NDArray[np.float64]
    pairs: NDArray[np.int64]
    keys: NDArray[np.int64]
    known: NDArray[np.float64]


@kernel
def new_workspace(robot):
    """A workspace for ``robot``."""
    size = step_size(robot)
    active, pose = size + SPARE_ACTIVE, 2 * size
    return Workspace(
        new_placed(scene_of(robot)),
        np.empty((CAPACITY, MODEL + size)),
        np.empty((CAPACITY, MODEL + size)),
        np.empty((active, active + 2)),
        np.empty(active + 1, dtype=np.int64),
        np.empty(active),
        np.empty(size),
        np.empty(pose),
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty(pose),
        np.zeros(1, dtype=np.int64),
        np.zeros(_REMEMBERED, dtype=np.int64) - 1,
        np.empty((_REMEMBERED, 3)),
    )


@inlined
def _put_across(model, count, across):
    """Split the gradients of a model: the part along ``across`` (last column), and the rest."""
    size = across.shape[0]
    for k in range(count):
        along = 0.0
        for m in range(size):
            along += model[k, GRADIENT + m] * across[m]
        for m in range(size):
            model[k, GRADIENT + m] -= along * across[m]
        model[k, GRADIENT + size] = along


@kernel
def step_length(step):
    """Euclidean length of a step."""
    square = 0.0
    for m in range(step.shape[0]):
        square += step[m] * step[m]
    return math.sqrt(square)


@inlined
def _shortened(step, longest):
    """Shorten ``step`` to ``longest``: the factor."""
    length = step_length(step)
    if length <= longest:
        return 1.0
    scale = longest / length
    for m in range(step.shape[0]):
        step[m] *= scale
    return scale


@kernel
def centre(robot, pose, across, turns, within, enough, precision, steps, work):
    """Move ``pose`` to where its smallest gap is largest: (gap, slope).

    Stops once the gap is ``enough``, when no more than ``precision`` of it is to gain, or after
    ``steps`` models. ``across`` is a unit direction to which steps stay orthogonal, or zero;
    ``turns`` whether the robot may turn. Returns the gap, an estimate of what can be proved, and
    how it changes along ``across``.
    """
    scene, reach = scene_of(robot), reach_of(robot)
    inverse_reach = 1.0 / reach if turns else 0.0
    placed, trial, step = work.placed, work.trial[: pose.shape[0]], work.step
    here, there = work.first, work.second
    count = contact_model(
        robot, placed, pose, within, inverse_reach, here, work.pairs, work.keys, work.known
    )
    _put_across(here, count, across)
    gap = smallest_gap(here, count, within)
    size, longest, slope = reach, 0.5 * reach, 0.0
    for _ in range(steps):
        if gap >= enough or count == 0:
            break
        promised = minimise(here, count, size, work.matrix, work.active, work.weights, step)
        slope = 0.0
        for k in range(work.active[work.weights.shape[0]]):
            slope += work.weights[k] * here[work.active[k], GRADIENT + step.shape[0]]
        gain = _shortened(step, longest) * (promised - gap)
        if gain <= precision * abs(gap) + 1e-14 * reach:
            if size >= _LONGEST_STEPS * reach:
                break
            # What is left to gain may lie in a direction of little curvature.
            size *= 10.0
            continue
        moved(robot, pose, step, inverse_reach, trial)
        for k in range(3):
            trial[k] = min(max(trial[k], scene[LOW + k]), scene[HIGH + k])
        more = contact_model(
            robot, placed, trial, within, inverse_reach, there, work.pairs, work.keys, work.known
        )
        value = smallest_gap(there, more, within)
        # A gain that falls short of the promise by a share tells the curvature, and that the best
        # size: s/(2·share).
        share = min(max(1.0 - (value - gap) / gain, 0.125), 2.5)
        if share > 1.0:
            longest = 0.5 * step_length(step)
        elif share < 0.5:
            longest = min(2.0 * longest, 0.5 * reach)
        size = min(size / (2.0 * share), _LONGEST_STEPS * reach)
        if value > gap:
            for k in range(pose.shape[0]):
                pose[k] = trial[k]
            here, there = there, here
            count, gap = more, value
            _put_across(here, count, across)
    return gap, slope
