"""The palette: conversions, and hues that stay apart without one of the eye's cones."""

from itertools import combinations

import numpy as np
import pytest

from planners.view import colours

# What is left of linear red, green and blue without the long- or the middle-wave cones:
# Machado, Oliveira and Fernandes, "A physiologically-based model for simulation of color
# vision deficiency", IEEE TVCG 15 (2009), severity 1.
MISSING_CONES = {
    "none": np.eye(3),
    "protanopia": [[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]],
    "deuteranopia": [[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]],
}
BODIES = {"obstacle": colours.OBSTACLE, "start": colours.START, "goal": colours.GOAL,
          "robot": colours.ROBOT, "path": colours.PATH}  # fmt: skip


def test_conversions():
    assert colours.rgb("#ff8000") == (1.0, 128 / 255, 0.0)
    assert colours.as_integer("#ff8000") == 0xFF8000
    assert colours.tint("#336699", 0.0) == "#336699"
    assert colours.tint("#336699", 1.0) == "#ffffff"


@pytest.mark.parametrize("eye", MISSING_CONES)
@pytest.mark.parametrize("pair", list(combinations(BODIES, 2)), ids="-".join)
def test_bodies_differ_for_every_eye(pair, eye):
    linear = np.array([colours.rgb(BODIES[name]) for name in pair]) ** 2.2
    seen = np.clip(linear @ np.array(MISSING_CONES[eye]).T, 0.0, 1.0) ** (1 / 2.2)
    assert np.linalg.norm(seen[0] - seen[1]) > 0.15
