"""Exceptions that nobody expects have codes of their own, and no traceback unless asked for."""

import os
import resource
import subprocess

import pytest

from planners.cli import faults
from tests.cli.command import COMMAND

PLANNERS = """
from ompl import base as ob


class Raising(ob.Planner):
    def __init__(self, si):
        super().__init__(si, type(self).__name__)

    def solve(self, ptc):
        raise ZeroDivisionError("no way\\nout")


class Short(Raising):
    def solve(self, ptc):
        raise MemoryError


class Failing(Raising):
    error = None

    def solve(self, ptc):
        self.error = "ValueError: the reason"
        return ob.PlannerStatus(ob.PlannerStatus.PlannerStatusType.CRASH)
"""


@pytest.fixture
def planned(tmp_path):
    """Runs `plan` with one of the planners above."""
    (tmp_path / "faulty.py").write_text(PLANNERS, encoding="utf-8")
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])

    def run(planner, *options, **process):
        return subprocess.run(
            [*COMMAND, "plan", "rabbit-2d-open", "--planner", f"faulty:{planner}", *options],
            env={**os.environ, "PYTHONPATH": path},
            capture_output=True,
            text=True,
            check=False,
            **process,
        )

    return run


def errors(done):
    """What is said beside the progress."""
    return [line for line in done.stderr.splitlines() if not line.endswith("...")]


def test_a_fault_is_one_line_that_asks_to_report_it(planned):
    done = planned("Raising")
    (line,) = errors(done)
    assert (done.returncode, done.stdout) == (70, "")
    for words in ("ZeroDivisionError: no way out", "plan rabbit-2d-open", "report", "--debug"):
        assert words in line


def test_the_traceback_is_shown_when_asked_for(planned):
    done = planned("Raising", "--seed", "1", "--debug", "--json")
    assert done.returncode == 70
    assert "Traceback" in done.stderr
    assert 'raise ZeroDivisionError("no way' in done.stderr
    assert "nanobind" not in done.stderr


def test_a_planner_that_fails_is_no_fault_of_the_program(planned):
    done = planned("Failing")
    assert (done.returncode, errors(done)) == (2, ["Error: Failing failed: ValueError: the reason"])


def test_too_little_memory_has_its_own_code(planned):
    done = planned("Short")
    (line,) = errors(done)
    assert done.returncode == 71
    assert "out of memory" in line


def test_a_limit_of_the_address_space_is_named_before_anything_begins(planned):
    limit = 600 << 20

    def limited():
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))

    done = planned("Short", preexec_fn=limited)
    (line,) = errors(done)
    assert (done.returncode, done.stdout) == (71, "")
    assert "ulimit -v) is 600 MB" in line
    assert "Checking" not in done.stderr


@pytest.mark.parametrize(
    ("error", "short"),
    [
        (MemoryError(), True),
        (ImportError("libx.so: failed to map segment from shared object"), True),
        (OSError(12, "Cannot allocate memory"), True),
        (ImportError("No module named 'x'"), False),
        (ValueError("cannot allocate memory"), False),
    ],
)
def test_what_tells_of_too_little_memory(error, short):
    assert faults._is_short_of_memory(error) is short
    wrapped = RuntimeError("while importing")
    wrapped.__cause__ = error
    assert faults._is_short_of_memory(wrapped) is short
