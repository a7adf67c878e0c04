"""Files that are written completely or not at all."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterable
from pathlib import Path

from ellipsoid_planning.leftovers import locked


def partial_path(path: str | Path) -> Path:
    """Return the file beside `path` that holds what this process has written of it so far."""
    target = Path(os.path.realpath(path))
    return target.with_name(f".{target.name}.{os.getpid()}.part")


def write_text(path: str | Path, text: str) -> None:
    """Write `text` as UTF-8 to `path`, as :func:`write_bytes` does.

    Halves of surrogate pairs, which UTF-8 cannot hold, are written as escapes.

    Raises:
        OSError: if the folder is missing or the file cannot be written.
    """
    write_bytes(path, text.encode(errors="backslashreplace"))


def write_bytes(path: str | Path, content: bytes) -> None:
    """Write `content` to `path`: to a file beside it first, which then takes its place.

    Whatever interrupts the writing, an older file of this name stays as it was and no
    half-written one is left behind. Links are followed; devices are written to, and pipes that
    somebody reads from.

    Raises:
        OSError: if the folder is missing or the file cannot be written.
    """
    write_pieces(path, (content,))


def write_pieces(path: str | Path, pieces: Iterable[bytes]) -> None:
    """As :func:`write_bytes`, for content that is made while it is written.

    Raises:
        OSError: if the folder is missing or the file cannot be written.
    """
    if not _is_file_or_new(path):
        _write_through(path, pieces)
        return
    beside = partial_path(path)
    try:
        with beside.open("wb") as stream, locked(stream.fileno()):
            stream.writelines(pieces)
            stream.flush()
            os.fsync(stream.fileno())
            os.replace(beside, os.path.realpath(path))
    except BaseException:
        beside.unlink(missing_ok=True)
        raise


def _is_file_or_new(path: str | Path) -> bool:
    try:
        return stat.S_ISREG(os.stat(path).st_mode)  # noqa: PTH116 (says more than "no file")
    except FileNotFoundError:
        return True


def _write_through(path: str | Path, pieces: Iterable[bytes]) -> None:
    try:
        # Opened in the ordinary way, a pipe would wait for its reader, if need be for ever.
        place = os.open(path, os.O_WRONLY | os.O_NONBLOCK)
    except OSError as error:
        if error.errno != errno.ENXIO:
            raise
        raise OSError(error.errno, "nobody reads from this pipe", str(path)) from None
    os.set_blocking(place, True)
    with os.fdopen(place, "wb") as stream:
        stream.writelines(pieces)
