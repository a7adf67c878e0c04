"""Files of our own: zip archives of plain arrays and a header.

They are numpy's .npz files with a member in JSON besides. Nothing in them is ever executed: arrays
are numbers and truth values only, and no member is unpickled.
"""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from ellipsoid_planning import __version__, atomic
from ellipsoid_planning.array_members import BROKEN, PackedArray, packed_array, read_member
from ellipsoid_planning.errors import EllipsoidPlanningError
from ellipsoid_planning.numbers_shown import shown

_SUFFIX = ".npy"
_REMEDY = "name another file, or delete this one to make it anew"


@dataclass(frozen=True)
class FileKind:
    """What a file holds.

    Attributes:
        noun: such as "roadmap".
        format: number of the format; files of another one are refused.
        error: what is raised for files that cannot be used or written.
    """

    noun: str
    format: int
    error: type[EllipsoidPlanningError]

    @property
    def title(self) -> str:
        """How the header names the kind."""
        return f"ellipsoid-planning {self.noun}"

    @property
    def member(self) -> str:
        """The header's name in the archive."""
        return f"{self.noun}.json"


@dataclass(frozen=True, eq=False)
class Document:
    """The content of a file.

    Attributes:
        kind: what it is.
        file: its name, for messages.
        header: data that JSON can hold.
        arrays: by name, not unpacked yet.
    """

    kind: FileKind
    file: str
    header: Mapping[str, Any]
    arrays: Mapping[str, PackedArray]

    def number(self, place: str, entry: Mapping[str, Any], most: int = 1 << 62) -> int:
        """The count ``entry[name]`` of a place ``….name``, from 0 to ``most``."""
        name = place.rsplit(".", 1)[-1]
        value = entry.get(name)
        if type(value) is not int or not 0 <= value <= most:
            raise self.error(f"{place}: expected a count, got {shown(value)}")
        return value

    def array(self, name: str, kind: type, *shape: int | None) -> NDArray[Any]:
        """An array of the header's file, of the given type and shape; None fits any length.

        It is unpacked after its type and shape were found to be those.
        """
        packed = self.arrays.get(name)
        if packed is None:
            raise self.error(f"{name}: this array is missing")
        fits = len(packed.shape) == len(shape) and all(
            want in (None, have) for want, have in zip(shape, packed.shape, strict=True)
        )
        if packed.dtype != np.dtype(kind) or not fits:
            wanted = ", ".join("any" if want is None else str(want) for want in shape)
            raise self.error(
                f"{name}: expected {np.dtype(kind)} numbers of shape ({wanted}),"
                f" got {packed.dtype} {packed.shape}"
            )
        try:
            found = packed.read()
        except (OSError, *BROKEN) as error:
            raise self.error(f"{name}: {error}") from None
        if found.dtype.kind == "f" and not np.isfinite(found).all():
            raise self.error(f"{name}: expected finite numbers")
        return found

    def error(self, problem: str) -> EllipsoidPlanningError:
        """The exception for an entry that no file of ours has."""
        return self.kind.error(f"{self.file}: damaged {self.kind.noun}: {problem}; {_REMEDY}")

    def refusal(self, problem: str) -> EllipsoidPlanningError:
        """The exception for a file that cannot be used here."""
        return self.kind.error(f"{self.file}: {problem}; {_REMEDY}")


def write_document(
    kind: FileKind,
    path: str | Path,
    header: Mapping[str, Any],
    arrays: Mapping[str, NDArray[Any]],
) -> None:
    """Write a file, completely or not at all. An older one of its kind is replaced.

    Raises:
        kind.error: there is another kind of file, or the file cannot be written.
    """
    target = Path(path)
    check_target(kind, target)
    if target.is_file():
        read_header(kind, target)
    content = {"kind": kind.title, "format": kind.format, "version": __version__, **header}
    text = json.dumps(content, default=_plain)
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr(_member(kind.member), text)
        for name, array in arrays.items():
            member = io.BytesIO()
            plain = np.dtype(array.dtype).newbyteorder("<")
            npy.write_array(member, np.ascontiguousarray(array, plain), (1, 0), allow_pickle=False)
            archive.writestr(_member(name + _SUFFIX), member.getvalue())
    try:
        atomic.write_bytes(target, stream.getvalue())
    except OSError as error:
        raise kind.error(f"{path}: cannot write the file: {error.strerror}") from None


