"""The same campaign on a cluster of this machine: equal in everything but time."""

import os
import signal
import threading
from dataclasses import replace

import pytest

from planners.benchmark.cluster import ClusterError, cluster_client, run_on_cluster
from planners.benchmark.watch import run_one
from tests.benchmark.runs import stubborn, task

pytest.importorskip("distributed")

# The cluster's own processes end a little after it is closed.
pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestWarning")


@pytest.fixture(scope="module")
def client():
    with cluster_client("local", workers=2) as connected:
        yield connected


def collected(client, tasks, begins=lambda _: None):
    interrupted = threading.Event()
    found = {run.key: run for run in run_on_cluster(client, tasks, interrupted, begins)}
    assert len(found) == len(tasks)
    return [found[wanted.key] for wanted in tasks]


def without_times(record):
    path = None if record.result is None else record.result["path"]
    kept = replace(record, seconds=0.0, simplification=None, memory=None, log=None, result=None)
    return kept, path


def test_a_cluster_run_equals_a_local_run_in_everything_but_time(client):
    tasks = [task("HighwayRoadmap"), task("RRTConnect"), stubborn("Aborting"), stubborn("Lying")]
    there, here = collected(client, tasks), [run_one(wanted) for wanted in tasks]
    assert [without_times(run) for run in there] == [without_times(run) for run in here]


def test_the_runs_of_a_killed_worker_are_done_again(client):
    tasks = [stubborn("Sleeping", run=run, time_limit=1.5) for run in range(3)]
    begun = []

    def kill_the_first(started):
        begun.append(started.key)
        if len(begun) == 2:
            pids = list(client.run(os.getpid).values())
            threading.Timer(0.5, os.kill, (pids[0], signal.SIGKILL)).start()

    runs = collected(client, tasks, kill_the_first)
    assert [run.status for run in runs] == ["timeout"] * 3
    assert len(begun) > len(tasks)


def test_two_clusters_get_along(client):
    with cluster_client("local", workers=1) as other:
        assert other.scheduler.address != client.scheduler.address


def test_an_interrupt_ends_the_campaign(client):
    interrupted = threading.Event()
    threading.Timer(0.5, interrupted.set).start()
    tasks = [stubborn("Sleeping", run=run, time_limit=2.0) for run in range(8)]
    assert list(run_on_cluster(client, tasks, interrupted, lambda _: None)) == []


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "nonsense"])
def test_nobody_there(address):
    with pytest.raises(ClusterError, match="no Dask scheduler"), cluster_client(address):
        pass
