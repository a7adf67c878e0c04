"""Worlds without bodies, time limits, and files written whole."""

import math
import os

import numpy as np
import pytest
from ompl import geometric as og

from ellipsoid_planning.atomic import write_text
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario import load_scenario
from ellipsoid_planning.world import World
from planners.highway import HighwayRoadmap
from planners.setup import simple_setup


def empty_space(dimension):
    robot = RigidRobot((Ellipsoid.from_semi_axes(np.ones(dimension)),))
    return CSpace(World(np.full(dimension, -5.0), np.full(dimension, 5.0)), robot)


def test_there_is_no_limit_to_the_clearance_of_an_empty_world():
    space = empty_space(2)
    assert space.motion_clearance([0, 0, 0], [1, 1, 1]) == math.inf
    assert space.motion_clearance([0, 0, 0], [9, 1, 1]) < 0


@pytest.mark.parametrize("planner", [HighwayRoadmap, og.RRTConnect])
def test_planners_take_seconds(planner):
    setup = simple_setup(load_scenario("rabbit-2d-open"), seed=1)
    setup.setPlanner(planner(setup.getSpaceInformation()))
    setup.setup()
    setup.getPlanner().solve(5.0)
    assert setup.getProblemDefinition().hasExactSolution()


def test_a_pipe_as_output_stays_a_pipe(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDWR | os.O_NONBLOCK)
    try:
        write_text(pipe, "text")
        assert os.read(reader, 10) == b"text"
    finally:
        os.close(reader)
    assert pipe.is_fifo()
