"""Slow twins of chapter 5: quadrature on spheres, and random bodies as the thesis draws them."""

import itertools
import math

import numpy as np
from scipy.integrate import quad
from scipy.spatial.transform import Rotation
from scipy.special import ellipe

from ellipsoid_planning.geometry import Ellipsoid

TRIALS = (10.0, 50.0)


def random_rotation(rng, dimension):
    if dimension == 3:
        return Rotation.random(random_state=rng).as_matrix()
    angle = rng.uniform(0.0, 2.0 * math.pi)
    return np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])


def random_ellipsoid(rng, dimension, low=1.0, high=4.0):
    axes = rng.uniform(low, high, dimension)
    centre = rng.uniform(-3.0, 3.0, dimension)
    return Ellipsoid.from_semi_axes(axes, centre, random_rotation(rng, dimension))


def ball(radius, dimension, centre=None):
    return Ellipsoid.from_semi_axes([radius] * dimension, centre)


def trials(rng, count, dimension):
    """Matrices (2, count, n, n): semi-axes from U[10, 50], angles from U[0, 2 pi]."""
    axes = rng.uniform(*TRIALS, (2, count, dimension))
    angles = rng.uniform(0.0, 2.0 * math.pi, (2 * count, 3))
    if dimension == 2:
        cosine, sine = np.cos(angles[:, 0]), np.sin(angles[:, 0])
        turns = np.stack([np.stack([cosine, -sine], -1), np.stack([sine, cosine], -1)], -2)
    else:
        turns = Rotation.from_euler("ZXZ", angles).as_matrix()
    return turns.reshape(2, count, dimension, dimension) * axes[..., None, :]


def sphere_quadrature(dimension, count):
    """Unit vectors and weights that integrate smooth functions over the circle or sphere."""
    angle = np.arange(count) * (2.0 * math.pi / count)
    if dimension == 2:
        return np.column_stack([np.cos(angle), np.sin(angle)]), np.full(
            count, 2.0 * math.pi / count
        )
    height, weight = np.polynomial.legendre.leggauss(count)
    flat = np.sqrt(1.0 - height**2)
    z = np.broadcast_to(height[:, None], (count, count))
    unit = np.stack([flat[:, None] * np.cos(angle), flat[:, None] * np.sin(angle), z], axis=-1)
    weights = np.broadcast_to(weight[:, None] * (2.0 * math.pi / count), (count, count))
    return unit.reshape(-1, 3), weights.reshape(-1)


def radii_matrices(matrix, unit):
    """The Hessians (m, n, n) of the support function: radii of curvature across u."""
    shape = matrix @ matrix.T
    lengths = np.linalg.norm(unit @ matrix, axis=1)
    points = (unit @ shape) / lengths[:, None]
    return (shape - points[:, :, None] * points[:, None, :]) / lengths[:, None, None]


def steiner_twin(first, second, sign=1.0, count=120):
    """Volume of the sum (or summand) as the integral of h / n over the surface elements."""
    n = first.dimension
    unit, weights = sphere_quadrature(n, count)
    h = np.linalg.norm(unit @ first.matrix, axis=1)
    h = h + sign * np.linalg.norm(unit @ second.matrix, axis=1)
    radii = radii_matrices(first.matrix, unit) + sign * radii_matrices(second.matrix, unit)
    # The determinant across u: u itself is in the kernel.
    element = np.linalg.det(radii + unit[:, :, None] * unit[:, None, :])
    return float(np.sum(h * element * weights) / n)


def mean_length_twin(lengths):
    """The mean of |diag(lengths) u| over the sphere by one-dimensional adaptive quadrature."""
    x, y, z = np.sort(np.asarray(lengths, dtype=float)) ** 2

    def ring(t):
        p, q = x * (1 - t * t) + z * t * t, y * (1 - t * t) + z * t * t
        return 4.0 * math.sqrt(q) * ellipe(1.0 - p / q) if q > 0.0 else 0.0

    decades = [0.0, *10.0 ** np.arange(-12.0, 0.5, 0.5)]
    parts = [quad(ring, a, b, epsabs=0.0, epsrel=1e-13)[0] for a, b in itertools.pairwise(decades)]
    return 2.0 * math.fsum(parts) / (4.0 * math.pi)
