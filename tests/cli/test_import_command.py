"""``import urdf``: what is printed, written and refused."""

import json

from ruamel.yaml import YAML

from tests.cli.command import refused, run
from tests.importing.descriptions import GRIPPER, written


def test_a_robot_is_written_and_reported(tmp_path):
    file, output = written(tmp_path), tmp_path / "robot.yaml"
    done = run("import", "urdf", file, "--output", output, "--base", "free")
    assert done.returncode == 0, done.stderr
    assert f"Wrote {output}" in done.stderr
    for words in ("base", "arm", "2.721", "1.732", "turn", "revolute", "carried over"):
        assert words in done.stdout
    robot = YAML(typ="safe").load(output.read_text(encoding="utf-8"))["robot"]
    assert robot["base"] == "free" and [link["name"] for link in robot["links"]] == ["base", "arm"]
    printed = run("import", "urdf", file, "--base", "free")
    assert printed.stdout == output.read_text(encoding="utf-8") and "2.721" in printed.stderr


def test_the_report_as_json_names_what_changed():
    done = run("import", "urdf", GRIPPER, "--json", "--mimic", "fixed")
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    fates = {joint["name"]: joint["fate"] for joint in report["joints"]}
    assert fates["left_inner_finger_joint"] == "mimics 'finger_joint': fixed at 0"
    assert "left_inner_finger_joint" in done.stderr
    assert report["volume_excess"] > 1.0 and report["robot"]["base"] == "fixed"


def test_bad_input_writes_nothing(tmp_path):
    file = written(tmp_path, ('<box size="1 2 3"/>', '<mesh filename="package://two/a.stl"/>'))
    output = tmp_path / "robot.yaml"
    done = run("import", "urdf", file, "--output", output)
    assert refused(done, "'base'", "package://two/a.stl", str(tmp_path), "--mesh-dir")
    assert refused(run("import", "urdf", tmp_path / "none.urdf"), "none.urdf")
    assert refused(run("import", "urdf", file, "--output", tmp_path / "no" / "r.yaml"), "--output")
    assert not output.exists()
