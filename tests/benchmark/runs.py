"""Tasks, records and problems for the tests of benchmarks."""

from ellipsoid_planning.scenario import Scenario
from planners.benchmark.run import RunRecord, RunTask

MODULE = "tests.benchmark.stubborn_planners"

WALL = {
    "format": 1,
    "name": "wall",
    "dimension": 2,
    "bounds": {"low": [-6.0, -6.0], "high": [6.0, 6.0]},
    "obstacles": [{"name": "wall", "semi_axes": [0.5, 4.0]}],
    "robot": {"parts": [{"name": "hull", "semi_axes": [0.6, 0.3]}]},
    "start": {"position": [-4.0, 0.0]},
    "goal": {"position": [4.0, 0.0]},
}


def task(planner="HighwayRoadmap", **changes):
    """A task on the wall."""
    entries = {
        "problem": "wall",
        "scenario": Scenario.from_dict(WALL).to_dict(),
        "planner": planner,
        "checker": "plugin",
        "label": planner.rpartition(":")[2],
        "run": 0,
        "seed": 1,
        "time_limit": 5.0,
        "memory_limit": 1000.0,
        **changes,
    }
    return RunTask(**entries)


def stubborn(name, **changes):
    """A task for a planner that misbehaves."""
    return task(f"{MODULE}:{name}", **changes)


def record(label="RRT", run=0, status="solved", problem="wall", **changes):
    """A record as a run might leave it."""
    entries = {
        "problem": problem,
        "planner": label.split()[0],
        "checker": "fcl" if "fcl" in label else "plugin",
        "label": label,
        "run": run,
        "seed": run + 1,
        "status": status,
        **changes,
    }
    return RunRecord(**entries)
