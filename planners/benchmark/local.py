"""The runs of a campaign on this machine."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

from ellipsoid_planning.leftovers import remove_run_folders
from planners.benchmark.run import RunRecord, RunTask
from planners.benchmark.watch import run_one

_LOOK_EVERY = 0.1  # [s]


def run_locally(
    jobs: int,
    tasks: Sequence[RunTask],
    interrupted: threading.Event,
    begins: Callable[[RunTask], None],
) -> Iterator[RunRecord]:
    """The records of ``tasks`` as they come, ``jobs`` of them at a time; ``begins`` tells of each.

    Once ``interrupted`` is set, or the caller takes no more, the running ones are killed.
    """
    remove_run_folders()
    stop = threading.Event()
    with ThreadPoolExecutor(jobs) as pool:
        try:
            yield from _as_they_come(pool, tasks, jobs, begins, interrupted, stop)
        finally:
            stop.set()


def _as_they_come(
    pool: ThreadPoolExecutor,
    tasks: Sequence[RunTask],
    jobs: int,
    begins: Callable[[RunTask], None],
    interrupted: threading.Event,
    stop: threading.Event,
) -> Iterator[RunRecord]:
    waiting = list(reversed(tasks))
    running: set[Future[RunRecord]] = set()
    while waiting or running:
        while waiting and len(running) < jobs:
            task = waiting.pop()
            begins(task)
            running.add(pool.submit(run_one, task, stop.is_set))
        done, running = wait(running, _LOOK_EVERY, FIRST_COMPLETED)
        for future in done:
            yield future.result()
        if interrupted.is_set():
            return
