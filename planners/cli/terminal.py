"""What the user sees besides results: messages and progress, all on stderr."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

WIDTH = 200
"""Of tables for files and pipes [characters]."""


def say(message: str) -> None:
    """Write a line to stderr, neither wrapped nor coloured, so that it can be searched for.

    What nobody can be told, since stderr is full or closed, is no reason to end.
    """
    with suppress(OSError, ValueError):
        sys.stderr.write(f"{message}\n")
        sys.stderr.flush()


def result_console() -> Console:
    """A rich console on stdout, for the tables of results."""
    from rich.console import Console

    return Console(emoji=False)


def wide_console() -> Console:
    """As `result_console`, for wide tables: nothing is folded for a file or a pipe."""
    from rich.console import Console

    return Console(emoji=False, width=None if sys.stdout.isatty() else WIDTH)


@contextmanager
def working(message: str) -> Iterator[None]:
    """Tell on stderr that something goes on inside the block.

    A terminal shows a spinner that vanishes; anything else gets the message as a line.
    """
    if not sys.stderr.isatty():
        say(f"{message} ...")
        yield
        return
    from rich.console import Console
    from rich.markup import escape

    with Console(stderr=True, emoji=False).status(escape(message)):
        yield


@contextmanager
def stages(message: str) -> Iterator[Callable[[str], None]]:
    """As `working`, with a function that replaces the message; only a terminal shows those."""
    if not sys.stderr.isatty():
        say(f"{message} ...")
        yield lambda _: None
        return
    from rich.console import Console
    from rich.markup import escape

    with Console(stderr=True, emoji=False).status(escape(message)) as status:
        yield lambda message: status.update(escape(message))
