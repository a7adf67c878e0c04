"""What is read: ordinary files that fit into memory; the rest is refused, not waited for."""

import os
from pathlib import Path

import pytest

from ellipsoid_planning import input_files
from ellipsoid_planning.crystal.structures.structure import read_structure
from ellipsoid_planning.crystal.symmetry.group_text import space_group_from_text
from ellipsoid_planning.errors import EllipsoidPlanningError
from ellipsoid_planning.result import load_result
from ellipsoid_planning.scenario import load_scenario
from planners.importing.urdf_text import read_description


def endless(folder):
    (folder / "input").symlink_to("/dev/zero")


def pipe(folder):
    os.mkfifo(folder / "input")


def loop(folder):
    (folder / "input").symlink_to(folder / "input")


def a_folder(folder):
    (folder / "input").mkdir()


LOADERS = (load_scenario, load_result, read_structure, space_group_from_text, read_description)


@pytest.mark.parametrize("make", [endless, pipe, loop, a_folder])
@pytest.mark.parametrize("load", LOADERS)
def test_every_loader_refuses_what_is_no_file(tmp_path, make, load):
    make(tmp_path)
    with pytest.raises(EllipsoidPlanningError, match=str(tmp_path / "input")):
        load(tmp_path / "input")


def test_too_large_a_file_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(input_files, "LARGEST", 10)
    file = tmp_path / "input"
    file.write_bytes(b"0123456789")
    assert input_files.read_bytes(file) == b"0123456789"
    file.write_bytes(b"0123456789a")
    with pytest.raises(OSError, match="larger than"):
        input_files.read_bytes(file)


def test_lines_end_as_python_has_them(tmp_path):
    file = tmp_path / "input"
    file.write_bytes("a\r\nb\rc\nä".encode())
    assert input_files.read_text(file) == "a\nb\nc\nä" == Path(file).read_text(encoding="utf-8")
