"""Where compiled kernels are kept, and who is told of compilations."""

import os
import subprocess
import sys

PROGRAM = """
import os, tempfile
folder, locked = os.environ["ELLIPSOID_PLANNING_CACHE"], {locked}
if locked:  # chmod does not keep the superuser from writing
    inner, makedirs = tempfile.TemporaryFile, os.makedirs
    def refuse(*arguments, **options):
        if str(options.get("dir", "")).startswith(folder):
            raise OSError(30, "Read-only file system")
        return inner(*arguments, **options)
    tempfile.TemporaryFile = refuse
from ellipsoid_planning.compilation import listening
from ellipsoid_planning.kernels import linear
from ellipsoid_planning.kernels.compile import CACHE_FOLDER
heard = []
with listening(lambda *told: heard.append(told)):
    assert abs(linear.norm(1.0, 2.0, 2.0) - 3.0) < 1e-15
    print(str(CACHE_FOLDER).startswith(folder), len(heard) > 0)
    assert abs(linear.norm(1, 2, 2) - 3.0) < 1e-15  # a version that the cache does not have
    print(heard[-1][0] if heard else None)
"""


def run(folder, locked):
    environment = {**os.environ, "ELLIPSOID_PLANNING_CACHE": str(folder)}
    command = [sys.executable, "-c", PROGRAM.format(locked=locked)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return done.stdout.split()


def files(folder):
    return {path.name for path in folder.rglob("*") if path.is_file()}


def test_a_warm_cache_serves_where_nothing_can_be_written(tmp_path):
    folder = tmp_path / "cache"
    folder.mkdir()
    assert run(folder, locked=False) == ["True", "True", "False"]
    kept = files(folder)
    for path in folder.rglob("*.nbc"):
        if path.name.endswith(".2.nbc"):
            path.unlink()
    kept = files(folder)
    assert run(folder, locked=True)[:2] == ["True", "False"]
    assert files(folder) == kept


def test_a_cold_folder_that_cannot_be_written_is_not_used(tmp_path):
    assert run(tmp_path / "cache", locked=True)[0] == "False"
    assert not files(tmp_path)
