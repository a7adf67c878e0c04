"""What killed processes have left behind: found by its name, and removed by the next one.

Whoever works on a file or in a folder of ours holds a lock on it, which the system takes away
when the process ends, however it ends. So what nobody holds is left over.
"""

from __future__ import annotations

import fcntl
import os
import re
import shutil
import stat
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ellipsoid_planning.trusted_folder import PREFIX

RUN_PREFIX = f"{PREFIX}run-"
"""How the names of the folders of single runs in the temporary one begin."""

_PARTIAL = re.compile(r"\..+\.(\d+)\.part")
_LOCK = "lock"
_OLD = 86_400.0
"""What nobody holds, but may be about to, is left over after this time [s]."""


@contextmanager
def locked(descriptor: int) -> Iterator[None]:
    """Show for the length of the block that somebody works on an open file.

    Where the file system has no locks, nothing is shown.
    """
    with suppress(OSError):
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    yield


@contextmanager
def run_folder() -> Iterator[Path]:
    """A new temporary folder for a single run, removed after the block, with a file ``lock``."""
    with tempfile.TemporaryDirectory(prefix=RUN_PREFIX) as name:
        folder, new = Path(name), Path(name, "new-lock")
        with new.open("wb") as lock, locked(lock.fileno()):
            new.rename(folder / _LOCK)  # nobody ever finds it unlocked
            yield folder


def remove_partial_files(folder: Path) -> None:
    """Remove the half-written files of processes that are gone from a folder, not from below."""
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            match = _PARTIAL.fullmatch(entry.name)
            if match is None or not _is_own(entry, stat.S_ISREG):
                continue
            gone = not _is_running(int(match.group(1))) or _age(entry) > _OLD
            if gone and not _is_held(Path(entry.path)):
                with suppress(OSError):
                    os.unlink(entry.path)  # noqa: PTH108 (an entry has its path as text)


def remove_run_folders() -> None:
    """Remove the folders of runs whose process is gone from the temporary one."""
    with suppress(OSError), os.scandir(tempfile.gettempdir()) as entries:
        for entry in entries:
            if not entry.name.startswith(RUN_PREFIX) or not _is_own(entry, stat.S_ISDIR):
                continue
            lock = Path(entry.path, _LOCK)
            if not _is_held(lock) if lock.exists() else _age(entry) > _OLD:
                shutil.rmtree(entry.path, ignore_errors=True)


def _is_own(entry: os.DirEntry[str], is_kind: Callable[[int], bool]) -> bool:
    found = entry.stat(follow_symlinks=False)
    return found.st_uid == os.getuid() and is_kind(found.st_mode)


def _age(entry: os.DirEntry[str]) -> float:
    return time.time() - entry.stat(follow_symlinks=False).st_mtime


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True


def _is_held(file: Path) -> bool:
    """Whether somebody works on a file; who cannot find out must leave it alone."""
    try:
        descriptor = os.open(file, os.O_RDWR | os.O_NOFOLLOW)
    except OSError:
        return True
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return True
    else:
        return False
    finally:
        os.close(descriptor)
