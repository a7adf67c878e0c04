"""Filling tables, by several threads: kernels let go of Python's lock."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.packing import pack_parts
from ellipsoid_planning.errors import GeometryError, TableError
from ellipsoid_planning.kernels import layout, safety_sweep
from ellipsoid_planning.safety.table import LinkTable, TablePlan
from ellipsoid_planning.world import World

Array = NDArray[np.float64]
Chunk = tuple[NDArray[np.int32], NDArray[np.uint16]]

Progress = Callable[[int, int], None]
"""Called with how many lines of all tables are done, and how many there are."""

_LINES_AT_A_TIME = 1 << 13
_ROOM_PER_LINE = 4
MOST_INTERVALS = (1 << 31) - 1


def fill_tables(
    plans: Sequence[TablePlan], workers: int | None = None, on_progress: Progress | None = None
) -> tuple[LinkTable, ...]:
    """The tables of ``plans``, the same whatever the number of ``workers`` (one a core if None).

    ``on_progress`` is called in the thread of the caller.

    Raises:
        TableError: ``workers`` is not positive, or a table would have more than 2^31 intervals.
    """
    if workers is not None and workers < 1:
        raise TableError(f"workers: expected a positive whole number, got {workers!r}")
    _compile()
    total, done, tables = sum(plan.size for plan in plans), 0, []

    def on_lines(count: int) -> None:
        nonlocal done
        done += count
        if on_progress is not None:
            on_progress(done, total)

    with ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
        for plan in plans:
            began = time.perf_counter()
            chunks = _chunks(pool, plan, on_lines)
            tables.append(_joined(plan, chunks, time.perf_counter() - began))
    return tuple(tables)


def _compile() -> None:
    """Have the kernel compiled before anything is timed: no orientation, no world."""
    three, none = np.zeros(3), np.empty(0, dtype=np.int32)
    counts, out = np.zeros(3, dtype=np.int64), np.empty((0, 2), dtype=np.uint16)
    scene, quaternions = np.zeros(layout.HEADER), np.empty((0, 4))
    scene.setflags(write=False)
    safety_sweep.sweep(scene, quaternions, 0, three, three, counts, 0.0, 1.0, none, out)


def table_scene(plan: TablePlan) -> Array | None:
    """The packed scene of the inflated link, or None if no place is free at that inflation."""
    found = plan.resolution
    if found is None:
        return None
    n, world, shape = plan.world.dimension, plan.world, plan.shape
    box = World(found.lines.low[:n], found.lines.high[:n], world.obstacles, world.arenas)
    rows = shape.part_rows()
    try:
        bare = pack_parts(box, rows, shape.radius, plan.clearance)
        # Forward kinematics rounds too, by some 10 units for each joint, which the robot's scale
        # counts: 4e-12 of it is 500 times as much. The look-up takes five roundings of numbers of
        # the table's size, and cells are widened by 1e-9 of themselves.
        rounding = 4.0 * layout.TOLERANCE * max(float(bare[layout.SCALE]), plan.scale)
        inflated = plan.clearance + found.inflation + rounding
        return pack_parts(box, rows, shape.radius, inflated)
    except GeometryError:
        return None


def _chunks(
    pool: ThreadPoolExecutor, plan: TablePlan, on_lines: Callable[[int], None]
) -> list[Chunk]:
    scene = table_scene(plan)
    if scene is None or plan.resolution is None:
        on_lines(plan.size)
        return [(np.zeros(plan.size, dtype=np.int32), np.empty((0, 2), dtype=np.uint16))]
    lines = plan.resolution.lines.count
    quaternions = plan.resolution.orientations.quaternions()
    pieces = list(_pieces(quaternions, max(1, _LINES_AT_A_TIME // lines)))
    futures: list[Future[Chunk]] = [pool.submit(_fill, plan, scene, piece) for piece in pieces]
    counts = {future: len(piece) * lines for future, piece in zip(futures, pieces, strict=True)}
    try:
        for future in as_completed(futures):
            future.result()
            on_lines(counts[future])
    except BaseException:
        for future in futures:
            future.cancel()
        raise
    return [future.result() for future in futures]


def _pieces(quaternions: Array, size: int) -> Iterator[Array]:
    for first in range(0, len(quaternions), size):
        yield quaternions[first : first + size].copy()


def _fill(plan: TablePlan, scene: Array, quaternions: Array) -> Chunk:
    """Sizes (lines,) and intervals (k, 2) of all lines at some orientations."""
    assert plan.resolution is not None  # noqa: S101
    lines = plan.resolution.lines
    sizes = np.zeros(len(quaternions) * lines.count, dtype=np.int32)
    room = _ROOM_PER_LINE * len(sizes)
    counts = np.array(lines.counts, dtype=np.int64)
    while True:
        out = np.empty((room, 2), dtype=np.uint16)
        used = safety_sweep.sweep(
            scene, quaternions, lines.axis, lines.low, lines.spacing, counts,
            float(lines.low[lines.axis]), plan.ticks_per_length, sizes, out,
        )  # fmt: skip
        if used <= room:
            return sizes, out[:used].copy()
        room = used


def _joined(plan: TablePlan, chunks: list[Chunk], seconds: float) -> LinkTable:
    offsets = np.zeros(plan.size + 1, dtype=np.int64)
    np.cumsum(np.concatenate([sizes for sizes, _ in chunks]), out=offsets[1:])
    if offsets[-1] > MOST_INTERVALS:
        raise TableError("a table has too many intervals; lower its lines or orientations")
    intervals = np.concatenate([found for _, found in chunks])
    return LinkTable(plan, offsets.astype(np.int32), intervals, seconds)
