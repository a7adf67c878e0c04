"""One run in a process of its own, watched: time, memory and how it ends."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ellipsoid_planning.leftovers import run_folder
from planners.benchmark.limits import (
    CHECKING,
    MEMORY_GRACE,
    OUTPUT,
    PHASE,
    PLANNING,
    RECORD,
    STARTING,
    TASK,
    phase_limit,
)
from planners.benchmark.memory import resident_memory
from planners.benchmark.run import CRASHED, HUNG, OUT_OF_MEMORY, RunRecord, RunTask

CHILD = "planners.benchmark.child"
_LOOK_EVERY = 0.02  # [s]


class StoppedError(Exception):
    """A run was given up because the campaign was interrupted."""


def never() -> bool:
    """Nobody interrupts."""
    return False


def run_one(task: RunTask, stopped: Callable[[], bool] = never) -> RunRecord:
    """Run ``task`` in a new process and wait for it; whatever happens to it, there is a record.

    Args:
        task: what to run.
        stopped: asked all the time; once it says True the process is killed.

    Raises:
        StoppedError: it was stopped.
    """
    with run_folder() as folder, _pipe() as pipe:
        (folder / TASK).write_text(json.dumps(task.to_dict()), encoding="utf-8")
        with (folder / OUTPUT).open("wb") as output:
            process = _started(folder, output.fileno(), pipe)
            try:
                return _Watch(task, folder, process).record(stopped)
            finally:
                _kill(process)


@contextmanager
def _pipe() -> Iterator[int]:
    """The reading end of a pipe that ends with this process; nothing is written to it."""
    reading, writing = os.pipe()
    try:
        yield reading
    finally:
        os.close(reading)
        os.close(writing)


def _started(folder: Path, output: int, pipe: int) -> subprocess.Popen[bytes]:
    paths = [path or os.getcwd() for path in sys.path]  # noqa: PTH109
    return subprocess.Popen(  # noqa: S603  our own module
        [sys.executable, "-m", CHILD, str(folder), str(os.getpid()), str(pipe)],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)},
        stdin=subprocess.DEVNULL,
        stdout=output,
        stderr=output,
        pass_fds=(pipe,),
        start_new_session=True,  # Ctrl-C is for the parent, which then ends its runs
    )


def _kill(process: subprocess.Popen[bytes]) -> None:
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


class _Watch:
    """What is known about a running process."""

    def __init__(self, task: RunTask, folder: Path, process: subprocess.Popen[bytes]) -> None:
        self.task, self.folder, self.process = task, folder, process
        self.phase, self.since = STARTING, time.monotonic()
        self.planned = 0.0  # [s]
        self.memory = 0.0  # when planning began [MB]

    def record(self, stopped: Callable[[], bool]) -> RunRecord:
        """Wait for the end, or bring it about."""
        while True:
            try:
                self.process.wait(_LOOK_EVERY)
                return self._ended()
            except subprocess.TimeoutExpired:
                pass
            if stopped():
                raise StoppedError
            self._look()
            excess = self._excess()
            if excess is not None:
                return excess

    def _look(self) -> None:
        try:
            phase = (self.folder / PHASE).read_text(encoding="utf-8")
        except OSError:
            return
        if phase == self.phase:
            return
        now = time.monotonic()
        if self.phase == PLANNING:
            self.planned = now - self.since
        self.phase, self.since = phase, now
        if phase == PLANNING:
            self.memory = resident_memory(self.process.pid) or 0.0

    def _excess(self) -> RunRecord | None:
        """The record of a process that has taken too much time or memory, None for a good one."""
        seconds = time.monotonic() - self.since
        if seconds > phase_limit(self.task, self.phase):
            return self._failure(HUNG, _OVERDUE[self.phase].format(seconds))
        if self.phase != PLANNING:
            return None
        taken = (resident_memory(self.process.pid) or 0.0) - self.memory
        if taken > MEMORY_GRACE * self.task.memory_limit:
            reason = f"killed at {taken:.0f} MB, the limit is {self.task.memory_limit:g} MB"
            return self._failure(OUT_OF_MEMORY, reason, memory=taken)
        return None

    def _ended(self) -> RunRecord:
        code = self.process.returncode
        # A planner may end the process with code 0 as well; then there is no record.
        if code == 0 and (self.folder / RECORD).exists():
            text = (self.folder / RECORD).read_text(encoding="utf-8")
            record = RunRecord(**json.loads(text))
            return record if record.log is not None else self._failure(CRASHED, record.reason)
        return self._failure(CRASHED, f"{_ending(code)} while {self._doing()}{self._last_words()}")

    def _failure(self, status: str, reason: str, memory: float | None = None) -> RunRecord:
        self._look()
        seconds = time.monotonic() - self.since if self.phase == PLANNING else self.planned
        return RunRecord.of(self.task, status, reason=reason, seconds=seconds, memory=memory)

    def _doing(self) -> str:
        self._look()
        return {CHECKING: "checking its path"}.get(self.phase, self.phase)

    def _last_words(self) -> str:
        text = (self.folder / OUTPUT).read_text(encoding="utf-8", errors="replace").strip()
        return f": {text.splitlines()[-1][:200]}" if text else ""


_OVERDUE = {
    STARTING: "killed after {:.0f} s of getting ready",
    PLANNING: "killed after {:.1f} s, it ignored its time limit",
    CHECKING: "killed after {:.0f} s of checking its path",
}


def _ending(code: int) -> str:
    if code >= 0:
        return f"ended with exit code {code}"
    try:
        return f"ended by {signal.Signals(-code).name}"
    except ValueError:
        return f"ended by signal {-code}"
