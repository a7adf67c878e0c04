"""Walls of big bodies around an opening of exactly known play.

The main part passes the opening lengthwise. Around it stand bodies with normals n_k (from the
robot into the body) that hold each other in balance, Σ λ_k n_k = 0 with λ_k > 0, and its spin about
the direction of travel is a minimiser of Σ λ_k h(n_k), h the support function of the main part: so
the torques balance, too. Put against the robot, the bodies cannot be parted by any small motion;
each moved out by δ, the least of their gaps is δ, it is less at all other poses nearby but those
farther along the passage, and a longer part cannot gain by turning, since no projection of an
ellipsoid is smaller than that along its longest axis. Between flat walls this is exact at any
distance: Σ λ_k gap_k does not depend on the position.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.families.draws import Draws
from ellipsoid_planning.families.turns import about
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

Array = NDArray[np.float64]

SPINS = 720
BISECTIONS = 60
LEAST_STIFFNESS = 0.15
ATTEMPTS = 1000


@dataclass(frozen=True, eq=False)
class Opening:
    """An opening around the x axis, and how the main part fits it best.

    Attributes:
        normals: (k, n), unit vectors across x from the robot into the bodies.
        weights: (k,), positive, with Σ λ_k n_k = 0.
        rotation: (n, n), of the main part when it fits best.
    """

    normals: Array
    weights: Array
    rotation: Array


def pair(dimension: int) -> Opening:
    """The opening between two bodies, above and below, in the plane."""
    normals = np.zeros((2, dimension))
    normals[:, 1] = 1.0, -1.0
    return Opening(normals, np.ones(2), np.eye(dimension))


def wedge(main: Ellipsoid, draws: Draws) -> Opening:
    """Two bodies that close in on each other downwards and a third on top, in space."""
    half = math.radians(draws.number(20.0, 16.0, 24.0))
    return around(main, np.array([-half, math.pi + half, math.pi / 2.0]), np.ones(3))


def frame(main: Ellipsoid, draws: Draws, count: int) -> Opening:
    """Three or four bodies around the opening, in space, so that one spin clearly fits best."""
    usual, target = (
        ((-20.0, 204.0, 94.0), (1.0, 1.0, 1.0))
        if count == 3
        else ((5.0, 97.0, 178.0, 266.0), (2.0, 1.0, 2.0, 1.0))
    )
    for _ in range(ATTEMPTS):
        degrees = [draws.number(angle, angle - 8.0, angle + 8.0) for angle in usual]
        opening = around(main, np.radians(degrees), np.array(target))
        if stiffness(main, opening) >= LEAST_STIFFNESS:
            return opening
    raise RuntimeError("no opening that needs one spin was found")  # pragma: no cover


def around(main: Ellipsoid, angles: Array, target: Array) -> Opening:
    """The opening among bodies at angles (k,) [rad] about the x axis, measured from y.

    The weights are those nearest to `target` (k,) that are in balance.
    """
    normals = np.stack([np.zeros_like(angles), np.cos(angles), np.sin(angles)], axis=1)
    weights = target - np.linalg.pinv(normals.T) @ (normals.T @ target)
    return Opening(normals, weights, about(0, _best_spin(main, angles, weights)))


def stiffness(main: Ellipsoid, opening: Opening) -> float:
    """Second derivative of Σ λ_k h(n_k) by the spin, divided by the sum itself."""
    step = 1e-3
    sums = []
    for spin in (-step, 0.0, step):
        body = main.transform(about(0, spin) @ opening.rotation, np.zeros(3))
        sums.append(float(opening.weights @ body.support(opening.normals)))
    return (sums[0] - 2.0 * sums[1] + sums[2]) / step**2 / sums[1]


def _best_spin(main: Ellipsoid, angles: Array, weights: Array) -> float:
    """The spin [rad] that minimises Σ λ_k h(n_k): the best of a grid, then bisection."""
    _, thin, medium = main.semi_axes

    def total(spin: Array) -> Array:
        off = angles - spin[..., None]
        widths = np.sqrt((thin * np.cos(off)) ** 2 + (medium * np.sin(off)) ** 2)
        return np.asarray(widths @ weights)

    def slope(spin: float) -> float:
        off = angles - spin
        widths = np.sqrt((thin * np.cos(off)) ** 2 + (medium * np.sin(off)) ** 2)
        return float(weights @ ((thin**2 - medium**2) * np.sin(off) * np.cos(off) / widths))

    grid = np.linspace(-math.pi / 2.0, math.pi / 2.0, SPINS, endpoint=False)
    best = float(grid[np.argmin(total(grid))])
    low, high = best - math.pi / SPINS, best + math.pi / SPINS
    for _ in range(BISECTIONS):
        middle = (low + high) / 2.0
        low, high = (middle, high) if slope(middle) < 0.0 else (low, middle)
    return (low + high) / 2.0


@dataclass(frozen=True)
class Wall:
    """The semi-axes of a wall's bodies: along the passage, along the wall, and into the depth."""

    thick: float
    wide: float
    deep: float


def wall_bodies(
    main: Ellipsoid, opening: Opening, wall: Wall, clearance: float, name: str
) -> tuple[Ellipsoid, ...]:
    """The bodies of a wall with the opening at the origin, every one with a pole at the robot.

    A negative clearance closes the passage: the bodies then stand around a ball whose radius is
    (1 + clearance) times the main part's least semi-axis, so that it cannot pass at any
    orientation.
    """
    least = float(main.semi_axes[1])
    fitted = main.transform(opening.rotation, np.zeros(main.dimension))
    if clearance > 0.0:
        contacts = fitted.support_points(opening.normals) + clearance * least * opening.normals
    else:
        contacts = (1.0 + clearance) * least * opening.normals
    return tuple(
        _body(contact, normal, wall, f"{name} {number}")
        for number, (contact, normal) in enumerate(zip(contacts, opening.normals, strict=True), 1)
    )


def _body(contact: Array, normal: Array, wall: Wall, name: str) -> Ellipsoid:
    centre = contact + wall.deep * normal
    if len(normal) == 2:
        return Ellipsoid(centre, np.eye(2), np.array([wall.thick, wall.deep]), name)
    travel = np.array([1.0, 0.0, 0.0])
    axes = np.stack([travel, np.cross(normal, travel), normal], axis=1)
    return Ellipsoid(centre, axes, np.array([wall.thick, wall.wide, wall.deep]), name)
