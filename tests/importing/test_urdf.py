"""URDFs of real robots and small ones: every vertex inside, the same kinematics."""

import logging
import math

import numpy as np
import pytest
import trimesh
import yourdfpy

from ellipsoid_planning.errors import UrdfError
from ellipsoid_planning.scenario import Scenario
from planners.importing import import_urdf
from planners.importing.contacts import contacts, random_configuration, zero_configuration
from tests.importing.descriptions import (
    ARM,
    BEND_FACES,
    BEND_VERTICES,
    GRIPPER,
    mesh_text,
    written,
)

JOINT = '<joint name="turn" type="revolute">'
LIMIT = '<limit lower="-1" upper="2" effort="1" velocity="1"/>'
BOX = '<box size="1 2 3"/>'


def as_scenario(imported):
    """A scenario with the robot pasted, as the format reads it."""
    pose = {"position": [0.0] * 3, "orientation": {"quaternion": [0.0, 0.0, 0.0, 1.0]}}
    document = {
        "format": 1,
        "name": "imported",
        "dimension": 3,
        "bounds": {"low": [-5.0] * 3, "high": [5.0] * 3},
        **imported.document(),
        "start": pose,
        "goal": pose,
    }
    return Scenario.from_dict(document)


def original_vertices(file, link):
    """All vertices of a link's collision meshes in the link's frame, read without us."""
    for collision in link.collisions:
        if collision.geometry.mesh is not None:
            path = file.parent / collision.geometry.mesh.filename
            vertices = trimesh.load(path, force="mesh", process=False, skip_materials=True).vertices
            scale = collision.geometry.mesh.scale
            vertices = np.asarray(vertices) * (1.0 if scale is None else scale)
            pose = np.eye(4) if collision.origin is None else collision.origin
            yield vertices @ pose[:3, :3].T + pose[:3, 3]


@pytest.fixture(scope="module")
def described():
    # It complains of prefixes that these files do not declare.
    logging.getLogger("yourdfpy.urdf").setLevel(logging.CRITICAL)
    found = {}

    def load(file):
        if file not in found:
            found[file] = yourdfpy.URDF.load(str(file), load_meshes=False)
        return found[file]

    return load


@pytest.mark.parametrize(("file", "parts"), [(ARM, 1), (ARM, 2), (GRIPPER, 1)])
def test_every_vertex_of_a_real_robot_is_inside(file, parts, described):
    imported = import_urdf(file, parts=parts)
    checked = 0
    for link, report in zip(described(file).robot.links, imported.links, strict=True):
        parts_of_link = next(x for x in imported.robot.links if x.name == link.name).parts
        assert len(parts_of_link) == report.parts <= parts
        for vertices in original_vertices(file, link):
            inside = np.zeros(len(vertices), dtype=bool)
            for part in parts_of_link:
                ball = (vertices - part.centre) @ part.rotation / part.semi_axes
                inside |= np.linalg.norm(ball, axis=1) <= 1.0
            assert inside.all()
            checked += len(vertices)
        for collision in link.collisions:
            if collision.geometry.sphere is not None and parts == 1:
                directions = np.random.default_rng(0).normal(size=(1000, 3))
                directions /= np.linalg.norm(directions, axis=1, keepdims=True)
                at = np.eye(4) if collision.origin is None else collision.origin
                surface = at[:3, 3] + collision.geometry.sphere.radius * directions
                assert parts_of_link[0].contains(surface).all()
    assert checked > 1000
    assert 1.0 < imported.excess < (2.0 if parts == 1 else 1.8)


@pytest.mark.parametrize("file", [ARM, GRIPPER])
def test_kinematics_are_those_of_the_description(file, described):
    robot = import_urdf(file).robot
    model = described(file)
    for joint in model.robot.joints:  # its own forward kinematics would follow the leaders
        joint.mimic = None
    model._update_actuated_joints()
    model._cfg = model.zero_cfg
    rng = np.random.default_rng(5)
    for _ in range(5):
        q = random_configuration(robot, zero_configuration(robot), rng)
        model.update_cfg({n: q[robot.joint_slices[n]][0] for n in robot.joint_names})
        for link, (position, rotation) in robot.link_poses(q).items():
            expected = model.get_transform(link, robot.root)
            assert rotation == pytest.approx(expected[:3, :3], abs=1e-12)
            assert position == pytest.approx(expected[:3, 3], abs=1e-12)


