"""Least gaps of the families' gates, found without the kernels and without the construction."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from ellipsoid_planning.families import make_family_scene
from tests.oracles import Body, arena_clearance, body_of, distance_bounds, signed_gaps

CASES = [
    ("gap", 2),
    ("gap", 3),
    ("turned-gap", 2),
    ("turned-gap", 3),
    ("window-3d", 3),
    ("slot-3d", 3),
    ("bend", 2),
    ("bend", 3),
    ("chain-of-gaps", 2),
    ("chain-of-gaps", 3),
    ("tight-arena", 2),
    ("tight-arena", 3),
]
ROUNDS = 100
WALLS = [case for case in CASES if case[0] not in ("bend", "tight-arena")]


@dataclass(frozen=True)
class Around:
    """The poses around a gate, as motions of the robot about the centre of its main part."""

    scenario: object
    gate: object

    @cached_property
    def hull(self):
        """The main part at the gate."""
        return self.scenario.robot.bodies_at(self.gate.configuration)[0]

    @cached_property
    def bodies(self):
        """The obstacles at the gate."""
        c, a = self.hull.centre, self.hull.matrix[None]
        return [
            body
            for body in self.scenario.world.obstacles
            if signed_gaps((body.centre - c)[None], a, body.matrix[None])[0][0] <= 1.01 * self.gap
        ]

    @property
    def gap(self):
        """Half the free play: the gap on either side."""
        return self.gate.play / 2.0

    def least_gaps(self, shifts, turns):
        """Upper bounds of the least gaps (m,) of poses, exact at the gate.

        The main part's centre is moved by `shifts` (m, n) and the robot turned about it by
        `turns` (m, n, n). Only the main part and the bodies at the gate are looked at: all
        others could only lessen the gaps.
        """
        c, a = self.hull.centre + shifts, turns @ self.hull.matrix
        least = self.obstacle_gaps(shifts, turns)
        for arena in self.scenario.world.arenas:
            least = np.minimum(least, _room(arena, c, a))
        return least

    def obstacle_gaps(self, shifts, turns):
        """The same to the obstacles alone."""
        c, a = self.hull.centre + shifts, turns @ self.hull.matrix
        least = np.full(len(shifts), np.inf)
        for obstacle in self.bodies:
            other = np.broadcast_to(obstacle.matrix, a.shape)
            least = np.minimum(least, signed_gaps(obstacle.centre - c, a, other)[0])
        return least


def _room(arena, centres, matrices):
    """Least difference of supports (m,) of an arena and bodies, on both sides of the bodies."""
    n = len(arena.centre)
    u = np.broadcast_to(directions(n), (len(centres), *directions(n).shape))
    values = _room_along(arena, centres, matrices, u)
    rows = np.arange(len(centres))
    nearest = np.argmin(values, axis=1)
    behind = np.einsum("mkj,mj->mk", u, u[rows, nearest]) < 0.0
    opposite = np.argmin(np.where(behind, values, np.inf), axis=1)
    sides = [_descended(arena, centres, matrices, u[rows, k]) for k in (nearest, opposite)]
    return np.minimum(*sides)


def _descended(arena, centres, matrices, best):
    """The room along directions (m, n), lessened by a search in a shrinking neighbourhood."""
    n, rows = len(arena.centre), np.arange(len(centres))
    least = _room_along(arena, centres, matrices, best[:, None])[:, 0]
    radius = np.full(len(best), 0.1)
    offsets = np.array([o for o in itertools.product((-1.0, 0.0, 1.0), repeat=n) if any(o)])
    for _ in range(ROUNDS):
        trial = best[:, None] + radius[:, None, None] * offsets
        trial /= np.linalg.norm(trial, axis=2, keepdims=True)
        found = _room_along(arena, centres, matrices, trial)
        choice = np.argmin(found, axis=1)
        better = found[rows, choice] < least
        best = np.where(better[:, None], trial[rows, choice], best)
        least = np.where(better, found[rows, choice], least)
        radius = np.where(better, radius, 0.6 * radius)
    return least


def _room_along(arena, centres, matrices, u):
    """Support of the arena minus that of the bodies for directions u (m, k, n), (m, k)."""
    outer = np.linalg.norm(u @ arena.matrix, axis=2) + u @ arena.centre
    inner = np.linalg.norm(np.einsum("mkj,mji->mki", u, matrices), axis=2)
    return outer - inner - np.einsum("mkj,mj->mk", u, centres)


def directions(dimension):
    """Some hundred unit vectors (k, n)."""
    if dimension == 2:
        angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
        return np.stack([np.cos(angle), np.sin(angle)], axis=1)
    rows = np.random.default_rng(0).normal(size=(1000, 3))
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def turns_of(vectors, dimension):
    """Rotations (m, n, n) of rotation vectors (m, 1) or (m, 3)."""
    if dimension == 3:
        return Rotation.from_rotvec(vectors).as_matrix()
    c, s = np.cos(vectors[:, 0]), np.sin(vectors[:, 0])
    return np.stack([np.stack([c, -s], axis=1), np.stack([s, c], axis=1)], axis=1)


def exact_least_gap(scenario, configuration):
    """The least distance of any part to any obstacle or arena, as a pair of bounds."""
    low, high = np.inf, np.inf
    for part in scenario.robot.bodies_at(configuration):
        for obstacle in scenario.world.obstacles:
            bounds = distance_bounds(body_of(part), body_of(obstacle))
            low, high = min(low, bounds[0]), min(high, bounds[1])
        for arena in scenario.world.arenas:
            room = arena_clearance(body_of(arena), body_of(part))
            low, high = min(low, room), min(high, room)
    return low, high


def best_nearby(around, basis, start, scale):
    """The least gap of the best pose that Nelder-Mead finds near a start (k,), measured anew.

    `basis` maps coordinates (k,) to a shift (n,) and a rotation (n, n).
    """

    def lost(x):
        shift, turn = basis(x)
        return -around.least_gaps(shift[None], turn[None])[0]

    simplex = np.vstack([start, start + scale * np.eye(len(start))])
    options = {"xatol": 1e-10, "fatol": 1e-13, "maxfev": 160, "adaptive": True}
    options["initial_simplex"] = simplex
    found = minimize(lost, start, method="Nelder-Mead", options=options)
    shift, turn = basis(found.x)
    hull = Body(around.hull.centre + shift, turn @ around.hull.matrix)
    return min(around.obstacle_gaps(shift[None], turn[None])[0], _arena_gap(around.scenario, hull))


def _arena_gap(scenario, hull):
    return min(arena_clearance(body_of(arena), hull) for arena in scenario.world.arenas)


def across(name, gate, hull):
    """Coordinates of the poses across a passage: all that do not lead along it, and how many.

    Along a gap the centre moves in the direction of travel; in the tight arena the passage is a
    turn through the upright.
    """
    n = len(gate.position)
    axes = np.linalg.svd(gate.travel[None])[2][1:]
    turning = 1 if n == 2 else 3

    def beside(x):
        return x[: n - 1] @ axes, turns_of(x[None, n - 1 :], n)[0]

    def upright(x):
        if n == 2:
            return x, np.eye(2)
        # Turns about the arena's axis and about the robot's own leave it upright.
        vectors = np.stack([x[3] * gate.travel, x[4] * hull.rotation[:, 0]])
        first, second = turns_of(vectors, 3)
        return x[:3], first @ second

    if name == "tight-arena":
        return upright, 2 if n == 2 else 5
    return beside, n - 1 + turning


def scene(name, clearance, dimension, seed, **variant):
    """A scenario and what is around its gates."""
    made = make_family_scene(name, clearance, dimension, seed, **variant)
    return made.scenario, [Around(made.scenario, gate) for gate in made.gates]
