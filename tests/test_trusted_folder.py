"""Where compiled kernels, which are run, may lie: where nobody else can write."""

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from ellipsoid_planning import trusted_folder
from ellipsoid_planning.trusted_folder import PREFIX, is_trusted, temporary_folder

STRANGER = 12_345


@pytest.fixture
def shared(tmp_path, monkeypatch):
    """A shared temporary folder: everybody writes, nobody exchanges what others made."""
    folder = tmp_path / "shared"
    folder.mkdir()
    folder.chmod(0o1777)
    monkeypatch.setattr(trusted_folder.tempfile, "tempdir", str(folder))
    return folder


@pytest.mark.parametrize(("mode", "trusted"), [(0o700, True), (0o755, True), (0o777, False)])
def test_a_folder_that_others_write_to_is_not_trusted(tmp_path, mode, trusted):
    folder = tmp_path / "cache"
    folder.mkdir()
    folder.chmod(mode)
    assert is_trusted(folder) is trusted


@pytest.mark.parametrize(("mode", "trusted"), [(0o755, True), (0o1777, True), (0o777, False)])
def test_nor_one_that_others_can_exchange(tmp_path, mode, trusted):
    (tmp_path / "above" / "cache").mkdir(parents=True)
    (tmp_path / "above").chmod(mode)
    assert is_trusted(tmp_path / "above" / "cache") is trusted


def test_nor_one_of_another_user(tmp_path, monkeypatch):
    monkeypatch.setattr(trusted_folder, "_ADMINISTRATOR", -1)
    monkeypatch.setattr(os, "getuid", lambda: STRANGER)
    assert not is_trusted(tmp_path)


def test_the_group_of_the_users_own_name_is_the_user(tmp_path, monkeypatch):
    folder = tmp_path / "cache"
    folder.mkdir()
    folder.chmod(0o775)
    monkeypatch.setattr(trusted_folder, "_ADMINISTRATOR", os.getuid())
    group = folder.stat().st_gid
    monkeypatch.setattr(trusted_folder, "_own_group", lambda: group)
    assert is_trusted(folder)
    monkeypatch.setattr(trusted_folder, "_ADMINISTRATOR", -1)
    monkeypatch.setattr(trusted_folder, "_own_group", lambda: group + 1)
    assert not is_trusted(folder)


def test_the_temporary_folder_is_the_users_alone(shared):
    folder = temporary_folder()
    assert folder == shared / f"{PREFIX}{os.getuid()}"
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert temporary_folder() == folder


def squat_with_a_link(place):
    (place.parent / "mine").mkdir(mode=0o700)
    place.symlink_to(place.parent / "mine")


def squat_with_a_file(place):
    place.touch()


def squat_with_an_open_folder(place):
    place.mkdir()
    place.chmod(0o777)


@pytest.mark.parametrize("squat", [squat_with_a_link, squat_with_a_file, squat_with_an_open_folder])
def test_what_somebody_put_there_first_is_not_used(shared, squat):
    squat(shared / f"{PREFIX}{os.getuid()}")
    folder = temporary_folder()
    assert folder.name != f"{PREFIX}{os.getuid()}"
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert list(folder.iterdir()) == []


CACHE = "from ellipsoid_planning.kernels.compile import CACHE_FOLDER; print(CACHE_FOLDER)"


def cache_folder(chosen, shared):
    environment = {**os.environ, "ELLIPSOID_PLANNING_CACHE": str(chosen), "TMPDIR": str(shared)}
    command = [sys.executable, "-c", CACHE]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return Path(done.stdout.strip())


def test_kernels_are_kept_where_nobody_else_writes(tmp_path, shared):
    good, bad = tmp_path / "good", tmp_path / "bad"
    bad.mkdir()
    bad.chmod(0o777)
    assert cache_folder(good, shared).parent == good
    assert cache_folder(bad, shared).parent == shared / f"{PREFIX}{os.getuid()}"
