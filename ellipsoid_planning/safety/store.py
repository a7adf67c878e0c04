"""Tables are kept in files, named after a hash of what they were made from."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.array_files import FileKind, check_target, read_document, write_document
from ellipsoid_planning.errors import TableError
from ellipsoid_planning.kernels.compile import CACHE_FOLDER
from ellipsoid_planning.safety.build import Progress, fill_tables
from ellipsoid_planning.safety.table import LinkTable, TablePlan

TABLE = FileKind("safety table", 1, TableError)
SUFFIX = ".safety"


def default_folder() -> Path:
    """Where tables are kept unless another folder is named: beside the compiled kernels."""
    return CACHE_FOLDER.parent / "safety-tables"


def table_path(plan: TablePlan, folder: Path) -> Path:
    """The file of a plan's table in a folder."""
    return folder / f"{plan.key()}{SUFFIX}"


def save_table(table: LinkTable, path: str | Path) -> None:
    """Write a table to a file, completely or not at all.

    Raises:
        TableError: there is another kind of file, or the file cannot be written.
    """
    header = {"key": table.plan.key(), "description": table.description}
    arrays: dict[str, NDArray[Any]] = {"offsets": table.offsets, "intervals": table.intervals}
    write_document(TABLE, path, header, arrays)


def load_table(plan: TablePlan, path: str | Path) -> LinkTable:
    """Read the table of ``plan`` from a file.

    Raises:
        TableError: the file cannot be read, is no table or a damaged one, or is that of another
            link, world, clearance, resolution or version of this package.
    """
    began = time.perf_counter()
    document = read_document(TABLE, path)
    if document.header.get("key") != plan.key():
        raise document.refusal(
            "expected the table of this link, world, clearance and resolution, got another one"
        )
    offsets = document.array("offsets", np.int32, plan.size + 1)
    intervals = document.array("intervals", np.uint16, None, 2)
    ordered = offsets[0] == 0 and offsets[-1] == len(intervals) and np.all(np.diff(offsets) >= 0)
    if not ordered:
        raise document.error("offsets: expected places of intervals in ascending order")
    if not np.all(intervals[:, 0] < intervals[:, 1]):
        raise document.error("intervals: expected pairs, the lower end first")
    return LinkTable(plan, offsets, intervals, time.perf_counter() - began, loaded=True)


def kept_tables(
    plans: Sequence[TablePlan],
    folder: Path,
    workers: int | None = None,
    on_progress: Progress | None = None,
) -> tuple[LinkTable, ...]:
    """The tables of ``plans``: loaded from ``folder`` where they are kept, else filled and kept.

    Raises:
        TableError: see fill_tables and load_table; or the folder cannot be made or written to.
    """
    paths = {plan: table_path(plan, folder) for plan in plans}
    known = {plan: load_table(plan, path) for plan, path in paths.items() if path.exists()}
    missing = [plan for plan in plans if plan not in known]
    if missing:
        _make(folder)
        for plan in missing:
            check_target(TABLE, paths[plan])
    for table in fill_tables(missing, workers, on_progress):
        save_table(table, paths[table.plan])
        known[table.plan] = table
    return tuple(known[plan] for plan in plans)


def _make(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise TableError(f"{folder}: cannot make the folder: {error.strerror}") from None
