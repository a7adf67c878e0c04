"""Roadmaps of other scenes, and files that are no roadmaps, are refused and stay as they are."""

import zipfile

import numpy as np
import pytest

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import RoadmapError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.roadmap.store_format import FORMAT
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.world import World
from tests.roadmap.stored import (
    HEADER,
    changed_header,
)


def nudged(ellipsoids):
    first, *others = ellipsoids
    centre = first.centre + np.spacing(np.abs(first.centre) + 1.0)
    return (Ellipsoid(centre, first.rotation, first.semi_axes), *others)


def other_scenes(cspace):
    """C-spaces that differ from this one a little, and what the refusal says of each."""
    world, robot = cspace.world, cspace.robot
    wider = World(world.low, world.high + 1e-12, world.obstacles, world.arenas)
    moved = World(world.low, world.high, nudged(world.obstacles), world.arenas)
    yield CSpace(wider, robot), "another world;"
    yield CSpace(moved, robot), "another world;"
    yield CSpace(world, RigidRobot(nudged(robot.parts))), "another robot;"
    yield CSpace(world, RigidRobot(robot.parts, rotates=False)), "another robot;"
    yield CSpace(world, robot, 1e-3), "clearance 0.0 (here 0.001);"
    yield CSpace(moved, RigidRobot(robot.parts[:1]), 1e-3), "another world, another robot, clear"


def test_every_other_scene_is_refused(planned, file):
    for other, words in other_scenes(planned[0]):
        with pytest.raises(RoadmapError) as refusal:
            HighwayRoadmap.load(file, other)
        assert str(refusal.value).startswith(f"{file}: expected a roadmap of this scene, got one")
        assert words in str(refusal.value)
        assert "name another file, or delete this one" in str(refusal.value)


def test_names_and_the_sign_of_zero_do_not_count(planned, file):
    cspace, roadmap = planned
    world = cspace.world
    named = tuple(
        Ellipsoid(e.centre, np.where(e.rotation == 0.0, -0.0, e.rotation), e.semi_axes, "pillar")
        for e in world.obstacles
    )
    same = CSpace(World(world.low, world.high, named, world.arenas), cspace.robot)
    assert HighwayRoadmap.load(file, same).statistics == roadmap.statistics


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("layers", 12, "layers 36 (here 12)"),
        ("lines", 30, "lines 24 (here 30)"),
        ("axis", 1, "axis null (here 1)"),
        ("neighbours", 9, "neighbours 4 (here 9)"),
        ("seed", 2, "seed 1 (here 2)"),
    ],
)
def test_parameters_that_shape_the_roadmap_must_agree(planned, file, name, value, words):
    with pytest.raises(RoadmapError) as refusal:
        HighwayRoadmap.load(file, planned[0], RoadmapParameters(**{name: value}))
    assert words in str(refusal.value)


def test_parameters_of_the_search_may_differ(planned, file):
    given = RoadmapParameters(inflation=1.0, refine=0, layers=36, lines=24, metric_weight=3.0)
    assert HighwayRoadmap.load(file, planned[0], given).parameters == given
    assert HighwayRoadmap.load(file, planned[0]).parameters == RoadmapParameters()


def foreign_files(folder):
    """Files that are no roadmaps."""
    contents = {"empty": b"", "text": b"hello", "cut": b"PK\x03\x04" + b"x" * 40}
    for name, content in contents.items():
        (folder / name).write_bytes(content)
    np.savez(folder / "arrays.npz", a=np.arange(3))
    with zipfile.ZipFile(folder / "other.zip", "w") as archive:
        archive.writestr(HEADER, '{"kind": "map of the roads"}')
    with zipfile.ZipFile(folder / "list.zip", "w") as archive:
        archive.writestr(HEADER, "[1, 2]")
    return sorted(folder.iterdir())


def test_foreign_files_are_neither_loaded_nor_replaced(planned, tmp_path):
    cspace, roadmap = planned
    for foreign in foreign_files(tmp_path):
        before = foreign.read_bytes()
        with pytest.raises(RoadmapError, match="expected a roadmap") as refusal:
            HighwayRoadmap.load(foreign, cspace)
        assert str(foreign) in str(refusal.value)
        with pytest.raises(RoadmapError, match="expected a roadmap"):
            roadmap.save(foreign)
        assert foreign.read_bytes() == before


def test_places_where_no_file_can_be(planned, tmp_path):
    cspace, roadmap = planned
    missing = tmp_path / "missing" / "a.roadmap"
    for use in (roadmap.save, lambda path: HighwayRoadmap.load(path, cspace)):
        with pytest.raises(RoadmapError, match=r"does not exist; create it first"):
            use(missing)
        with pytest.raises(RoadmapError, match="expected a file"):
            use(tmp_path)
    with pytest.raises(RoadmapError, match="cannot read the roadmap: No such file"):
        HighwayRoadmap.load(tmp_path / "a.roadmap", cspace)
    assert list(tmp_path.iterdir()) == []


def test_a_failed_write_leaves_the_older_file(planned, file, monkeypatch):
    before = file.read_bytes()

    def no_space(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", no_space)
    with pytest.raises(RoadmapError, match="cannot write the file: No space left"):
        HighwayRoadmap(planned[0]).save(file)
    assert file.read_bytes() == before
    assert list(file.parent.iterdir()) == [file]


@pytest.mark.parametrize(("name", "value"), [("format", FORMAT + 1), ("version", "9.0")])
def test_other_formats_and_versions_are_refused_but_may_be_replaced(planned, file, name, value):
    cspace, roadmap = planned
    changed_header(file, lambda header: header.update({name: value}))
    with pytest.raises(RoadmapError, match=f"expected a roadmap of {name} .*, got {value}; name"):
        HighwayRoadmap.load(file, cspace)
    roadmap.save(file)
    assert HighwayRoadmap.load(file, cspace).statistics == roadmap.statistics
