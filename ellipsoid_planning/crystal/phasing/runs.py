"""Long work in pieces: in threads here or on a cluster's workers, kept and continued.

The pieces' results come in the pieces' order, so that everything that follows is the same whoever
did the work, and however often it was interrupted.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import lru_cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cluster import ClusterError, cluster_client, run_on_workers
from ellipsoid_planning.crystal.packing.fingerprint import received_model, sent_model
from ellipsoid_planning.crystal.packing.grid import ArrangementGrid
from ellipsoid_planning.crystal.packing.grid_search import GridSearch
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.phasing.run_store import Keeper, Nowhere, array_bytes, bytes_array

Integers = NDArray[np.int64]

AT_A_TIME = 1 << 21
"""A piece of a search has about so many arrangements: a tenth of a second, a few megabytes."""

POSES_AT_A_TIME = 1 << 14
"""Nor more base poses: each costs some microseconds, more for a molecule of many parts."""

MOST_PIECES = 4096
"""A larger search has larger pieces, not more."""

LOOK_EVERY = 0.1  # [s]


@dataclass(frozen=True)
class Piece:
    """A part of a stage of work: the items ``first`` to ``last`` - 1 of something.

    Attributes:
        stage: its name, such as ``search``.
        number: the place among its stage's pieces, from 0.
        first, last: the items; base poses of a grid, for example.
        data: what else the work needs to know, if anything.
    """

    stage: str
    number: int
    first: int
    last: int
    data: Any = field(default=None, compare=False, repr=False)

    @property
    def key(self) -> str:
        """Its name in a store."""
        return f"{self.stage}/{self.number:06d}"


Work = Callable[[Piece], NDArray[Any]]
"""Does a piece; it can be pickled for a cluster, and threads may call it together."""

Execute = Callable[
    [Work, Sequence[Piece], Callable[[], bool]], "Iterator[tuple[Piece, NDArray[Any]]]"
]
"""Does pieces until it is stopped, and gives the results as they come, in any order."""


def pieces(stage: str, items: int, size: int) -> tuple[Piece, ...]:
    """So many items in pieces of a size; the last one may be smaller."""
    starts = range(0, items, size)
    return tuple(Piece(stage, n, s, min(s + size, items)) for n, s in enumerate(starts))


def piece_size(grid: ArrangementGrid) -> int:
    """How many base poses a piece of a grid's search has; it depends on the grid alone.

    Whole turns, where they are not more: all shifts of one turn are ranked fastest together.
    """
    share = min(AT_A_TIME // grid.joint_count, POSES_AT_A_TIME)
    share = max(share, -(-grid.base_poses // MOST_PIECES))
    shifts = math.prod(len(r.values) for r in grid.ranges[: grid.shift_count])
    return max(1, share // shifts * shifts, share if share < shifts else 1)


def search_pieces(
    grid: ArrangementGrid, size: int | None = None, stage: str = "search"
) -> tuple[Piece, ...]:
    """The pieces of a grid's search, in base poses."""
    return pieces(stage, grid.base_poses, size or piece_size(grid))


@dataclass(frozen=True, eq=False)
class FreeArrangements:
    """The work of a search: the numbers of a piece's free arrangements, ascending.

    It is pickled as its model's document; each process makes the tables once.
    """

    model: PackingModel

    def __call__(self, piece: Piece) -> Integers:
        """The numbers of the free arrangements with the base poses of a piece."""
        return _search_of(self.model).free(piece.first, piece.last)

    def __reduce__(self) -> tuple[Any, ...]:
        return _received, (sent_model(self.model),)


@lru_cache(maxsize=4)
def _search_of(model: PackingModel) -> GridSearch:
    return GridSearch(model)


def _received(sent: tuple[str, str]) -> FreeArrangements:
    return FreeArrangements(received_model(sent))


