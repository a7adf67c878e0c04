"""The runs of a campaign on a Dask cluster, one at a time in each of its workers."""

from __future__ import annotations

import logging
import threading
import time
import uuid
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from ellipsoid_planning.errors import EllipsoidPlanningError
from planners.benchmark.run import LOST, RunRecord, RunTask
from planners.benchmark.watch import run_one

LOCAL = "local"
"""The address that stands for workers on this machine."""

_CONNECT_LIMIT = 5.0  # [s]
_WORKER_LIMIT = 30.0  # the longest time without a single worker [s]
_LOOK_EVERY = 0.1  # [s]
_MOST_LOSSES = 3
"""A run that has lost so many workers is given up: it may be what kills them."""


class ClusterError(EllipsoidPlanningError):
    """A cluster cannot be used."""


@contextmanager
def cluster_client(address: str, workers: int = 1) -> Iterator[Any]:
    """A `distributed.Client` of the scheduler at ``address``, or of ``workers`` local processes.

    Raises:
        ClusterError: dask.distributed is not installed, the address is none, or nobody answers
            there within a few seconds.
    """
    try:
        import distributed
    except ImportError:
        raise ClusterError(
            "--cluster needs dask.distributed; "
            "install it with: pip install 'ellipsoid-planning[cluster]'"
        ) from None
    # What it has to say about lost connections and workers, we say ourselves.
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    if address == LOCAL:
        with (
            _local_cluster(distributed, workers) as cluster,
            distributed.Client(cluster, timeout=_WORKER_LIMIT) as client,
        ):
            yield client
        return
    client = _connected(distributed, address)
    try:
        yield client
    finally:
        client.close()


def _local_cluster(distributed: Any, workers: int) -> Any:
    return distributed.LocalCluster(
        n_workers=workers,
        threads_per_worker=1,
        processes=True,
        dashboard_address=None,
        memory_limit=None,  # each run has its own
        host="127.0.0.1",
        preload=["planners.benchmark.quiet_worker"],
    )


def _connected(distributed: Any, address: str) -> Any:
    try:
        return distributed.Client(address, timeout=_CONNECT_LIMIT)
    except (OSError, TimeoutError, ValueError, TypeError) as error:
        reason = (str(error).strip().splitlines() or [type(error).__name__])[0]
        raise ClusterError(
            f"--cluster {address}: no Dask scheduler can be reached there ({reason}); "
            "give its address, such as tcp://10.0.0.5:8786, or local"
        ) from None


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
    dispatch = _Dispatch(client, tasks, begins)
    try:
        while dispatch.unfinished and not interrupted.is_set():
            yield from dispatch.step()
            time.sleep(_LOOK_EVERY)
    finally:
        dispatch.give_up()


class _Dispatch:
    """Which worker does what."""

    def __init__(
        self, client: Any, tasks: Sequence[RunTask], begins: Callable[[RunTask], None]
    ) -> None:
        self._client, self._begins = client, begins
        self._waiting = list(reversed(tasks))
        self._running: dict[str, tuple[RunTask, Any]] = {}
        self._losses: Counter[str] = Counter()
        self._last_worker = time.monotonic()

    @property
    def unfinished(self) -> bool:
        return bool(self._waiting or self._running)

    def step(self) -> Iterator[RunRecord]:
        """Collect what is done, notice lost workers, and give idle workers something to do."""
        present = self._workers()
        for worker, (task, future) in list(self._running.items()):
            if future.done():
                del self._running[worker]
                yield from self._collected(worker, task, future)
            elif worker not in present:
                del self._running[worker]
                future.cancel()
                yield from self._lost(task)
        for worker in present:
            if self._waiting and worker not in self._running:
                self._running[worker] = self._submitted(worker, self._waiting.pop())

    def give_up(self) -> None:
        """Cancel what has not begun; what has ends at its own limits."""
        for _, future in self._running.values():
            future.cancel()

    def _workers(self) -> list[str]:
        try:
            present = list(self._client.nthreads())
        except (OSError, TimeoutError) as error:
            raise ClusterError(f"the connection to the cluster is lost: {error}") from None
        now = time.monotonic()
        if present:
            self._last_worker = now
        elif now - self._last_worker > _WORKER_LIMIT:
            raise ClusterError(
                f"the cluster has had no worker for {_WORKER_LIMIT:g} s; start some, "
                "and give the same command to go on"
            )
        return present

    def _submitted(self, worker: str, task: RunTask) -> tuple[RunTask, Any]:
        self._begins(task)
        # No worker but this one: we know then which of them are idle, whatever their threads.
        key = f"{task.key}-{uuid.uuid4().hex}"
        future = self._client.submit(run_one, task, key=key, pure=False, workers=[worker])
        return task, future

    def _collected(self, worker: str, task: RunTask, future: Any) -> Iterator[RunRecord]:
        if future.status == "finished":
            record: RunRecord = future.result()
            yield record
        elif future.status in {"cancelled", "lost"} or _is_loss(future.exception()):
            yield from self._lost(task)
        else:
            error = future.exception()
            raise ClusterError(
                f"the worker {worker} cannot run it: {type(error).__name__}: {error}; "
                "this package, in the same version, must be installed there"
            )

    def _lost(self, task: RunTask) -> Iterator[RunRecord]:
        self._losses[task.key] += 1
        if self._losses[task.key] < _MOST_LOSSES:
            self._waiting.append(task)
            return
        reason = f"{_MOST_LOSSES} workers were lost while they ran it"
        yield RunRecord.of(task, LOST, reason=reason)


def _is_loss(error: BaseException | None) -> bool:
    return type(error).__name__ in {"KilledWorker", "CancelledError", "FutureCancelledError"}
