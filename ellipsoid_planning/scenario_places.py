"""YAML of any kind as plain data, with the line and column of each entry."""

from __future__ import annotations

import re
from typing import Any

from ellipsoid_planning.errors import ScenarioError
from ellipsoid_planning.scenario_origin import Path, Places

DUPLICATE = re.compile(r'found duplicate key "(.*?)"')
POSITION = re.compile(r"position (\d+)")

MOST_ENTRIES = 1_000_000


def places_of(text: str) -> Places:
    """Where the entries of a YAML text stand, none for a text that is read another way only."""
    try:
        return read_yaml(text)[1]
    except ScenarioError:
        return Places()


def read_yaml(text: str, file: str | None = None) -> tuple[Any, Places]:
    """Return YAML text as plain Python data, and where each entry stands.

    Raises:
        ScenarioError: if it is broken YAML, repeats a key, or has far too many entries.
    """
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    places = Places()
    try:
        loaded = YAML(typ="rt", pure=True).load(text)
        return _plain(loaded, (), places), places
    except YAMLError as error:
        raise _syntax_error(error, text, file) from None
    except RecursionError:
        raise ScenarioError("the YAML is nested too deeply or contains itself", file=file) from None
    except ValueError as error:
        raise ScenarioError(f"broken YAML: {error}", file=file) from None
    except _TooManyError:
        problem = (
            f"expected at most {MOST_ENTRIES} entries, aliases written out; split the scenario"
        )
        raise ScenarioError(problem, file=file) from None


class _TooManyError(Exception):
    """The document has too many entries."""


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


def _plain(value: Any, path: Path, places: Places) -> Any:
    """Return `value` without ruamel's types, noting the places of its entries in `places`."""
    if len(places.values) > MOST_ENTRIES:
        raise _TooManyError
    if isinstance(value, dict):
        return {key: _entry(value, key, path, places) for key in value}
    if isinstance(value, (list, tuple)):
        return [_item(value, index, path, places) for index in range(len(value))]
    if value is None or isinstance(value, bool):
        return value
    for kind in (int, float, str):
        if isinstance(value, kind):
            return kind(value)
    # ruamel's booleans with anchors are no bool; everything else is left for validation.
    return bool(value) if type(value).__name__ == "ScalarBoolean" else value


def _entry(mapping: Any, key: Any, path: Path, places: Places) -> Any:
    inner = (*path, key)
    lines = getattr(mapping, "lc", None)
    if lines is not None and lines.data and key in lines.data:
        key_line, key_column, line, column = lines.data[key]
        _note(places.keys, inner, key_line, key_column)
        _note(places.values, inner, line, column)
    return _plain(mapping[key], inner, places)


def _item(sequence: Any, index: int, path: Path, places: Places) -> Any:
    inner = (*path, index)
    lines = getattr(sequence, "lc", None)
    if lines is not None and lines.data and index in lines.data:
        _note(places.values, inner, *lines.data[index][:2])
    return _plain(sequence[index], inner, places)


def _note(noted: dict[Path, tuple[int, int]], path: Path, line: int, column: int) -> None:
    noted[path] = (line + 1, column + 1)
