"""The runs of a campaign on a Dask cluster, one at a time in each of its workers."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from ellipsoid_planning.cluster import (
    LOCAL,
    MOST_LOSSES,
    ClusterError,
    cluster_client,
    run_on_workers,
)
from planners.benchmark.run import LOST, RunRecord, RunTask
from planners.benchmark.watch import run_one

__all__ = ["LOCAL", "ClusterError", "cluster_client", "run_on_cluster"]


def run_on_cluster(
    client: Any,
    tasks: Sequence[RunTask],
    interrupted: threading.Event,
    begins: Callable[[RunTask], None],
) -> Iterator[RunRecord]:
    """The records of ``tasks`` as they come; ``begins`` tells of each that is handed to a worker.

    A worker that is lost costs nothing but time: its run is done again by another.

    Raises:
        ClusterError: the scheduler or all workers are gone, or a worker cannot run our code.
    """
    stopped = interrupted.is_set
    for _, record in run_on_workers(client, run_one, tasks, stopped, begins=begins, lost=_lost):
        yield record


def _lost(task: RunTask) -> RunRecord:
    return RunRecord.of(task, LOST, reason=f"{MOST_LOSSES} workers were lost while they ran it")
