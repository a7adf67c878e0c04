"""The command ``benchmark``: what it leaves, going on after Ctrl-C, and bad input."""

import csv
import json
import os
import signal
import sqlite3
import subprocess
import time
from contextlib import closing
from pathlib import Path

import pytest

from ellipsoid_planning.result import load_result
from tests.cli.command import COMMAND, refused, run

ROOT = Path(__file__).parents[2]
STUBBORN = "tests.benchmark.stubborn_planners"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}


def counts(folder, query="SELECT count(*) FROM runs"):
    with closing(sqlite3.connect(folder / "benchmark.db")) as connection:
        return connection.execute(query).fetchall()


SOLVED = """SELECT e.name, p.name, sum(solved) FROM runs r
    JOIN plannerConfigs p ON p.id = r.plannerid JOIN experiments e ON e.id = r.experimentid
    GROUP BY e.name, p.name"""


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """A finished campaign: its folder and the process."""
    folder = tmp_path_factory.mktemp("campaign")
    done = run(
        "benchmark",
        "rabbit-2d-open",
        *("--family", "turned-gap", "--clearances", "5e-1,2e-1", "--dimension", 2),
        *("--planners", "HighwayRoadmap,RRTConnect", "--runs", 2, "--time-limit", 5),
        *("--output", "out", "--seed", 3, "--jobs", 2),
        folder=folder,
    )
    assert done.returncode == 0, done.stderr
    return folder / "out", done


def test_everything_is_there(campaign):
    folder, done = campaign
    names = {path.name for path in folder.iterdir()}
    assert names == {
        *("campaign.json", "runs", "logs", "benchmark.db", "figures"),
        *("summary.csv", "summary.md", "summary.txt", "runs.csv"),
    }
    assert (folder / "figures" / "turned-gap-2d.png").exists()
    assert counts(folder) == [(18,)]
    assert counts(folder, "SELECT name, clearance FROM experiments ORDER BY clearance")[1:] == [
        ("turned-gap-2d-2e-1", 0.2),
        ("turned-gap-2d-5e-1", 0.5),
    ]
    assert "Note: HighwayRoadmap runs with the plug-in checker only" in done.stderr
    assert "[18/18]" in done.stderr


def test_paths_are_kept_as_results(campaign):
    folder, _ = campaign
    kept = folder / "runs" / "turned-gap-2d-2e-1" / "HighwayRoadmap"
    results = [load_result(kept / number / "RESULT.json") for number in ("000", "001")]
    assert [result.seed for result in results] == [3, 4]
    assert all(result.path.certified for result in results)
    assert results[0].scenario.to_dict() != results[1].scenario.to_dict()


def test_text_markdown_csv_and_database_agree(campaign):
    folder, done = campaign
    table = list(csv.DictReader((folder / "summary.csv").read_text(encoding="utf-8").splitlines()))
    markdown = (folder / "summary.md").read_text(encoding="utf-8")
    assert (folder / "summary.txt").read_text(encoding="utf-8") == done.stdout
    solved = {row[:2]: row[2] for row in counts(folder, SOLVED)}
    lines = [line.strip("| ").split(" | ") for line in markdown.splitlines() if "/2" in line]
    assert len(lines) == len(table) == 9
    for line, entry in zip(lines, table, strict=True):
        assert line[:3] == [entry["problem"], entry["label"], f"{entry['solved']}/{entry['runs']}"]
        in_text = [row.split() for row in done.stdout.splitlines()]
        assert " ".join(line[1:]).split() in in_text
        key = (entry["problem"], f"geometric_{entry['label']}")
        assert solved[key] == int(entry["solved"])


def start(*arguments, folder):
    return subprocess.Popen(
        [*COMMAND, "benchmark", *map(str, arguments)],
        cwd=folder,
        env=ENVIRONMENT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,  # so that Ctrl-C can reach the whole group, as at a terminal
    )


def test_an_interrupted_benchmark_goes_on(scenario_file, tmp_path):
    arguments = (scenario_file(), "--planners", f"RRTConnect,{STUBBORN}:Sleeping")
    arguments += ("--checkers", "plugin", "--runs", 2, "--time-limit", 1.5, "--output", "out")
    process = start(*arguments, folder=tmp_path)
    line = ""
    while "[2/4]" not in line:
        line = process.stderr.readline()
        assert line
    time.sleep(0.3)
    os.killpg(process.pid, signal.SIGINT)
    out, errors = process.communicate(timeout=900)
    assert process.returncode == 130
    assert "Traceback" not in errors
    assert "Sleeping" in out
    finished = counts(tmp_path / "out")[0][0]
    assert 2 <= finished < 4
    records = sorted((tmp_path / "out" / "runs").rglob("record.json"))
    before = {path: path.read_bytes() for path in records}
    assert len(before) == finished
    assert not [path for path in (tmp_path / "out").rglob("*") if path.suffix == ".part"]
    again = start(*arguments, folder=tmp_path)
    _, errors = again.communicate(timeout=900)
    assert again.returncode == 0, errors
    assert f"Going on: {finished} of 4 runs are there already." in errors
    assert counts(tmp_path / "out") == [(4,)]
    assert all(path.read_bytes() == content for path, content in before.items())
    other = run("benchmark", *arguments[:-4], "--output", "out", "--runs", 2, folder=tmp_path)
    assert other.returncode == 2


