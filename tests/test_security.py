"""The claims of docs/security.md: what files of strangers cannot do.

That scenarios name no code is tested in planners/test_planner_names.py, that pages show texts as
texts in view/, what the cache folder must be in test_trusted_folder.py, and that no loader reads
devices or pipes in test_input_files.py.
"""

import io
import json
import pickle
import zipfile
from pathlib import Path

import numpy as np
import pytest

from ellipsoid_planning.crystal.phasing.run_store import bytes_array
from ellipsoid_planning.errors import EllipsoidPlanningError, RoadmapError, UrdfError
from ellipsoid_planning.scenario import bundled_scenarios, load_scenario
from planners.benchmark.run import RunRecord
from planners.benchmark.store import RECORD, Store
from planners.importing.mesh_files import MeshFiles
from planners.importing.urdf_text import read_description
from planners.solve import plan


class Trap:
    """Makes a file when it is unpickled."""

    def __init__(self, place):
        self.place = str(place)

    def __reduce__(self):
        return open, (self.place, "w")


def pickled_array(place):
    """What numpy writes for an array of objects: a header, then a pickle."""
    content = io.BytesIO()
    np.save(content, np.array([Trap(place)], dtype=object), allow_pickle=True)
    return content.getvalue()


@pytest.fixture
def sprung(tmp_path):
    place = tmp_path / "sprung"
    pickle.loads(pickle.dumps(Trap(place))).close()
    assert place.exists()  # the trap works
    place.unlink()
    return place


@pytest.mark.parametrize("tag", ["!!python/object/apply:builtins.open", "!!python/name:os.system"])
def test_yaml_makes_data_only(tmp_path, sprung, tag):
    text = bundled_scenarios()["rabbit-2d-open"].read_text(encoding="utf-8")
    file = tmp_path / "scenario.yaml"
    file.write_text(f'{text}\nmore: {tag} ["{sprung}", w]\n', encoding="utf-8")
    with pytest.raises(EllipsoidPlanningError):
        load_scenario(file)
    assert not sprung.exists()


def test_roadmaps_are_not_unpickled(tmp_path, sprung):
    scenario, file = load_scenario("rabbit-2d-open"), tmp_path / "a.roadmap"
    plan(scenario, seed=1, roadmap=file)
    with zipfile.ZipFile(file) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    arrays = [name for name in members if name.endswith(".npy")]
    with zipfile.ZipFile(file, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, pickled_array(sprung) if name in arrays else content)
    with pytest.raises(RoadmapError):
        plan(scenario, seed=1, roadmap=file)
    assert not sprung.exists()


def test_kept_pieces_of_runs_are_not_unpickled(sprung):
    with pytest.raises(ValueError, match="array"):  # told to do the piece again
        bytes_array(pickled_array(sprung))
    assert not sprung.exists()


def test_records_of_benchmarks_are_data(tmp_path, sprung):
    class Task:
        key = "problem/planner/000"

    folder = tmp_path / "runs" / Task.key
    folder.mkdir(parents=True)
    fields = {"problem": "p", "planner": "os:system", "checker": "plugin", "label": "x"}
    for content in (json.dumps({**fields, "run": 0, "seed": 1, "status": "solved"}), "[1, 2]"):
        (folder / RECORD).write_text(content, encoding="utf-8")
        found = Store(tmp_path).finished(Task())
        assert found is None or type(found) is RunRecord
    (folder / RECORD).write_bytes(pickle.dumps(Trap(sprung)))
    assert Store(tmp_path).finished(Task()) is None
    assert not sprung.exists()


SPHERE = "<collision><geometry><sphere radius='1'/></geometry></collision>"
BOMB = "".join(f"<!ENTITY a{k + 1} '{f'&a{k};' * 10}'>" for k in range(9))


@pytest.mark.parametrize(
    ("entities", "name"),
    [
        ("<!ENTITY x SYSTEM 'SECRET'>", "&x;"),
        (f"<!ENTITY a0 'aaaaaaaaaa'>{BOMB}", "&a9;"),
    ],
)
def test_urdf_reads_no_other_file_and_does_not_grow(tmp_path, entities, name):
    secret = tmp_path / "secret"
    secret.write_text("hidden words", encoding="utf-8")
    file = tmp_path / "robot.urdf"
    entities = entities.replace("SECRET", secret.as_uri())
    file.write_text(
        f"<!DOCTYPE robot [{entities}]><robot name='{name}'><link name='l'>{SPHERE}</link></robot>",
        encoding="utf-8",
    )
    with pytest.raises(UrdfError) as caught:
        read_description(file)
    assert "hidden" not in str(caught.value)


def square(path):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")
    return path


@pytest.fixture
def robot_folder(tmp_path):
    folder = tmp_path / "a" / "b" / "c" / "d" / "robot"
    folder.mkdir(parents=True)
    return folder


@pytest.mark.parametrize("form", ["{}", "file://{}", "../../../../../far/mesh.off"])
def test_meshes_far_from_the_urdf_need_the_users_word(tmp_path, robot_folder, form):
    far = square(tmp_path / "far" / "mesh.off")
    name = form.format(far)
    with pytest.raises(UrdfError, match="--mesh-dir"):
        MeshFiles(robot_folder / "robot.urdf").solid("hand", name, None)
    trusted = MeshFiles(robot_folder / "robot.urdf", far.parent)
    assert len(trusted.solid("hand", name, None).points) == 4


def test_a_link_does_not_lead_out(tmp_path, robot_folder):
    far = square(tmp_path / "far" / "mesh.off")
    (robot_folder / "near.off").symlink_to(far)
    with pytest.raises(UrdfError, match="outside"):
        MeshFiles(robot_folder / "robot.urdf").solid("hand", "near.off", None)


@pytest.mark.parametrize("form", ["mesh.off", "../mesh.off", "package://some/mesh.off"])
def test_meshes_of_the_package_are_read(robot_folder, form):
    square(robot_folder.parent / "mesh.off")
    square(robot_folder / "mesh.off")
    assert len(MeshFiles(robot_folder / "robot.urdf").solid("hand", form, None).points) == 4


@pytest.mark.parametrize("name", ["mesh.zip", "mesh.3mf", "mesh.tar.gz", "passwords"])
def test_archives_and_other_files_are_no_meshes(robot_folder, name):
    (robot_folder / name).write_bytes(b"secret")
    with pytest.raises(UrdfError, match="formats") as caught:
        MeshFiles(robot_folder / "robot.urdf").solid("hand", name, None)
    assert "secret" not in str(caught.value)


def test_nothing_here_can_unpickle():
    """But for a message to our own workers, which Dask pickles anyway."""
    root = Path(__file__).parent.parent
    for package in ("ellipsoid_planning", "planners"):
        for source in (root / package).rglob("*.py"):
            text = source.read_text(encoding="utf-8")
            assert "allow_pickle=True" not in text
            assert ("pickle.load" in text) == (source.name == "ranking_runs.py"), source
