"""Reading what others wrote: ordinary files of a size that fits into memory, and nothing else.

A device may have no end and a pipe no writer, so that reading them would fill the memory or hang.
"""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

LARGEST = 1 << 28
"""Of files that are read as a whole [bytes]; scenarios with 100,000 bodies have a tenth of it."""


def read_text(path: str | Path, encoding: str = "utf-8") -> str:
    """Return the text of a file.

    Raises:
        OSError: it cannot be read, is no ordinary file, or is too large; ``strerror`` says so.
        UnicodeDecodeError: it is not in this encoding.
    """
    text = read_bytes(path).decode(encoding)
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_bytes(path: str | Path) -> bytes:
    """Return the content of a file.

    Raises:
        OSError: it cannot be read, is no ordinary file, or is too large; ``strerror`` says so.
    """
    with os.fdopen(_opened(path), "rb") as stream:
        content = stream.read(LARGEST + 1)
    if len(content) > LARGEST:
        raise OSError(errno.EFBIG, f"it is larger than {LARGEST >> 20} MB", str(path))
    return content


def check_readable(path: str | Path) -> None:
    """Check that a library can be given a file to read.

    Raises:
        OSError: it cannot be read or is no ordinary file; ``strerror`` says so.
    """
    os.close(_opened(path))


def _opened(path: str | Path) -> int:
    descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    mode = os.fstat(descriptor).st_mode
    if stat.S_ISREG(mode):
        return descriptor
    os.close(descriptor)
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    raise OSError(
        errno.EINVAL, "expected a file, this is a pipe or a device; save it to a file", str(path)
    )
