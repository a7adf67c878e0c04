"""Results of articulated robots: joints by name, unit quaternions, limits, lengths."""

import json
import math

import numpy as np
import pytest

from ellipsoid_planning.errors import ResultError
from ellipsoid_planning.metric import path_length
from ellipsoid_planning.result import PathResult, PlanResult, load_result
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.scenario_files import parse_document
from tests.articulated_texts import PLANAR, SPATIAL


def solved(text):
    data, origin = parse_document(text)
    scenario = Scenario._from_document(data, origin)
    path = PathResult.from_configurations(
        scenario.robot, [scenario.start, scenario.goal], min_clearance=math.inf, certified=True
    )
    return PlanResult(scenario, "PRM", "solved", 3, {"total": 0.1}, path)


@pytest.mark.parametrize(("text", "names"), [(PLANAR, "ear"), (SPATIAL, "shoulder wrist slide")])
def test_results_come_back(tmp_path, text, names):
    result = solved(text)
    result.save(tmp_path / "out.json")
    back = load_result(tmp_path / "out.json")
    np.testing.assert_array_equal(back.path.configurations, result.path.configurations)
    assert back.to_json() == result.to_json()
    assert result.to_dict()["path"]["joints"] == names.split()
    assert back.path.length == path_length(result.scenario.robot, result.path.configurations) > 0.0


def refused(tmp_path, document):
    (tmp_path / "bad.json").write_text(json.dumps(document))
    with pytest.raises(ResultError) as caught:
        load_result(tmp_path / "bad.json")
    return str(caught.value)


@pytest.mark.parametrize(
    ("text", "place", "value", "words"),
    [
        (PLANAR, 3, math.radians(90) + 1e-8, "[1]: expected a value between 0 and 1.570796327"),
        (PLANAR, 3, -1e-8, "for joint 'ear', got -1e-08"),
        (SPATIAL, 3, 1.1, "[1]: expected a unit quaternion for joint 'shoulder'"),
        (SPATIAL, 5, 0.5, "for joint 'slide', got 0.5"),
        (SPATIAL, 5, "a", "6 finite numbers"),
    ],
)
def test_wrong_configurations_are_refused(tmp_path, text, place, value, words):
    document = solved(text).to_dict()
    document["path"]["configurations"][1][place] = value
    message = refused(tmp_path, document)
    assert "bad.json: path.configurations[1]" in message
    assert words in message


def test_a_limit_is_kept_to_rounding(tmp_path):
    document = solved(PLANAR).to_dict()
    document["path"]["configurations"][1][3] = -1e-10
    (tmp_path / "out.json").write_text(json.dumps(document))
    assert load_result(tmp_path / "out.json").path.configurations[1, 3] == -1e-10


@pytest.mark.parametrize("joints", [["wrist", "shoulder", "slide"], [], "shoulder", None])
def test_joints_must_be_those_of_the_scenario(tmp_path, joints):
    document = solved(SPATIAL).to_dict()
    document["path"]["joints"] = joints
    assert "bad.json: path.joints: expected" in refused(tmp_path, document)
    del document["path"]["joints"]
    assert "path.joints: this entry is missing" in refused(tmp_path, document)


def test_base_quaternions_are_checked_too(tmp_path):
    text = SPATIAL.replace("base: fixed", "base: free")
    text = text.replace("goal:\n", "goal:\n  position: [1, 0, 1]\n")
    document = solved(text).to_dict()
    assert len(document["path"]["configurations"][0]) == 13
    document["path"]["configurations"][0][6] = 2.0
    message = refused(tmp_path, document)
    assert message.endswith("path.configurations[0]: expected a unit quaternion")
