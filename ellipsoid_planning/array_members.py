"""The arrays of a zip archive: looked at before anything is unpacked.

An array's header, of numpy's format 1.0 as we write it, says its type and shape; both, and the
sizes that the archive states, have to agree before the numbers are read, and no more is read than
they say. Nothing is evaluated: the header is compared with a pattern.
"""

from __future__ import annotations

import io
import math
import re
import struct
import zipfile
import zlib
from dataclasses import dataclass
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

_MAGIC = b"\x93NUMPY\x01\x00"
_HEADER = re.compile(
    rb"\{'descr': '(<f8|<i8|\|b1|<i4|<u2)', 'fortran_order': False, "
    rb"'shape': \(((?:\d{1,15}, ?)*\d{0,15})\), \} *\n"
)
_LONGEST_HEADER = 4096
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_ENCRYPTED = 0x1
_SMALL = 1 << 24
_MOST_PACKED = 200
"""Bytes above `_SMALL` that are believed to be packed into one; numbers of ours need far more."""

BROKEN = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    ValueError,
    KeyError,
    IndexError,
    EOFError,
    NotImplementedError,
    RuntimeError,
    OverflowError,
    MemoryError,
)
"""What zipfile, zlib and json raise for bytes that are not what they should be."""


@dataclass(frozen=True, eq=False)
class PackedArray:
    """An array in an archive, not read yet.

    Attributes:
        archive, member: where it is.
        dtype, shape: what its header says, and the archive's sizes agree.
    """

    archive: zipfile.ZipFile
    member: zipfile.ZipInfo
    dtype: np.dtype[Any]
    shape: tuple[int, ...]

    def read(self) -> NDArray[Any]:
        """The numbers.

        Raises:
            BROKEN: one of them: the archive is damaged.
        """
        size = self.dtype.itemsize * math.prod(self.shape)
        with self.archive.open(self.member) as stream:
            stream.read(self.member.file_size - size)
            data = stream.read(size)
            if len(data) != size or stream.read(1):
                raise ValueError("an array ends early or late")
        # A copy, because kernels would be compiled anew for arrays that are read-only.
        return np.ndarray(self.shape, self.dtype, buffer=data).copy()


def packed_array(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> PackedArray:
    """The array of a member, its header read.

    Raises:
        BROKEN: one of them: it is no array, not of the numbers that we write, or its size is not
            the member's.
    """
    check_member(member)
    with archive.open(member) as stream:
        kind, shape, _ = _read_header(stream, member.file_size)
    return PackedArray(archive, member, kind, shape)


def plain_array(content: bytes) -> NDArray[Any]:
    """The array of bytes in numpy's format 1.0.

    Raises:
        ValueError: it is no array, or not of the numbers that we write.
    """
    stream = io.BytesIO(content)
    kind, shape, begin = _read_header(stream, len(content))
    return np.ndarray(shape, kind, buffer=content, offset=begin).copy()


def _read_header(stream: IO[bytes], total: int) -> tuple[np.dtype[Any], tuple[int, ...], int]:
    """Type, shape and length of the header of an array that has ``total`` bytes with it."""
    begin = stream.read(len(_MAGIC) + 2)
    if begin[:-2] != _MAGIC:
        raise ValueError("expected arrays in numpy's format 1.0")
    length = int.from_bytes(begin[-2:], "little")
    if length > _LONGEST_HEADER:
        raise ValueError("expected a short header of an array")
    found = _HEADER.fullmatch(stream.read(length))
    if found is None:
        raise ValueError("expected an array of plain numbers")
    kind, sides = np.dtype(found[1].decode()), found[2].decode()
    shape = tuple(int(side) for side in sides.split(",") if side.strip())
    if len(begin) + length + kind.itemsize * math.prod(shape) != total:
        raise ValueError(f"an array of shape {shape} is stated to have {total} bytes")
    return kind, shape, len(begin) + length


def read_member(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> bytes:
    """The content of a member, no more than is stated.

    Raises:
        BROKEN: one of them: the archive is damaged.
    """
    check_member(member)
    with archive.open(member) as stream:
        return stream.read(member.file_size)


def check_member(member: zipfile.ZipInfo) -> None:
    """Refuse what we do not write, and what would fill the memory.

    Raises:
        ValueError: saying what is wrong.
    """
    if member.flag_bits & _ENCRYPTED or member.compress_type not in _METHODS:
        raise ValueError("expected members that are deflated")
    if member.file_size > _SMALL + _MOST_PACKED * member.compress_size:
        raise ValueError(
            f"{member.compress_size} bytes are stated to hold {member.file_size} bytes"
        )
