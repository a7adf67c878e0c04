"""The unit cell: a parallelogram or parallelepiped, and its two coordinate systems."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import CrystalError

LENGTHS = ("a", "b", "c")
ANGLES = ("alpha", "beta", "gamma")
EXACT_COSINES = {60.0: 0.5, 90.0: 0.0, 120.0: -0.5}  # so that these cells have exact zeros
LONGEST, SHORTEST = 1e100, 1e-100  # so that volumes and squares are numbers
FLATNESS = 1e-9  # a cell's volume over the product of its edges, below which it is no cell


@dataclass(frozen=True, eq=False)
class UnitCell:
    """The cell spanned by the vectors a, b (and c), in n = 2 or 3 dimensions.

    Attributes:
        basis: shape (n, n), the columns are a, b (, c) in Cartesian world axes; cells made of
            parameters have a along x and b in the xy-plane. Read-only.

    Raises:
        CrystalError: the vectors span no right-handed cell.
    """

    basis: NDArray[np.float64]

    def __post_init__(self) -> None:
        basis = np.array(self.basis, dtype=float)
        if basis.shape not in ((2, 2), (3, 3)) or not np.all(np.isfinite(basis)):
            raise CrystalError(
                "unit cell: expected a finite (2, 2) or (3, 3) matrix with the cell's vectors as "
                f"columns, got shape {basis.shape}"
            )
        if np.linalg.det(basis) <= FLATNESS * float(np.prod(np.linalg.norm(basis, axis=0))):
            raise CrystalError(
                "unit cell: expected vectors that span a right-handed cell, these are flat or "
                "left-handed; change the angles, or the order of the vectors"
            )
        basis.setflags(write=False)
        object.__setattr__(self, "basis", basis)

    @classmethod
    def from_parameters(cls, lengths: ArrayLike, angles_deg: ArrayLike | None = None) -> UnitCell:
        """Build from lengths (n,) and angles: gamma in 2-D, (alpha, beta, gamma) in 3-D.

        The angles are in degrees, right ones by default.

        Raises:
            CrystalError: names the length or angle that is no good, or the angles that make no
                cell together.
        """
        sizes = _checked_lengths(lengths)
        if len(sizes) == 2:
            (gamma,) = _checked_angles(angles_deg, ("gamma",))
            return cls(np.array([[1.0, _cosine(gamma)], [0.0, _sine(gamma)]]) * sizes)
        return cls(_unit_vectors(*_checked_angles(angles_deg, ANGLES)) * sizes)

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return len(self.basis)

    @cached_property
    def lengths(self) -> NDArray[np.float64]:
        """Shape (n,), the lengths a, b (, c)."""
        lengths: NDArray[np.float64] = np.sqrt(np.sum(self.basis**2, axis=0))
        lengths.setflags(write=False)
        return lengths

    @cached_property
    def angles_deg(self) -> tuple[float, ...]:
        """Gamma in 2-D; alpha (between b and c), beta (c, a), gamma (a, b) in 3-D [degree]."""
        pairs = ((0, 1),) if self.dimension == 2 else ((1, 2), (2, 0), (0, 1))
        unit = self.basis / self.lengths
        return tuple(_angle_deg(unit[:, i], unit[:, j]) for i, j in pairs)

    @cached_property
    def volume(self) -> float:
        """The cell's volume, in 2-D its area."""
        return float(np.linalg.det(self.basis))

    @cached_property
    def metric(self) -> NDArray[np.float64]:
        """The metric tensor, shape (n, n): the scalar products of the cell's vectors."""
        metric = self.basis.T @ self.basis
        metric.setflags(write=False)
        return metric

    @cached_property
    def reciprocal(self) -> NDArray[np.float64]:
        """Shape (n, n), the columns are a*, b* (, c*), with a . a* = 1 (no factor of 2 pi)."""
        reciprocal = np.array(np.linalg.inv(self.basis).T, dtype=np.float64)
        reciprocal.setflags(write=False)
        return reciprocal

    def fractional(self, points: ArrayLike) -> NDArray[np.float64]:
        """The coordinates along a, b (, c) of Cartesian points, both (..., n)."""
        return np.asarray(points, dtype=float) @ self.reciprocal

    def cartesian(self, points: ArrayLike) -> NDArray[np.float64]:
        """The Cartesian points of fractional coordinates, both (..., n)."""
        return np.asarray(points, dtype=float) @ self.basis.T

    def lattice_within(self, away: ArrayLike, reach: float) -> Iterator[tuple[int, ...]]:
        """The lattice vectors v, in cells, that bring a point near: |away + B v| <= reach.

        Args:
            away: (n,), where the point is, in Cartesian coordinates.
            reach: how near.
        """
        place = np.asarray(away, dtype=float)
        middle = self.fractional(place)
        # Coordinates are rounded; the distance decides.
        width = reach * np.linalg.norm(self.reciprocal, axis=0) + 1e-9
        low, high = np.ceil(-width - middle).astype(int), np.floor(width - middle).astype(int)
        for lattice in itertools.product(*map(range, low.tolist(), (high + 1).tolist())):
            if np.linalg.norm(place + self.cartesian(lattice)) <= reach:
                yield lattice


