"""Where a scenario came from: its file, and the line and column of each of its entries."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ellipsoid_planning.errors import ScenarioError

Path = tuple[str | int, ...]


class Places:
    """Lines and columns of a document's entries.

    Attributes:
        values: line and column, from 1, of each value by its path in the document.
        keys: line and column, from 1, of each key by its value's path.
    """

    def __init__(self) -> None:
        self.values: dict[Path, tuple[int, int]] = {}
        self.keys: dict[Path, tuple[int, int]] = {}


@dataclass(frozen=True, eq=False)
class Origin:
    """The source of a scenario, for messages and for writing it as it was read.

    Attributes:
        file: the file's path as the user gave it, None for a scenario built in Python.
        text: the YAML text, which is searched for lines and columns only when there is an error.
        orientations: pairs of an object that was built and its orientation as written.
    """

    file: str | None = None
    text: str | None = None
    orientations: tuple[tuple[object, Mapping[str, Any]], ...] = ()

    @cached_property
    def places(self) -> Places:
        """Where the entries of the document stand."""
        from ellipsoid_planning.scenario_places import places_of

        return Places() if self.text is None else places_of(self.text)

    def written_orientation(self, owner: object) -> Mapping[str, Any] | None:
        """The orientation of an object as it was written, None for another object."""
        index = self._index_of.get(id(owner))
        return None if index is None else self.orientations[index][1]

    @cached_property
    def _index_of(self) -> dict[int, int]:
        return {id(owner): index for index, (owner, _) in enumerate(self.orientations)}

    def __getstate__(self) -> dict[str, Any]:
        # Objects have other identities in another process.
        return {key: value for key, value in vars(self).items() if key != "_index_of"}

    def error(self, path: Path, problem: str, *, at_key: bool = False) -> ScenarioError:
        """Return the error for the entry at `path`; for a missing one, its parent's place."""
        positions = self.places.keys if at_key else self.places.values
        place = positions.get(path)
        ancestor = path
        while place is None and ancestor:
            ancestor = ancestor[:-1]
            place = self.places.values.get(ancestor)
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
