"""The numbers of a URDF: how many an attribute has, and how large they are."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from ellipsoid_planning.errors import UrdfError
from ellipsoid_planning.numbers_shown import shown
from ellipsoid_planning.sizes import LEAST_LENGTH, MOST_LENGTH

COORDINATE = "coordinate"
LENGTH = "length"
FACTOR = "factor"
LIMIT = "limit"
# What attributes hold, by element: what kind of numbers, and how many.
ATTRIBUTES: dict[str, dict[str, tuple[str, int]]] = {
    "origin": {"xyz": (COORDINATE, 3), "rpy": (FACTOR, 3)},
    "axis": {"xyz": (FACTOR, 3)},
    "box": {"size": (LENGTH, 3)},
    "sphere": {"radius": (LENGTH, 1)},
    "cylinder": {"radius": (LENGTH, 1), "length": (LENGTH, 1)},
    "capsule": {"radius": (LENGTH, 1), "length": (LENGTH, 1)},
    "mesh": {"scale": (FACTOR, 3)},
    "limit": {"lower": (LIMIT, 1), "upper": (LIMIT, 1)},
    "mimic": {"multiplier": (FACTOR, 1), "offset": (COORDINATE, 1)},
}
COUNTS = {1: "one number", 3: "three numbers"}


def check_numbers(file: Path, owner: str, element: Any, tag: str) -> None:
    """Check the attributes of an element that hold numbers.

    Args:
        file: the URDF, for messages.
        owner: whose the element is, such as "link 'arm'".
        element: of the XML.
        tag: its name without a prefix.

    Raises:
        UrdfError: naming file, line, owner and attribute: there are more or fewer numbers than
            there should be, text that is no number, or a size out of range.
    """
    for name, (kind, count) in ATTRIBUTES.get(tag, {}).items():
        text = element.get(name)
        if text is None:
            continue
        problem = _problem(text, kind, count)
        if problem is not None:
            raise UrdfError(
                f"{file}:{element.sourceline}: {owner}: <{tag} {name}={shown(text)}>: {problem}"
            )


def _problem(text: str, kind: str, count: int) -> str | None:
    words = text.split()
    if len(words) != count:
        return f"expected {COUNTS[count]}, got {len(words)}; correct the attribute"
    for word in words:
        try:
            number = float(word)
        except ValueError:
            return f"expected {COUNTS[count]}, got {shown(word)}; correct the attribute"
        expected = _expected(number, kind)
        if expected is not None:
            return f"expected {expected}, got {word}; correct the attribute"
    return None


def _expected(number: float, kind: str) -> str | None:
    """What was expected instead of a number, None if it is fine."""
    if math.isnan(number) or (kind != LIMIT and math.isinf(number)):
        return "finite numbers"
    if kind == LENGTH and number > 0.0 and not LEAST_LENGTH <= number <= MOST_LENGTH:
        return f"a length from {LEAST_LENGTH:g} to {MOST_LENGTH:g} m"
    if kind in (COORDINATE, FACTOR) and abs(number) > MOST_LENGTH:
        return f"numbers from {-MOST_LENGTH:g} to {MOST_LENGTH:g}"
    return None