def done(
    work: Work,
    wanted: Sequence[Piece],
    execute: Execute,
    store: Keeper | None = None,
    *,
    stopped: Callable[[], bool] = lambda: False,
    on_piece: Callable[[Piece], None] = lambda _: None,
) -> Iterator[tuple[Piece, NDArray[Any]]]:
    """The results of all pieces, in order; what the store has is taken from it, the rest is done.

    Args:
        work: what is done with a piece.
        wanted: the pieces, numbered in order.
        execute: who does it.
        store: where finished pieces are kept, and looked for.
        stopped: asked all the time; once it says True, no piece is begun any more.
        on_piece: told of each piece that has been done or was found, for a progress bar.

    Raises:
        KeyboardInterrupt: it was stopped; everything that was finished by then is kept.
    """
    keeper = Nowhere() if store is None else store
    found: dict[str, NDArray[Any] | None] = {}
    for piece in wanted:
        if _kept(keeper, piece) is not None:
            found[piece.key] = None  # read again when its turn comes
            on_piece(piece)
    missing = [piece for piece in wanted if piece.key not in found]
    waiting = deque(wanted)
    with _closing(execute(work, missing, stopped)) as results:
        yield from _in_turn(waiting, found, keeper)
        for piece, result in results:
            keeper.keep(piece.key, array_bytes(result))
            found[piece.key] = result
            on_piece(piece)
            yield from _in_turn(waiting, found, keeper)
    if waiting:
        raise KeyboardInterrupt


def _kept(keeper: Keeper, piece: Piece) -> NDArray[Any] | None:
    content = keeper.kept(piece.key)
    try:
        return None if content is None else bytes_array(content)
    except ValueError:  # it is no piece of ours, so that it is done again
        return None


def _in_turn(
    waiting: deque[Piece], found: dict[str, NDArray[Any] | None], keeper: Keeper
) -> Iterator[tuple[Piece, NDArray[Any]]]:
    """The results whose turn has come."""
    while waiting and waiting[0].key in found:
        piece = waiting.popleft()
        result = found.pop(piece.key)
        if result is None:
            result = _kept(keeper, piece)
        if result is None:
            raise ClusterError(f"{piece.key}: its file vanished meanwhile; give the command again")
        yield piece, result


@contextmanager
def _closing(results: Iterator[Any]) -> Iterator[Iterator[Any]]:
    try:
        yield results
    finally:
        close = getattr(results, "close", None)
        if close is not None:
            close()


def in_threads(count: int) -> Execute:
    """Pieces by so many threads of this process."""
    return partial(_run_in_threads, count)


def _run_in_threads(
    count: int, work: Work, wanted: Sequence[Piece], stopped: Callable[[], bool]
) -> Iterator[tuple[Piece, NDArray[Any]]]:
    waiting = deque(wanted)
    running: dict[Future[NDArray[Any]], Piece] = {}
    with ThreadPoolExecutor(count) as pool:
        while (waiting and not stopped()) or running:
            # One more than threads, so that none waits for this loop.
            while waiting and len(running) <= count and not stopped():
                piece = waiting.popleft()
                running[pool.submit(work, piece)] = piece
            ready, _ = wait(running, LOOK_EVERY, FIRST_COMPLETED)
            for future in ready:
                yield running.pop(future), future.result()


@contextmanager
def on_cluster(address: str, workers: int) -> Iterator[Execute]:
    """Pieces by the workers of a Dask cluster, one a thread; ``local`` starts workers here.

    Raises:
        ClusterError: the cluster cannot be reached.
    """
    with cluster_client(address, workers) as client:
        yield partial(_run_on_cluster, client)


def _run_on_cluster(
    client: Any, work: Work, wanted: Sequence[Piece], stopped: Callable[[], bool]
) -> Iterator[tuple[Piece, NDArray[Any]]]:
    yield from run_on_workers(
        client, work, wanted, stopped, begins=lambda _: None, lost=_lost, each_thread=True
    )


def _lost(piece: Piece) -> NDArray[Any]:
    raise ClusterError(
        f"several workers were lost while they did {piece.key}; see what ends them "
        "(memory?), and give the same command to go on"
    )
