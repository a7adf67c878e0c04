"""OMPL's benchmark database, made from logs by OMPL's own reader."""

from __future__ import annotations

import contextlib
import io
import os
import sqlite3
from collections.abc import Iterable
from pathlib import Path

from ompl import tools as ot

from ellipsoid_planning.atomic import partial_path
from ellipsoid_planning.errors import EllipsoidPlanningError


def write_database(database: Path, logs: Iterable[Path]) -> None:
    """Read ``logs`` into a new SQLite file, which then takes the place of ``database``.

    It has OMPL's tables ``experiments``, ``plannerConfigs``, ``enums``, ``runs`` and ``progress``
    and its views of the best planners, as its statistics script and Planner Arena want them.

    Raises:
        EllipsoidPlanningError: the file cannot be written.
    """
    beside = partial_path(database)
    beside.unlink(missing_ok=True)
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # the reader prints what it reads
            ot.readBenchmarkLog(str(beside), [str(log) for log in logs], False)
            ot.computeViews(str(beside), False)
        os.replace(beside, database)
    except (OSError, sqlite3.OperationalError) as error:
        raise EllipsoidPlanningError(f"{database}: cannot write the database: {error}") from None
    finally:
        beside.unlink(missing_ok=True)
