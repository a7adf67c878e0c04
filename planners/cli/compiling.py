"""Compilation is announced, whatever command sets it off, and its progress shown."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from ellipsoid_planning.compilation import listening
from planners.cli.terminal import say

EVERY = 5.0  # [s]


@contextmanager
def telling_of_compilation() -> Iterator[None]:
    """Say on stderr inside the block that kernels are compiled, and every few seconds how many."""
    teller = _Teller()
    try:
        with listening(teller.note):
            yield
    finally:
        teller.close()


class _Teller:
    """A first line, then one every few seconds for as long as a compilation goes on."""

    def __init__(self) -> None:
        self._going_on, self._done, self._most = False, 0, 0
        self._began: float | None = None
        self._closed = threading.Event()

    def note(self, going_on: bool, done: int, most: int) -> None:
        """Take what `ellipsoid_planning.compilation` reports."""
        self._going_on, self._done, self._most = going_on, done, most
        if self._began is None:
            self._began = time.monotonic()
            say("Compiling the kernels for this machine, once; it takes a minute or so.")
            threading.Thread(target=self._tell, daemon=True).start()

    def close(self) -> None:
        """Say no more."""
        self._closed.set()

    def _tell(self) -> None:
        while not self._closed.wait(EVERY):
            if self._going_on and self._began is not None:
                seconds = time.monotonic() - self._began
                say(f"[{self._done} of at most {self._most} functions compiled, {seconds:.0f} s]")
