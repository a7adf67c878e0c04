"""Samples a path where bodies are close: contacts, and the smallest clearance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.robots.robot import Robot
from ellipsoid_planning.scenario import Scenario
from planners.verify.clearance import ClearanceTester
from planners.verify.meetings import Clearances, Meeting
from planners.verify.motion import interpolate, joint_speeds, speeds
from planners.verify.self_collision import SelfTester

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

_Bound = Callable[[Robot, Array, Array], Array]

_FIRST_SAMPLES = 2000
_FEWEST_A_MOTION = 16
_MOST_SAMPLES = 8000
_ROUNDS = 40
_CLOSE_TO_SMALLEST = 0.9


@dataclass(frozen=True, eq=False)
class SampledPath:
    """What sampling a path found.

    Attributes:
        configurations: (k, d), all that were tested.
        lower: (k,), lower bounds of their clearances.
        smallest: the smallest clearance of any of them.
        worst: the deepest contact that is certain, None if there is none.
        place: of that contact or, without one, of the smallest clearance: the motion's index
            and the fraction of it.
    """

    configurations: Array
    lower: Array
    smallest: float
    worst: Meeting | None
    place: tuple[int, float]


@dataclass(frozen=True, eq=False)
class _Samples:
    motion: Indices
    s: Array
    configurations: Array
    lower: Array
    upper: Array


class _Tester(Protocol):
    def test(self, configurations: Array, needed: Array) -> Clearances: ...


class _Sampler:
    """Tests configurations along one path and remembers what was found."""

    def __init__(self, robot: Robot, tester: _Tester, path: Array, bound: _Bound) -> None:
        self._robot = robot
        self._tester = tester
        # The last state is a motion of its own, which goes nowhere.
        self._first, self._second = path, np.vstack([path[1:], path[-1:]])
        self.speeds = bound(robot, self._first, self._second)
        self._found: list[_Samples] = []
        self.smallest = np.inf
        self.worst: Meeting | None = None
        self._worst_place = (0, 0.0)

    def test(self, motion: Indices, s: Array, spacing: Array) -> Array:
        """Lower bounds (k,) of the clearances at s (k,) of motions (k,), ``spacing`` (k,) apart."""
        rows = interpolate(self._robot, self._first[motion], self._second[motion], s)
        if not np.isfinite(self.smallest):
            few = rows[:: max(1, len(rows) // 64)]
            upper = self._tester.test(few, np.full(len(few), np.inf)).upper
            self.smallest = float(np.min(upper, initial=np.inf))
        needed = max(self.smallest, 0.0) + spacing
        clearances = self._tester.test(rows, needed)
        self.smallest = min(self.smallest, float(np.min(clearances.upper, initial=np.inf)))
        for meeting in clearances.meetings:
            if self.worst is None or meeting.depth > self.worst.depth:
                self.worst = meeting
                self._worst_place = int(motion[meeting.row]), float(s[meeting.row])
        self._found.append(_Samples(motion, s, rows, clearances.lower, clearances.upper))
        return clearances.lower

    def collect(self) -> SampledPath:
        """Everything that was found."""
        upper = np.concatenate([samples.upper for samples in self._found])
        motion = np.concatenate([samples.motion for samples in self._found])
        s = np.concatenate([samples.s for samples in self._found])
        least = int(np.argmin(upper))
        return SampledPath(
            np.concatenate([samples.configurations for samples in self._found]),
            np.concatenate([samples.lower for samples in self._found]),
            float(upper[least]),
            self.worst,
            (int(motion[least]), float(s[least])) if self.worst is None else self._worst_place,
        )


def sample_path(scenario: Scenario, path: Array) -> SampledPath:
    """Sample a path (m, d) for what the robot meets around it, see `_sampled`."""
    robot = scenario.robot
    return _sampled(_Sampler(robot, ClearanceTester(scenario), path, speeds))


def sample_path_itself(scenario: Scenario, path: Array) -> SampledPath | None:
    """Sample a path (m, d) for parts that meet each other; clearances are half their distances.

    None if there are no two parts that could.
    """
    tester = SelfTester(scenario.robot)
    if not tester.pairs:
        return None
    return _sampled(_Sampler(scenario.robot, tester, path, joint_speeds))


def _sampled(sampler: _Sampler) -> SampledPath:
    """Sample the motions of a path (m, d) evenly at first, then wherever bodies are close.

    Between two samples the clearance is at least half of what is left of both when the robot's
    largest travel is taken off. Where that is clearly below the smallest found, halves are
    sampled. `resolution` proves what lies between.
    """
    motion, begin, end = _first_intervals(sampler.speeds)
    spacing = sampler.speeds[motion] * (end - begin)
    at_begin = sampler.test(motion, begin, spacing)
    at_end = sampler.test(motion, end, spacing)
    tested = 2 * len(motion)
    for _ in range(_ROUNDS):
        spacing = sampler.speeds[motion] * (end - begin)
        least = 0.5 * (at_begin + at_end - spacing)
        split = np.flatnonzero(least < _CLOSE_TO_SMALLEST * sampler.smallest)
        split = split[np.argsort(least[split])][: _MOST_SAMPLES - tested]
        if sampler.worst is not None or not len(split):
            break
        middle = 0.5 * (begin[split] + end[split])
        at_middle = sampler.test(motion[split], middle, 0.5 * spacing[split])
        tested += len(split)
        motion = np.concatenate([motion, motion[split]])
        begin, end = np.concatenate([begin, middle]), np.concatenate([end, end[split]])
        at_begin = np.concatenate([at_begin, at_middle])
        at_end = np.concatenate([at_end, at_end[split]])
        end[split], at_end[split] = middle, at_middle
    return sampler.collect()


def _first_intervals(speeds: Array) -> tuple[Indices, Array, Array]:
    """Motion, begin and end (k,) of even intervals, longer motions having more of them."""
    total = float(np.sum(speeds))
    share = speeds / total if total > 0.0 else np.zeros_like(speeds)
    counts = np.maximum(_FEWEST_A_MOTION, np.ceil(share * _FIRST_SAMPLES)).astype(np.intp)
    counts[-1] = 1
    motion = np.repeat(np.arange(len(speeds)), counts)
    index = np.concatenate([np.arange(count) for count in counts])
    return motion, index / counts[motion], (index + 1) / counts[motion]
