"""The poses between two others that trees grow by."""

import numpy as np
import pytest

from ellipsoid_planning.cspace.poses import interpolate
from ellipsoid_planning.kernels import tree_extension
from ellipsoid_planning.robots.rigid import RigidRobot
from tests.roadmap.scenes import body

ROBOT = RigidRobot((body([1.0, 0.5, 0.4]),))
# Inlined into its caller otherwise; as plain Python it is the same arithmetic.
between = tree_extension._write_between.py_func


@pytest.mark.parametrize("arc", [3.0, 1.0, 1e-3, 1e-5, 1e-7, 0.0])
def test_between_follows_ompl_s_interpolation(arc):
    random = np.random.default_rng(2)
    out = np.empty(7)
    for _ in range(50):
        q, axis = random.normal(size=4), random.normal(size=4)
        q /= np.linalg.norm(q)
        axis -= (axis @ q) * q
        r = np.cos(arc / 2) * q + np.sin(arc / 2) * axis / np.linalg.norm(axis)
        first = np.append(random.normal(size=3), q)
        last = np.append(random.normal(size=3), r * random.choice([-1.0, 1.0]))
        for s in (0.0, 0.125, 0.5, 1.0):
            between(first, last, s, out)
            expected = interpolate(ROBOT, first, last, s)
            np.testing.assert_allclose(out[:3], expected[:3], atol=1e-14)
            # Below 9e-5 rad OMPL keeps the first orientation; the pose is proved as it is.
            assert abs(out[3:] @ expected[3:]) > 1.0 - 1e-9
            assert abs(np.linalg.norm(out[3:]) - 1.0) < 1e-14
