"""Plan results: round trip, self-consistency, atomic files."""

import json
import math

import numpy as np
import pytest

from ellipsoid_planning import atomic
from ellipsoid_planning.errors import ResultError
from ellipsoid_planning.metric import base_travel, path_length
from ellipsoid_planning.result import TIMES, PathResult, PlanResult, load_result
from ellipsoid_planning.scenario import load_scenario


def solved(name="rabbit-2d-open", clearance=0.25):
    scenario = load_scenario(name)
    configurations = np.array([scenario.start, 0.5 * (scenario.start + scenario.goal)])
    if scenario.dimension == 3:
        configurations[1, 3:] /= np.linalg.norm(configurations[1, 3:])
    path = PathResult.from_configurations(
        scenario.robot,
        np.vstack([configurations, scenario.goal]),
        min_clearance=clearance,
        certified=True,
    )
    time = {"total": 0.01}
    statistics = {"layers": np.int64(3), "gaps": np.array([0.5])}
    return PlanResult(scenario, "RRT", "solved", 7, time, path, statistics)


@pytest.mark.parametrize("name", ["rabbit-2d-open", "rabbit-3d-open"])
def test_results_come_back(tmp_path, name):
    result = solved(name)
    result.save(tmp_path / "out.json")
    back = load_result(tmp_path / "out.json")
    np.testing.assert_array_equal(back.path.configurations, result.path.configurations)
    assert back.path.length == result.path.length
    assert back.path.base_travel == result.path.base_travel
    assert (back.planner, back.seed, back.status, back.solved) == ("RRT", 7, "solved", True)
    assert dict(back.time) == {**dict.fromkeys(TIMES), "total": 0.01}
    assert back.statistics == {"layers": 3, "gaps": [0.5]}
    assert back.to_json() == result.to_json()
    assert [file.name for file in tmp_path.iterdir()] == ["out.json"]


def test_unsolved_results_have_no_path(tmp_path):
    PlanResult(load_scenario("rabbit-2d-open"), "PRM", "timeout").save(tmp_path / "out.json")
    assert json.loads((tmp_path / "out.json").read_text())["path"] is None
    assert not load_result(tmp_path / "out.json").solved


def test_an_infinite_clearance_becomes_null(tmp_path):
    result = solved(clearance=math.inf)
    result.save(tmp_path / "out.json")
    assert json.loads((tmp_path / "out.json").read_text())["path"]["min_clearance"] is None
    assert load_result(tmp_path / "out.json").path.min_clearance == math.inf


def test_lengths_follow_ompl():
    planar = load_scenario("rabbit-2d-open").robot
    path = [[0.0, 0.0, 3.0], [3.0, 4.0, -3.0]]
    assert path_length(planar, path) == pytest.approx(5.0 + 0.5 * (2.0 * math.pi - 6.0))
    assert base_travel(planar, path) == 5.0
    spatial = load_scenario("rabbit-3d-open").robot
    turn = [0.0, 0.0, math.sin(0.4), math.cos(0.4)]
    path = [[0.0] * 6 + [1.0], [0.0, 0.0, 2.0, *turn], [0.0, 0.0, 2.0, *np.negative(turn)]]
    assert path_length(spatial, path) == pytest.approx(2.0 + 0.4)


@pytest.mark.parametrize(
    ("keys", "value", "words"),
    [
        (("format",), 2, "expected 1"),
        (("status",), "done", "status"),
        (("status",), "timeout", "path"),
        (("planner",), None, "planner"),
        (("time", "total"), "fast", "time.total"),
        (("path", "length"), 3.0, "path.length: says 3"),
        (("path", "base_travel"), True, "path.base_travel"),
        (("path", "certified"), 1, "path.certified"),
        (("path", "configurations"), [], "one configuration"),
        (("path", "configurations"), [[1, 2]], r"configurations\[0\]: expected 3"),
        (("path", "configurations"), [[1, 2, math.nan]], r"configurations\[0\]"),
        (("path", "configurations"), [[1, 2, 10**400]], r"configurations\[0\]"),
        (("scenario", "start", "position"), [1, 2, 3], "scenario.start.position"),
        (("statistics",), [], "statistics"),
    ],
)
def test_wrong_entries_are_named(tmp_path, keys, value, words):
    document = json.loads(solved().to_json())
    entry = document
    for key in keys[:-1]:
        entry = entry[key]
    entry[keys[-1]] = value
    file = tmp_path / "bad.json"
    file.write_text(json.dumps(document))
    with pytest.raises(ResultError, match=words) as caught:
        load_result(file)
    assert str(file) in str(caught.value)


def test_times_of_before_they_were_told_apart_are_read():
    document = json.loads(solved().to_json())
    document["time"] = {"total": 0.25, "build": None, "search": None}
    time = PlanResult.from_dict(document).time
    assert (time["planning"], time["simplification"], time["total"]) == (0.25, None, 0.25)


def test_missing_entries_are_named():
    for key in ("format", "scenario", "planner", "status", "time", "path", "statistics"):
        document = json.loads(solved().to_json())
        del document[key]
        with pytest.raises(ResultError, match=f"{key}: this entry is missing"):
            PlanResult.from_dict(document)


@pytest.mark.parametrize("text", ["", "{", "[1]", "3", "[" * 100000, "9" * 5000])
def test_files_that_are_no_result(tmp_path, text):
    (tmp_path / "bad.json").write_text(text)
    with pytest.raises(ResultError, match=r"bad\.json"):
        load_result(tmp_path / "bad.json")


def test_unreadable_and_unwritable_files(tmp_path):
    with pytest.raises(ResultError, match="No such file"):
        load_result(tmp_path / "none.json")
    with pytest.raises(ResultError, match="folder"):
        solved().save(tmp_path / "missing" / "out.json")
    with pytest.raises(ResultError, match="cannot write"):
        solved().save(tmp_path)


def test_an_interrupted_write_leaves_the_old_file(tmp_path, monkeypatch):
    target = tmp_path / "out.json"
    atomic.write_text(target, "old")

    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(atomic.os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        atomic.write_text(target, "new")
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_impossible_results_are_refused():
    scenario = load_scenario("rabbit-2d-open")
    with pytest.raises(ResultError, match="status"):
        PlanResult(scenario, "RRT", "done")
    with pytest.raises(ResultError, match="exactly when solved"):
        PlanResult(scenario, "RRT", "solved")
    with pytest.raises(ResultError, match="one or more"):
        PathResult(np.zeros((0, 3)), 0.0, 0.0, 1.0, True)
    with pytest.raises(ResultError, match="3 numbers"):
        PlanResult(scenario, "RRT", "solved", path=PathResult(np.zeros((1, 2)), 0, 0, 1, True))
