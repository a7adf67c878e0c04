"""Discs, balls and ellipsoids as images of the unit ball, and their farthest points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.geometry.farthest import farthest_points, farthest_squared

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Rounds:
    """Discs, balls or ellipsoids {c + M w : |w| <= 1}.

    Attributes:
        centres: c, (m, n).
        matrices: M, (m, n, n), not zero; with a zero column for a disc.
    """

    centres: Array
    matrices: Array

    @classmethod
    def none(cls, dimension: int) -> Rounds:
        """No body of the dimension n."""
        return cls(np.zeros((0, dimension)), np.zeros((0, dimension, dimension)))

    @classmethod
    def joined(cls, groups: list[Rounds], dimension: int = 3) -> Rounds:
        """The bodies of all groups."""
        groups = [Rounds.none(dimension), *groups]
        return cls(
            np.concatenate([group.centres for group in groups]),
            np.concatenate([group.matrices for group in groups]),
        )

    def transform(self, matrix: Array, shift: Array) -> Rounds:
        """The images under x -> matrix @ x + shift."""
        return Rounds(self.centres @ matrix.T + shift, matrix @ self.matrices)

    def axis_points(self) -> Array:
        """The ends of the bodies' principal axes, (k, n)."""
        left, stretch, _ = np.linalg.svd(self.matrices)
        ends = np.swapaxes(left[..., : stretch.shape[1]] * stretch[:, None, :], 1, 2)
        ends = np.concatenate([ends, -ends], axis=1) + self.centres[:, None, :]
        return np.asarray(ends.reshape(-1, self.centres.shape[1]))

    def farthest(self) -> tuple[Array, Array]:
        """Each body's farthest point from the origin (m, n), and its squared norm, from above."""
        left, stretch, _ = np.linalg.svd(self.matrices)
        local = np.einsum("mij,mi->mj", left, self.centres)
        used = stretch.shape[1]
        across = np.sum(local[:, used:] ** 2, axis=1)
        squares = farthest_squared(local[:, :used], stretch) + across
        local[:, :used] += stretch * farthest_points(local[:, :used], stretch)
        return np.einsum("mij,mj->mi", left, local), squares
