"""Minimum-volume ellipsoids around points, discs and balls, proved to enclose all of them.

The minimum-volume ellipsoid of points is the dual of their D-optimal design. That is computed
for a small set of points, to which the farthest ones of everything that is to be enclosed are
added until nothing is outside; any weights of that set bound the minimum volume from below. In
the end the ellipsoid is grown until it encloses everything in floating point too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.optimal_design import ellipsoid_of_design, optimal_design
from ellipsoid_planning.geometry.rounds import Rounds

Array = NDArray[np.float64]

# The shortest semi-axis divided by the longest one, at least: bodies in a plane, or on a line,
# get this thickness.
THINNEST = 1e-3
# By how much a squared norm may miss its optimum, with points alone and with curved bodies too,
# which are approached by ever more of their points.
TOLERANCE = 1e-7
CURVED_TOLERANCE = 1e-6
FLAT = 1e-9
MOST_ADDITIONS = 100
NEGLIGIBLE = 1e-9
CANDIDATES = 4
ROUNDING = 64.0 * float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class Enclosure:
    """An ellipsoid around something.

    Attributes:
        ellipsoid: encloses every point, in floating point too.
        excess: the volume divided by the minimum volume, minus 1, is proved to be at most this;
            infinite for something flat, whose minimum volume is 0.
    """

    ellipsoid: Ellipsoid
    excess: float


def enclosing_ellipsoid(
    points: ArrayLike,
    rounds: Rounds | None = None,
    *,
    tolerance: float | None = None,
    thinnest: float = THINNEST,
    name: str = "",
) -> Enclosure:
    """The minimum-volume ellipsoid around points (m, n) and bodies, n = 2 or 3.

    What lies in a plane or on a line gets the minimum-volume ellipsoid there and the thickness
    ``thinnest`` times the longest semi-axis across; no semi-axis is shorter than that.

    Args:
        points: (m, n), possibly none if there are bodies.
        rounds: discs, balls or ellipsoids to enclose too.
        tolerance: by how much the squared norm of the farthest point may miss its optimum; by
            default `TOLERANCE`, or `CURVED_TOLERANCE` if there are bodies.
        thinnest: the smallest ratio of two semi-axes.
        name: the ellipsoid's.

    Raises:
        GeometryError: if there is nothing to enclose, it is a single point, or not finite.
    """
    cloud = np.atleast_2d(np.asarray(points, dtype=float))
    bodies = Rounds.none(cloud.shape[1]) if rounds is None else rounds
    if tolerance is None:
        tolerance = CURVED_TOLERANCE if len(bodies.centres) else TOLERANCE
    sample = np.concatenate([cloud, bodies.axis_points()])
    middle, basis, extents = _principal_box(sample)
    scale = 1.0 / extents
    inward = basis.T * scale[:, None]
    flat_points = (cloud - middle) @ inward.T
    flat_bodies = bodies.transform(inward, -inward @ middle)
    centre, matrix, ratio = _minimum_volume(flat_points, flat_bodies, tolerance)
    axes_in, semi_axes, _ = np.linalg.svd(extents[:, None] * matrix)
    rotation, semi_axes = _lifted(basis @ axes_in, semi_axes, thinnest)
    body = Ellipsoid(middle + basis @ (extents * centre), rotation, semi_axes, name)
    grown = grown_around(body, cloud, bodies)
    if len(extents) < cloud.shape[1]:
        return Enclosure(grown, math.inf)
    # The volumes are compared where the numbers are: before and after growing and thickening.
    growth = float(np.prod(grown.semi_axes / extents) / abs(np.linalg.det(matrix)))
    return Enclosure(grown, max(ratio * growth - 1.0, 0.0))


def grown_around(body: Ellipsoid, points: Array, rounds: Rounds | None = None) -> Ellipsoid:
    """The body scaled about its centre so that everything is inside, and a few roundings more.

    Also after its pose went through a quaternion. It shrinks if there is room.
    """
    inward = body.rotation.T / body.semi_axes[:, None]
    squares = [np.sum(((points - body.centre) @ inward.T) ** 2, axis=1)]
    if rounds is not None and len(rounds.centres):
        shifted = Rounds(rounds.centres - body.centre, rounds.matrices)
        squares.append(shifted.transform(inward, np.zeros(len(inward))).farthest()[1])
    farthest = math.sqrt(float(np.max(np.concatenate(squares))))
    size = float(np.linalg.norm(body.centre) + body.semi_axes.max())
    factor = farthest + ROUNDING * (1.0 + size / float(body.semi_axes.min()))
    return Ellipsoid(body.centre, body.rotation, body.semi_axes * factor, body.name)


def _principal_box(sample: Array) -> tuple[Array, Array, Array]:
    """Middle (n,), principal axes (n, k) and half-extents (k,) of points; k < n if flat."""
    if not len(sample) or not np.all(np.isfinite(sample)):
        raise GeometryError("expected finite points to enclose, at least two")
    mean = sample.mean(axis=0)
    axes = np.linalg.svd(sample - mean, full_matrices=False)[2].T
    along = (sample - mean) @ axes
    low, high = along.min(axis=0), along.max(axis=0)
    half = 0.5 * (high - low)
    kept = half > FLAT * max(float(half.max()), float(np.abs(sample).max()) * 1e-3)
    if not np.any(kept):
        raise GeometryError("all points to enclose are the same; they have no size")
    return mean + axes @ (0.5 * (low + high)), axes[:, kept], half[kept]


def _lifted(axes: Array, semi_axes: Array, thinnest: float) -> tuple[Array, Array]:
    """A rotation (n, n) and semi-axes (n,) from axes (n, k) and semi-axes (k,)."""
    n, used = axes.shape
    shortest = thinnest * float(semi_axes.max())
    whole = np.full(n, shortest)
    whole[:used] = np.maximum(semi_axes, shortest)
    rotation = np.linalg.qr(np.column_stack([axes, np.eye(n)]))[0][:, :n]
    rotation[:, :used] *= np.sign(np.sum(rotation[:, :used] * axes, axis=0))
    if np.linalg.det(rotation) < 0.0:
        rotation[:, -1] = -rotation[:, -1]
    return rotation, whole


def _minimum_volume(points: Array, bodies: Rounds, tolerance: float) -> tuple[Array, Array, float]:
    """Centre (n,) and matrix (n, n) of an ellipsoid around points (m, n) and bodies.

    The third value bounds its volume divided by the minimum volume.
    """
    n = points.shape[1]
    core = np.concatenate([_extreme_points(points), bodies.axis_points()])
    for _ in range(MOST_ADDITIONS):
        weights, inside = optimal_design(core, 0.1 * tolerance)
        centre, matrix = ellipsoid_of_design(core, weights)
        outside, farthest = _farthest(points, bodies, centre, matrix)
        farthest = max(farthest, inside)
        if farthest <= 1.0 + tolerance or not len(outside):
            break
        core = np.unique(np.concatenate([core[weights > NEGLIGIBLE], outside]), axis=0)
    grown = math.sqrt(farthest)
    return centre, grown * matrix, float(grown**n)


def _extreme_points(points: Array) -> Array:
    """The points farthest along each axis and diagonal, without repetition."""
    if not len(points):
        return points
    n = points.shape[1]
    signs = np.array(np.meshgrid(*[[-1.0, 1.0]] * n)).reshape(n, -1)
    directions = np.concatenate([np.eye(n), -np.eye(n), signs.T])
    return points[np.unique(np.argmax(directions @ points.T, axis=1))]


def _farthest(points: Array, bodies: Rounds, centre: Array, matrix: Array) -> tuple[Array, float]:
    """Points outside the ellipsoid worth adding (k, n), and the largest squared norm of all."""
    inward: Array = np.asarray(np.linalg.inv(matrix), dtype=float)
    found, largest = [], 0.0
    if len(points):
        ball = (points - centre) @ inward.T
        squares = np.einsum("ij,ij->i", ball, ball)
        worst = np.argpartition(squares, -min(CANDIDATES, len(squares)))[-CANDIDATES:]
        found.append(points[worst[squares[worst] > 1.0]])
        largest = float(squares.max())
    if len(bodies.centres):
        ends, squares = bodies.transform(inward, -inward @ centre).farthest()
        found.append(centre + ends[squares > 1.0] @ matrix.T)
        largest = max(largest, float(squares.max()))
    return np.concatenate(found), largest
