"""Pages and pictures that appear whole or not at all."""

from __future__ import annotations

from pathlib import Path

from ellipsoid_planning.atomic import write_bytes
from ellipsoid_planning.errors import EllipsoidPlanningError


def write_whole(output: str | Path, content: bytes) -> Path:
    """Write `content` to a file beside `output`, which then takes its place.

    Raises:
        EllipsoidPlanningError: if the folder is missing or the file cannot be written; an
            older file of this name stays as it was and nothing is left behind.
    """
    target = Path(output)
    if not target.parent.is_dir():
        raise EllipsoidPlanningError(
            f"{target}: the folder {str(target.parent)!r} does not exist; create it first"
        )
    try:
        write_bytes(target, content)
    except OSError as error:
        raise EllipsoidPlanningError(
            f"{target}: cannot write the file: {error.strerror or error}"
        ) from None
    return target
