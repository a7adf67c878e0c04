"""The highway roadmap planner, without OMPL (thesis 6.3)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import roadmap_tables
from ellipsoid_planning.kernels.grid import between
from ellipsoid_planning.kernels.robot_model import ways_are_free
from ellipsoid_planning.kernels.shortcut import shortcut
from ellipsoid_planning.metric import path_length, turn_length
from ellipsoid_planning.outcome import EXHAUSTED, SOLVED, TIMEOUT, Outcome
from ellipsoid_planning.roadmap.grid import Grid, grid_columns, most_lines
from ellipsoid_planning.roadmap.joint_layers import (
    guided_layers,
    has_few_angles,
    has_fixed_base,
    home_configuration,
    layer_metric,
)
from ellipsoid_planning.roadmap.level import Level
from ellipsoid_planning.roadmap.own_layers import only_column, own_layers
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.roadmap.passage_kernels import compile_passage_kernels, compiling_aside
from ellipsoid_planning.roadmap.passages import PassageFinder
from ellipsoid_planning.roadmap.regions import Box, is_same, query_boxes, within
from ellipsoid_planning.roadmap.shorten import shorten
from ellipsoid_planning.roadmap.store import StoredRoadmap, save
from ellipsoid_planning.roadmap.store_level import StoredLevel

Array = NDArray[np.float64]

# A finer level has this many times the lines along a side.
_MORE_LINES = 1.6
# Orientations put between those of start and goal.
_BETWEEN = 3
# Boxes that are kept; the levels of one take a few megabytes.
_MOST_BOXES = 32
_LOWER_INFLATIONS = (2.0, 1.5, 1.2, 1.0)


class HighwayRoadmap:
    """A roadmap of free intervals, built where queries look and kept for later ones.

    Later queries find the lines and edges of its grids, but not what others added to them (layers
    and columns of starts and goals, passages): each goes the way that it would go on an empty
    roadmap, with less to compute, so that neither its path nor its cost depends on how many came
    before. A query that was stopped goes on where it was when it is asked again next.

    The direct motion comes first. Then levels of growing resolution are searched until one has a
    path, which is proved motion by motion before it is given out.

    A roadmap can be saved to a file and loaded again. What a file says is proved may be wrong, so
    that paths are then proved once more from end to end; if one is refused, everything that came
    from the file is forgotten.

    Attributes:
        cspace: what is planned in.
        parameters: see RoadmapParameters.
        levels: the levels made so far, coarsest first.
        loaded: whether anything came from a file.
    """

    def __init__(self, cspace: CSpace, parameters: RoadmapParameters | None = None) -> None:
        """Prepare to plan; nothing is computed yet.

        Raises:
            PlannerError: if a parameter does not fit the C-space.
        """
        self.cspace = cspace
        self.parameters = parameters or RoadmapParameters()
        self.levels: list[Level] = []
        self.passages: list[PassageFinder] = []
        self._axis = self.parameters.checked_axis(cspace.dimension)
        turns = self.parameters.axis is None and not has_fixed_base(cspace)
        self._axes = cspace.dimension if turns else 1
        chosen = self.parameters.metric_weight
        self._weight = turn_length(cspace.robot) if chosen is None else chosen
        self._random = np.random.default_rng(self.parameters.seed)
        self._direct = 0
        self._forgotten: Counter[str] = Counter()
        self._open: tuple[Array, Array] | None = None
        self.loaded = False

    def solve(
        self,
        starts: Array,
        goals: Array,
        should_stop: Callable[[], bool],
        on_path: Callable[[Array], None] | None = None,
    ) -> Outcome:
        """Look for a path from one of ``starts`` (S, d) to one of ``goals`` (G, d).

        All must be valid. ``should_stop`` is asked every few milliseconds. With ``anytime``,
        ``on_path`` receives every better path, and the search goes on until told to stop or until
        nothing is left to try.
        """
        begin, end = self.cspace.poses(starts), self.cspace.poses(goals)
        direct = self._direct_motion(begin, end, should_stop)
        if direct is not None:
            self._direct += 1
            return self._solved(direct, on_path)
        if should_stop():
            return Outcome(TIMEOUT)
        best: Array | None = None
        self._turn_to(begin, end)
        for attempt in self._attempts(np.vstack([begin, end])):
            level = self._level(*attempt, begin, end)
            inflation = self.parameters.inflation if best is None else _LOWER_INFLATIONS[0]
            last_axis = attempt[1] == self._axes - 1
            status, path = level.solve(begin, end, inflation, self._weight, should_stop, last_axis)
            if status == roadmap_tables.SOLVED:
                if best is None and not self._holds(path):
                    self.clear()
                    return self.solve(starts, goals, should_stop, on_path)
                self._open = None
                if not self.parameters.anytime:
                    return self._solved(path, on_path)
                best = self._better(best, path, on_path)
                best = self._improve(level, begin, end, best, should_stop, on_path)
            if should_stop():
                break
        if best is not None:
            return Outcome(SOLVED, self.cspace.configurations(best))
        return Outcome(TIMEOUT if should_stop() else EXHAUSTED)

    def prepare(self) -> None:
        """Make the first level, which depends on no query; :meth:`solve` does it if need be."""
        if not self.levels:
            self.levels.append(self._new_level(0, self._axis, None))

    def clear(self) -> None:
        """Forget everything computed so far."""
        self.levels = []
        self.passages = []
        self._random = np.random.default_rng(self.parameters.seed)
        self._direct = 0
        self._forgotten = Counter()
        self._open = None
        self.loaded = False

    def save(self, path: str | Path) -> None:
        """Write the roadmap to a file, completely or not at all; an older roadmap is replaced.

        Raises:
            RoadmapError: the file cannot be written, or is there already and no roadmap.
        """
        random = self._random.bit_generator.state
        unanswered = None if self._open is None else [ends.tolist() for ends in self._open]
        state = {"direct_motions": self._direct, "random": random, "unanswered": unanswered}
        save(self, path, state)

    @classmethod
    def load(
        cls, path: str | Path, cspace: CSpace, parameters: RoadmapParameters | None = None
    ) -> HighwayRoadmap:
        """The roadmap of a file, which answers queries as the one that was saved would.

        It plans with ``parameters``, or else those that it was made with.

        Raises:
            RoadmapError: the file cannot be read, is no roadmap or a damaged one, or belongs to
                another world, robot or clearance, to parameters that make another roadmap, or to
                another version of this package.
        """
        stored = StoredRoadmap(path, cspace, parameters)
        roadmap = cls(cspace, stored.parameters)
        roadmap.restore(stored)
        return roadmap

    def restore(self, stored: StoredRoadmap) -> None:
        """Replace everything computed so far by what a file holds.

        Raises:
            RoadmapError: the file is damaged.
        """
        self.clear()
        stored.restore_levels(self._add_stored)
        stored.restore_passages(self.passages)
        stored.restore_random(self._random)
        self._direct = stored.count("direct_motions")
        self._open = stored.unanswered()
        self.loaded = True

    @property
    def statistics(self) -> dict[str, int]:
        """Counts over all levels: the work since the last :meth:`clear`, and what is known now."""
        total = {
            "levels": len(self.levels),
            "direct_motions": self._direct,
            "passages": sum(len(finder.found) for finder in self.passages),
            "seeds": sum(finder.seeds_tried for finder in self.passages),
            "closed_seeds": sum(finder.seeds_closed for finder in self.passages),
        }
        for level in self.levels:
            for name, count in level.statistics.items():
                total[name] = total.get(name, 0) + count
        for name, count in self._forgotten.items():
            total[name] = total.get(name, 0) + count
        return total

    def _turn_to(self, starts: Array, goals: Array) -> None:
        """Go on with a query that was asked last and not answered, or begin a new one."""
        query = starts, goals
        same = self._open is not None and all(map(np.array_equal, self._open, query))
        for finder in self.passages:
            finder.rest(forget=not same)
        self._open = query

    def _attempts(self, ends: Array) -> Iterator[tuple[int, int, Box | None]]:
        """What to try for queries between ``ends`` (m, 7), in turn: (refinement, turn, box).

        Finer levels come when the whole world was looked at, and begin at the ends again. The
        axes take turns, unless one was asked for, so that a scene that one axis suits costs at
        most n times what it costs with that axis.
        """
        for refinement in range(self.parameters.refine + 1):
            for box in query_boxes(self.cspace, ends):
                for turn in range(self._axes):
                    yield refinement, turn, box

    def _level(
        self, refinement: int, turn: int, box: Box | None, starts: Array, goals: Array
    ) -> Level:
        axis = (self._axis - turn) % self.cspace.dimension
        for level in self.levels:
            if (level.refinement, level.axis) == (refinement, axis) and is_same(level.box, box):
                break
        else:
            level = self._new_level(refinement, axis, box)
            self.levels.append(level)
            self._bound_boxes(box)
        level.forget_earlier_query()
        if not level.passages.begun:
            level.passages.begin(starts, goals)
        for first in starts:
            for last in goals:
                for row in self._guides(first, last):
                    level.grid.layer_of(row)
        return level

    def _bound_boxes(self, present: Box | None) -> None:
        """Forget the boxes that were made first, but not the ``present`` one, beyond so many."""
        finders = [level.passages for level in self.levels if level.box is not None]
        boxes = list(dict.fromkeys(finders))
        for finder in boxes[: max(len(boxes) - _MOST_BOXES, 0)]:
            own = [level for level in self.levels if level.passages is finder]
            if not is_same(own[0].box, present):
                for level in own:
                    self._forgotten.update(level.work)
                self.levels = [level for level in self.levels if level.passages is not finder]
                self.passages.remove(finder)

    def _guides(self, first: Array, last: Array) -> Array:
        """Layers that a query between two poses is likely to need, beside the grid's."""
        if isinstance(self.cspace, ArticulatedCSpace):
            return guided_layers(self.cspace, first, last, _BETWEEN)
        quaternions = np.empty((_BETWEEN, 4))
        if not (self.cspace.rotates and between(first[3:], last[3:], quaternions)):
            return quaternions[:0]
        return quaternions

    def _add_stored(self, stored: StoredLevel) -> Level:
        level = self._new_level(stored.refinement, stored.axis, stored.box, stored.orientations)
        self.levels.append(level)
        return level

    def _new_level(
        self, refinement: int, axis: int, box: Box | None, orientations: Array | None = None
    ) -> Level:
        """An empty level; its ``orientations`` (L, 4) are chosen here unless they are given."""
        dimension, given = self.cspace.dimension, self.parameters
        local = within(self.cspace, box)
        lines, joints = given.line_count(dimension), layer_metric(self.cspace)
        if refinement > 0:
            lines = min(round(lines * _MORE_LINES**refinement), max(lines, most_lines(dimension)))
        columns, neighbours = grid_columns(local.world, axis, lines)
        if has_fixed_base(self.cspace):
            columns, neighbours = (
                only_column(self.cspace, axis),
                np.full((1, neighbours.shape[1]), -1),
            )
        layers, near = own_layers(self.cspace, given, refinement, axis, orientations)
        joined = given.neighbour_count(dimension, articulated=len(joints) > 0)
        grid = Grid(columns, neighbours, layers, joined, joints, self._weight, near)
        guides = None
        if isinstance(self.cspace, ArticulatedCSpace):
            few = has_few_angles(self.cspace.articulated)
            guides = None if few else self._guides
        return Level(local, grid, axis, self._finder(local, box), refinement, box, guides)

    def _finder(self, cspace: CSpace, box: Box | None) -> PassageFinder:
        """The finder of passages in a box, which the box's levels share."""
        for level in self.levels:
            if is_same(level.box, box):
                return level.passages
        self.passages.append(PassageFinder(cspace))
        return self.passages[-1]

    def _direct_motion(
        self, starts: Array, goals: Array, should_stop: Callable[[], bool]
    ) -> Array | None:
        """The first motion (2, 7) from a start to a goal that is proved free, or None."""
        for start in starts:
            counts = np.empty(len(goals), dtype=np.int64)
            ways_are_free(self.cspace.model, np.tile(start, (len(goals), 1)), goals, counts)
            reached = np.flatnonzero(counts > 0)
            if len(reached):
                return np.vstack([start, goals[reached[0]]])
            if should_stop():
                break
        return None

    def _solved(self, path: Array, on_path: Callable[[Array], None] | None) -> Outcome:
        configurations = self.cspace.configurations(path)
        if on_path is not None:
            on_path(configurations)
        return Outcome(SOLVED, configurations)

    def _holds(self, path: Array) -> bool:
        """Whether a path (m, 7) may be given out: proved as configurations, if a file led to it."""
        if not self.loaded:
            return True
        rows = self.cspace.configurations(path)
        return bool(self.cspace.are_motions_valid(rows[:-1], rows[1:]).all())

    def _improve(
        self,
        level: Level,
        starts: Array,
        goals: Array,
        best: Array,
        should_stop: Callable[[], bool],
        on_path: Callable[[Array], None] | None,
    ) -> Array:
        """Better paths by lower inflations and by shortening, while that helps."""
        best = self._better(best, self._shortened(best), on_path)
        for inflation in _LOWER_INFLATIONS:
            if should_stop():
                return best
            status, path = level.solve(starts, goals, inflation, self._weight, should_stop)
            if status == roadmap_tables.SOLVED:
                best = self._better(best, self._shortened(path), on_path)
        while not should_stop():
            shorter = shorten(self.cspace, best, self._random, should_stop)
            if self._length(shorter) > (1.0 - 1e-4) * self._length(best):
                return self._better(best, shorter, on_path)
            best = self._better(best, shorter, on_path)
        return best

    def _shortened(self, path: Array) -> Array:
        kept = np.zeros(len(path), dtype=np.bool_)
        shortcut(self.cspace.model, path, kept)
        return path[kept]

    def _better(
        self, best: Array | None, path: Array, on_path: Callable[[Array], None] | None
    ) -> Array:
        shorter = best is None or self._length(path) < self._length(best)
        if best is not None and not (shorter and self._holds(path)):
            return best
        self._solved(path, on_path)
        return path

    def _length(self, path: Array) -> float:
        return path_length(self.cspace.robot, self.cspace.configurations(path))

    def compile_kernels(self) -> None:
        """Compile everything that a query can call, so that the next one's time is its own.

        For a planner made for this alone: it lays out the first level, and adds two ends to it.
        """
        with compiling_aside(isinstance(self.cspace, ArticulatedCSpace)):
            self._compile_search()
        compile_passage_kernels(self.cspace)

    def _compile_search(self) -> None:
        robot, world = self.cspace.robot, self.cspace.world
        if isinstance(self.cspace, ArticulatedCSpace):
            ends = np.repeat(home_configuration(self.cspace.articulated)[None], 2, axis=0)
        else:
            ends = np.zeros((2, robot.configuration_size))
            ends[:, : robot.dimension] = [world.low, world.high]
            if robot.rotates and robot.dimension == 3:
                ends[:, -1] = 1.0
        poses = self.cspace.poses(ends)
        self._level(0, 0, None, poses[:1], poses[1:]).compile_kernels(poses)
        if not isinstance(self.cspace, ArticulatedCSpace):
            within(self.cspace, (world.low, world.low + 1e-3 * (world.high - world.low)))
        self.cspace.is_valid(ends[0])
        self._direct_motion(poses[:1], poses[:1], lambda: True)
        if self.parameters.anytime:
            self._shortened(np.repeat(poses[:1], 2, axis=0))
