"""Files that are written completely or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path


def partial_path(path: str | Path) -> Path:
    """Return the file beside `path` that holds what this process has written of it so far."""
    target = Path(path).resolve()
    return target.with_name(f".{target.name}.{os.getpid()}.part")


def write_text(path: str | Path, text: str) -> None:
    """Write `text` as UTF-8 to `path`, as :func:`write_bytes` does.

    Raises:
        OSError: if the folder is missing or the file cannot be written.
    """
    write_bytes(path, text.encode())


def write_bytes(path: str | Path, content: bytes) -> None:
    """Write `content` to `path`: to a file beside it first, which then takes its place.

    Whatever interrupts the writing, an older file of this name stays as it was and no
    half-written one is left behind. Links are followed; devices and pipes are written to.

    Raises:
        OSError: if the folder is missing or the file cannot be written.
    """
    write_pieces(path, (content,))


def write_pieces(path: str | Path, pieces: Iterable[bytes]) -> None:
    """As :func:`write_bytes`, for content that is made while it is written.

    Raises:
        OSError: if the folder is missing or the file cannot be written.
    """
    target = Path(path).resolve()
    if target.exists() and not target.is_file():
        with target.open("wb") as stream:
            stream.writelines(pieces)
        return
    beside = partial_path(path)
    try:
        with beside.open("wb") as stream:
            stream.writelines(pieces)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(beside, target)
    except BaseException:
        beside.unlink(missing_ok=True)
        raise
