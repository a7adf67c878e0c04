"""The memory that another process takes."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

_MEGABYTE = 2.0**20


def resident_memory(pid: int) -> float | None:
    """Resident memory of a process [MB], None if it cannot be told (it may have ended)."""
    if Path("/proc/self/statm").exists():
        try:
            pages = Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1]
        except (OSError, IndexError):
            return None
        return int(pages) * os.sysconf("SC_PAGE_SIZE") / _MEGABYTE
    return _asked_of_ps(pid)


def _asked_of_ps(pid: int) -> float | None:
    command = ["ps", "-o", "rss=", "-p", str(pid)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=True)  # noqa: S603
        return int(done.stdout) / 1024.0
    except (OSError, ValueError, subprocess.CalledProcessError):
        return None