@pytest.mark.parametrize("base", ["fixed", "translating", "free"])
def test_a_scenario_takes_the_robot_as_written(base):
    imported = import_urdf(ARM, base=base)
    read = as_scenario(imported).robot
    assert read.base == base and read.joint_names == imported.robot.joint_names
    for ours, theirs in zip(imported.robot.parts, read.parts, strict=True):
        assert np.array_equal(ours.semi_axes, theirs.semi_axes)
        assert ours.rotation == pytest.approx(theirs.rotation, abs=1e-15)
    for ours, theirs in zip(imported.robot.moving_joints, read.moving_joints, strict=True):
        assert (ours.lower, ours.upper) == pytest.approx((theirs.lower, theirs.upper), abs=1e-15)


def test_joints_axes_and_limits_are_carried_over(tmp_path):
    robot = import_urdf(written(tmp_path)).robot
    (joint,) = robot.joints
    assert (joint.type, joint.lower, joint.upper) == ("revolute", -1.0, 2.0)
    assert joint.axis == pytest.approx([0, 1, 0]) and joint.position == pytest.approx([0, 0, 2])
    for kind in ("continuous", "prismatic"):
        file = written(tmp_path, (JOINT, JOINT.replace("revolute", kind)))
        assert import_urdf(file).robot.joints[0].type == kind


def test_shapes_get_their_exact_ellipsoids(tmp_path):
    imported = import_urdf(written(tmp_path))
    box, cylinder = imported.robot.parts
    assert np.sort(box.semi_axes) == pytest.approx(math.sqrt(3) * np.array([0.5, 1.0, 1.5]))
    assert cylinder.semi_axes == pytest.approx([0.2 * 1.5**0.5, 0.2 * 1.5**0.5, math.sqrt(3.0)])
    assert cylinder.centre == pytest.approx([0, 0, 1])
    ratios = [math.sqrt(27) * math.pi / 6, math.sqrt(3.0)]
    assert [link.excess for link in imported.links] == pytest.approx(ratios)
    for capsule in ("capsule", "drake:capsule"):
        shape = f'<{capsule} radius="0.2" length="2"/>'
        file = written(tmp_path, ('<cylinder radius="0.2" length="2"/>', shape))
        body = import_urdf(file).robot.parts[1]
        assert body.contains([[0, 0, 2.2], [0.2, 0, 2], [0, 0.2, 0], [0, 0, -0.2]]).all()
    assert import_urdf(written(tmp_path, (BOX, '<sphere radius="2"/>'))).robot.parts[
        0
    ].semi_axes == pytest.approx([2, 2, 2])


MESHES = {
    "meshes/bend.obj": "meshes/bend.obj",
    "package://two_description/meshes/bend.obj": "meshes/bend.obj",
    "package://other/meshes/bend.obj": "packages/other/meshes/bend.obj",
    "model://two/bend.obj": "two/bend.obj",
    "bend.obj": "packages/bend.obj",
}


@pytest.mark.parametrize("name", MESHES)
def test_meshes_are_found_and_scaled(name, tmp_path):
    place = tmp_path / MESHES[name]
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_text(mesh_text(BEND_VERTICES, BEND_FACES), encoding="utf-8")
    mesh = f'<mesh filename="{name}" scale="1 -2 0.5"/>'
    imported = import_urdf(written(tmp_path, (BOX, mesh)), mesh_dir=tmp_path / "packages", parts=2)
    parts = imported.robot.links[0].parts
    inside = [part.contains(BEND_VERTICES * [1, -2, 0.5]) for part in parts]
    assert np.any(inside, axis=0).all() and imported.links[0].vertices == 12


def test_collada_in_centimetres(tmp_path):
    text = trimesh.creation.box(extents=[100.0, 200.0, 300.0]).export(file_type="dae").decode()
    assert "<asset>" in text
    text = text.replace("<asset>", '<asset><unit name="centimeter" meter="0.01"/>', 1)
    (tmp_path / "box.dae").write_text(text, encoding="utf-8")
    file = written(tmp_path, (BOX, '<mesh filename="box.dae"/>'))
    half = math.sqrt(3) * np.array([0.5, 1.0, 1.5])
    assert np.sort(import_urdf(file).robot.parts[0].semi_axes) == pytest.approx(half, rel=1e-6)


def test_mimic_joints_are_named_and_independent_or_fixed():
    free = import_urdf(GRIPPER)
    changed = {joint.name: joint.fate for joint in free.joints if joint.changed}
    assert len(changed) == 5 and "finger_joint" in changed["left_inner_finger_joint"]
    assert len(free.robot.joint_names) == 6
    held = import_urdf(GRIPPER, mimic="fixed")
    assert held.robot.joint_names == ("finger_joint",)
    zero = zero_configuration(free.robot)
    poses = held.robot.link_poses(zero_configuration(held.robot))
    for link, (position, rotation) in free.robot.link_poses(zero).items():
        assert position == pytest.approx(poses[link][0]) and rotation == pytest.approx(
            poses[link][1]
        )


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
def test_equal_limits_fix_the_joint_there(kind, tmp_path):
    moved = written(tmp_path, (JOINT, JOINT.replace("revolute", kind)))
    robot = import_urdf(moved).robot
    locked = written(
        tmp_path,
        (JOINT, JOINT.replace("revolute", kind)),
        (LIMIT, LIMIT.replace('"-1"', '"0.7"').replace('"2"', '"0.7"')),
    )
    imported = import_urdf(locked, base="free")
    assert imported.robot.joint_names == () and "fixed at 0.7" in imported.joints[0].fate
    expected = robot.link_poses(np.array([0.7]))["arm"]
    position, rotation = imported.robot.link_poses(np.array([0, 0, 0, 0, 0, 0, 1.0]))["arm"]
    assert position == pytest.approx(expected[0]) and rotation == pytest.approx(expected[1])


