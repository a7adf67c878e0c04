"""Who wants to know that kernels are being compiled; it imports nothing heavy.

`kernels.compile` reports here, whatever asked for the kernels; a user interface listens.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

Listener = Callable[[bool, int, int], None]
"""Takes whether a compilation goes on, how many functions are compiled, and of how many at most."""

_listeners: list[Listener] = []


@contextmanager
def listening(listener: Listener) -> Iterator[None]:
    """Let ``listener`` be told inside the block of every function whose compilation begins or ends.

    Functions that come from the cache on disk are not compiled, and nothing is said of them.
    """
    _listeners.append(listener)
    try:
        yield
    finally:
        _listeners.remove(listener)


def report(going_on: bool, done: int, most: int) -> None:
    """Tell all listeners."""
    for listener in tuple(_listeners):
        listener(going_on, done, most)
