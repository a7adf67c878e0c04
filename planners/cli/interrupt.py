"""Ctrl-C: the command ends at once with 130, and leaves nothing half done."""

from __future__ import annotations

import os
import signal
import threading
from pathlib import Path

from ellipsoid_planning.atomic import partial_path

INTERRUPTED = 130
_MESSAGE = b"Interrupted.\n"
_SHOW_CURSOR = b"\r\x1b[K\x1b[?25h"

_unfinished: list[Path] = []


def end_on_interrupt() -> None:
    """Let Ctrl-C end this process from now on, wherever it is.

    Python's own way, an exception, gets lost in the callbacks of compilers and planners: there
    it is printed and forgotten, or it aborts the process. While a planner solves, `solve.plan`
    puts a handler of its own in place of this one, stops the planner, and raises
    KeyboardInterrupt once it has returned.
    """
    signal.signal(signal.SIGINT, _end)


def note_interrupts(*, twice_ends: bool = False) -> threading.Event:
    """Let Ctrl-C from now on only be noted; what is running is ended, what is finished written.

    Args:
        twice_ends: whether a second one ends the process at once, as without this.
    """
    interrupted = threading.Event()

    def note(*_: object) -> None:
        if twice_ends and interrupted.is_set():
            _end()
        interrupted.set()

    signal.signal(signal.SIGINT, note)
    return interrupted


def clean_up(outputs: list[Path]) -> None:
    """Remember output files of which no half-written remainder may stay."""
    _unfinished.extend(partial_path(output) for output in outputs)


def _end(*_: object) -> None:
    for remainder in _unfinished:
        remainder.unlink(missing_ok=True)
    # No streams here: the signal may have come while one of them was being written to.
    os.write(2, (_SHOW_CURSOR if os.isatty(2) else b"") + _MESSAGE)
    os._exit(INTERRUPTED)
