"""OMPL's logs, merged, and its database, made by its own reader."""

import sqlite3
import subprocess
import sys
from contextlib import closing
from dataclasses import replace

import pytest

from ellipsoid_planning.errors import EllipsoidPlanningError
from planners.benchmark.database import write_database
from planners.benchmark.merge import merged_log
from planners.benchmark.ompl_log import format_log, parse_log
from planners.benchmark.watch import run_one
from tests.benchmark.runs import record, task


@pytest.fixture(scope="module")
def measured():
    return [run_one(task(name, label=f"{name} (plugin)")) for name in ("HighwayRoadmap", "PRM")]


def test_what_is_read_is_written_again(measured):
    for run in measured:
        assert format_log(parse_log(run.log)) == run.log


def test_a_broken_log_is_refused(measured):
    text = measured[0].log
    for broken in (text[: len(text) // 2], text.replace("Running on", "Run on"), ""):
        with pytest.raises(EllipsoidPlanningError):
            parse_log(broken)


def merged(records):
    return merged_log(
        records,
        runs=2,
        time_limit=5.0,
        memory_limit=100.0,
        parameters={"clearance REAL": "0.1"},
    )


def rows(database, query):
    with closing(sqlite3.connect(database)) as connection:
        return connection.execute(query).fetchall()


def test_the_database_is_ompls(measured, tmp_path):
    lost = record("RRT", status="hung", seconds=5.5, reason="it hung; and more")
    records = [*measured, replace(measured[1], run=1, seed=2), lost]
    log = tmp_path / "wall.log"
    log.write_text(merged(records), encoding="utf-8")
    write_database(tmp_path / "wall.db", [log])
    experiments = rows(
        tmp_path / "wall.db", "SELECT name, timelimit, runcount, clearance FROM experiments"
    )
    assert experiments == [("wall", 5.0, 2, 0.1)]
    runs = rows(
        tmp_path / "wall.db",
        "SELECT p.name, solved, certified, verified, seed, outcome, proved_clearance > 0"
        " FROM runs r JOIN plannerConfigs p ON p.id = r.plannerid ORDER BY r.id",
    )
    assert runs == [
        ("geometric_HighwayRoadmap (plugin)", 1, 1, 1, 1, "solved", 1),
        ("geometric_PRM (plugin)", 1, 1, 1, 1, "solved", 1),
        ("geometric_PRM (plugin)", 1, 1, 1, 1, "solved", 1),
        ("geometric_RRT", 0, 0, 0, 1, "hung", None),
    ]
    assert rows(tmp_path / "wall.db", "SELECT count(*) FROM bestPlannerConfigs") == [(3,)]
    assert not list(tmp_path.glob(".*"))


def test_ompls_statistics_script_reads_the_log(measured, tmp_path):
    log = tmp_path / "wall.log"
    log.write_text(merged(measured), encoding="utf-8")
    command = [sys.executable, "-m", "ompl.ompl_benchmark_statistics", log, "-d", "own.db"]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    assert rows(tmp_path / "own.db", "SELECT count(*) FROM runs") == [(2,)]


def test_a_problem_without_any_log_has_a_database_too(tmp_path):
    log = tmp_path / "wall.log"
    log.write_text(merged([record(status="crashed", seconds=1.0)]), encoding="utf-8")
    write_database(tmp_path / "wall.db", [log])
    assert rows(tmp_path / "wall.db", "SELECT solved, status, time FROM runs") == [(0, 7, 1.0)]


def test_a_database_that_cannot_be_written(tmp_path):
    log = tmp_path / "wall.log"
    log.write_text(merged([record(status="crashed", seconds=1.0)]), encoding="utf-8")
    with pytest.raises(EllipsoidPlanningError, match="cannot write"):
        write_database(tmp_path / "missing" / "wall.db", [log])
