"""A benchmark that is killed leaves nothing behind: no process, and no file for long."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from ellipsoid_planning import processes as our_processes
from tests.cli.command import COMMAND

STUBBORN = "tests.benchmark.stubborn_planners"
PATIENCE = 300
"""By then a process that is left over would be found out; an idle machine needs no second [s]."""


def processes(word):
    """The numbers of all processes whose command line has a word."""
    command = [shutil.which("ps"), "-ww", "-eo", "pid=,args="]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return [line.split()[0] for line in listed.splitlines() if word in line]


def eventually(holds):
    """Whether something holds before all patience is gone."""
    end = time.monotonic() + PATIENCE
    while not holds() and time.monotonic() < end:
        time.sleep(0.05)
    return holds()


@pytest.fixture
def hanging(scenario_file, tmp_path):
    """Starts a benchmark whose first run hangs; its runs have their folders in ``temporary``."""
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    arguments = ("benchmark", scenario_file(), "--checkers", "plugin", "--runs", "1")
    arguments += ("--planners", f"{STUBBORN}:Hanging", "--time-limit", str(PATIENCE))
    started = []

    def start():
        root = os.pathsep.join([str(Path.cwd()), os.environ.get("PYTHONPATH", "")])
        process = subprocess.Popen(
            [*COMMAND, *map(str, arguments), "--output", "out"],
            cwd=tmp_path,
            env={**os.environ, "TMPDIR": str(temporary), "PYTHONPATH": root},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        started.append(process)
        return process

    yield start, temporary
    for process in started:
        process.kill()
        process.wait()
        process.stderr.close()


def planning(temporary):
    return any(file.read_text() == "planning" for file in temporary.glob("*/phase"))


@pytest.mark.skipif(sys.platform != "linux", reason="a planner that hangs in C++ outlives it there")
def test_children_end_with_their_parent_and_the_next_run_tidies_up(hanging, tmp_path):
    start, temporary = hanging
    killed = start()
    assert eventually(lambda: planning(temporary))
    assert processes(str(temporary))
    killed.kill()
    assert killed.wait() == -signal.SIGKILL
    assert eventually(lambda: not processes(str(temporary)))
    (left,) = temporary.iterdir()
    partial = tmp_path / "out" / f".campaign.json.{killed.pid}.part"
    partial.touch()
    again = start()
    assert eventually(lambda: not left.exists() and planning(temporary))
    assert not partial.exists()
    again.send_signal(signal.SIGTERM)
    _, errors = again.communicate(timeout=PATIENCE)
    assert again.returncode == 143
    assert "Terminated. The finished runs are kept" in errors
    assert "Traceback" not in errors
    assert eventually(lambda: not processes(str(temporary)))
    assert list(temporary.iterdir()) == []


def test_a_child_whose_parent_is_gone_ends_at_once(tmp_path):
    command = [sys.executable, "-m", "planners.benchmark.child", str(tmp_path), "1", "0"]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, check=False)
    assert done.returncode == -signal.SIGKILL


def test_elsewhere_a_pipe_tells_of_the_end(monkeypatch):
    ended = []
    monkeypatch.setattr(our_processes.sys, "platform", "another")
    monkeypatch.setattr(our_processes, "_end", lambda: ended.append(True))
    reading, writing = os.pipe()
    our_processes.end_with(os.getppid(), reading)
    assert ended == []
    os.close(writing)
    assert eventually(lambda: ended == [True])
    os.close(reading)
