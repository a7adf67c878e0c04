"""Bad links, joints and joint values: one message each with file, field, line and remedy."""

import pytest

from ellipsoid_planning.errors import ScenarioError
from ellipsoid_planning.scenario import load_scenario
from tests.articulated_texts import PLANAR, SPATIAL

LIMIT = "limit: {lower_deg: 0, upper_deg: 90}"
JOINT = "    - name: ear\n      type"
SHOULDER = "shoulder: {rpy_deg: [10, 20, 30]}"


def fault(tmp_path, text):
    """The error of a scenario text, which must name its file, in one line."""
    file = tmp_path / "bad.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ScenarioError) as caught:
        load_scenario(file)
    error = caught.value
    assert str(error).startswith(f"{file}:{error.line}:{error.column}: {error.field}: ")
    assert "\n" not in str(error)
    return error


def changed(text, *replacements):
    for old, new in zip(replacements[::2], replacements[1::2], strict=True):
        assert old in text
        text = text.replace(old, new, 1)
    return text


def back(kind, parent, child, name="back"):
    """Another joint before the ear's."""
    return f"    - {{name: {name}, type: {kind}, parent: {parent}, child: {child}}}\n{JOINT}"


# text to replace, replacement, field, line, words of the message
TREE_FAULTS = [
    ("parent: head", "parent: haed", "robot.joints[0].parent", 17, "did you mean 'head'?"),
    ("parent: head", "parent: body", "robot.joints[0].parent", 17, "the links are head, ear"),
    ("child: ear", "child: eear", "robot.joints[0].child", 18, "is no link"),
    ("child: ear", "child: head", "robot.joints[0]", 15, "cycle, head -> head"),
    (JOINT, back("fixed", "ear", "head"), "robot.joints[1]", 16, "head -> ear -> head"),
    (JOINT, back("fixed", "head", "ear"), "robot.joints[1].child", 19, "child of two joints"),
    (JOINT, back("fixed", "a", "b", "ear"), "robot.joints[1].name", 16, "two joints are called"),
    ("name: head", "name: ear", "robot.links[1].name", 11, "two links are called 'ear'"),
    ("  joints:", "    - name: tail\n  joints:", "robot.links[2]", 14, "not connected"),
    ("name: head", "name: ''", "robot.links[0].name", 8, "not empty"),
    ("- name: head\n      parts", "- parts", "robot.links[0].name", 8, "missing"),
]
ROBOT_FAULTS = [
    ("base: free", "base: flying", "robot.base", 6, "free, translating or fixed, got 'flying'"),
    ("base: free", "rotates: false", "robot.rotates", 6, "write base"),
    ("base: free", "parts: [{semi_axes: [1, 1]}]", "robot.parts", 6, "either parts"),
    ("  links:", "  parts:", "robot.base", 6, "either parts"),
    ("base: free", "base: free\n  joint: 3", "robot.joint", 7, "'joints'"),
    ("base: free", "base: translating", "goal.orientation", 22, "robot.base is translating"),
    ("base: free", "base: fixed", "goal.position", 22, "because robot.base is fixed"),
    ("dimension: 2", "dimension: 3", "bounds.low", 4, "3 numbers because"),
    *[
        ("base: free", f"ignore_self_collision: {pairs}", field, 6, words)
        for pairs, field, words in [
            ("[[ear, hed]]", "robot.ignore_self_collision[0]", "did you mean 'head'?"),
            ("[[ear, head], [ear, ear]]", "robot.ignore_self_collision[1]", "two different links"),
            ("[[ear]]", "robot.ignore_self_collision[0]", "pairs of two links, got 1"),
            ("[ear, head]", "robot.ignore_self_collision[0]", "a list, got 'ear'"),
        ]
    ],
]
JOINT_FAULTS = [
    ("lower_deg: 0", "lower_deg: 100", "robot.joints[0].limit.lower_deg", 20, "got 100 and 90"),
    ("lower_deg: 0", "lower_deg: 90", "robot.joints[0].limit.lower_deg", 20, "got 90 and 90"),
    ("lower_deg: 0, ", "", "robot.joints[0].limit.lower_deg", 20, "missing"),
    ("lower_deg", "lower", "robot.joints[0].limit.lower", 20, "is revolute, so its limits"),
    ("upper_deg: 90", "upper_deg: .inf", "robot.joints[0].limit.upper_deg", 20, "finite"),
    (LIMIT, "axis: [1, 0]", "robot.joints[0].axis", 20, "in the plane"),
    ("type: revolute", "type: ball", "robot.joints[0].type", 16, "no ball joints in the plane"),
    ("type: revolute", "type: floating", "robot.joints[0].type", 16, "got 'floating'"),
    ("type: revolute", "type: continuous", "robot.joints[0].limit", 20, "make it revolute"),
    ("type: revolute", "type: fixed", "robot.joints[0].limit", 20, "remove them"),
    ("type: revolute", "type: prismatic", "robot.joints[0].limit.lower_deg", 20, "lower and upper"),
    ("[-6, 2]", "[-6, 2, 1]", "robot.joints[0].origin.position", 19, "2 numbers because"),
    ("yaw_deg: 90", "rpy_deg: [0, 0, 0]", "robot.joints[0].origin.orientation.rpy_deg", 19, "yaw"),
    ("origin:", "orign:", "robot.joints[0].orign", 19, "'origin'"),
]
VALUE_FAULTS = [
    ("ear_deg: 30", "ear_deg: 91", "start.joints.ear_deg", 21, "[0, 90] deg, got 91"),
    ("ear_deg: 30", "ear_deg: -1", "start.joints.ear_deg", 21, "[0, 90] deg, got -1"),
    ("ear_deg: 30", "ear: 30", "start.joints.ear", 21, "write ear_deg and an angle in degrees"),
    ("ear_deg: 30", "eer_deg: 30", "start.joints.eer_deg", 21, "did you mean ear_deg?"),
    ("ear_deg: 30", "tail: 30", "start.joints.tail", 21, "expected one of ear_deg"),
    ("ear_deg: 30", "ear_deg: {yaw_deg: 3}", "start.joints.ear_deg", 21, "expected a number"),
    ("ear_deg: 30", "ear_deg: '3'", "start.joints.ear_deg", 21, "got '3'"),
    ("ear_deg: 30", "ear_deg: ", "start.joints.ear_deg", 21, "got nothing"),
    ("ear_deg: 30", "ear_deg: .nan", "start.joints.ear_deg", 21, "finite"),
    ("ear_deg: 30", "3: 4", "start.joints[3]", 21, "text, got 3"),
    ("{ear_deg: 30}", "30", "start.joints", 21, "a mapping, got 30"),
    ("lower_deg: 0", "lower_deg: 10", "goal.joints", 22, "would stand at 0"),
    ("{position: [40, 10], o", "{o", "goal.position", 22, "missing"),
]


@pytest.mark.parametrize(
    ("old", "new", "field", "line", "words"),
    [*TREE_FAULTS, *ROBOT_FAULTS, *JOINT_FAULTS, *VALUE_FAULTS],
)
def test_planar_faults(tmp_path, old, new, field, line, words):
    error = fault(tmp_path, changed(PLANAR, old, new))
    assert (error.field, error.line) == (field, line)
    assert words in error.problem


# text to replace, replacement, field, words of the message
SPATIAL_FAULTS = [
    ("axis: [1, 1, 1]", "axis: [0, 0, 0]", "robot.joints[1].axis", "other than zero"),
    ("axis: [1, 1, 1]", "axis: [0, 1]", "robot.joints[1].axis", "3 numbers because"),
    ("type: ball", "type: ball\n      axis: [1, 0, 0]", "robot.joints[0].axis", "about every axis"),
    ("lower: -0.1", "lower_deg: 4", "robot.joints[2].limit.lower_deg", "is prismatic"),
    ("lower: -0.1", "lower: 0.1", "goal.joints", "'slide' is not named"),
    ("upper: 0.4", "upper: -0.4", "robot.joints[2].limit.lower", "lower < upper"),
    ("name: slide", "name: wrist_deg", "robot.joints[2].name", "both be called wrist_deg"),
    ("slide: 0.33", "slide: 0.5", "start.joints.slide", "[-0.1, 0.4], got 0.5"),
    ("slide: 0.33", "slide_deg: 0.5", "start.joints.slide_deg", "write slide and a length"),
    ("wrist_deg: 270", "wrist: 270", "start.joints.wrist", "write wrist_deg"),
    ("shoulder: {rpy", "shoulder_deg: {rpy", "start.joints.shoulder_deg", "write shoulder"),
    (SHOULDER, "shoulder: 4", "start.joints.shoulder", "expected an orientation, got 4"),
    (SHOULDER, "shoulder: [0, 0, 0, 1]", "start.joints.shoulder", "or NAME: {quaternion"),
    (SHOULDER, "shoulder: {yaw_deg: 4}", "start.joints.shoulder.yaw_deg", "quaternion or rpy"),
    (SHOULDER, "shoulder: {}", "start.joints.shoulder", "exactly one"),
    (
        SHOULDER,
        "shoulder: {quaternion: [0, 0, 0, 2]}",
        "start.joints.shoulder.quaternion",
        "length 2",
    ),
    ("type: ball", "type: fixed", "start.joints.shoulder", "is fixed and has no value"),
    ("goal:", "goal:\n  position: [0, 0, 0]", "goal.position", "expected the start's position"),
    (
        "goal:",
        "goal:\n  orientation: {rpy_deg: [0, 0, 1]}",
        "goal.orientation",
        "because robot.base is fixed",
    ),
    ("base: fixed", "base: translating", "goal.position", "missing"),
]


