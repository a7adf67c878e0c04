"""Ctrl-C and its like: the command ends at once, and leaves nothing half done.

What a batch system (SIGTERM) or a terminal that is closed (SIGHUP) sends does what Ctrl-C does;
the exit code is the shell's for the signal.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ellipsoid_planning.atomic import partial_path

INTERRUPTED = 130
_ENDINGS = {
    signal.SIGINT: "Interrupted.",
    signal.SIGTERM: "Terminated.",
    signal.SIGHUP: "Hung up.",
}
_SHOW_CURSOR = b"\r\x1b[K\x1b[?25h"

_unfinished: list[Path] = []


class Interruption(threading.Event):
    """Whether a signal has asked this process to end, and which."""

    def __init__(self) -> None:
        super().__init__()
        self.signal: signal.Signals = signal.SIGINT

    @property
    def exit_code(self) -> int:
        """The exit code that tells of the signal."""
        return _exit_code(self.signal)

    @property
    def message(self) -> str:
        """What is said about it, one sentence."""
        return _ENDINGS[self.signal]


def end_on_interrupt() -> None:
    """Let Ctrl-C end this process from now on, wherever it is.

    Python's own way, an exception, gets lost in the callbacks of compilers and planners: there
    it is printed and forgotten, or it aborts the process. While a planner solves, `solve.plan`
    puts a handler of its own in place of the one for Ctrl-C, stops the planner, and raises
    KeyboardInterrupt once it has returned.
    """
    for number in _heeded():
        signal.signal(number, _end)


@contextmanager
def noted_interrupts(*, twice_ends: bool = False) -> Iterator[Interruption]:
    """Let Ctrl-C inside the block only be noted: what is running is ended, what is finished kept.

    Args:
        twice_ends: whether a second one ends the process at once, as without this.
    """
    interruption = Interruption()

    def note(number: int, _: object) -> None:
        if twice_ends and interruption.is_set():
            _end(number)
        interruption.signal = signal.Signals(number)
        interruption.set()

    before = {number: signal.signal(number, note) for number in _heeded()}
    try:
        yield interruption
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def clean_up(outputs: list[Path]) -> None:
    """Remember output files of which no half-written remainder may stay."""
    _unfinished.extend(partial_path(output) for output in outputs)


def _heeded() -> list[signal.Signals]:
    # Under nohup, SIGHUP is ignored, and must be.
    return [
        number
        for number in _ENDINGS
        if number is not signal.SIGHUP or signal.getsignal(number) is not signal.SIG_IGN
    ]


def _exit_code(number: int) -> int:
    return 128 + number


def _end(number: int = signal.SIGINT, _: object = None) -> None:
    for remainder in _unfinished:
        remainder.unlink(missing_ok=True)
    # No streams here: the signal may have come while one of them was being written to.
    message = f"{_ENDINGS[signal.Signals(number)]}\n".encode()
    try:
        os.write(2, (_SHOW_CURSOR if os.isatty(2) else b"") + message)
    finally:
        os._exit(_exit_code(number))
