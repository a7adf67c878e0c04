"""Output files: checked before the work begins, written whole."""

from __future__ import annotations

import json
import os
import stat
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ellipsoid_planning import atomic
from ellipsoid_planning.csv_text import csv_text
from ellipsoid_planning.errors import EllipsoidPlanningError
from ellipsoid_planning.leftovers import remove_partial_files
from planners.cli.interrupt import clean_up

if TYPE_CHECKING:
    from ellipsoid_planning.result import PlanResult
    from ellipsoid_planning.robots import Robot

PAGES = (".html", ".htm")
QUATERNION = ("qx", "qy", "qz", "qw")
COLUMNS = {
    (2, True): ("x", "y", "yaw"),
    (3, True): ("x", "y", "z", "qx", "qy", "qz", "qw"),
    (2, False): ("x", "y"),
    (3, False): ("x", "y", "z"),
}


def columns(robot: Robot) -> tuple[str, ...]:
    """The names of a configuration's numbers."""
    base = COLUMNS[robot.dimension, robot.rotates][: robot.base_size]
    joints: list[str] = []
    for name, where in robot.joint_slices.items():
        ball = where.stop - where.start == len(QUATERNION)
        joints += [f"{name}_{entry}" for entry in QUATERNION] if ball else [name]
    return (*base, *joints)


def check_outputs(**outputs: Path | None) -> None:
    """Check that files can be written where the options, by name, want them.

    Ctrl-C leaves no half-written remainders of these files; those of killed commands go.

    Raises:
        EllipsoidPlanningError: a folder is missing, is not one or is read-only, an output is a
            folder or a loop of links, a page has another format's suffix, or two options name the
            same file.
    """
    taken: dict[Path, str] = {}
    for option, path in outputs.items():
        if path is None:
            continue
        _check_output(f"--{option}", path)
        if option == "html" and path.suffix.lower() not in PAGES:
            raise EllipsoidPlanningError(
                f"--html {path}: unknown format {path.suffix!r}; expected {' or '.join(PAGES)}"
            )
        other = taken.setdefault(Path(os.path.realpath(path)), option)
        if other != option:
            raise EllipsoidPlanningError(
                f"--{other} and --{option}: expected two files, both are {path}; rename one"
            )
    clean_up([path for path in outputs.values() if path is not None])
    for folder in {Path(os.path.realpath(path)).parent for path in outputs.values() if path}:
        remove_partial_files(folder)


def _check_output(option: str, path: Path) -> None:
    folder = path.parent
    mode = _mode(option, path)
    if not folder.exists():
        raise EllipsoidPlanningError(
            f"{option} {path}: the folder {str(folder)!r} does not exist; create it first"
        )
    if not folder.is_dir():
        raise EllipsoidPlanningError(f"{option} {path}: {str(folder)!r} is a file, not a folder")
    if stat.S_ISDIR(mode):
        raise EllipsoidPlanningError(f"{option} {path}: expected a file name, this is a folder")
    # Devices such as /dev/null and pipes are written to; they stay what they are.
    beside = not mode or stat.S_ISREG(mode)
    if beside and not os.access(Path(os.path.realpath(path)).parent, os.W_OK):
        raise EllipsoidPlanningError(
            f"{option} {path}: the folder {str(folder)!r} cannot be written to; name another one"
        )


def _mode(option: str, path: Path) -> int:
    """What stands at a path, as `os.stat` tells of it; 0 if nothing does."""
    try:
        return path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return 0
    except OSError as error:  # a loop of links, too long a name, a closed folder
        raise EllipsoidPlanningError(
            f"{option} {path}: cannot write there: {error.strerror}; name another file"
        ) from None


def print_json(document: Mapping[str, Any]) -> None:
    """Print a result as JSON on stdout; it must hold no number that JSON cannot write."""
    sys.stdout.write(json.dumps(document, indent=2, allow_nan=False) + "\n")
    sys.stdout.flush()


def write_csv(result: PlanResult, output: Path) -> None:
    """Write the interpolated path: a header, then one row a configuration.

    The first column is the length travelled so far in OMPL's metric; headings and joint values
    that are angles are in radians and go on beyond ±π instead of jumping by 2π, quaternions are
    (x, y, z, w) and keep their sign from row to row. A joint's column has its name, a
    ball joint's four have a suffix too. Every state of the path is among the rows.

    Raises:
        EllipsoidPlanningError: the file cannot be written.
    """
    from planners.view.trajectory import follow, unwound

    scenario = result.scenario
    if result.path is None:
        raise EllipsoidPlanningError(f"{output}: there is no path to write")
    trajectory = follow(scenario.cspace(), result.path.configurations)
    configurations = unwound(scenario.robot, trajectory.configurations)
    travelled, rows = trajectory.travelled.tolist(), configurations.tolist()
    header = ("travelled", *columns(scenario.robot))
    lines = ([length, *row] for length, row in zip(travelled, rows, strict=True))
    try:
        atomic.write_text(output, csv_text([header, *lines]))
    except OSError as error:
        raise EllipsoidPlanningError(f"{output}: cannot write the file: {error.strerror}") from None
