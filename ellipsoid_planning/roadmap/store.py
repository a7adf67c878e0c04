"""Roadmaps are saved to files, and loaded for later queries on the same scene.

A file is refused for any other scene. What it holds as proved is believed in the search, and no
further: whatever a loaded roadmap gives out is proved again (HighwayRoadmap.solve).
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import EllipsoidPlanningError
from ellipsoid_planning.roadmap.fingerprint import (
    differences,
    fingerprint,
    shape_differences,
    shape_of,
)
from ellipsoid_planning.roadmap.level import Level
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.roadmap.passages import Passage, PassageFinder
from ellipsoid_planning.roadmap.regions import within
from ellipsoid_planning.roadmap.store_format import read_document, write_document
from ellipsoid_planning.roadmap.store_level import StoredLevel, level_arrays, level_header

if TYPE_CHECKING:
    from ellipsoid_planning.roadmap.highway import HighwayRoadmap

Array = NDArray[np.float64]
LevelMaker = Callable[[StoredLevel], Level]


def save(roadmap: HighwayRoadmap, path: str | Path, state: dict[str, Any]) -> None:
    """Write a roadmap with ``state``, its own data for JSON, to a file.

    Raises:
        RoadmapError: the file cannot be written, or is there already and no roadmap.
    """
    header: dict[str, Any] = {
        **fingerprint(roadmap.cspace),
        "parameters": vars(roadmap.parameters),
        "state": state,
        "levels": [level_header(level) for level in roadmap.levels],
        "passages": [
            {"seeds_tried": int(finder.seeds_tried), "seeds_closed": int(finder.seeds_closed)}
            for finder in roadmap.passages
        ],
    }
    arrays: dict[str, NDArray[Any]] = {}
    for k, level in enumerate(roadmap.levels):
        arrays |= {f"levels[{k}].{name}": array for name, array in level_arrays(level).items()}
    for k, finder in enumerate(roadmap.passages):
        arrays |= {f"passages[{k}].{name}": array for name, array in _passages(finder).items()}
    write_document(path, header, arrays)


def _passages(finder: PassageFinder) -> dict[str, NDArray[Any]]:
    none = np.empty((0, finder.cspace.pose_size))
    return {
        "poses": np.concatenate([none, *(found.poses for found in finder.found)]),
        "sizes": np.array([len(found.poses) for found in finder.found], dtype=np.int64),
        "lengths": np.array([found.length for found in finder.found], dtype=float),
    }


class StoredRoadmap:
    """A roadmap's file that fits a scene.

    Attributes:
        parameters: those to plan with.
        state: what was given to :func:`save`.
    """

    def __init__(
        self, path: str | Path, cspace: CSpace, parameters: RoadmapParameters | None = None
    ) -> None:
        """Read the file at ``path``, for ``parameters`` or else those that it was made with.

        Raises:
            RoadmapError: the file cannot be read, is no roadmap or a damaged one, or belongs to
                another scene, other parameters, or another version of this package.
        """
        self._document, self._cspace = read_document(path), cspace
        self._check_scene(fingerprint(cspace))
        own = self._own_parameters()
        self.parameters = own if parameters is None else parameters
        shapes = [shape_of(given, cspace.dimension) for given in (own, self.parameters)]
        if found := shape_differences(*shapes):
            raise self._document.refusal(
                f"expected a roadmap of these parameters, got {', '.join(found)}"
            )
        self.state: dict[str, Any] = self._entry("state", dict)

    def _check_scene(self, present: dict[str, Any]) -> None:
        stored = {name: self._document.header.get(name) for name in present}
        if found := differences(stored, present):
            raise self._document.refusal(
                f"expected a roadmap of this scene, got one of {', '.join(found)}"
            )

    def _own_parameters(self) -> RoadmapParameters:
        try:
            return RoadmapParameters(**self._entry("parameters", dict))
        except (TypeError, EllipsoidPlanningError) as error:
            raise self._document.error(f"parameters: {error}") from None

    def _entry(self, name: str, kind: type) -> Any:
        value = self._document.header.get(name)
        if not isinstance(value, kind):
            raise self._document.error(f"{name}: this entry is missing or wrong")
        return value

    def count(self, name: str) -> int:
        """The count ``state[name]``."""
        return self._document.number(f"state.{name}", self.state)

    def unanswered(self) -> tuple[Array, Array] | None:
        """Starts (S, 7 + V) and goals (G, 7 + V) of a query that has found no path yet, or None."""
        if self.state.get("unanswered") is None:
            return None
        try:
            starts, goals = (np.array(ends, dtype=float) for ends in self.state["unanswered"])
        except (TypeError, ValueError):
            raise self._document.error("state.unanswered: expected starts and goals") from None
        return starts, goals

    def restore_random(self, random: np.random.Generator) -> None:
        """Let ``random`` go on as the generator whose state is ``state['random']``."""
        try:
            random.bit_generator.state = self.state["random"]
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            raise self._document.error(f"state.random: {error!r}") from None

    def restore_levels(self, add_level: LevelMaker) -> None:
        """Fill the levels that ``add_level`` makes one after the other."""
        for index, entry in enumerate(self._entry("levels", list)):
            if not isinstance(entry, dict):
                raise self._document.error(f"levels[{index}]: expected an entry of a level")
            stored = StoredLevel(self._document, index, self._cspace)
            try:
                level = add_level(stored)
            except EllipsoidPlanningError as error:
                raise self._document.error(f"levels[{index}]: {error}") from None
            stored.fill(level, within(self._cspace, stored.box).model)

    def restore_passages(self, finders: list[PassageFinder]) -> None:
        """Enter the passages found, and how many places were looked at, in empty ``finders``."""
        entries = self._entry("passages", list)
        if len(entries) != len(finders):
            raise self._document.error(f"passages: expected {len(finders)} entries")
        for index, (entry, finder) in enumerate(zip(entries, finders, strict=True)):
            place = f"passages[{index}]"
            if not isinstance(entry, dict):
                raise self._document.error(f"{place}: expected an entry of passages")
            finder.seeds_tried = self._document.number(f"{place}.seeds_tried", entry)
            finder.seeds_closed = self._document.number(f"{place}.seeds_closed", entry)
            finder.found.extend(self._stored_passages(place))

    def _stored_passages(self, place: str) -> list[Passage]:
        poses = self._document.array(f"{place}.poses", float, None, self._cspace.pose_size)
        sizes = self._document.array(f"{place}.sizes", int, None)
        lengths = self._document.array(f"{place}.lengths", float, len(sizes))
        # The sum of many might wrap around to what is expected.
        if np.any((sizes < 2) | (sizes > len(poses))) or sum(sizes.tolist()) != len(poses):
            raise self._document.error(f"{place}.sizes: expected two or more poses a passage")
        if np.any(lengths < 0.0) or not poses[:, 3:7].any(axis=1).all():
            raise self._document.error(f"{place}: expected lengths and poses")
        ends = np.cumsum(sizes)
        return [
            Passage(poses[end - size : end], float(length))
            for end, size, length in zip(ends, sizes, lengths, strict=True)
        ]
