"""Runs the command line in a process of its own, as a user does."""

import subprocess
import sys

COMMAND = (sys.executable, "-m", "planners.cli")


def run(*arguments, folder=None, timeout=900):
    """The finished process of `ellipsoid-planning` with these arguments, run in a folder."""
    return subprocess.run(
        [*COMMAND, *map(str, arguments)],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=timeout,
        stdin=subprocess.DEVNULL,
        check=False,
    )


def refused(done, *words):
    """Whether a run ended with 2, one message with these words, no traceback and no result."""
    assert done.returncode == 2, (done.stdout, done.stderr)
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    errors = [line for line in done.stderr.splitlines() if line.startswith("Error: ")]
    assert len(errors) == 1, done.stderr
    for word in words:
        assert word in errors[0]
    return True
