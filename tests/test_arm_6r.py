"""The arm of six revolute joints: it can meet itself, and samplers solve its scene as well."""

from __future__ import annotations

import numpy as np
import pytest

from ellipsoid_planning.scenario import Scenario, load_scenario
from planners.solve import plan

# Upright, the wrist turned down and back: the hand points at the forearm, far from the shelf.
AT_ITSELF = np.radians([0, 0, 0, 180, 180, 0])


def test_arm_meets_itself_away_from_all_obstacles():
    contacts = load_scenario("arm-6r").cspace().explain(AT_ITSELF)
    assert contacts
    assert {contact.kind for contact in contacts} == {"self"}
    assert {"palm", "forearm 1"} in [{contact.part, contact.body} for contact in contacts]


def test_no_pair_of_links_is_left_out_of_self_collision():
    scenario = load_scenario("arm-6r")
    assert not scenario.robot.ignored
    data = scenario.to_dict()
    data["robot"]["ignore_self_collision"] = [["forearm", "hand"], ["first wrist", "hand"]]
    assert Scenario.from_dict(data).cspace().is_valid(AT_ITSELF)


@pytest.mark.parametrize("planner", ["HighwayRoadmap", "RRTConnect"])
def test_it_is_solved(planner):
    result = plan(load_scenario("arm-6r"), planner=planner, seed=1, time_limit=600.0)
    assert result.path is not None
    assert result.path.certified
