"""Layers of a C-space at the points of a randomly shifted sequence, with their free fractions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.articulated_sampling import base_kind
from ellipsoid_planning.cspace.estimate import COPIES
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.kernels import articulated_sampling, free_length, kinematics, sampling
from ellipsoid_planning.robots.joint import BALL

Array = NDArray[np.float64]

# Lines a layer. Where joints move, layers differ more than the lines of one.
RIGID_LINES = {2: 8, 3: 8}
ARTICULATED_LINES = {2: 1, 3: 2}
# Across a layer in space lines form Fibonacci's lattice, 5 / 8, or the diagonal, 1 / 2.
STEPS = {1: 0.0, 2: 0.5, 8: 5.0 / 8.0}
SHIFT_NUMBERS = 2


class LayerSequence:
    """Draws layers (rotations and joint values, all by their own measure) and looks at them.

    Attributes:
        lines: how many sweep lines a layer is looked at along; 1 where the base is fixed and
            whole configurations are tested.
        layers: how many layers of each of the ``COPIES`` copies were looked at so far.
    """

    def __init__(self, cspace: CSpace, seed: int, layer: ArrayLike | None = None) -> None:
        """Prepare the whole C-space, or but the layer of a configuration (d,).

        Raises:
            GeometryError: if the configuration does not fit, or a fixed base has no layers.
        """
        self._cspace = cspace
        self._drawn = layer is None
        self._kind = _kind(cspace)
        if layer is not None and self._kind == articulated_sampling.IMMOBILE:
            raise GeometryError("a robot on a fixed base does not translate: it has no layers")
        self._near = _near(cspace, layer)
        self.lines = _line_count(cspace, self._kind)
        self._step = STEPS[self.lines]
        used = _used(cspace, self._kind if self._drawn else sampling.FIXED, self._drawn)
        self._steps = _steps(used)
        self._shifts = np.random.default_rng(seed).random((COPIES, len(used)))
        self._numbers = np.empty(len(used))
        self.layers = 0

    def advance(self, layers: int) -> Array:
        """The free fractions (COPIES, layers) of the next layers of each copy."""
        shares = np.empty((COPIES, layers))
        rest = (self._shifts, self._steps, self.layers, self.lines, self._step)
        cspace = self._cspace
        if isinstance(cspace, ArticulatedCSpace):
            free_length.articulated_layers(
                cspace.scene,
                cspace.kinematics,
                self._kind,
                self._near,
                self._drawn,
                *rest,
                self._numbers,
                shares,
            )
        else:
            kind = self._kind if self._drawn else sampling.FIXED
            free_length.rigid_layers(
                cspace.scene, kind, self._near[3:7], *rest, self._numbers, shares
            )
        self.layers += layers
        return shares

    @property
    def varies(self) -> bool:
        """Whether layers differ, so that their fractions have a distribution."""
        joints: Any = getattr(self._cspace.robot, "moving_joints", ())
        return self._drawn and (self._kind in (sampling.PLANAR, sampling.SPATIAL) or bool(joints))

    def configuration(self, copy: int, layer: int) -> Array:
        """The configuration (d,), base in the middle of the bounds, of a drawn rigid layer."""
        u = (self._shifts[copy] + layer * self._steps) % 1.0
        row = self._near.copy()
        n = self._cspace.dimension
        world = self._cspace.world
        row[:n] = 0.5 * (world.low + world.high)
        if isinstance(self._cspace, ArticulatedCSpace):
            kernel = articulated_sampling.draw_turns
            joints = kinematics.joint_rows(self._cspace.kinematics)
            kernel(joints, self._kind, self._near, -1.0, u, row)
        elif self._kind == sampling.SPATIAL:
            row[3:7] = sampling.random_rotation(u[0], u[1], u[2])
        elif self._kind == sampling.PLANAR:
            half = math.pi * (u[0] - 0.5)
            row[3:7] = (0.0, 0.0, math.sin(half), math.cos(half))
        return self._cspace.configurations(row[None])[0]


def whole_measure(cspace: CSpace) -> float:
    """The measure of all configurations within bounds and limits.

    The volume of the bounds (nothing for a fixed base), times 2 pi or 8 pi^2 if the base rotates,
    times the ranges of the joints: lengths or radians, 2 pi if continuous, 8 pi^2 for a ball joint.
    """
    kind = _kind(cspace)
    measure = 1.0
    if kind != articulated_sampling.IMMOBILE:
        measure = float(np.prod(cspace.world.high - cspace.world.low))
    if kind in (sampling.PLANAR, sampling.SPATIAL):
        measure *= 2.0 * math.pi if kind == sampling.PLANAR else 8.0 * math.pi**2
    for joint in getattr(cspace.robot, "moving_joints", ()):
        measure *= 8.0 * math.pi**2 if joint.type == BALL else joint.upper - joint.lower
    return measure


def _kind(cspace: CSpace) -> int:
    if isinstance(cspace, ArticulatedCSpace):
        return base_kind(cspace.articulated)
    if not cspace.rotates:
        return sampling.FIXED
    return sampling.PLANAR if cspace.dimension == 2 else sampling.SPATIAL


def _line_count(cspace: CSpace, kind: int) -> int:
    if kind == articulated_sampling.IMMOBILE:
        return 1
    counts = ARTICULATED_LINES if isinstance(cspace, ArticulatedCSpace) else RIGID_LINES
    return counts[cspace.dimension]


def _near(cspace: CSpace, layer: ArrayLike | None) -> Array:
    if layer is not None:
        return cspace.pose(layer).copy()
    return np.array(cspace.poses(np.zeros(cspace.robot.configuration_size))[0])


def _used(cspace: CSpace, kind: int, drawn: bool) -> NDArray[np.bool_]:
    """Which of a point's numbers mean something: the others stand still."""
    joints: Any = getattr(cspace.robot, "moving_joints", ()) if drawn else ()
    base = articulated_sampling.BASE_NUMBERS
    used = np.zeros(base + articulated_sampling.JOINT_NUMBERS * len(joints) + SHIFT_NUMBERS, bool)
    used[: {sampling.PLANAR: 1, sampling.SPATIAL: 3}.get(kind, 0)] = True
    for j, joint in enumerate(joints):
        first = base + articulated_sampling.JOINT_NUMBERS * j
        used[first : first + (3 if joint.type == BALL else 1)] = True
    if kind != articulated_sampling.IMMOBILE:
        used[-SHIFT_NUMBERS : len(used) + cspace.dimension - 3] = True
    return used


def _steps(used: NDArray[np.bool_]) -> Array:
    """Richtmyer's sequence: the square roots of primes, modulo 1."""
    steps = np.zeros(len(used))
    steps[used] = np.sqrt(_primes(int(np.sum(used)))) % 1.0
    return steps


def _primes(count: int) -> Array:
    primes: list[int] = []
    candidate = 2
    while len(primes) < count:
        if all(candidate % prime for prime in primes):
            primes.append(candidate)
        candidate += 1
    return np.array(primes, dtype=float)
