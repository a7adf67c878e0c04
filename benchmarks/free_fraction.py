"""The measured free fraction against rejection sampling for the same time; a Markdown table.

    python -m benchmarks.free_fraction

Rejection's time is that of the state checks alone, drawing configurations is not counted. How
much narrower its interval is, is the ratio of standard errors at equal time; both intervals must
agree.
"""

from __future__ import annotations

import math
import time

import numpy as np

from ellipsoid_planning.cspace.free_fraction import Budget, FreeFraction, free_fraction
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.scenario import bundled_scenarios, load_scenario

LINES = 100_000
STATES = 400_000
ROUNDS = 3


def rejection(cspace: CSpace, count: int, seed: int) -> tuple[float, float]:
    """The share of free configurations, and the seconds that checking them took."""
    drawn = configurations(cspace, count, seed)
    cspace.are_valid(drawn[:10])
    began = time.perf_counter()
    free = cspace.are_valid(drawn)
    return float(np.mean(free)), time.perf_counter() - began


def configurations(cspace: CSpace, count: int, seed: int) -> np.ndarray:
    """Configurations (count, d), uniform on bounds, rotations and joint ranges."""
    rng, robot, n = np.random.default_rng(seed), cspace.robot, cspace.dimension
    rows = np.empty((count, robot.configuration_size))
    if robot.base_size:
        rows[:, :n] = rng.uniform(cspace.world.low, cspace.world.high, (count, n))
    if robot.rotates and n == 2:
        rows[:, 2] = rng.uniform(-math.pi, math.pi, count)
    elif robot.rotates:
        rows[:, 3:7] = _quaternions(rng, count)
    for joint in getattr(robot, "moving_joints", ()):
        where = robot.joint_slices[joint.name]
        if joint.type == "ball":
            rows[:, where] = _quaternions(rng, count)
        else:
            rows[:, where] = rng.uniform(joint.lower, joint.upper, (count, 1))
    return rows


def _quaternions(rng: np.random.Generator, count: int) -> np.ndarray:
    q = rng.normal(size=(count, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def gain(ours: FreeFraction, share: float, seconds: float) -> float:
    """Rejection's standard error at our time, divided by ours."""
    spread = math.sqrt(share * (1.0 - share) * seconds / STATES / ours.seconds)
    return spread / ours.fraction.standard_error


def row(name: str) -> tuple[str, bool, float]:
    """The line of a scenario, whether both agree, and the gain, a median of some seeds."""
    cspace = load_scenario(name).cspace()
    free_fraction(cspace, budget=Budget(lines=1))
    gains, agree = [], True
    for seed in range(ROUNDS):
        ours = free_fraction(cspace, seed, Budget(lines=LINES))
        share, seconds = rejection(cspace, STATES, seed)
        spread = math.sqrt(share * (1.0 - share) / STATES + ours.fraction.standard_error**2)
        agree &= abs(share - ours.fraction.value) < 4.0 * spread
        gains.append(gain(ours, share, seconds))
    value = float(np.median(gains))
    half = 100.0 * ours.fraction.half_width
    cells = (
        f"{100.0 * ours.fraction.value:.4f} % ± {half:.2g} %",
        f"{ours.seconds:.2f} s",
        f"{1e6 * seconds / STATES:.2f} µs",
        f"{value:.1f}",
        f"{value**2:.0f}",
        "yes" if agree else "NO",
    )
    return f"| {name} | " + " | ".join(cells) + " |", agree, value


def main() -> None:
    """Measure and print."""
    head = ("scenario", f"{LINES} lines", "time", "a state", "narrower", "faster", "agree")
    print("| " + " | ".join(head) + " |")
    print("|---|" + "---:|" * (len(head) - 1))
    fine, gains = True, []
    for name in bundled_scenarios():
        line, agree, value = row(name)
        fine &= agree
        gains.append(value)
        print(line, flush=True)
    print(f"\nintervals narrower for the same time: {min(gains):.1f} to {max(gains):.1f} times")
    print("all agree" if fine else "SOME DISAGREE")


if __name__ == "__main__":
    main()
