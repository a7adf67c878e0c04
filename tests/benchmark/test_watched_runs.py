"""One run in its own process: OMPL's log, a verified path, and whatever a planner may do."""

import json
import shutil
import subprocess
import tempfile

import pytest

from ellipsoid_planning.result import PlanResult
from planners.benchmark.run import RunRecord
from planners.benchmark.watch import StoppedError, run_one
from planners.verify import verify_result
from tests.benchmark.runs import stubborn, task


def test_a_run_is_measured_by_ompl_and_verified():
    record = run_one(task())
    assert (record.status, record.reason) == ("solved", "")
    assert record.certified
    assert record.verified
    assert record.seconds > 0.0
    assert record.clearance >= record.proved_clearance > 0.0
    assert record.statistics["edges_certified"] > 0
    for line in ("Experiment wall", "geometric_HighwayRoadmap", "certified BOOLEAN"):
        assert line in record.log.splitlines()
    result = PlanResult.from_dict(record.result)
    assert result.path.length == record.length
    assert verify_result(result).passed
    assert RunRecord(**json.loads(json.dumps(record.to_dict()))) == record


def test_seeds_make_runs_repeat():
    for planner in ("HighwayRoadmap", "RRTConnect"):
        first, second = (run_one(task(planner, seed=7)) for _ in range(2))
        assert first.result["path"] == second.result["path"]
        assert first.statistics == second.statistics


MISBEHAVIOUR = {
    "Hanging": ("hung", "ignored its time limit"),
    "Aborting": ("crashed", "ended by SIGABRT while planning"),
    "Raising": ("crashed", "no way out"),
    "Hoarding": ("out of memory", "the limit is 60 MB"),
    "Leaving": ("crashed", "ended with exit code 3"),
    "Quitting": ("crashed", "ended with exit code 0 while planning"),
    "Lying": ("not free", "obstacles: part 'hull' hits obstacle 'wall'"),
    "Sleeping": ("timeout", "no path within 0.4 s"),
}


@pytest.mark.parametrize("name", MISBEHAVIOUR)
def test_whatever_a_planner_does_is_recorded(name):
    status, reason = MISBEHAVIOUR[name]
    # Those that would go on for ever are short of time; the others end by themselves.
    time_limit = 0.4 if name in ("Hanging", "Sleeping") else 300.0
    record = run_one(stubborn(name, time_limit=time_limit, memory_limit=60.0))
    assert record.status == status
    assert reason in record.reason
    assert not record.solved
    if name == "Hanging":
        assert record.seconds > 0.4


def test_a_stopped_run_leaves_no_process(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    seen = []

    def stopped():
        seen.append(str(tmp_path) in processes())
        return len(seen) > 5

    with pytest.raises(StoppedError):
        run_one(stubborn("Hanging", time_limit=60.0), stopped)
    assert any(seen)
    assert str(tmp_path) not in processes()
    assert not list(tmp_path.iterdir())


def processes():
    """The command lines of all processes."""
    command = [shutil.which("ps"), "-ww", "-eo", "args"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout
