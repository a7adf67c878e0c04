"""Robots whose least width at a passage is known exactly.

The *main part* has semi-axes a > b ≥ c. All other parts hide in its shadow: seen along its longest
axis they lie within its outline, with a twentieth to spare. So where the main part passes
lengthwise between flat walls, the robot passes; and a ball of radius c about the main part's
centre, which goes wherever the robot goes, bounds what any other orientation could gain.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.families.draws import Draws
from ellipsoid_planning.families.turns import turn
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot

Array = NDArray[np.float64]

OUTLINE = 0.95
OUTLINE_DIRECTIONS = 180


@dataclass(frozen=True, eq=False)
class Shape:
    """A robot in the frame of its main part, and where its base frame is.

    Attributes:
        parts: in the main part's frame: its longest axis is x, its thinnest is y. The first part
            is the main one.
        turned: B (n, n), and
        shifted: o (n,): a point p of the main part's frame is B p + o in the base frame.
    """

    parts: tuple[Ellipsoid, ...]
    turned: Array
    shifted: Array

    @property
    def main(self) -> Ellipsoid:
        """The main part, in its own frame."""
        return self.parts[0]

    @property
    def least(self) -> float:
        """The least semi-axis c of the main part."""
        return float(self.main.semi_axes[1])

    @property
    def reach(self) -> float:
        """Radius of a ball about the main part's centre that contains the robot."""
        farthest = [np.linalg.norm(p.centre) + p.semi_axes.max() for p in self.parts]
        return float(max(farthest))

    def robot(self) -> RigidRobot:
        """The robot in its base frame."""
        return RigidRobot(tuple(p.transform(self.turned, self.shifted) for p in self.parts))

    def base(self, centre: Array, rotation: Array) -> tuple[Array, Array]:
        """Position (n,) and rotation (n, n) of the base for a pose of the main part's frame."""
        base_rotation = rotation @ self.turned.T
        return centre - base_rotation @ self.shifted, base_rotation


def long_shape(
    draws: Draws, dimension: int, flatness: float = 1.6, outline: float = OUTLINE
) -> Shape:
    """A long robot of one to three parts whose other parts hide in the main part's shadow.

    Args:
        draws: of the scene.
        dimension: n.
        flatness: b / c of the canonical robot, n = 3.
        outline: how much of the main part's outline the other parts may fill.
    """
    thin = draws.number(0.4, 0.34, 0.46)
    long = thin * draws.number(3.0, 2.6, 3.2)
    medium = thin * draws.number(flatness, 1.4, 1.7)
    axes = [long, thin] if dimension == 2 else [long, thin, medium]
    main = Ellipsoid.from_semi_axes(axes, name="hull")
    others = [
        _hidden(draws, main, side, name, outline)
        for side, name in ((-1.0, "tail"), (1.0, "nose"))[: draws.integer(1, 0, 2)]
    ]
    return Shape((main, *others), *base_frame(draws, main))


def base_frame(draws: Draws, main: Ellipsoid) -> tuple[Array, Array]:
    """A base frame for a main part: turned anyhow, with its origin well inside the part."""
    n = main.dimension
    turned = draws.rotation(np.eye(n))
    inside = float(main.semi_axes[1]) / 2.0 / math.sqrt(n)
    return turned, draws.vector(np.zeros(n), inside)


def _hidden(draws: Draws, main: Ellipsoid, side: float, name: str, outline: float) -> Ellipsoid:
    """A part at one end of the main part, within its outline as seen along its longest axis."""
    n, axes = main.dimension, main.semi_axes
    smaller = draws.number(0.6, 0.5, 0.7)
    semi_axes = np.append(axes[0] * draws.number(0.4, 0.3, 0.45), smaller * axes[1:])
    beside = draws.vector(0.3 * np.ones(n - 1), 0.35) * axes[1:]
    centre = np.append(side * axes[0] * draws.number(0.7, 0.55, 0.75), beside)
    tilt = turn(n, draws.number(0.0, -8.0, 8.0), draws.number(0.0, -8.0, 8.0))
    part = Ellipsoid(centre, tilt, semi_axes, name)
    scale = min(1.0, outline / _outline_share(main, part))
    centre[1:] *= scale
    return Ellipsoid(centre, tilt, semi_axes * scale, name)


def _outline_share(main: Ellipsoid, part: Ellipsoid) -> float:
    """The largest ratio of the supports of a part and of the main part across its long axis."""
    angles = np.linspace(0.0, 2.0 * math.pi, OUTLINE_DIRECTIONS, endpoint=False)
    across = np.stack([np.zeros_like(angles), np.cos(angles), np.sin(angles)], axis=1)
    directions = across[:, : main.dimension]
    if main.dimension == 2:
        directions = np.array([[0.0, 1.0], [0.0, -1.0]])
    return float(np.max(part.support(directions) / main.support(directions)))
