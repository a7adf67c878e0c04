"""Roadmaps' files for the tests: how they are looked into, and changed."""

import io
import json
import zipfile

import numpy as np

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.world import World
from tests.roadmap.scenes import body, configuration
from tests.roadmap.test_level import never

HEADER = "roadmap.json"


def answers(roadmap, queries):
    """Status and path of every query, and the statistics afterwards."""
    found = []
    for query in queries:
        outcome = roadmap.solve(*query, never)
        found.append((outcome.status, None if outcome.path is None else outcome.path.tolist()))
    return found, roadmap.statistics


def members(file):
    """Header and arrays of a roadmap's file."""
    with np.load(file) as archive:
        content = {name: archive[name] for name in archive.files}
    return json.loads(content.pop(HEADER)), content


def rewrite(file, header, arrays):
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr(HEADER, json.dumps(header))
        for name, array in arrays.items():
            content = io.BytesIO()
            np.lib.format.write_array(content, np.asarray(array))
            archive.writestr(f"{name}.npy", content.getvalue())


def changed(file, **replaced):
    """Replace arrays of the first level by what functions make of them."""
    header, arrays = members(file)
    for name, change in replaced.items():
        arrays[f"levels[0].{name}"] = change(arrays[f"levels[0].{name}"].copy())
    rewrite(file, header, arrays)


def changed_header(file, change):
    header, arrays = members(file)
    change(header)
    rewrite(file, header, arrays)


def gap_scene(gap=1e-3):
    """Two walls that leave a gap, hardly wider than the robot."""
    robot = RigidRobot((body([1.0, 0.5]),))
    half = 3.0 + 0.5 * (1.0 + gap)
    walls = tuple(body([0.5, 3.0], [0.0, side * half]) for side in (-1.0, 1.0))
    return CSpace(World([-6.0] * 2, [6.0] * 2, walls), robot)


def gap_query(cspace):
    return configuration(cspace, -4.0, 1.0, yaw=0.3), configuration(cspace, 4.0, -1.0, yaw=0.4)
