"""A roadmap that has answered queries, and its file."""

import pytest

from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from tests.roadmap.test_level import free_ends, never, random_cspace


@pytest.fixture(scope="module")
def planned():
    """A C-space, and a roadmap that has answered a few queries in it."""
    cspace = random_cspace(5, 2)
    roadmap = HighwayRoadmap(cspace)
    ends = free_ends(cspace, 6)
    for _ in range(4):
        roadmap.solve(next(ends), next(ends), never)
    assert roadmap.statistics["edges_certified"] > 20
    return cspace, roadmap


@pytest.fixture
def file(planned, tmp_path):
    planned[1].save(tmp_path / "a.roadmap")
    return tmp_path / "a.roadmap"
