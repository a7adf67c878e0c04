"""Ctrl-C: exit 130, cleanly, under every planner, with no half file."""

import signal
import subprocess
import time

import pytest

from planners.registry import planner_names
from tests.cli.command import COMMAND

WALL = ("semi_axes: [1, 3], position: [0, 4]", "semi_axes: [1, 15], position: [0, 4]")


def interrupted(arguments, folder, wait_for, delay, how=signal.SIGINT):
    """Run, send a signal a while after a line on stderr, and return (code, stdout, stderr)."""
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
        process.send_signal(how)
        out, errors = process.communicate(timeout=LONGEST)
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
        process.stderr.close()
    return process.returncode, out, seen + errors


# By then a planner that goes on would be found out; an idle machine needs a second [s].
LONGEST = 300


@pytest.mark.parametrize("planner", planner_names())
def test_every_planner_stops_cleanly(planner, scenario_file, tmp_path):
    file = scenario_file(WALL)
    arguments = ("plan", file, "--planner", planner, "--time-limit", 10 * LONGEST, "--json")
    arguments += ("--output", "out.json", "--csv", "out.csv", "--html", "out.html")
    code, out, errors = interrupted(arguments, tmp_path, "Planning", 0.7)
    assert (code, out) == (130, ""), errors
    assert "Interrupted." in errors
    assert "Traceback" not in errors
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("delay", [0.0, 0.02, 0.05, 0.1, 0.2, 0.4])
def test_it_does_not_matter_when(delay, scenario_file, tmp_path):
    file = scenario_file(WALL)
    arguments = (
        "plan",
        file,
        "--planner",
        "PRM",
        "--time-limit",
        10 * LONGEST,
        "--output",
        "out.json",
    )
    code, out, errors = interrupted(arguments, tmp_path, "Checking", delay)
    assert (code, out) == (130, ""), errors
    assert "Traceback" not in errors
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize(
    ("how", "code", "word"),
    [(signal.SIGTERM, 143, "Terminated."), (signal.SIGHUP, 129, "Hung up.")],
)
@pytest.mark.parametrize("planner", ["HighwayRoadmap", "PRM"])
def test_what_batch_systems_and_terminals_send_does_the_same(
    planner, how, code, word, scenario_file, tmp_path
):
    file = scenario_file(WALL)
    arguments = ("plan", file, "--planner", planner, "--time-limit", 10 * LONGEST)
    arguments += ("--output", "out.json")
    found, out, errors = interrupted(arguments, tmp_path, "Planning", 0.3, how)
    assert (found, out) == (code, ""), errors
    assert errors.splitlines()[-1] == word
    assert list(tmp_path.iterdir()) == [file]
