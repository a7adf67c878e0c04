"""What killed processes leave is removed; what anybody works on is not."""

import errno
import fcntl
import os
import signal
import subprocess
import sys
import tempfile

import pytest

from ellipsoid_planning import leftovers
from ellipsoid_planning.atomic import partial_path, write_pieces, write_text
from ellipsoid_planning.leftovers import (
    RUN_PREFIX,
    remove_partial_files,
    remove_run_folders,
    run_folder,
)


@pytest.fixture(scope="module")
def dead():
    """The number of a process that has ended."""
    with subprocess.Popen([sys.executable, "-c", ""]) as process:
        process.wait()
    return process.pid


@pytest.fixture
def temporary(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_partial_files_of_dead_processes_go(tmp_path, dead):
    kept = [".other.part", f"result.json.{dead}.part", f".result.{os.getpid()}.part", "a.txt"]
    for name in (*kept, f".result.json.{dead}.part"):
        (tmp_path / name).touch()
    remove_partial_files(tmp_path)
    assert names(tmp_path) == sorted(kept)


def test_one_that_somebody_writes_stays_whatever_its_number(tmp_path, dead):
    # On a shared file system, its process may run on another machine.
    file = tmp_path / f".result.json.{dead}.part"
    with file.open("wb") as stream:
        fcntl.flock(stream, fcntl.LOCK_EX)
        remove_partial_files(tmp_path)
        assert file.exists()
    remove_partial_files(tmp_path)
    assert not file.exists()


def test_links_and_folders_of_that_name_stay(tmp_path, dead):
    (tmp_path / "target").touch()
    (tmp_path / f".link.{dead}.part").symlink_to(tmp_path / "target")
    (tmp_path / f".folder.{dead}.part").mkdir()
    before = names(tmp_path)
    remove_partial_files(tmp_path)
    assert names(tmp_path) == before


def test_files_of_others_stay(tmp_path, dead, monkeypatch):
    file = tmp_path / f".result.json.{dead}.part"
    file.touch()
    monkeypatch.setattr(leftovers.os, "getuid", lambda: 12_345)
    remove_partial_files(tmp_path)
    assert file.exists()


def test_what_is_being_written_is_held(tmp_path, monkeypatch):
    target = tmp_path / "result.json"
    monkeypatch.setattr(leftovers, "_is_running", lambda _: False)

    def pieces():
        yield b"one"
        remove_partial_files(tmp_path)
        assert partial_path(target).exists()
        yield b"two"

    write_pieces(target, pieces())
    assert target.read_bytes() == b"onetwo"
    assert names(tmp_path) == ["result.json"]


KILLED = """
import os, signal
from ellipsoid_planning.leftovers import run_folder
with run_folder() as folder:
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_folders_of_killed_runs_go(temporary):
    command = [sys.executable, "-c", KILLED]
    environment = {**os.environ, "TMPDIR": str(temporary)}
    done = subprocess.run(command, env=environment, check=False)
    assert done.returncode == -signal.SIGKILL
    (left,) = temporary.iterdir()
    (temporary / "something-else").mkdir()
    with run_folder() as own:
        remove_run_folders()
        assert names(temporary) == sorted([own.name, "something-else"])
    assert not left.exists()
    assert names(temporary) == ["something-else"]


def test_a_run_folder_without_a_lock_goes_when_it_is_old(temporary):
    new, old = temporary / f"{RUN_PREFIX}new", temporary / f"{RUN_PREFIX}old"
    for folder in (new, old):
        folder.mkdir()
    os.utime(old, (0, 0))
    remove_run_folders()
    assert names(temporary) == [new.name]


def test_a_pipe_that_nobody_reads_is_an_error(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(OSError, match="nobody reads") as caught:
        write_text(pipe, "text")
    assert caught.value.errno == errno.ENXIO


def test_a_loop_of_links_is_an_error_and_stays(tmp_path):
    (tmp_path / "a").symlink_to(tmp_path / "b")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    with pytest.raises(OSError, match="links") as caught:
        write_text(tmp_path / "a", "text")
    assert caught.value.errno == errno.ELOOP
    assert names(tmp_path) == ["a", "b"]


def test_halves_of_surrogate_pairs_are_written_as_escapes(tmp_path):
    write_text(tmp_path / "file", "\ud800")
    assert (tmp_path / "file").read_bytes() == rb"\ud800"
