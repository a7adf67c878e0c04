"""Files that are written completely or not at all."""

from __future__ import annotations

import os
from pathlib import Path


def partial_path(path: str | Path) -> Path:
    """Return the file beside `path` that holds what this process has written of it so far."""
    target = Path(path)
    return target.with_name(f".{target.name}.{os.getpid()}.part")


def write_text(path: str | Path, text: str) -> None:
    """Write `text` as UTF-8 to `path`: to a file beside it first, which then takes its place.

    Whatever interrupts the writing, an older file of this name stays as it was and no
    half-written one is left behind.

    Raises:
        OSError: if the folder is missing or the file cannot be written.
    """
    target = Path(path)
    beside = partial_path(target)
    try:
        with beside.open("w", encoding="utf-8", newline="\n") as stream:
            stream.write(text)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(beside, target)
    except BaseException:
        beside.unlink(missing_ok=True)
        raise
