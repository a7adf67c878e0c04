"""Texts of whole characters: escapes in YAML and JSON can make halves, which nothing can write."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from ellipsoid_planning.scenario_origin import Path

_MAYBE = re.compile(r"\\[uU](?:0000)?[dD][89a-fA-F]")

PROBLEM = (
    "expected whole characters, got half of a surrogate pair (such as \\ud800);"
    " write the character itself"
)


def halved_text(source: str, data: Any) -> Path | None:
    """Return the place of a text in loaded `data` that holds half of a surrogate pair.

    Args:
        source: what `data` was loaded from; without such an escape nothing is looked through.
        data: mappings, lists, texts and numbers.
    """
    return next(_halved(data, ()), None) if _MAYBE.search(source) else None


def _halved(value: Any, path: Path) -> Iterator[Path]:
    if isinstance(value, str):
        if not value.isascii() and any("\ud800" <= sign <= "\udfff" for sign in value):
            yield path
    elif isinstance(value, Mapping):
        for key, entry in value.items():
            yield from _halved(key, path)
            yield from _halved(entry, (*path, key))
    elif isinstance(value, list):
        for index, entry in enumerate(value):
            yield from _halved(entry, (*path, index))