def test_planners_that_hang_abort_or_lie_are_failures_and_named(tmp_path):
    from tests.benchmark.runs import WALL

    (tmp_path / "wall.yaml").write_text(json.dumps(WALL), encoding="utf-8")
    names = ",".join(f"{STUBBORN}:{name}" for name in ("Hanging", "Aborting", "Lying"))
    process = start(
        *("wall.yaml", "--planners", f"{names},RRTConnect", "--checkers", "plugin"),
        *("--runs", 1, "--time-limit", 0.5, "--output", "out"),
        folder=tmp_path,
    )
    out, errors = process.communicate(timeout=900)
    assert process.returncode == 0, errors
    for words in ("1 hung", "1 crashed", "1 not free", "the path of wall/Lying/000"):
        assert words in out
    outcomes = counts(tmp_path / "out", "SELECT solved, outcome FROM runs ORDER BY id")
    assert outcomes == [(0, "hung"), (0, "crashed"), (0, "not free"), (1, "solved")]


BAD = {
    "unknown planner": (("--planners", "RTRConnect"), ("RTRConnect", "RRTConnect?")),
    "unknown checker": (("--checkers", "bullet"), ("--checkers", "bullet")),
    "no planners": (("--planners", ","), ("--planners",)),
    "plug-in planner with FCL alone": (
        ("--planners", "HighwayRoadmap", "--checkers", "fcl"),
        ("HighwayRoadmap works with the plug-in checker only",),
    ),
    "no runs": (("--runs", "0"), ("--runs",)),
    "no time": (("--time-limit", "0"), ("--time-limit",)),
    "no memory": (("--memory-limit", "-1"), ("--memory-limit",)),
    "negative seed": (("--seed", "-1"), ("--seed",)),
    "no jobs": (("--jobs", "0"), ("--jobs",)),
    "unknown family": (("--family", "gpa"), ("gpa",)),
    "wrong dimension": (("--family", "window-3d", "--dimension", "2"), ("window-3d",)),
    "zero clearance": (("--family", "gap", "--clearances", "0"), ("--clearances",)),
    "large clearance": (("--family", "gap", "--clearances", "5"), ("clearance",)),
    "dimension without family": (("--dimension", "3"), ("--family",)),
    "jobs on a cluster": (("--cluster", "tcp://127.0.0.1:9", "--jobs", "2"), ("--jobs",)),
    "unknown scenario": (("rabbit-2d-opne",), ("did you mean rabbit-2d-open",)),
    "missing folder": (("--output", "no/such"), ("does not exist",)),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input(case, tmp_path):
    options, words = BAD[case]
    done = run("benchmark", "rabbit-2d-open", *options, folder=tmp_path)
    assert refused(done, *words)
    assert not list(tmp_path.iterdir())


def test_nothing_to_plan_and_folders_of_others(tmp_path):
    assert refused(run("benchmark", folder=tmp_path), "SCENARIO", "--family")
    (tmp_path / "notes.txt").write_text("mine", encoding="utf-8")
    done = run("benchmark", "rabbit-2d-open", "--output", ".", folder=tmp_path)
    assert refused(done, "holds other files")
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]


def test_an_unreachable_cluster(tmp_path):
    pytest.importorskip("distributed")
    done = run("benchmark", "rabbit-2d-open", "--cluster", "tcp://127.0.0.1:9", folder=tmp_path)
    assert refused(done, "--cluster", "no Dask scheduler can be reached there")
    assert not list(tmp_path.iterdir())


def test_a_missing_extra_is_named(tmp_path):
    (tmp_path / "hidden").mkdir()
    (tmp_path / "hidden" / "distributed.py").write_text("raise ImportError", encoding="utf-8")
    done = subprocess.run(
        [*COMMAND, "benchmark", "rabbit-2d-open", "--cluster", "local"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path / "hidden")},
        capture_output=True,
        text=True,
        check=False,
    )
    assert refused(done, "dask.distributed", "ellipsoid-planning[cluster]")