@pytest.mark.parametrize(("old", "new", "field", "words"), SPATIAL_FAULTS)
def test_spatial_faults(tmp_path, old, new, field, words):
    error = fault(tmp_path, changed(SPATIAL, old, new))
    assert error.field == field
    assert error.line is not None
    assert words in error.problem


def test_a_revolute_joint_needs_limits(tmp_path):
    error = fault(tmp_path, changed(PLANAR, LIMIT, ""))
    assert error.field == "robot.joints[0].limit"
    assert "add limit: {lower_deg: ..., upper_deg: ...}" in error.problem


def test_a_robot_needs_a_part_somewhere(tmp_path):
    bodies = ("- {name: face, semi_axes: [5, 3]}", "- {semi_axes: [3, 1], position: [3, 0]}")
    text = changed(PLANAR, bodies[0], "[]", bodies[1], "[]")
    error = fault(tmp_path, text)
    assert error.field == "robot.links"
    assert "at least one part" in error.problem
    error = fault(
        tmp_path, changed(PLANAR, PLANAR[PLANAR.index("  base") :], "  links: []\n" + ENDS)
    )
    assert (error.field, error.line) == ("robot.links", 6)
    assert "at least one link" in error.problem
    error = fault(tmp_path, changed(PLANAR, PLANAR[PLANAR.index("  base") :], "  {}\n" + ENDS))
    assert error.field == "robot.parts"
    assert "or links" in error.problem


ENDS = "start: {position: [0, 0]}\ngoal: {position: [1, 0]}\n"


def test_a_fixed_robot_must_move_somehow(tmp_path):
    robot = "  base: fixed\n  links:\n    - name: rock\n      parts:\n        - semi_axes: [1, 1]\n"
    text = PLANAR[: PLANAR.index("  base")] + robot + "start: {}\ngoal: {}\n"
    error = fault(tmp_path, text)
    assert error.field == "robot.base"
    assert "a joint that moves" in error.problem


def test_rigid_robots_have_no_joints(tmp_path):
    robot = "  parts:\n    - semi_axes: [1, 1]\n"
    text = PLANAR[: PLANAR.index("  base")] + robot + ENDS
    error = fault(tmp_path, changed(text, "[0, 0]}", "[0, 0], joints: {ear_deg: 3}}"))
    assert error.field == "start.joints"
    assert "rigid" in error.problem
    error = fault(tmp_path, changed(text, "parts:", "joints: []\n  parts:"))
    assert error.field == "robot.joints"
    assert "put the parts into links" in error.problem
