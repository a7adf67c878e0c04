"""Where a scenario came from: its file, and the line and column of each of its entries."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ellipsoid_planning.errors import ScenarioError

Path = tuple[str | int, ...]


@dataclass(frozen=True, eq=False)
class Origin:
    """The source of a scenario, for messages and for writing it as it was read.

    Attributes:
        file: the file's path as the user gave it, None for a scenario built in Python.
        values: line and column, from 1, of each value by its path in the document.
        keys: line and column, from 1, of each key by its value's path.
        orientations: pairs of an object that was built and its orientation as written.
    """

    file: str | None = None
    values: Mapping[Path, tuple[int, int]] = field(default_factory=dict)
    keys: Mapping[Path, tuple[int, int]] = field(default_factory=dict)
    orientations: tuple[tuple[object, Mapping[str, Any]], ...] = ()

    def error(self, path: Path, problem: str, *, at_key: bool = False) -> ScenarioError:
        """Return the error for the entry at `path`; for a missing one, its parent's place."""
        positions = self.keys if at_key else self.values
        place = positions.get(path)
        ancestor = path
        while place is None and ancestor:
            ancestor = ancestor[:-1]
            place = self.values.get(ancestor)
        line, column = place if place is not None else (None, None)
        return ScenarioError(
            problem, file=self.file, field=dotted(path) or None, line=line, column=column
        )


def dotted(path: Path) -> str:
    """Return a path as text: ("robot", "parts", 1) gives ``robot.parts[1]``."""
    text = ""
    for step in path:
        text += f"[{step}]" if isinstance(step, int) else f".{step}"
    return text.removeprefix(".")
