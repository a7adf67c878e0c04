"""Scenario files: which are bundled, where a name points, and YAML with line and column."""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ellipsoid_planning.errors import ScenarioError
from ellipsoid_planning.scenario_origin import Origin
from ellipsoid_planning.scenario_origin import Path as EntryPath

SUFFIXES = (".yaml", ".yml")
DUPLICATE = re.compile(r'found duplicate key "(.*?)"')
POSITION = re.compile(r"position (\d+)")

MOST_ENTRIES = 1_000_000


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
    path = Path(path_or_name)
    if path.is_file():
        return path
    text = str(path_or_name)
    if text in bundled:
        return bundled[text]
    if path.is_dir():
        raise ScenarioError(f"expected a {file}, got a folder", file=text)
    problem = f"no such file, and no bundled {kind} of this name"
    close = difflib.get_close_matches(path.stem, list(bundled), n=3, cutoff=0.5)
    if close:
        problem = f"{problem}; did you mean {' or '.join(close)}?"
    else:
        problem = f"{problem}; bundled are {', '.join(bundled) or 'none'}"
    raise ScenarioError(problem, file=text)


def read_document(path: Path) -> tuple[Any, Origin]:
    """Return a YAML file's content as plain Python data, and where each entry stands.

    Raises:
        ScenarioError: if the file cannot be read, is broken YAML or repeats a key.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        problem = f"expected UTF-8 text, but byte {error.start} is not; save the file as UTF-8"
        raise ScenarioError(problem, file=str(path)) from None
    except OSError as error:
        raise ScenarioError(f"cannot read the file: {error.strerror}", file=str(path)) from None
    return parse_document(text, str(path))


def parse_document(text: str, file: str | None = None) -> tuple[Any, Origin]:
    """Return YAML text as plain Python data, and where each entry stands; see `read_document`."""
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    origin = Origin(file)
    try:
        loaded = YAML(typ="rt", pure=True).load(text)
        return _plain(loaded, (), origin), origin
    except YAMLError as error:
        raise _syntax_error(error, text, file) from None
    except RecursionError:
        raise ScenarioError("the YAML is nested too deeply or contains itself", file=file) from None
    except ValueError as error:
        raise ScenarioError(f"broken YAML: {error}", file=file) from None


def _syntax_error(error: Exception, text: str, file: str | None) -> ScenarioError:
    mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    message = str(getattr(error, "problem", None) or error).splitlines()[0]
    duplicate = DUPLICATE.search(message)
    field = None
    problem = f"broken YAML: {message}; correct the syntax here"
    if duplicate:
        field = duplicate.group(1)
        problem = "this key is written twice in one mapping; remove one of them"
    line, column = (mark.line + 1, mark.column + 1) if mark else _place(str(error), text)
    return ScenarioError(problem, file=file, field=field, line=line, column=column)


def _place(message: str, text: str) -> tuple[int | None, int | None]:
    """Return line and column of an unreadable character, which only has a position."""
    position = POSITION.search(message)
    if position is None:
        return None, None
    before = text[: int(position.group(1))]
    return before.count("\n") + 1, len(before) - (before.rfind("\n") + 1) + 1


def _plain(value: Any, path: EntryPath, origin: Origin) -> Any:
    """Return `value` without ruamel's types, noting the places of its entries in `origin`."""
    if len(origin.values) > MOST_ENTRIES:
        raise ScenarioError(
            f"expected at most {MOST_ENTRIES} entries, aliases written out; split the scenario",
            file=origin.file,
        )
    if isinstance(value, dict):
        return {key: _entry(value, key, path, origin) for key in value}
    if isinstance(value, (list, tuple)):
        return [_item(value, index, path, origin) for index in range(len(value))]
    if value is None or isinstance(value, bool):
        return value
    for kind in (int, float, str):
        if isinstance(value, kind):
            return kind(value)
    # ruamel's booleans with anchors are no bool; everything else is left for validation.
    return bool(value) if type(value).__name__ == "ScalarBoolean" else value


def _entry(mapping: Any, key: Any, path: EntryPath, origin: Origin) -> Any:
    inner = (*path, key)
    places = getattr(mapping, "lc", None)
    if places is not None and places.data and key in places.data:
        key_line, key_column, line, column = places.data[key]
        _note(origin.keys, inner, key_line, key_column)
        _note(origin.values, inner, line, column)
    return _plain(mapping[key], inner, origin)


def _item(sequence: Any, index: int, path: EntryPath, origin: Origin) -> Any:
    inner = (*path, index)
    places = getattr(sequence, "lc", None)
    if places is not None and places.data and index in places.data:
        _note(origin.values, inner, *places.data[index][:2])
    return _plain(sequence[index], inner, origin)


def _note(places: Any, path: EntryPath, line: int, column: int) -> None:
    places[path] = (line + 1, column + 1)
