"""What no command expects: faults of this program, and too little memory."""

from __future__ import annotations

import errno
import os
import resource
import sys
import traceback
from collections.abc import Iterator
from contextlib import suppress
from typing import NoReturn

from ellipsoid_planning import __version__
from planners.cli.terminal import say

FAULT = 70
"""The exit code of an exception that nobody expected; sysexits.h calls it EX_SOFTWARE."""
OUT_OF_MEMORY = 71
"""The exit code when the system gives too little memory; sysexits.h calls it EX_OSERR."""

DEBUG = "--debug"
NEEDED = 1_100 << 20
"""Address space that compiling needs [bytes]: for an arm 1,015 MB were taken, on two cores."""

_UNMAPPED = ("failed to map segment", "cannot allocate memory", "libllvmlite")
"""How the loader of libraries says that memory is short."""

_tracebacks: list[bool] = []


def show_tracebacks() -> None:
    """Let every error show where it came from, from now on."""
    _tracebacks.append(True)


def show_traceback(error: BaseException) -> None:
    """Write an exception's traceback to stderr, if that was asked for."""
    if _tracebacks:
        say("".join(traceback.format_exception(error)).rstrip())


def leave(error: Exception, command: str) -> NoReturn:
    """End the process because of an exception that nobody expected.

    Args:
        error: what was raised.
        command: what the user gave, for the message.
    """
    show_traceback(error)
    if _is_short_of_memory(error):
        say(f"Error: out of memory{_limit()}; give more, or plan something smaller")
        code = OUT_OF_MEMORY
    else:
        reason = " ".join(str(error).split())[:500]
        what = f"{type(error).__name__}: {reason}" if reason else type(error).__name__
        remedy = "" if _tracebacks else f"; run it again with {DEBUG} to see where it happens"
        say(
            f"Error: unexpected {what} in `{command}` (ellipsoid-planning {__version__}). "
            f"This is a fault of the program: please report it{remedy}"
        )
        code = FAULT
    with suppress(OSError, ValueError):
        sys.stdout.flush()
    # The traceback's frames hold planners; taken apart at exit, OMPL's bindings tell of leaks.
    os._exit(code)


def check_address_space() -> None:
    """Check that a limit of the address space (``ulimit -v``) leaves room for compiling.

    Without room, the compiler ends the process by itself, which cannot be caught.

    Raises:
        MemoryError: it does not.
    """
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    if limit != resource.RLIM_INFINITY and limit < NEEDED:
        raise MemoryError


def _limit() -> str:
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    if limit == resource.RLIM_INFINITY:
        return ""
    return (
        f": the limit of the address space (ulimit -v) is {limit >> 20} MB, "
        f"this command needs about {NEEDED >> 20} MB"
    )


def _is_short_of_memory(error: BaseException) -> bool:
    return any(
        isinstance(cause, MemoryError)
        or getattr(cause, "errno", None) == errno.ENOMEM
        or (isinstance(cause, (ImportError, OSError)) and _tells_of_memory(str(cause)))
        for cause in _causes(error)
    )


def _tells_of_memory(text: str) -> bool:
    return any(words in text.lower() for words in _UNMAPPED)


def _causes(error: BaseException | None) -> Iterator[BaseException]:
    while error is not None:
        yield error
        error = error.__cause__ or error.__context__