def _plain(value: Any) -> Any:
    """numpy's numbers, which parameters may be, as Python's."""
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"expected data that JSON can hold, got {type(value).__name__}")


def _member(name: str) -> zipfile.ZipInfo:
    # Without the time of day, the same content makes the same file.
    info = zipfile.ZipInfo(name)
    info.compress_type = zipfile.ZIP_DEFLATED
    info.external_attr = 0o644 << 16
    return info


def check_target(kind: FileKind, path: Path) -> None:
    """Check that ``path`` can be a file of this kind.

    Raises:
        kind.error: its folder is missing, or it is no ordinary file.
    """
    if not path.parent.is_dir():
        folder = str(path.parent)
        raise kind.error(f"{path}: the folder {folder!r} does not exist; create it first")
    if path.exists() and not path.is_file():
        raise kind.error(f"{path}: expected a file, this is a folder or a device")


def read_header(kind: FileKind, path: str | Path) -> dict[str, Any]:
    """The header of a file, of whatever format and version.

    Raises:
        kind.error: the file cannot be read, or is of another kind.
    """
    return _read(kind, path, arrays=False)[0]


def read_document(kind: FileKind, path: str | Path) -> Document:
    """The content of a file of this kind, format and version.

    Raises:
        kind.error: the file cannot be read, is of another kind, format or version, or is damaged.
    """
    header, arrays = _read(kind, path, arrays=True)
    return Document(kind, str(path), header, arrays)


def _read(
    kind: FileKind, path: str | Path, *, arrays: bool
) -> tuple[dict[str, Any], dict[str, PackedArray]]:
    check_target(kind, Path(path))
    try:
        stream = io.BytesIO(Path(path).read_bytes())
        if not zipfile.is_zipfile(stream):
            raise _foreign(kind, path)
        archive = zipfile.ZipFile(stream)
        members = {member.filename: member for member in archive.infolist()}
        header = _header(kind, path, archive, members.pop(kind.member, None))
        if not arrays:
            return header, {}
        _check_version(kind, path, header)
        return header, {
            name.removesuffix(_SUFFIX): packed_array(archive, member)
            for name, member in members.items()
        }
    except OSError as error:
        reason = error.strerror or str(error)
        raise kind.error(f"{path}: cannot read the {kind.noun}: {reason}") from None
    except BROKEN as error:
        raise kind.error(f"{path}: damaged {kind.noun}: {error}; {_REMEDY}") from None


def _header(
    kind: FileKind, path: str | Path, archive: zipfile.ZipFile, member: zipfile.ZipInfo | None
) -> dict[str, Any]:
    if member is None:
        raise _foreign(kind, path)
    header = json.loads(read_member(archive, member))
    if not isinstance(header, dict) or header.get("kind") != kind.title:
        raise _foreign(kind, path)
    return header


def _foreign(kind: FileKind, path: str | Path) -> EllipsoidPlanningError:
    return kind.error(
        f"{path}: expected a {kind.noun}, this file is another one or was cut short;"
        " name another file, or remove this one"
    )


def _check_version(kind: FileKind, path: str | Path, header: Mapping[str, Any]) -> None:
    for name, expected in (("format", kind.format), ("version", __version__)):
        got = header.get(name)
        if got != expected:
            raise kind.error(
                f"{path}: expected a {kind.noun} of {name} {expected}, got {_bare(got)}; {_REMEDY}"
            )


def _bare(value: Any) -> str:
    """A value for a message, a text without quotes."""
    return shown(value).strip("'")
