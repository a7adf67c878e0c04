"""A scene whose names are markup, scripts, formulas and maths."""

from __future__ import annotations

import numpy as np

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots import ArticulatedRobot, Joint, Link
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World

RAN = "it-ran"
TAG = f"</script></title><script>console.log('{RAN}')</script>"
IMAGE = f"<img src=x onerror=\"console.log('{RAN}')\">"
MARKUP = "a[/red]b[bold]:bomb:"
MATHS = "costs $x^$ or $"
FORMULA = "=1+1"


def odd_scenario(name: str = MARKUP, description: str = TAG) -> Scenario:
    """A planar robot with one joint, and everything named to be taken for something else."""
    ball = Ellipsoid.from_semi_axes
    links = (
        Link(TAG, (ball([1.0, 0.5], name=IMAGE),)),
        Link(IMAGE, (ball([1.0, 0.3], [1.0, 0.0], name=FORMULA),)),
    )
    joint = Joint.of(FORMULA, TAG, IMAGE, "continuous", [1.0, 0.0])
    obstacle = ball([1.0, 1.0], [0.0, 5.0], name=TAG)
    arena = ball([20.0, 20.0], name=IMAGE)
    world = World(np.full(2, -10.0), np.full(2, 10.0), (obstacle,), (arena,))
    robot = ArticulatedRobot(links, (joint,))
    start, goal = np.array([-5.0, 0.0, 3.0, 3.0]), np.array([5.0, 0.0, -3.0, -2.0])
    return Scenario(name, world, robot, start, goal, description=description)
