"""Runs in pieces: the same whoever works, however they are cut, interrupted or damaged."""

import os
import pickle
import signal
import threading
import time

import numpy as np
import pytest

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.diffraction.magnitudes import simulate
from ellipsoid_planning.crystal.diffraction.ranking import rank
from ellipsoid_planning.crystal.packing.fingerprint import (
    differences,
    fingerprint,
    received_model,
    sent_model,
)
from ellipsoid_planning.crystal.packing.gaussian_mixture import GaussianMixture
from ellipsoid_planning.crystal.packing.grid_search import GridSearch
from ellipsoid_planning.crystal.packing.model import load_model, load_target
from ellipsoid_planning.crystal.packing.model_files import bundled_models
from ellipsoid_planning.crystal.packing.potential_candidates import candidates_by_potential
from ellipsoid_planning.crystal.phasing.potential_runs import (
    PotentialMinima,
    candidates_of,
    cell_pieces,
    cell_search,
)
from ellipsoid_planning.crystal.phasing.ranking_runs import RankedArrangements, ranking_of
from ellipsoid_planning.crystal.phasing.run_store import DIGEST, RunStore, run_settings
from ellipsoid_planning.crystal.phasing.runs import (
    AT_A_TIME,
    MOST_PIECES,
    FreeArrangements,
    Piece,
    done,
    in_threads,
    on_cluster,
    piece_size,
    pieces,
    search_pieces,
)
from ellipsoid_planning.errors import CrystalError, EllipsoidPlanningError
from tests.crystal.packings import model_from

P1 = bundled_models()["rabbit-p1"].read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def model():
    return load_model("rabbit-p1")


@pytest.fixture(scope="module")
def free(model):
    return GridSearch(model).free(0, model.grid.base_poses)


def search(model, size, execute, store=None, **options):
    found = done(
        FreeArrangements(model), search_pieces(model.grid, size), execute, store, **options
    )
    return np.concatenate([result for _, result in found])


def settings(model, size=40):
    return run_settings(model, "pack", piece=size)


def test_threads_and_sizes_do_not_matter(model, free):
    assert len(free) == 98_845
    for size, threads in ((None, 1), (100, 1), (7, 3), (1, 2), (728, 2), (10_000, 2)):
        assert np.array_equal(search(model, size, in_threads(threads)), free)


def test_pieces_cover_everything_once(model):
    for items, size in ((0, 3), (1, 3), (3, 3), (10, 3)):
        cut = pieces("x", items, size)
        assert [i for piece in cut for i in range(piece.first, piece.last)] == list(range(items))
        assert len({piece.key for piece in cut}) == len(cut)
    assert piece_size(model.grid) * model.grid.joint_count <= AT_A_TIME
    wide = load_model("rabbit-p212121").grid
    assert piece_size(wide) % 100 == 0  # whole turns
    assert len(search_pieces(wide)) < MOST_PIECES


def test_results_come_in_order_while_later_ones_are_there_already():
    def slow_first(piece):
        time.sleep(0.2 if piece.number == 0 else 0.0)
        return np.array([piece.number])

    seen = []
    found = done(slow_first, pieces("x", 8, 1), in_threads(4), on_piece=seen.append)
    assert [int(result[0]) for _, result in found] == list(range(8))
    assert sorted(piece.number for piece in seen) == list(range(8))
    assert seen[0].number != 0


def test_a_stopped_run_goes_on(model, free, tmp_path):
    store = RunStore(tmp_path / "run")
    store.check(settings(model))
    store.open(settings(model))
    stop = threading.Event()
    finished = []

    def stop_soon(piece):
        finished.append(piece.key)
        if len(finished) == 5:
            stop.set()

    with pytest.raises(KeyboardInterrupt):
        search(model, 40, in_threads(2), store, stopped=stop.is_set, on_piece=stop_soon)
    assert 5 <= len(finished) < 10
    kept = {file: file.stat().st_mtime_ns for file in (store.folder / "search").iterdir()}
    assert {f"search/{file.name}" for file in kept} == set(finished)
    again = RunStore(tmp_path / "run")
    again.check(settings(model))
    assert np.array_equal(search(model, 40, in_threads(2), again), free)
    assert all(file.stat().st_mtime_ns == when for file, when in kept.items())


@pytest.mark.parametrize(
    "damage",
    [
        lambda content: content[:-8],
        lambda content: content[: DIGEST - 5],
        lambda _: b"",
        lambda content: content[:-1] + bytes([content[-1] ^ 1]),
        lambda content: content + b"\0" * 8,
    ],
)
def test_a_damaged_piece_is_done_again(damage, model, free, tmp_path):
    store = RunStore(tmp_path)
    search(model, 200, in_threads(1), store)
    file = tmp_path / "search" / "000001"
    whole = file.read_bytes()
    file.write_bytes(damage(whole))
    assert store.kept("search/000001") is None
    assert np.array_equal(search(model, 200, in_threads(1), store), free)
    assert file.read_bytes() == whole


