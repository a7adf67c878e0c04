"""Wall time of the command: its first run with nothing compiled, and later ones."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class CommandTimes:
    """Wall seconds of ``plan`` on a scenario: with an empty kernel cache, and afterwards.

    ``first_cpu`` is the processor time of the first run: less than its wall time on a machine
    that is busy with other things.
    """

    scenario: str
    first: float
    first_cpu: float
    later: tuple[float, ...]


def command_times(scenario: str, repeats: int, progress: Callable[[str], None]) -> CommandTimes:
    """Run ``plan`` in processes of its own, the first with a fresh cache folder."""
    with tempfile.TemporaryDirectory() as cache:
        progress(f"command: first run of plan {scenario}, compiling")
        before = os.times()
        first = _wall_time(scenario, cache)
        after = os.times()
        progress(f"command: {repeats} later runs")
        later = tuple(_wall_time(scenario, cache) for _ in range(repeats))
    cpu = after.children_user + after.children_system
    cpu -= before.children_user + before.children_system
    return CommandTimes(scenario, first, cpu, later)


def _wall_time(scenario: str, cache: str) -> float:
    command = [sys.executable, "-m", "planners.cli", "plan", scenario, "--seed", "1"]
    environment = {**os.environ, "ELLIPSOID_PLANNING_CACHE": cache}
    began = time.perf_counter()
    subprocess.run(command, env=environment, check=True, capture_output=True)  # noqa: S603
    return time.perf_counter() - began
