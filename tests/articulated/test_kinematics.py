"""Forward kinematics: the robot's own and the kernels' against twins and a URDF library."""

from __future__ import annotations

import io
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ellipsoid_planning.kernels import kinematics
from tests.articulated import random_robots, twin

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])


@DIMENSIONS
def test_parts_stand_where_the_twins_stand(dimension: int) -> None:
    """Random trees with every type of joint, fixed ones merged into bodies by the kernels."""
    rng = np.random.default_rng(1)
    for k in range(60):
        robot = random_robots.random_robot(rng, dimension, links=int(rng.integers(2, 12)))
        space = random_robots.cspace(random_robots.random_world(rng, dimension, 1), robot)
        configurations = random_robots.random_configurations(rng, robot, 3)
        slow = twin.placed(robot, configurations)
        for m, configuration in enumerate(configurations):
            rows = space.placed(configuration)
            for row, (centres, matrices) in zip(rows, slow, strict=True):
                centre, shape = np.zeros(3), np.zeros((3, 3))
                centre[:dimension] = centres[m]
                shape[:dimension, :dimension] = matrices[m] @ matrices[m].T
                np.testing.assert_allclose(row[:3], centre, atol=2e-14, err_msg=str(k))
                matrix = row[3:12].reshape(3, 3)
                np.testing.assert_allclose(matrix @ matrix.T, shape, atol=2e-14)
                half = np.sqrt(np.diag(shape))
                np.testing.assert_allclose(row[12:15], half, atol=2e-14)


@DIMENSIONS
def test_velocities_are_differences_of_places(dimension: int) -> None:
    rng = np.random.default_rng(2)
    for _ in range(25):
        robot = random_robots.random_robot(rng, dimension, links=8, base="free")
        packed = random_robots.cspace(random_robots.random_world(rng, dimension, 1), robot)
        first = random_robots.random_configurations(rng, robot, 1)[0]
        table, start = packed.kinematics, packed.poses(first)[0]
        rates = np.zeros(len(start))
        used = slice(0, 6) if dimension == 3 else [0, 1, 5]
        rates[used] = rng.uniform(-2, 2, size=6 if dimension == 3 else 3)
        for joint in kinematics.joint_rows(table):
            at = int(joint[kinematics.JOINT_VALUE])
            size = 3 if joint[kinematics.JOINT_KIND] == kinematics.BALL else 1
            rates[at : at + size] = rng.uniform(-2, 2, size=size)
        frames = [kinematics.new_frames(table) for _ in range(3)]
        row = np.empty(len(start))
        for s, frame in zip((0.3 - 1e-5, 0.3, 0.3 + 1e-5), frames, strict=True):
            kinematics.row_at(table, start, rates, s, row)
            kinematics.body_frames(table, row, frame)
        kinematics.row_at(table, start, rates, 0.3, row)
        kinematics.body_velocities(table, rates, frames[1])
        change = (frames[2] - frames[0]) / 2e-5
        t, v = kinematics.FRAME_TRANSLATION, kinematics.FRAME_VELOCITY
        np.testing.assert_allclose(change[:, t : t + 3], frames[1][:, v : v + 3], atol=1e-6)
        for found, moved in zip(frames[1], change, strict=True):
            spin = found[kinematics.FRAME_SPIN : kinematics.FRAME_SPIN + 3]
            turned = np.cross(spin, found[:9].reshape(3, 3).T).T
            np.testing.assert_allclose(moved[:9].reshape(3, 3), turned, atol=1e-6)


def urdf_of(robot: Any) -> str:
    """A robot without ball joints in URDF; parts are left out."""
    root = ET.Element("robot", name="tree")
    for link in robot.links:
        ET.SubElement(root, "link", name=link.name)
    for joint in robot.joints:
        element = ET.SubElement(root, "joint", name=joint.name, type=joint.type)
        ET.SubElement(element, "parent", link=joint.parent)
        ET.SubElement(element, "child", link=joint.child)
        angles = Rotation.from_matrix(joint.rotation).as_euler("xyz")
        origin = {"xyz": joint.position, "rpy": angles}
        texts = {name: " ".join(map(repr, map(float, v))) for name, v in origin.items()}
        ET.SubElement(element, "origin", texts)
        if joint.axis is not None:
            xyz = " ".join(map(repr, map(float, joint.axis)))
            ET.SubElement(element, "axis", xyz=xyz)
        limits = {"lower": repr(joint.lower), "upper": repr(joint.upper)}
        ET.SubElement(element, "limit", limits, effort="1", velocity="1")
    return ET.tostring(root, encoding="unicode")


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_link_poses_are_a_urdf_library_s() -> None:
    yourdfpy = pytest.importorskip("yourdfpy")
    rng = np.random.default_rng(3)
    types = ("revolute", "continuous", "prismatic", "fixed")
    for _ in range(8):
        robot = random_robots.random_robot(rng, 3, links=7, base="free", types=types)
        text = io.BytesIO(urdf_of(robot).encode())
        model = yourdfpy.URDF.load(text, load_meshes=False, build_scene_graph=True)
        configuration = random_robots.random_configurations(rng, robot, 1)[0]
        configuration[:7] = [0, 0, 0, 0, 0, 0, 1]
        values = {
            name: float(configuration[place][0]) for name, place in robot.joint_slices.items()
        }
        model.update_cfg(values)
        for name, (position, rotation) in robot.link_poses(configuration).items():
            pose = model.get_transform(name, robot.root)
            np.testing.assert_allclose(pose[:3, :3], rotation, atol=1e-12)
            np.testing.assert_allclose(pose[:3, 3], position, atol=1e-12)