def test_a_piece_under_another_name_is_not_taken(model, tmp_path):
    store = RunStore(tmp_path)
    search(model, 400, in_threads(1), store)
    (tmp_path / "search" / "000000").rename(tmp_path / "search" / "000001")
    assert store.kept("search/000001") is None


def test_what_cannot_be_written_is_an_error(model, tmp_path):
    (tmp_path / "search").write_text("a file", encoding="utf-8")
    with pytest.raises(CrystalError, match="cannot write"):
        search(model, 400, in_threads(1), RunStore(tmp_path))


def test_a_changed_model_is_named_and_nothing_is_lost(model, tmp_path):
    store = RunStore(tmp_path)
    store.open(settings(model))
    before = (tmp_path / "run.json").read_bytes()
    other = model_from(P1.replace("left_pitch_deg: {step: 10}", "left_pitch_deg: {step: 5}"))
    for wanted, words in (
        (settings(other), "left_pitch_deg.step: 10.0 there, 5.0 now"),
        (settings(model, 41), "piece: 40 there, 41 now"),
        (settings(load_model("rabbit-plane")), "and [0-9]+ more"),
    ):
        with pytest.raises(EllipsoidPlanningError, match=words) as error:
            RunStore(tmp_path).check(wanted)
        assert "name a new folder" in str(error.value)
    assert (tmp_path / "run.json").read_bytes() == before


def test_folders_of_others_are_left_alone(model, tmp_path):
    (tmp_path / "notes.txt").write_text("mine", encoding="utf-8")
    for folder, words in (
        (tmp_path, "holds other files"),
        (tmp_path / "notes.txt", "this is a file"),
        (tmp_path / "no" / "such", "does not exist"),
    ):
        with pytest.raises(EllipsoidPlanningError, match=words):
            RunStore(folder).check(settings(model))
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]


def test_fingerprints_see_what_matters_only(model):
    text = P1.replace("[14, 14, 14]", "[14.0, 14, 1.4e1]").replace("The spatial rabbit", "A rabbit")
    same = model_from(text.replace("dimension: 3\ngroup: P1\n", "group: P1\ndimension: 3\n"))
    assert fingerprint(same) == fingerprint(model)
    for old, new in (("[14, 14, 14]", "[14, 14, 14.001]"), ("resolution: 4.6", "resolution: 4.5")):
        assert fingerprint(model_from(P1.replace(old, new))) != fingerprint(model)
    assert np.array_equal(
        received_model(sent_model(model)).grid.configurations([5, 944_783]),
        model.grid.configurations([5, 944_783]),
    )
    assert differences({"a": [1, {"b": 2}]}, {"a": [1, {"b": 2}]}) == []
    assert differences({"a": [1, 2]}, {"a": [1]}) == ["a[1]: nothing there, 2 now"]


def test_work_is_sent_as_its_document(model, free):
    content = pickle.dumps(FreeArrangements(model))
    assert len(content) < 10_000
    with pytest.raises(CrystalError, match=r"version.*got 0\.0\.1"):
        received_model(("0.0.1", sent_model(model)[1]))
    found = pickle.loads(content)(Piece("search", 0, 0, model.grid.base_poses))
    assert np.array_equal(found, free)


@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestWarning")
def test_a_cluster_gives_the_same_even_when_a_worker_is_killed(model, free):
    pytest.importorskip("distributed")
    with on_cluster("local", 2) as execute:
        client = execute.args[0]
        assert np.array_equal(search(model, 40, execute), free)
        pids, finished = list(client.run(os.getpid).values()), []

        def kill_one(piece):
            finished.append(piece)
            if len(finished) == 3:
                os.kill(pids[0], signal.SIGKILL)

        assert np.array_equal(search(model, 5, execute, on_piece=kill_one), free)
        assert len(finished) == len(search_pieces(model.grid, 5))
        assert set(client.run(os.getpid).values()) != set(pids)


def test_rankings_and_potential_minima_in_pieces_are_those_at_once():
    plane = load_model("rabbit-plane")
    cost = FourierCost(plane, simulate(plane, load_target("rabbit-plane-target", plane)))
    at_once = rank(GridSearch(plane), GridSearch(plane).free(0, plane.grid.base_poses), cost, 7)
    work = pickle.loads(pickle.dumps(RankedArrangements(cost, 7)))
    for size in (1, 4):
        results = done(work, search_pieces(plane.grid, size), in_threads(2))
        found = ranking_of(plane, (result for _, result in results), 7)
        assert np.array_equal(found.numbers, at_once.numbers)
        assert np.array_equal(found.costs, at_once.costs)
        assert found.looked_at == at_once.looked_at
    step = np.radians(90.0)
    whole = candidates_by_potential(plane, GaussianMixture(0.2), step=step)
    minima = pickle.loads(pickle.dumps(PotentialMinima(cell_search(plane, 0.2, step))))
    cut = done(minima, cell_pieces(minima.search), in_threads(2))
    again = candidates_of(result for _, result in cut)
    assert np.array_equal(again.configurations, whole.configurations)
    assert np.array_equal(again.potentials, whole.potentials)
    assert np.array_equal(again.free, whole.free)
