"""Scenario files: which are bundled, where a name points, and what they hold."""

from __future__ import annotations

import difflib
import stat
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ellipsoid_planning import input_files
from ellipsoid_planning.errors import ScenarioError
from ellipsoid_planning.plain_yaml import plain_data
from ellipsoid_planning.scenario_origin import Origin
from ellipsoid_planning.scenario_places import read_yaml
from ellipsoid_planning.whole_characters import PROBLEM, halved_text

SUFFIXES = (".yaml", ".yml")
# Beyond, a text may have more entries than are read.
MOST_CHARACTERS = 50_000_000


def bundled_scenarios() -> dict[str, Path]:
    """Return the bundled scenario files by name, in alphabetical order."""
    return {file.stem: file for file in bundled_files("*.yaml")}


def bundled_files(pattern: str) -> list[Path]:
    """Return the bundled files of a pattern below the folder of scenarios, in order."""
    folder = Path(__file__).parent
    # A wheel carries the files inside the package; a checkout has them beside it.
    for place in (folder / "_scenarios", folder.parent / "scenarios"):
        files = sorted(place.glob(pattern))
        if files:
            return files
    return []


def locate(path_or_name: str | Path) -> Path:
    """Return the file that a path or the name of a bundled scenario points at.

    Raises:
        ScenarioError: if there is neither such a file nor such a bundled scenario.
    """
    return located(path_or_name, bundled_scenarios(), "scenario", "scenario file")


def located(path_or_name: str | Path, bundled: Mapping[str, Path], kind: str, file: str) -> Path:
    """Return the file that a path or the name of a ``bundled`` one points at.

    Args:
        path_or_name: what the user gave.
        bundled: files by name.
        kind: what is looked for, in messages.
        file: what is expected instead of a folder, in messages.

    Raises:
        ScenarioError: if there is neither such a file nor such a bundled one.
    """
    path, text = Path(path_or_name), str(path_or_name)
    found = _mode(path, text)
    if stat.S_ISREG(found):
        return path
    if text in bundled:
        return bundled[text]
    if stat.S_ISDIR(found):
        raise ScenarioError(f"expected a {file}, got a folder", file=text)
    if found:
        raise ScenarioError(
            f"expected a {file}, got a pipe or a device; save it to a file first", file=text
        )
    problem = f"no such file, and no bundled {kind} of this name"
    close = difflib.get_close_matches(path.stem, list(bundled), n=3, cutoff=0.5)
    if close:
        problem = f"{problem}; did you mean {' or '.join(close)}?"
    else:
        problem = f"{problem}; bundled are {', '.join(bundled) or 'none'}"
    raise ScenarioError(problem, file=text)


def _mode(path: Path, text: str) -> int:
    """What stands at a path, as `os.stat` tells of it; 0 if nothing does."""
    try:
        return path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return 0
    except (OSError, ValueError) as error:  # a name that holds a null
        reason = getattr(error, "strerror", None) or str(error)
        raise ScenarioError(f"cannot read the file: {reason}", file=text) from None


def read_document(path: Path) -> tuple[Any, Origin]:
    """Return a YAML file's content as plain Python data, and where each entry stands.

    Raises:
        ScenarioError: if the file cannot be read, is broken YAML or repeats a key.
    """
    try:
        text = input_files.read_text(path)
    except UnicodeDecodeError as error:
        problem = f"expected UTF-8 text, but byte {error.start} is not; save the file as UTF-8"
        raise ScenarioError(problem, file=str(path)) from None
    except OSError as error:
        raise ScenarioError(f"cannot read the file: {error.strerror}", file=str(path)) from None
    return parse_document(text, str(path))


def parse_document(text: str, file: str | None = None) -> tuple[Any, Origin]:
    """Return YAML text as plain Python data, and where each entry stands; see `read_document`."""
    data = plain_data(text) if len(text) <= MOST_CHARACTERS else None
    if data is None:
        data, _ = read_yaml(text, file)
    origin = Origin(file, text)
    place = halved_text(text, data)
    if place is not None:
        raise origin.error(place, PROBLEM)
    return data, origin
