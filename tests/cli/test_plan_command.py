"""`plan`: what it prints, what it writes, and how it ends."""

import csv
import json

import numpy as np
import pytest

from ellipsoid_planning.result import load_result
from ellipsoid_planning.scenario import load_scenario
from tests.cli.command import run


def test_a_bundled_name_is_planned_and_a_table_printed():
    done = run("plan", "rabbit-2d-open", "--seed", 1)
    assert done.returncode == 0, done.stderr
    for word in ("solved", "HighwayRoadmap", "length", "clearance", "certified"):
        assert word in done.stdout
    assert "Planning rabbit-2d-open" in done.stderr


def test_json_is_the_result_and_nothing_else(scenario_file):
    done = run("plan", scenario_file(), "--json", "--seed", 3)
    result = json.loads(done.stdout)
    assert (result["status"], result["planner"], result["seed"]) == ("solved", "RRTConnect", 3)
    assert result["path"]["certified"] is True
    assert result["scenario"]["name"] == "two pillars"


@pytest.mark.parametrize("planner", ["PRM", "BITstar"])
def test_json_is_pure_with_planners_that_talk(scenario_file, planner):
    done = run("plan", scenario_file(), "--json", "--planner", planner)
    assert json.loads(done.stdout)["planner"] == planner
    assert "leak" not in done.stderr


def test_all_files_are_written(scenario_file, tmp_path):
    files = [tmp_path / name for name in ("out.json", "out.csv", "out.html")]
    done = run(
        *("plan", scenario_file(), "--seed", 1),
        *("--output", files[0], "--csv", files[1], "--html", files[2]),
    )
    assert done.returncode == 0, done.stderr
    assert sorted(tmp_path.iterdir()) == sorted([*files, tmp_path / "two-pillars.yaml"])
    assert load_result(files[0]).solved
    page = files[2].read_text(encoding="utf-8")
    assert page.startswith("<!DOCTYPE html>")
    assert "two pillars" in page


def test_the_csv_is_the_interpolated_path(scenario_file, tmp_path):
    run(
        "plan",
        scenario_file(),
        "--seed",
        1,
        "--output",
        "r.json",
        "--csv",
        "r.csv",
        folder=tmp_path,
    )
    with (tmp_path / "r.csv").open(encoding="utf-8", newline="") as stream:
        header, *rows = csv.reader(stream)
    assert header == ["travelled", "x", "y", "yaw"]
    values = np.array(rows, dtype=float)
    result = load_result(tmp_path / "r.json")
    assert len(values) > 300
    assert np.all(np.diff(values[:, 0]) >= 0.0)
    assert values[-1, 0] == pytest.approx(result.path.length)
    corners = {tuple(row) for row in values[:, 1:].tolist()}
    assert {tuple(row) for row in result.path.configurations.tolist()} <= corners


@pytest.mark.parametrize("name", ["rabbit-3d-open"])
def test_the_csv_of_a_spatial_path_has_quaternions(name, tmp_path):
    done = run("plan", name, "--csv", tmp_path / "r.csv")
    assert done.returncode == 0, done.stderr
    header = (tmp_path / "r.csv").read_text(encoding="utf-8").splitlines()[0]
    assert header == "travelled,x,y,z,qx,qy,qz,qw"


def test_no_path_is_a_result_too(scenario_file, tmp_path):
    closed = ("semi_axes: [1, 3], position: [0, 4]", "semi_axes: [1, 15], position: [0, 4]")
    done = run(
        *("plan", scenario_file(closed), "--time-limit", 0.3),
        *("--output", tmp_path / "none.json", "--csv", tmp_path / "none.csv"),
    )
    assert done.returncode == 1, done.stderr
    assert "timeout" in done.stdout
    assert load_result(tmp_path / "none.json").path is None
    assert not (tmp_path / "none.csv").exists()
    assert "none.csv was not written" in done.stderr


def test_parameters_reach_the_planner(scenario_file):
    done = run(
        "plan",
        scenario_file(),
        "--json",
        "--no-simplify",
        "--seed",
        1,
        "--set",
        "planner.range=0.5",
        "--set",
        "planner.intermediate_states=false",
    )
    path = np.array(json.loads(done.stdout)["path"]["configurations"])
    assert np.max(np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1)) <= 0.5 + 1e-9


def test_the_same_seed_plans_the_same_path(scenario_file):
    file = scenario_file()
    one, other = (json.loads(run("plan", file, "--json", "--seed", 5).stdout) for _ in range(2))
    assert one["path"] == other["path"]


@pytest.mark.parametrize("checker", ["plugin", "fcl"])
def test_a_path_that_is_not_certified_is_pointed_out(checker, scenario_file):
    done = run("plan", scenario_file(), "--checker", checker, "--seed", 1, "--json")
    assert done.returncode == 0, done.stderr
    certified = json.loads(done.stdout)["path"]["certified"]
    assert ("not certified" in done.stderr) is not certified


def test_an_existing_result_is_replaced(scenario_file, tmp_path):
    target = tmp_path / "result.json"
    target.write_text("old", encoding="utf-8")
    assert run("plan", scenario_file(), "--output", target).returncode == 0
    assert load_result(target).scenario.name == load_scenario(scenario_file()).name
