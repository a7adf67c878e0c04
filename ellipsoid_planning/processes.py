"""Processes that we start end with the one that started them, however that ends."""

from __future__ import annotations

import os
import signal
import sys
import threading

_PR_SET_PDEATHSIG = 1


def end_with(parent: int, pipe: int | None = None) -> None:
    """Let the system end this process when the one that started it has ended.

    Linux does so by itself, even if this process never comes back to Python. Elsewhere a thread
    waits for the end of a pipe that only the parent writes to, and never does.

    Args:
        parent: the process that started this one; it may have ended already.
        pipe: the reading end, None to do without where the system cannot do it.
    """
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    elif pipe is not None:
        threading.Thread(target=_end_at_end_of, args=(pipe,), daemon=True).start()
    if os.getppid() != parent:
        _end()


def _end_at_end_of(pipe: int) -> None:
    while os.read(pipe, 1):
        pass
    _end()


def _end() -> None:
    os.kill(os.getpid(), signal.SIGKILL)
