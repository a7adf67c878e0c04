"""Ellipsoids as rows of the arrays that kernels read (see kernels.layout)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.kernels import layout

Array = NDArray[np.float64]


def _embedded(body: Ellipsoid, third_axis: float) -> tuple[Array, Array, Array]:
    """Centre (3,), rotation (3, 3) and semi-axes (3,) of a body; planar ones in z = 0."""
    if body.dimension == 3:
        return body.centre, body.rotation, body.semi_axes
    centre, rotation = np.zeros(3), np.eye(3)
    centre[:2], rotation[:2, :2] = body.centre, body.rotation
    return centre, rotation, np.append(body.semi_axes, third_axis)


def grown_axes(semi_axes: Array, distance: float) -> Array:
    """Semi-axes (…, n) of ellipsoids that enclose the bodies' offsets by ``distance``.

    The member (1 + 1/p)Σ + (1 + p)r²I of the Kurzhanski family, p near its best.
    """
    if distance <= 0.0:
        return semi_axes
    p = np.sqrt(np.mean(semi_axes**2, axis=-1, keepdims=True)) / distance
    return np.sqrt((1.0 + 1.0 / p) * semi_axes**2 + (1.0 + p) * distance**2)


def shrunk_axes(semi_axes: Array, distance: float) -> Array:
    """Semi-axes of the largest known ellipsoid inside the body's inner offset by ``distance``.

    The family (1 − μ)(Σ − r²I/μ) of Kurzhanski and Vályi (1997), at the μ of largest volume.

    Raises:
        GeometryError: if the inner offset is empty.
    """
    if distance <= 0.0:
        return semi_axes
    lowest = (distance / float(semi_axes.min())) ** 2
    if lowest >= 1.0:
        raise GeometryError(
            f"a clearance of {distance:g} leaves nothing of an arena with a semi-axis of "
            f"{semi_axes.min():g}; lower the clearance below that"
        )
    mu = lowest + (1.0 - lowest) * np.linspace(0.0, 1.0, 2001)[1:-1, None]
    squares = (1.0 - mu) * (semi_axes**2 - distance**2 / mu)
    best = int(np.argmax(np.log(np.maximum(squares, 1e-300)).sum(axis=1)))
    return np.sqrt(squares[best])


def body_rows(bodies: Sequence[Ellipsoid], other_axes: Array | None = None) -> Array:
    """Obstacles or arenas of one dimension n as rows (m, BODY).

    ``other_axes`` (m, n) replace the semi-axes in whitening.
    """
    rows = np.zeros((len(bodies), layout.BODY))
    if not bodies:
        return rows
    n = bodies[0].dimension
    rotation = np.zeros((len(bodies), 3, 3))
    rotation[:, 2, 2] = 1.0  # stays for planar bodies, which stand in z = 0
    rotation[:, :n, :n] = [body.rotation for body in bodies]
    own = np.array([body.semi_axes for body in bodies])
    axes, other = _three(own), _three(own if other_axes is None else other_axes)
    matrix = rotation * axes[:, None, :]
    rows[:, layout.BODY_CENTRE : layout.BODY_CENTRE + n] = [body.centre for body in bodies]
    rows[:, layout.BODY_MATRIX : layout.BODY_MATRIX + 9] = matrix.reshape(-1, 9)
    rows[:, layout.BODY_WHITEN : layout.BODY_WHITEN + 9] = _inverses(rotation, other)
    rows[:, layout.BODY_INVERSE : layout.BODY_INVERSE + 9] = _inverses(rotation, axes)
    rows[:, layout.BODY_RADIUS] = own.max(axis=1)
    rows[:, layout.BODY_EXTENT : layout.BODY_EXTENT + 3] = np.linalg.norm(matrix, axis=2)
    return rows


def _three(axes: Array) -> Array:
    """Semi-axes (m, 3) of (m, n); the third axis of planar bodies is their smallest."""
    if axes.shape[1] == 3:
        return axes
    return np.column_stack([axes, axes.min(axis=1)])


def _inverses(rotation: Array, axes: Array) -> Array:
    """diag(1/a) Rᵀ of every row, row-major (m, 9)."""
    return (rotation / axes[:, None, :]).transpose(0, 2, 1).reshape(-1, 9)


def body_row(body: Ellipsoid) -> Array:
    """One obstacle or arena as BODY numbers."""
    return body_rows((body,))[0]


def farthest_of(rows: Array) -> float:
    """An upper bound of the distance from the origin of the points of body rows; 0 for none."""
    if not len(rows):
        return 0.0
    centres = rows[:, layout.BODY_CENTRE : layout.BODY_CENTRE + 3]
    return float(np.max(np.linalg.norm(centres, axis=1) + rows[:, layout.BODY_RADIUS]))


def farthest(part: Ellipsoid) -> float:
    """An upper bound of the distance of the part's points from the origin."""
    return float(np.linalg.norm(part.centre) + part.semi_axes.max())


def part_row(part: Ellipsoid) -> Array:
    """One robot part as PART numbers; a planar part is flat."""
    centre, rotation, axes = _embedded(part, 0.0)
    row = np.zeros(layout.PART)
    row[layout.PART_CENTRE : layout.PART_CENTRE + 3] = centre
    row[layout.PART_MATRIX : layout.PART_MATRIX + 9] = (rotation * axes).ravel()
    row[layout.PART_RADIUS] = part.semi_axes.max()
    row[layout.PART_REACH] = farthest(part)
    return row


def placed_row(part: Ellipsoid) -> Array:
    """A part that already stands where it is (world frame) as PLACED numbers."""
    centre, rotation, axes = _embedded(part, 0.0)
    matrix = rotation * axes
    extent = np.linalg.norm(matrix, axis=1)
    return np.concatenate([centre, matrix.ravel(), extent])
