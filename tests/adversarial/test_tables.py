"""States in the corners of safety tables' cells: none is called safe that touches."""

from __future__ import annotations

import numpy as np

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.kernels import layout
from ellipsoid_planning.robots.articulated import ArticulatedRobot, Link
from ellipsoid_planning.robots.joint import Joint
from ellipsoid_planning.safety import TableParameters
from ellipsoid_planning.safety.build import table_scene
from ellipsoid_planning.safety.planning import plan_tables
from ellipsoid_planning.world import World
from tests.adversarial.outcome import Outcome
from tests.adversarial.tables_search import SEARCHES


def test_no_state_in_a_corner_of_a_cell_is_called_safe_that_touches() -> None:
    total = sum((search(seed) for search in SEARCHES.values() for seed in range(6)), Outcome())
    assert total.tried >= 40
    assert total.certified >= 1
    assert not total.false, total.false[0].what


def test_tables_of_links_on_long_levers_keep_the_robots_own_rounding() -> None:
    """A tiny link that comes back to the base over two levers of 10,000."""
    tip = Ellipsoid.from_semi_axes([1e-3, 5e-4])
    joints = (
        Joint.of("out", "base", "arm", "revolute", [0.0, 0.0], lower=-3.0, upper=3.0),
        Joint.of("back", "arm", "tip", "revolute", [1e4, 0.0], lower=-3.0, upper=3.0),
        Joint.of("hand", "tip", "hand", "fixed", [-1e4, 0.0]),
    )
    links = (Link("base"), Link("arm"), Link("tip"), Link("hand", (tip,)))
    robot = ArticulatedRobot(links, joints, "translating")
    obstacle = Ellipsoid.from_semi_axes([0.1, 0.1], [0.5, 0.0])
    cspace = CSpace(World(np.full(2, -1.0), np.full(2, 1.0), (obstacle,)), robot)
    (plan,) = plan_tables(cspace, TableParameters(memory=3000)).tables
    scene = table_scene(plan)
    kept = scene[layout.CLEARANCE] - plan.resolution.inflation
    assert kept >= 3.9 * layout.TOLERANCE * cspace.scene[layout.SCALE]
