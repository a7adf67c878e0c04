"""Folders whose content nobody else can have changed: what is in them may be run."""

from __future__ import annotations

import atexit
import grp
import os
import pwd
import shutil
import stat
import tempfile
from pathlib import Path

PREFIX = "ellipsoid-planning-"
"""How the names of all our folders in the temporary one begin."""

_ADMINISTRATOR = 0


def is_trusted(folder: Path) -> bool:
    """Whether only this user and the administrator can change what is in a folder.

    Folder and ancestors must be theirs, and writable by nobody else; in an ancestor that is, as
    in the shared temporary one, the sticky bit must keep others from exchanging what is there.
    Give a path without links: where they point may change.
    """
    try:
        return _is_ours(folder.stat()) and all(
            _is_ours(ancestor.stat(), sticky=True) for ancestor in folder.parents
        )
    except OSError:
        return False


def temporary_folder() -> Path:
    """A folder of this user's alone for what is worth keeping: shared by all of its processes.

    Its name is known to everybody, so that somebody else may have made it first; then there is
    a new one for this process, removed at its end.
    """
    folder = Path(tempfile.gettempdir()).resolve() / f"{PREFIX}{os.getuid()}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()  # a link would be somebody's choice of a folder
    except OSError:
        return _folder_of_this_process()
    private = stat.S_ISDIR(found.st_mode) and not found.st_mode & 0o077
    if private and found.st_uid == os.getuid() and is_trusted(folder):
        return folder
    return _folder_of_this_process()


def _folder_of_this_process() -> Path:
    folder = Path(tempfile.mkdtemp(prefix=PREFIX)).resolve()
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def _is_ours(found: os.stat_result, *, sticky: bool = False) -> bool:
    if found.st_uid not in (os.getuid(), _ADMINISTRATOR):
        return False
    writable = found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
    if writable == stat.S_IWGRP and found.st_gid in (_ADMINISTRATOR, _own_group()):
        return True
    return not writable or (sticky and bool(found.st_mode & stat.S_ISVTX))


def _own_group() -> int | None:
    """The group of the user's own name, which many systems give everybody and no one else."""
    try:
        user = pwd.getpwuid(os.getuid()).pw_name
        group = grp.getgrgid(os.getgid())
    except KeyError:
        return None
    alone = group.gr_name == user and set(group.gr_mem) <= {user}
    return group.gr_gid if alone else None