def test_a_root_that_floats_is_the_free_base(tmp_path):
    floating = (
        '<link name="world"/><joint name="fly" type="floating">'
        '<parent link="world"/><child link="base"/></joint></robot>'
    )
    file = written(tmp_path, ("</robot>", floating))
    imported = import_urdf(file, base="free")
    assert imported.robot.root == "base" and imported.robot.joint_names == ("turn",)
    with pytest.raises(UrdfError, match=r"'fly' \(floating\).*--base free"):
        import_urdf(file)


def test_links_that_always_touch_are_ignored(tmp_path):
    last = (
        '<link name="hand"><collision><geometry><sphere radius="0.3"/></geometry></collision>'
        '</link><joint name="wrist" type="continuous"><parent link="arm"/><child link="hand"/>'
        '<origin xyz="0 0 0.5"/></joint></robot>'
    )
    imported = import_urdf(written(tmp_path, ("</robot>", last)))
    assert imported.ignored == (("base", "hand"),)
    assert imported.robot.ignored == {frozenset(("base", "hand"))}
    assert as_scenario(imported).robot.ignored == imported.robot.ignored
    assert contacts(import_urdf(ARM).robot) == ([], [])


BACK = '<joint name="back" type="fixed"><parent link="arm"/><child link="base"/></joint></robot>'
BAD = {
    "no file": (None, "cannot read the file"),
    "not XML": ((("<?xml", "xml"),), "broken XML"),
    "cut off": ((("</robot>", ""),), "broken XML"),
    "no robot": ((("<robot name", "<body name"), ("</robot>", "</body>")), "got body"),
    "xacro": (
        (("</robot>", '<xacro:arm xmlns:xacro="http://ros.org/wiki/xacro"/></robot>'),),
        "xacro",
    ),
    "joint type": ((("revolute", "planar"),), r"'turn' \(planar\)"),
    "unknown joint type": ((("revolute", "screw"),), r"'turn' \(screw\)"),
    "no joint type": (((' type="revolute"', ""),), "of 'turn': the attribute 'type'"),
    "no parent": ((('<parent link="base"/>', ""),), "'turn': <parent> is missing"),
    "unknown parent": ((('parent link="base"', 'parent link="bse"'),), "'bse' is no link"),
    "no limit": (((LIMIT, ""),), "'turn': a revolute joint needs <limit"),
    "limits reversed": (
        (('lower="-1"', 'lower="3"'),),
        "'turn': expected limits with lower <= upper",
    ),
    "endless limit": (
        (('upper="2"', 'upper="inf"'),),
        "'turn': expected both limits within a thousand",
    ),
    "scale": (
        ((BOX, '<mesh filename="broken.stl" scale="1 1"/>'),),
        ":3: link 'base': .*three num",
    ),
    "one angle": ((('rpy="0.1 0.2 0.3"', 'rpy="0"'),), ":11: joint 'turn': .*three numbers, got 1"),
    "four numbers": ((('xyz="0 0 1"', 'xyz="0 0 1 2"'),), "link 'arm': .*three numbers, got 4"),
    "huge radius": (
        (('radius="0.2"', 'radius="1e300"'),),
        "link 'arm': .*1e-12 to 1e\\+12 m, got 1e300",
    ),
    "huge box": (
        ((BOX, '<box size="1e200 1 1"/>'),),
        "link 'base': .*1e-12 to 1e\\+12 m, got 1e200",
    ),
    "nan": ((('lower="-1"', 'lower="nan"'),), "'turn': .*finite numbers"),
    "endless shift": (
        (
            (JOINT, JOINT.replace("revolute", "prismatic")),
            ('lower="-1"', 'lower="-1e16"'),
            ('upper="2"', 'upper="1e16"'),
        ),
        "'turn': expected the limits of a prismatic joint within 1e\\+12",
    ),
    "entities": (
        (('<?xml version="1.0"?>', '<?xml version="1.0"?><!DOCTYPE r [<!ENTITY a "x">]>'),),
        "without entities",
    ),
    "nothing moves": (
        (('lower="-1"', 'lower="0"'), ('upper="2"', 'upper="0"')),
        "equal: fixed at 0",
    ),
    "one point": (((BOX, '<mesh filename="point.obj"/>'),), "link 'base': all points"),
    "no number": (((BOX, '<mesh filename="nan.obj"/>'),), "link 'base': mesh .*nan.obj: .*got nan"),
    "huge mesh": (
        ((BOX, '<mesh filename="huge.obj"/>'),),
        "link 'base': mesh .*huge.obj: .*1e\\+300",
    ),
    "axis": ((('xyz="0 2 0"', 'xyz="0 0 0"'),), "'turn': expected an axis"),
    "number": ((('lower="-1"', 'lower="low"'),), "'low'"),
    "two links": ((('link name="arm"', 'link name="base"'),), "called 'base'"),
    "box": (((BOX, '<box size="1 -2 3"/>'),), "link 'base'.*size of a box"),
    "radius": ((('radius="0.2"', 'radius="0"'),), "link 'arm'.*radius of a cylinder"),
    "no length": (((' length="2"', ""),), "'length' is missing"),
    "shape": (((BOX, '<cone radius="1"/>'),), "link 'base': .*got cone"),
    "no shape": (((BOX, ""),), "link 'base': a <collision> without geometry"),
    "no mesh name": (((BOX, "<mesh/>"),), "link 'base': a <mesh> without a filename"),
    "no mesh": (((BOX, '<mesh filename="package://two/a.stl"/>'),), "link 'base'.*--mesh-dir"),
    "broken mesh": (((BOX, '<mesh filename="broken.stl"/>'),), "link 'base': .*the mesh"),
    "empty mesh": (((BOX, '<mesh filename="empty.obj"/>'),), "link 'base': .*the mesh"),
    "odd mesh": (((BOX, '<mesh filename="two.urdf"/>'),), "link 'base': cannot read the mesh"),
    "point": (((BOX, '<box size="0 0 0"/>'),), "link 'base'"),
    "cycle": ((("</robot>", BACK),), "cycle"),
    "apart": ((("</robot>", '<link name="lost"/></robot>'),), "'lost' are not connected"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_clear_error(case, tmp_path):
    replacements, words = BAD[case]
    (tmp_path / "broken.stl").write_bytes(b"solid nothing\x00\xff")
    (tmp_path / "empty.obj").write_text("v 0 0 0\n", encoding="utf-8")
    for name, number in (("point", "0"), ("nan", "nan"), ("huge", "1e300")):
        text = f"v 0 0 0\nv 0 0 {number}\nv 0 0 0\nf 1 2 3\n"
        (tmp_path / f"{name}.obj").write_text(text, encoding="utf-8")
    file = tmp_path / "none.urdf" if replacements is None else written(tmp_path, *replacements)
    with pytest.raises(UrdfError, match=words) as caught:
        import_urdf(file)
    assert "\n" not in str(caught.value)


def test_options_and_robots_without_geometry(tmp_path):
    file = written(tmp_path)
    for options in ({"parts": 0}, {"base": "flying"}, {"mimic": "follow"}):
        with pytest.raises(UrdfError, match=next(iter(options))):
            import_urdf(file, **options)
    text = file.read_text(encoding="utf-8").replace("collision>", "visual>")
    file.write_text(text, encoding="utf-8")
    with pytest.raises(UrdfError, match="no link has collision geometry"):
        import_urdf(file)


def test_missing_libraries_are_named(monkeypatch, tmp_path):
    monkeypatch.setitem(__import__("sys").modules, "yourdfpy", None)
    with pytest.raises(UrdfError, match=r"pip install.*ellipsoid-planning\[import\]"):
        import_urdf(written(tmp_path))


def test_limits_that_mean_none_and_what_is_left_out_are_reported(tmp_path):
    file = written(tmp_path, ('lower="-1"', 'lower="-1.8e308"'), ('upper="2"', 'upper="1.8e308"'))
    (joint,) = import_urdf(file).joints
    assert "mean none: it is taken for continuous" in joint.fate
    assert joint.changed
    (other,) = import_urdf(written(tmp_path)).joints
    assert other.dropped == ("velocity", "effort")
    assert not other.changed


def test_joints_whose_values_would_share_a_key_are_refused(tmp_path):
    more = (
        '<link name="c"/><joint name="turn_deg" type="prismatic"><parent link="base"/>'
        '<child link="c"/><limit lower="0" upper="1"/></joint></robot>'
    )
    with pytest.raises(UrdfError, match=r"'turn' and 'turn_deg' .*; rename one of them"):
        import_urdf(written(tmp_path, ("</robot>", more)))
