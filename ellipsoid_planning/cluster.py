"""Tasks on the workers of a Dask cluster: each is done once, whatever happens to workers."""

from __future__ import annotations

import logging
import time
import uuid
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Generic, Protocol, TypeVar

from ellipsoid_planning.errors import EllipsoidPlanningError

LOCAL = "local"
"""The address that stands for workers on this machine."""

MOST_LOSSES = 3
"""A task that has lost so many workers is given up: it may be what kills them."""

_CONNECT_LIMIT = 5.0  # [s]
_WORKER_LIMIT = 30.0  # the longest time without a single worker [s]
_LOOK_EVERY = 0.1  # [s]


class ClusterError(EllipsoidPlanningError):
    """A cluster cannot be used."""


class Task(Protocol):
    """Something to do, which can be pickled."""

    @property
    def key(self) -> str:
        """Its name, unlike any other's."""


T = TypeVar("T", bound=Task)
R = TypeVar("R")


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
        # Without an address, its web server takes a known port, and complains if it is taken.
        dashboard_address="127.0.0.1:0",
        scheduler_kwargs={"dashboard": False},
        memory_limit=None,  # each task has its own, where it needs one
        host="127.0.0.1",
        preload=["ellipsoid_planning.quiet_worker"],
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


def run_on_workers(
    client: Any,
    function: Callable[[T], R],
    tasks: Sequence[T],
    stopped: Callable[[], bool],
    *,
    begins: Callable[[T], None],
    lost: Callable[[T], R],
    each_thread: bool = False,
) -> Iterator[tuple[T, R]]:
    """Each task with ``function(task)``, as they come, until ``stopped``.

    A worker that is lost costs nothing but time: its tasks are done again by others.

    Args:
        client: from `cluster_client`.
        function: what workers do; it can be pickled, and gives the same wherever it runs.
        tasks: handed out in this order.
        stopped: asked all the time.
        begins: told of each task that is handed to a worker.
        lost: what to give for a task that has lost ``MOST_LOSSES`` workers; it may raise.
        each_thread: keep all threads of each worker busy; otherwise a worker has one task.

    Raises:
        ClusterError: the scheduler or all workers are gone, or a worker cannot run our code.
    """
    dispatch = _Dispatch(client, function, tasks, begins, lost, each_thread)
    try:
        while dispatch.unfinished and not stopped():
            yield from dispatch.step()
            dispatch.wait()
    finally:
        dispatch.give_up()


class _Dispatch(Generic[T, R]):
    """Which worker does what."""

    def __init__(
        self,
        client: Any,
        function: Callable[[T], R],
        tasks: Sequence[T],
        begins: Callable[[T], None],
        lost: Callable[[T], R],
        each_thread: bool,
    ) -> None:
        self._client, self._function = client, function
        self._begins, self._give_up, self._each_thread = begins, lost, each_thread
        self._waiting = list(reversed(tasks))
        self._running: dict[str, tuple[str, T, Any]] = {}
        self._losses: Counter[str] = Counter()
        self._last_worker = time.monotonic()
        self._present: dict[str, int] = {}
        self._asked = -_LOOK_EVERY

    @property
    def unfinished(self) -> bool:
        return bool(self._waiting or self._running)

    def step(self) -> Iterator[tuple[T, R]]:
        """Collect what is done, notice lost workers, and give idle workers something to do."""
        present = self._workers()
        for key, (worker, task, future) in list(self._running.items()):
            if future.done():
                del self._running[key]
                yield from self._collected(worker, task, future)
            elif worker not in present:
                del self._running[key]
                future.cancel()
                yield from self._lost(task)
        busy = Counter(worker for worker, _, _ in self._running.values())
        for worker, threads in present.items():
            # One more than threads, so that none of them waits for this loop.
            for _ in range((threads + 1 if self._each_thread else 1) - busy[worker]):
                if self._waiting:
                    self._submit(worker, self._waiting.pop())

    def wait(self) -> None:
        """Wait a little, not longer than until a task is done."""
        end = time.monotonic() + _LOOK_EVERY
        while time.monotonic() < end:
            if any(future.done() for _, _, future in self._running.values()):
                return
            time.sleep(_LOOK_EVERY / 50)

    def give_up(self) -> None:
        """Cancel what has not begun; what has ends at its own limits."""
        for _, _, future in self._running.values():
            future.cancel()

    def _workers(self) -> dict[str, int]:
        """The threads of each worker; the scheduler is asked now and then only."""
        if time.monotonic() - self._asked < _LOOK_EVERY:
            return self._present
        try:
            present: dict[str, int] = dict(self._client.nthreads())
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
        self._present, self._asked = present, now
        return present

    def _submit(self, worker: str, task: T) -> None:
        self._begins(task)
        # No worker but this one: we know then which of them are idle.
        key = f"{task.key}-{uuid.uuid4().hex}"
        submit = self._client.submit
        future = submit(self._function, task, key=key, pure=False, workers=[worker])
        self._running[key] = worker, task, future

    def _collected(self, worker: str, task: T, future: Any) -> Iterator[tuple[T, R]]:
        if future.status == "finished":
            result: R = future.result()
            yield task, result
        elif future.status in {"cancelled", "lost"} or _is_loss(future.exception()):
            yield from self._lost(task)
        else:
            error = future.exception()
            raise ClusterError(
                f"the worker {worker} cannot run it: {type(error).__name__}: {error}; "
                "this package, in the same version, must be installed there"
            )

    def _lost(self, task: T) -> Iterator[tuple[T, R]]:
        self._losses[task.key] += 1
        if self._losses[task.key] < MOST_LOSSES:
            self._waiting.append(task)
        else:
            yield task, self._give_up(task)


def _is_loss(error: BaseException | None) -> bool:
    return type(error).__name__ in {"KilledWorker", "CancelledError", "FutureCancelledError"}
