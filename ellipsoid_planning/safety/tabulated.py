"""The tabulated safety function: tables of link shapes first, the exact test where they fail."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.cspace.articulated_packing import bodies_of
from ellipsoid_planning.errors import TableError
from ellipsoid_planning.kernels import safety_table
from ellipsoid_planning.robots.configurations import checked_configuration
from ellipsoid_planning.safety.build import MOST_INTERVALS, Progress, fill_tables
from ellipsoid_planning.safety.exact import ExactSafety, mean_time
from ellipsoid_planning.safety.function import SafetyReport, TableReport
from ellipsoid_planning.safety.planning import RobotPlan, as_articulated, plan_tables
from ellipsoid_planning.safety.resolution import TableParameters
from ellipsoid_planning.safety.store import default_folder, kept_tables
from ellipsoid_planning.safety.table import LinkTable

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.space import CSpace

Array = NDArray[np.float64]


class TabulatedSafety:
    """Each link is looked up in its table; what that does not prove safe is tested exactly.

    A table is filled once for a link's shape and shared by identical links. It gives, for
    each cell of a grid of orientations and of sweep lines, where the link's middle is safe at all
    orientations and on all lines of the cell: the free intervals of the link grown to cover the
    cell. So the answers are those of the exact safety function.

    Attributes:
        cspace: of a robot of links, or a rigid one.
        tables: the distinct ones.
        book, offsets, intervals: all of them as kernels read them, see kernels.safety_table.
        kinematics: the robot as kernels read it.
    """

    def __init__(
        self,
        cspace: CSpace,
        parameters: TableParameters | None = None,
        *,
        folder: str | Path | None = None,
        keep: bool = True,
        workers: int | None = None,
        on_progress: Progress | None = None,
    ) -> None:
        """Load the tables, or fill and keep them.

        Args:
            cspace: of a robot of links, or a rigid one.
            parameters: resolution of tables; if None, such that they fit a processor's cache.
            folder: where tables are kept; in the user's cache, beside compiled kernels, if None.
            keep: whether tables are looked for in files, and kept in them, at all.
            workers: threads; one a core if None.
            on_progress: called with the number of lines done and of all while tables are filled.

        Raises:
            TableError: a table cannot be made, kept, or read: a file is damaged, say.
        """
        self.cspace = cspace
        self._plan = plan_tables(cspace, parameters or TableParameters())
        self.kinematics = self._plan.kinematics
        if keep:
            place = default_folder() if folder is None else Path(folder)
            self.tables = kept_tables(self._plan.tables, place, workers, on_progress)
        else:
            self.tables = fill_tables(self._plan.tables, workers, on_progress)
        self.book = _book(self._plan, self.tables)
        self.offsets, self.intervals = _stacked(self.tables)

    def is_safe(self, configuration: ArrayLike) -> bool:
        """Whether a configuration (d,) is proved safe."""
        size = self.cspace.robot.configuration_size
        return bool(self.are_safe(checked_configuration(configuration, size))[0])

    def are_safe(self, configurations: ArrayLike) -> NDArray[np.bool_]:
        """Whether each configuration (m, d) is proved safe, shape (m,)."""
        rows = self.cspace.poses(configurations)
        out = np.empty(len(rows), dtype=np.bool_)
        safety_table.are_tabulated_free(
            self.cspace.scene, self.kinematics, self.book, self.offsets, self.intervals, rows, out
        )
        return out

    def answers(self, configurations: ArrayLike) -> NDArray[np.bool_]:
        """Whether, (m, bodies), the tables alone prove each body safe, at configurations (m, d).

        Bodies are those of kernels.kinematics: links, with what is fixed to them.
        """
        rows = self.cspace.poses(configurations)
        out = np.zeros((len(rows), len(self._plan.members)), dtype=np.bool_)
        safety_table.table_answers(
            self.kinematics, self.book, self.offsets, self.intervals, rows, out
        )
        return out

    def report(self, configurations: ArrayLike | None = None) -> SafetyReport:
        """The tables, and what they cost and save on configurations (m, d), if given."""
        tables = tuple(self._table_report(index) for index in range(len(self.tables)))
        if configurations is None or not np.size(configurations):
            return SafetyReport("tabulated", tables)
        values = np.atleast_2d(np.asarray(configurations, dtype=float))
        exact = ExactSafety(self.cspace).report(values)
        asked = [body for body, index in enumerate(self._plan.table_of) if index >= 0]
        return SafetyReport(
            "tabulated",
            tables,
            states=len(values),
            safe=float(self.are_safe(values).mean()),
            answered=float(self.answers(values)[:, asked].mean()),
            lookup_time=mean_time(lambda: self.answers(values), len(values)),
            state_time=mean_time(lambda: self.are_safe(values), len(values)),
            exact_time=exact.state_time,
        )

    def _table_report(self, index: int) -> TableReport:
        table = self.tables[index]
        found = table.plan.resolution
        return TableReport(
            links=self._links_of(index),
            description=table.description,
            orientations=0 if found is None else found.orientations.count,
            lines=0 if found is None else found.lines.count,
            intervals=len(table.intervals),
            memory=table.memory,
            seconds=table.seconds,
            loaded=table.loaded,
            inflation=0.0 if found is None else found.inflation,
        )

    def _links_of(self, index: int) -> tuple[str, ...]:
        robot = as_articulated(self.cspace)
        owners = bodies_of(robot).owners.astype(int)
        names = dict.fromkeys(
            link
            for link, body in zip(robot.part_links, owners, strict=True)
            if self._plan.table_of[body] == index
        )
        return tuple(names)


def _book(plan: RobotPlan, tables: tuple[LinkTable, ...]) -> Array:
    """The book of kernels.safety_table, read-only."""
    links = np.zeros((len(plan.members), safety_table.LINK))
    for row, placed, index in zip(links, plan.shapes, plan.table_of, strict=True):
        row[safety_table.LINK_TABLE] = index
        if placed is not None:
            first, second = safety_table.LINK_MIDDLE, safety_table.LINK_TURN
            row[first : first + 3], row[second : second + 9] = placed.middle, placed.turn.ravel()
    rows, first = np.zeros((len(tables), safety_table.TABLE)), 0
    for row, table in zip(rows, tables, strict=True):
        row[:] = table.plan.row()
        row[safety_table.FIRST] = first
        first += len(table.offsets)
    begins = np.cumsum([len(plan.members) + 1, *(len(own) for own in plan.members)])
    header = np.array([len(links), len(rows)])
    book = np.concatenate([header, links.ravel(), rows.ravel(), begins, *plan.members])
    book.setflags(write=False)
    return book


def _stacked(tables: tuple[LinkTable, ...]) -> tuple[NDArray[np.int32], NDArray[np.uint16]]:
    """Offsets and intervals of all tables, one after the other, read-only."""
    offsets, intervals, first = [np.empty(0, np.int32)], [np.empty((0, 2), np.uint16)], 0
    for table in tables:
        offsets.append(table.offsets + np.int32(first))
        intervals.append(table.intervals)
        first += len(table.intervals)
        if first > MOST_INTERVALS:
            raise TableError("tables have too many intervals together; lower their memory")
    stacked = np.concatenate(offsets), np.concatenate(intervals)
    for array in stacked:
        array.setflags(write=False)
    return stacked
