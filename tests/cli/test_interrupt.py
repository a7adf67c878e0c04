"""Ctrl-C: exit 130, cleanly, under every planner, with no half file."""

import signal
import subprocess
import time

import pytest

from planners.registry import planner_names
from tests.cli.command import COMMAND

WALL = ("semi_axes: [1, 3], position: [0, 4]", "semi_axes: [1, 15], position: [0, 4]")


def interrupted(arguments, folder, wait_for, delay):
    """Run, send SIGINT a while after a line on stderr, and return (code, stdout, stderr, wait)."""
    process = subprocess.Popen(
        [*COMMAND, *map(str, arguments)],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    seen = ""
    try:
        while wait_for not in seen:
            line = process.stderr.readline()
            assert line, seen
            seen += line
        time.sleep(delay)
        process.send_signal(signal.SIGINT)
        began = time.perf_counter()
        out, errors = process.communicate(timeout=30)
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
        process.stderr.close()
    return process.returncode, out, seen + errors, time.perf_counter() - began


@pytest.mark.parametrize("planner", planner_names())
def test_every_planner_stops_cleanly(planner, scenario_file, tmp_path):
    file = scenario_file(WALL)
    arguments = ("plan", file, "--planner", planner, "--time-limit", 60, "--json")
    arguments += ("--output", "out.json", "--csv", "out.csv", "--html", "out.html")
    code, out, errors, seconds = interrupted(arguments, tmp_path, "Planning", 0.7)
    assert (code, out) == (130, ""), errors
    assert "Interrupted." in errors
    assert "Traceback" not in errors
    assert seconds < 5.0
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("delay", [0.0, 0.02, 0.05, 0.1, 0.2, 0.4])
def test_it_does_not_matter_when(delay, scenario_file, tmp_path):
    file = scenario_file(WALL)
    arguments = ("plan", file, "--planner", "PRM", "--time-limit", 60, "--output", "out.json")
    code, out, errors, _ = interrupted(arguments, tmp_path, "Checking", delay)
    assert (code, out) == (130, ""), errors
    assert "Traceback" not in errors
    assert list(tmp_path.iterdir()) == [file]
