"""The range of sizes that scenes may have.

Within it, lengths keep all their digits: squares and products of them neither overflow nor vanish,
and OMPL's absolute tolerances (about 1e-16) stay far below every body. Scenes multiplied by powers
of ten from 1e-15 to 1e20 were planned alike. A scene's largest number has to be comparable with its
smallest semi-axis, too: double precision resolves 1e-16 of the one, which must be little of the
other, or the margins for rounding swallow every gap.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

LEAST_LENGTH = 1e-12
MOST_LENGTH = 1e12
MOST_RATIO = 1e12
"""Of the largest length or coordinate of a scene to its smallest semi-axis."""
MOST_SHIFT = 1e3
"""Of the largest value of a prismatic joint to the size of the scene."""
MOST_SECONDS = 1e9
"""Of a time limit: OMPL counts nanoseconds, of which 64 bits hold 292 years."""
MOST_SEED = (1 << 64) - 1
"""Of a generator of random numbers."""

REMEDY = "choose a unit of length that suits the scene"


def check_bodies(bodies: Sequence[Ellipsoid], kind: str) -> None:
    """Check that bodies of one dimension are of the sizes that scenes may have.

    Raises:
        GeometryError: naming the first that is not.
    """
    if not bodies:
        return
    axes = np.array([body.semi_axes for body in bodies])
    centres = np.array([body.centre for body in bodies])
    fits = (axes >= LEAST_LENGTH) & (axes <= MOST_LENGTH) & (np.abs(centres) <= MOST_LENGTH)
    wrong = np.flatnonzero(~fits.all(axis=1))
    if len(wrong):
        body = bodies[int(wrong[0])]
        check_semi_axes(body.semi_axes, f"{kind} {body.name!r}")
        check_coordinates(body.centre, f"{kind} {body.name!r}")


def check_semi_axes(values: ArrayLike, whose: str) -> None:
    """Check that semi-axes, of any shape, are of the sizes that scenes may have.

    Raises:
        GeometryError: naming what it is about.
    """
    array = np.asarray(values)
    wrong = (array < LEAST_LENGTH) | (array > MOST_LENGTH)
    if wrong.any():
        raise GeometryError(
            f"{whose}: expected semi-axes from {LEAST_LENGTH:g} to {MOST_LENGTH:g}, "
            f"got {array[wrong][0]:g}; {REMEDY}"
        )


def check_coordinates(values: ArrayLike, whose: str) -> None:
    """Check that coordinates, of any shape, are finite and not too large.

    Raises:
        GeometryError: naming what it is about.
    """
    array = np.asarray(values)
    wrong = ~(np.abs(array) <= MOST_LENGTH)
    if wrong.any():
        raise GeometryError(
            f"{whose}: expected coordinates from {-MOST_LENGTH:g} to {MOST_LENGTH:g}, "
            f"got {array[wrong][0]:g}; {REMEDY}"
        )