def _checked_lengths(lengths: ArrayLike) -> NDArray[np.float64]:
    sizes = np.array(lengths, dtype=float)
    if sizes.shape not in ((2,), (3,)):
        raise CrystalError(f"unit cell: expected two or three lengths, got shape {sizes.shape}")
    for name, size in zip(LENGTHS, sizes.tolist(), strict=False):
        if not (math.isfinite(size) and size > 0.0):
            raise CrystalError(f"unit cell: expected a positive length {name}, got {size:g}")
        if not SHORTEST <= size <= LONGEST:
            raise CrystalError(
                f"unit cell: expected a length {name} from {SHORTEST:g} to {LONGEST:g}, got "
                f"{size:g}; choose another unit"
            )
    return sizes


def _checked_angles(angles_deg: ArrayLike | None, names: tuple[str, ...]) -> list[float]:
    angles = np.full(len(names), 90.0) if angles_deg is None else np.array(angles_deg, dtype=float)
    if angles.shape not in ((len(names),), () if len(names) == 1 else (len(names),)):
        raise CrystalError(
            f"unit cell: expected the angles ({', '.join(names)}) in degrees, "
            f"got shape {angles.shape}"
        )
    values: list[float] = angles.reshape(-1).tolist()
    for name, angle in zip(names, values, strict=True):
        if not 0.0 < angle < 180.0:
            raise CrystalError(
                f"unit cell: expected {name} between 0 and 180 degrees, got {angle:g}"
            )
    return values


def _cosine(angle_deg: float) -> float:
    return EXACT_COSINES.get(angle_deg, math.cos(math.radians(angle_deg)))


def _sine(angle_deg: float) -> float:
    return 1.0 if angle_deg == 90.0 else math.sin(math.radians(angle_deg))


def _unit_vectors(alpha: float, beta: float, gamma: float) -> NDArray[np.float64]:
    """Unit vectors with these angles between them [degree], the first along x, as columns."""
    cos_alpha, cos_beta, cos_gamma = _cosine(alpha), _cosine(beta), _cosine(gamma)
    sin_gamma = _sine(gamma)
    c_y = (cos_alpha - cos_beta * cos_gamma) / sin_gamma
    height = 1.0 - cos_beta**2 - c_y**2
    if height <= FLATNESS:
        raise CrystalError(
            f"unit cell: alpha = {alpha:g}, beta = {beta:g}, gamma = {gamma:g} degrees make no "
            "cell; each must be less than the sum of the others, and all less than 360 together"
        )
    columns = [[1.0, cos_gamma, cos_beta], [0.0, sin_gamma, c_y], [0.0, 0.0, math.sqrt(height)]]
    return np.array(columns)


def _angle_deg(first: NDArray[np.float64], second: NDArray[np.float64]) -> float:
    # More exact than the arc cosine for small angles, and 90 for perpendicular vectors.
    difference, total = np.linalg.norm(first - second), np.linalg.norm(first + second)
    return math.degrees(2.0 * math.atan2(float(difference), float(total)))
