"""The file that a roadmap is kept in, see array_files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from ellipsoid_planning import array_files
from ellipsoid_planning.array_files import Document, FileKind
from ellipsoid_planning.errors import RoadmapError

FORMAT = 2
ROADMAP = FileKind("roadmap", FORMAT, RoadmapError)


def write_document(
    path: str | Path, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]
) -> None:
    """Write a roadmap's file, completely or not at all. An older roadmap there is replaced.

    Raises:
        RoadmapError: there is another kind of file, or the file cannot be written.
    """
    array_files.write_document(ROADMAP, path, header, arrays)


def check_target(path: Path) -> None:
    """Check that ``path`` can be a roadmap's file.

    Raises:
        RoadmapError: its folder is missing, or it is no ordinary file.
    """
    array_files.check_target(ROADMAP, path)


def read_header(path: str | Path) -> dict[str, Any]:
    """The header of a roadmap's file, of whatever format and version.

    Raises:
        RoadmapError: the file cannot be read, or is no roadmap.
    """
    return array_files.read_header(ROADMAP, path)


def read_document(path: str | Path) -> Document:
    """The content of a roadmap's file of this format and version.

    Raises:
        RoadmapError: the file cannot be read, is no roadmap, is damaged, or is of another format
            or version.
    """
    return array_files.read_document(ROADMAP, path)
