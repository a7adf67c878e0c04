"""The content of a data file: unpacked, without a byte-order mark, and of a size that fits."""

from __future__ import annotations

import gzip
import zlib
from pathlib import Path

from ellipsoid_planning.errors import ScenarioError

GZIP, UTF_8_MARK = b"\x1f\x8b", b"\xef\xbb\xbf"
UTF_16_MARKS = (b"\xff\xfe", b"\xfe\xff")
LARGEST = 1 << 30  # bytes, far more than any entry of the archive has


def read_content(path: str | Path, most: int | None = None) -> bytes:
    """Read a file whole; one that is compressed by gzip is unpacked, whatever its name.

    A byte-order mark is taken off, and text of UTF-16 becomes UTF-8.

    Args:
        path: the file.
        most: bytes that are read at most, `LARGEST` by default.

    Raises:
        ScenarioError: it is no regular file, cannot be read or unpacked, or is enormous.
    """
    file, limit = Path(path), most or LARGEST
    _check_regular(file)
    try:
        with file.open("rb") as stream:
            packed = stream.read(len(GZIP)) == GZIP
        with gzip.open(file) if packed else file.open("rb") as source:
            content = source.read(limit + 1)  # a small file may unpack to any size
    except OSError as error:
        problem = f"cannot read the file: {error.strerror or error}"
        raise ScenarioError(problem, file=str(path)) from None
    except (EOFError, zlib.error) as error:
        problem = f"cannot unpack the file: {error}; it is damaged, get it again"
        raise ScenarioError(problem, file=str(path)) from None
    if len(content) > limit:
        raise ScenarioError(f"expected a file of at most {limit:,} bytes", file=str(path))
    return _without_mark(content, str(path))


def _check_regular(path: Path) -> None:
    try:
        if path.is_file():
            return
        problem = "no such file"
        if path.is_dir():
            problem = "expected a file, this is a folder"
        elif path.exists():
            problem = "expected a regular file, this is a device or a pipe; save it as a file first"
    except (OSError, ValueError) as error:
        problem = f"cannot read the file: {getattr(error, 'strerror', None) or error}"
    raise ScenarioError(problem, file=str(path))


def _without_mark(content: bytes, file: str) -> bytes:
    if content.startswith(UTF_8_MARK):
        return content[len(UTF_8_MARK) :]
    if not content.startswith(UTF_16_MARKS):
        return content
    try:
        return content.decode("utf-16").encode()
    except UnicodeDecodeError:
        raise ScenarioError("the text is damaged; save it as UTF-8", file=file) from None
