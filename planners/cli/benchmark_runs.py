"""The runs of a campaign, with their progress on stderr."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, Protocol

from ellipsoid_planning.errors import PlannerError
from planners.cli.progress import bar
from planners.cli.terminal import say

if TYPE_CHECKING:
    from planners.benchmark.campaign import Campaign
    from planners.benchmark.run import RunRecord, RunTask
    from planners.benchmark.store import Store


class _Progress(Protocol):
    """How far a campaign is."""

    def begins(self, task: RunTask) -> None:
        """A run begins."""

    def ends(self, record: RunRecord) -> None:
        """A run has ended."""


Execute = Callable[
    ["Sequence[RunTask]", threading.Event, "Callable[[RunTask], None]"], "Iterator[RunRecord]"
]
"""Runs tasks until it is interrupted, says which one begins, and gives records as they come."""


@contextmanager
def executor(cluster: str | None, jobs: int) -> Iterator[Execute]:
    """What runs tasks: ``jobs`` processes on this machine, or a Dask cluster at an address.

    Raises:
        EllipsoidPlanningError: the cluster cannot be reached.
    """
    if cluster is None:
        from planners.benchmark.local import run_locally

        yield partial(run_locally, jobs)
        return
    from planners.benchmark.cluster import LOCAL, cluster_client, run_on_cluster

    if cluster != LOCAL and jobs != 1:
        raise PlannerError(
            "--jobs is for this machine; each worker of a cluster runs one at a time"
        )
    with cluster_client(cluster, jobs) as client:
        yield partial(run_on_cluster, client)


def run_campaign(
    campaign: Campaign, store: Store, execute: Execute, interrupted: threading.Event
) -> list[RunRecord]:
    """Run what the store does not hold yet, keep every run at once, and return all there is."""
    tasks = list(campaign.tasks())
    records = {task.key: store.finished(task) for task in tasks}
    missing = [task for task in tasks if records[task.key] is None]
    if len(missing) < len(tasks):
        say(f"Going on: {len(tasks) - len(missing)} of {len(tasks)} runs are there already.")
    if missing:
        with _progress(len(tasks), len(tasks) - len(missing), campaign.runs) as progress:
            for record in execute(missing, interrupted, progress.begins):
                store.keep(record)
                records[record.key] = record
                progress.ends(record)
    return [record for record in records.values() if record is not None]


@contextmanager
def _progress(total: int, done: int, runs: int) -> Iterator[_Progress]:
    if not sys.stderr.isatty():
        yield _Lines(total, done)
        return
    with bar(total, done) as update:
        yield _Bar(update, runs)


class _Bar:
    """A bar for a terminal, with what is running now."""

    def __init__(self, update: Callable[[str | None, int], None], runs: int) -> None:
        self._update, self._runs = update, runs

    def begins(self, task: RunTask) -> None:
        text = f"{task.label} · run {task.run + 1} of {self._runs} · {task.problem}"
        self._update(text, 0)

    def ends(self, _: RunRecord) -> None:
        self._update(None, 1)


class _Lines:
    """A line for each run that has ended, for files and pipes."""

    def __init__(self, total: int, done: int) -> None:
        self._total, self._done = total, done

    def begins(self, task: RunTask) -> None:
        """Nothing is said yet."""

    def ends(self, record: RunRecord) -> None:
        from planners.benchmark.tables import duration

        self._done += 1
        how = duration(record.seconds) if record.solved else record.reason
        where = f"{record.problem}, {record.label}, run {record.run + 1}"
        say(f"[{self._done}/{self._total}] {where}: {record.status}, {how}")
