"""A chain of ball joints through a slit that is made narrower and narrower: time against play.

    python -m benchmarks.slit                 # 18 degrees of freedom, 20 queries a play
    python -m benchmarks.slit --links 8 --queries 5

The arena is cut by two discs that reach far beyond it; the slit between them leaves each link the
stated play on either side. Starts and goals are random, bent by up to 1.5 rad a joint. Every path
is proved once more.
"""

from __future__ import annotations

import argparse
import sys
import time

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.outcome import SOLVED
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link
from ellipsoid_planning.world import World

Array = NDArray[np.float64]

PLAYS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
THICKNESS, HALF = 0.35, 1.0
LIMIT = 60.0


def chain(links: int) -> ArticulatedRobot:
    """A chain of spheroids on ball joints, 6 + 3 (links − 1) degrees of freedom."""
    body = Ellipsoid.from_semi_axes([HALF, THICKNESS, THICKNESS], [HALF, 0.0, 0.0])
    joints = [
        Joint.of(f"joint {k}", f"link {k}", f"link {k + 1}", "ball", [2.1 * HALF, 0.0, 0.0])
        for k in range(links - 1)
    ]
    return ArticulatedRobot(tuple(Link(f"link {k}", (body,)) for k in range(links)), tuple(joints))


def slit(play: float, length: float) -> World:
    """An arena as long as needed, cut by two discs; ``play`` is a fraction of the thickness."""
    arena = Ellipsoid.from_semi_axes([1.6 * length, 7.0, 7.0])
    height = 4.5 + THICKNESS * (1.0 + play)
    discs = tuple(
        Ellipsoid.from_semi_axes([1.5, 600.0, 4.5], [0.0, 0.0, sign * height])
        for sign in (1.0, -1.0)
    )
    side = 1.6 * length
    return World(np.array([-side, -7.0, -7.0]), np.array([side, 7.0, 7.0]), discs, (arena,))


def ends(cspace: CSpace, random: np.random.Generator, side: float, count: int) -> Array:
    """Free configurations (count, d) in one half of the arena."""
    found: list[Array] = []
    joints = (cspace.robot.configuration_size - 7) // 4
    while len(found) < count:
        x = side * random.uniform(0.3, 0.8) * cspace.world.high[0]
        row = [x, *random.uniform(-3.0, 3.0, 2), *_turn(random, np.pi)]
        for _ in range(joints):
            row += _turn(random, 1.5)
        if cspace.is_valid(row):
            found.append(np.array(row))
    return np.array(found)


def _turn(random: np.random.Generator, most: float) -> list[float]:
    axis = random.normal(size=3)
    axis /= np.linalg.norm(axis)
    half = 0.5 * random.uniform(0.0, most)
    return [*(np.sin(half) * axis), float(np.cos(half))]


def times(links: int, play: float, queries: int) -> tuple[list[float], int]:
    """Seconds of each query, and how many were solved with a path that is proved."""
    cspace, random = CSpace(slit(play, 2.1 * links), chain(links)), np.random.default_rng(1)
    starts, goals = (ends(cspace, random, side, queries) for side in (-1.0, 1.0))
    taken, solved = [], 0
    for start, goal in zip(starts, goals, strict=True):
        began = time.perf_counter()
        stop = began + LIMIT
        planner = HighwayRoadmap(cspace)
        outcome = planner.solve(start[None], goal[None], lambda: time.perf_counter() > stop)  # noqa: B023
        taken.append(time.perf_counter() - began)
        if outcome.status == SOLVED and outcome.path is not None:
            solved += int(cspace.are_motions_valid(outcome.path[:-1], outcome.path[1:]).all())
    return taken, solved


def main() -> None:
    """Measure and print a Markdown table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.slit", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--links", type=int, default=5)
    parser.add_argument("--queries", type=int, default=20)
    parser.add_argument("--plays", type=float, nargs="+", default=list(PLAYS))
    given = parser.parse_args()
    world = slit(0.1, 2.1 * given.links)
    HighwayRoadmap(CSpace(world, chain(given.links))).compile_kernels()
    print("| play | solved | median | slowest |\n| ---: | ---: | ---: | ---: |")
    for play in given.plays:
        taken, solved = times(given.links, play, given.queries)
        middle, slowest = 1e3 * np.median(taken), 1e3 * max(taken)
        print(f"| {play:g} | {solved}/{given.queries} | {middle:.0f} ms | {slowest:.0f} ms |")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
