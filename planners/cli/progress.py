"""Progress of long work on stderr: a bar for a terminal, a line now and then for the rest."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from planners.cli.terminal import say

LINE_EVERY = 5.0  # [s]


@contextmanager
def bar(total: int, done: int) -> Iterator[Callable[[str | None, int], None]]:
    """A bar on a terminal; the function that it gives takes a text or None, and a step."""
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    columns = (
        BarColumn(bar_width=24),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        TextColumn("{task.description}", markup=False),
    )
    # The steps differ by orders of magnitude: all that have ended count for the time left.
    with Progress(*columns, console=Console(stderr=True), speed_estimate_period=1e9) as shown:
        row = shown.add_task("", total=total, completed=done)
        yield lambda text, step: shown.update(row, description=text, advance=step)


@contextmanager
def progress(title: str, total: int) -> Iterator[Callable[[str | None, int], None]]:
    """As `bar`, with a title; not on a terminal, lines that say how many of ``total`` are done."""
    if sys.stderr.isatty():
        with bar(total, 0) as update:
            update(title, 0)
            yield lambda text, step: update(None if text is None else f"{title}: {text}", step)
        return
    say(f"{title} ...")
    lines = _Lines(title, total)
    yield lines.update


class _Lines:
    """A line every few seconds."""

    def __init__(self, title: str, total: int) -> None:
        self._title, self._total = title, total
        self._done, self._said = 0, time.monotonic()

    def update(self, text: str | None, step: int) -> None:
        self._done += step
        now = time.monotonic()
        if now - self._said < LINE_EVERY:
            return
        self._said = now
        say(f"[{self._done}/{self._total}] {self._title}{'' if text is None else f': {text}'}")
