"""Quaternions in bulk against scipy's rotations."""

import numpy as np
from scipy.spatial.transform import Rotation

from ellipsoid_planning.groups import quaternions as quat
from tests.groups.checks import probes


def test_products_inverses_and_left_matrices_are_scipys():
    a, b = probes(200, 1), probes(200, 2)
    expected = (Rotation.from_quat(a) * Rotation.from_quat(b)).as_matrix()
    np.testing.assert_allclose(
        Rotation.from_quat(quat.product(a, b)).as_matrix(), expected, atol=1e-14
    )
    np.testing.assert_allclose(quat.left_matrix(a[0]) @ b[0], quat.product(a[0], b[0]), atol=1e-15)
    one = quat.product(a, quat.inverse(a))
    np.testing.assert_allclose(one, np.tile(quat.IDENTITY, (200, 1)), atol=1e-15)


def test_exponential_and_logarithm_are_scipys_and_each_others_inverse():
    q = np.vstack([probes(500), quat.IDENTITY, [1.0, 0.0, 0.0, 0.0], [1e-12, 0.0, 0.0, 1.0]])
    vectors = quat.logarithm(q)
    regular = slice(0, 500)
    np.testing.assert_allclose(vectors[regular], Rotation.from_quat(q[regular]).as_rotvec())
    np.testing.assert_allclose(quat.exponential(vectors), quat.canonical(q), atol=1e-15)


def test_angles_are_those_of_the_relative_rotation_however_small():
    a, b = probes(500, 1), probes(500, 2)
    expected = (Rotation.from_quat(a).inv() * Rotation.from_quat(b)).magnitude()
    np.testing.assert_allclose(quat.angle(a, -b), expected, atol=1e-12)
    tiny = quat.exponential([1e-11, 0.0, 0.0])
    np.testing.assert_allclose(quat.angle(a, quat.product(a, tiny)), 1e-11, rtol=1e-4)


def test_rodrigues_coordinates_come_back():
    q = quat.canonical(probes(100))
    np.testing.assert_allclose(quat.from_rodrigues(quat.rodrigues(q)), q, atol=1e-14)
