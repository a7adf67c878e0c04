"""From a scenario to the text of a YAML file."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ellipsoid_planning.scenario import Scenario

WIDTH = 100
PLAIN = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 -_,.()")
WORDS = frozenset({"true", "false", "null", "yes", "no", "on", "off"})


def scenario_text(scenario: Scenario) -> str:
    """Return the scenario as the text of a YAML file, which reads back without loss.

    Vectors and orientations stand on one line each, the description is folded.
    """
    return document_text(scenario.to_dict())


def document_text(document: Mapping[str, Any]) -> str:
    """Return a scenario's document, or entries of one, as the text of a YAML file."""
    return "\n".join(_block(document, "")) + "\n"


def _block(mapping: Mapping[str, Any], indent: str) -> Iterator[str]:
    """The lines of a mapping in block style."""
    for name, value in mapping.items():
        key = _flow(name)
        if key == "description" and _foldable(value):
            yield f"{indent}{key}: >-"
            yield from _folded(value, indent + "  ")
        elif _is_bodies(value):
            yield f"{indent}{key}:"
            for body in value:
                first, *rest = _block(body, indent + "    ")
                yield f"{indent}  - {first.strip()}"
                yield from rest
        elif isinstance(value, Mapping) and not _fits_a_line(indent, key, value):
            yield f"{indent}{key}:"
            yield from _block(value, indent + "  ")
        else:
            yield f"{indent}{key}: {_flow(value)}"


def _folded(text: str, indent: str) -> list[str]:
    return textwrap.wrap(
        text,
        WIDTH,
        initial_indent=indent,
        subsequent_indent=indent,
        break_long_words=False,
        break_on_hyphens=False,
    )


def _is_bodies(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], Mapping)


def _fits_a_line(indent: str, key: str, value: Mapping[str, Any]) -> bool:
    if any(_is_bodies(entry) for entry in value.values()):
        return False
    return len(f"{indent}{key}: {_flow(value)}") <= WIDTH


def _foldable(text: str) -> bool:
    """Whether a folded block gives exactly this text back."""
    return bool(text) and text == " ".join(text.split())


def _flow(value: Any) -> str:
    """A value on one line."""
    if isinstance(value, Mapping):
        return (
            "{" + ", ".join(f"{_flow(key)}: {_flow(entry)}" for key, entry in value.items()) + "}"
        )
    if isinstance(value, list):
        return "[" + ", ".join(map(_flow, value)) + "]"
    if isinstance(value, str) and _plain(value):
        return value
    return json.dumps(value, ensure_ascii=False)


def _plain(text: str) -> bool:
    """Whether a text is a string to YAML without quotes, inside brackets, too."""
    inside = set(text) <= PLAIN - {","} and text == text.strip()
    return inside and text[:1].isalpha() and text.lower() not in WORDS
