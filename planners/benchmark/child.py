"""The process of one run; `watch` starts it."""

from __future__ import annotations

import json
import os
import signal
import sys
from pathlib import Path

from ellipsoid_planning import atomic
from ellipsoid_planning.processes import end_with
from planners.benchmark.limits import PHASE, RECORD, STARTING, TASK, phase_limit
from planners.benchmark.run import CRASHED, RunRecord, RunTask


def main() -> None:
    """Run the task in a folder, and leave a record there.

    The arguments are the folder, the watching process, and a pipe that ends with it.
    """
    folder, parent, pipe = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    end_with(parent, pipe)
    os.chdir(folder)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # who watches decides
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    task = RunTask(**json.loads(Path(TASK).read_text(encoding="utf-8")))
    _announce(task, STARTING)
    record = _record(task)
    text = json.dumps(record.to_dict(), allow_nan=False, default=lambda value: value.tolist())
    atomic.write_text(RECORD, text)
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)  # the record is there; how OMPL's globals are taken apart is of no interest


def _record(task: RunTask) -> RunRecord:
    try:
        from planners.benchmark.measured import measured_run

        return measured_run(task, lambda phase: _announce(task, phase))
    except Exception as error:  # noqa: BLE001  whatever a planner raises is recorded
        first = (str(error).strip().splitlines() or [""])[0]
        return RunRecord.of(task, CRASHED, reason=f"{type(error).__name__}: {first}".rstrip(": "))


def _announce(task: RunTask, phase: str) -> None:
    # Should nobody watch any more, the kernel ends this process, even one that holds the GIL.
    signal.alarm(int(2.0 * phase_limit(task, phase)) + 10)
    atomic.write_text(PHASE, phase)


if __name__ == "__main__":
    main()
