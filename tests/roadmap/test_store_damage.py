"""Damaged roadmaps are refused, and those that lie are not believed."""

import numpy as np
import pytest

from ellipsoid_planning.errors import RoadmapError
from ellipsoid_planning.kernels import roadmap_tables
from ellipsoid_planning.roadmap.graph import explored_graph
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from tests.roadmap.scenes import cage, configuration
from tests.roadmap.stored import (
    answers,
    changed,
    changed_header,
    gap_query,
    gap_scene,
    members,
    rewrite,
)
from tests.roadmap.test_level import is_proved, never


def test_a_damaged_file_is_refused_or_harmless(planned, file):
    cspace, roadmap = planned
    whole = file.read_bytes()
    random = np.random.default_rng(1)
    refused = 0
    for cut in random.integers(len(whole), size=40):
        file.write_bytes(whole[:cut])
        with pytest.raises(RoadmapError, match=r"a\.roadmap: "):
            HighwayRoadmap.load(file, cspace)
    for place in random.integers(len(whole), size=300):
        damaged = bytearray(whole)
        damaged[place] ^= 1 << random.integers(8)
        file.write_bytes(damaged)
        try:
            # A bit that tells when a file was made, say, is no harm.
            assert HighwayRoadmap.load(file, cspace).statistics == roadmap.statistics
        except RoadmapError as error:
            assert str(error).startswith(f"{file}: ")  # noqa: PT017
            refused += 1
    assert refused > 250


def test_nothing_is_unpickled(planned, file):
    header, arrays = members(file)
    arrays["levels[0].edges"] = np.array([print], dtype=object)
    rewrite(file, header, arrays)
    with pytest.raises(RoadmapError, match="damaged roadmap: expected an array of plain numbers"):
        HighwayRoadmap.load(file, planned[0])


def at(place, value):
    def change(array):
        array[place] = value
        return array

    return change


def repeated(array):
    array[..., 1] = array[..., 0]
    return array


TOO_LARGE = 1 << 40
WRONG = {
    "a node of no layer": {"nodes": at((0, 0), 400)},
    "a node of no column": {"nodes": at((0, 1), -1)},
    "a node of another line": {"nodes": at((0, 1), 1)},
    "an interval upside down": {"intervals": at(0, (2.0, 1.0))},
    "an endless interval": {"intervals": at((0, 1), np.inf)},
    "too few intervals": {"intervals": lambda array: array[:-1]},
    "a line of no layer": {"lines": at((0, 0), TOO_LARGE)},
    "nodes that are not there": {"lines": at((1, 0), TOO_LARGE)},
    "more nodes than a line has": {"lines": at((1, 0), roadmap_tables.LINE_BASE - 1)},
    "negative nodes": {"lines": at((1, 0), -1)},
    "one line twice": {"lines": repeated},
    "an edge of no nodes": {"edges": at(0, TOO_LARGE)},
    "an edge to itself": {"edges": at(0, 0)},
    "one edge twice": {"edges": repeated},
    "too few crossings": {"crossings": lambda array: array[:-1]},
    "a crossing nowhere": {"crossings": at((0, 1), np.nan)},
    "crossings of another type": {"crossings": lambda array: array.astype(int)},
    "another column": {"columns": at((0, 0), 0.123)},
    "one column twice": {"columns": lambda array: at(-1, array[0])(array)},
    "columns of another shape": {"columns": lambda array: array[:, :2]},
    "an orientation out of the plane": {"orientations": at((0, 0), 0.5)},
    "no orientation": {"orientations": at(0, 0.0)},
    "one orientation twice": {"orientations": lambda array: at(-1, array[0])(array)},
    "too few layers": {"ready": lambda array: array[:-1]},
}


@pytest.mark.parametrize("case", WRONG)
def test_what_kernels_would_stumble_over_is_refused(case, planned, file):
    changed(file, **WRONG[case])
    with pytest.raises(RoadmapError, match=r"a.roadmap: damaged roadmap: levels\[0\]\."):
        HighwayRoadmap.load(file, planned[0])


def level(**values):
    return lambda header: header["levels"][0].update(values)


WRONG_HEADERS = {
    "no levels": lambda header: header.pop("levels"),
    "a level that is none": lambda header: header["levels"].insert(0, 3),
    "a level without arrays": lambda header: header["levels"].append(header["levels"][0]),
    "an axis of no world": level(axis=2),
    "endless refinement": level(refinement=10**9),
    "a box of one corner": level(box=[[1.0, 1.0]]),
    "a box of no corners": level(box="large"),
    "a box outside": level(box=[[100.0, 100.0], [101.0, 101.0]]),
    "a negative count": level(proved=-1),
    "a count that is none": level(steps="many"),
    "more layers than there are": level(own_layers=1000),
    "no passages": lambda header: header.update(passages=[]),
    "passages that are none": lambda header: header.update(passages=[1]),
    "unknown parameters": lambda header: header["parameters"].update(speed=3),
    "wrong parameters": lambda header: header["parameters"].update(inflation=0.0),
    "another generator": lambda header: header["state"]["random"].update(bit_generator="MT19937"),
    "no generator": lambda header: header["state"].pop("random"),
    "no state": lambda header: header.pop("state"),
}


@pytest.mark.parametrize("case", WRONG_HEADERS)
def test_headers_of_no_roadmap_are_refused(case, planned, file):
    changed_header(file, WRONG_HEADERS[case])
    with pytest.raises(RoadmapError, match=r"a.roadmap: damaged roadmap: .*; name another file"):
        HighwayRoadmap.load(file, planned[0])


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("sizes", lambda sizes, _: at(0, sizes[0] + 1)(sizes)),
        ("sizes", lambda sizes, _: at(0, -sizes[0])(sizes)),
        ("lengths", lambda lengths, _: -1.0 - lengths),
        ("poses", lambda poses, _: np.zeros_like(poses)),
    ],
)
def test_passages_of_no_roadmap_are_refused(name, change, tmp_path):
    cspace = gap_scene()
    roadmap = HighwayRoadmap(cspace)
    answers(roadmap, [gap_query(cspace)])
    assert roadmap.passages[0].found
    file = tmp_path / "a.roadmap"
    roadmap.save(file)
    header, arrays = members(file)
    arrays[f"passages[0].{name}"] = change(arrays[f"passages[0].{name}"], header)
    rewrite(file, header, arrays)
    with pytest.raises(RoadmapError, match=r"damaged roadmap: passages\[0\]"):
        HighwayRoadmap.load(file, cspace)


def believes(cspace, file, query, *, proved):
    """Load a file of lies and ask: the answer must be that of a planner which knows nothing.

    ``proved`` tells whether the lies lead to a path.
    """
    fresh = HighwayRoadmap(cspace, RoadmapParameters(refine=0)).solve(*query, never)
    loaded = HighwayRoadmap.load(file, cspace, RoadmapParameters(refine=0))
    outcome = loaded.solve(*query, never)
    if outcome.path is not None:
        assert is_proved(cspace, outcome.path)
        np.testing.assert_array_equal(outcome.path[[0, -1]], np.vstack(query))
    if not proved:
        assert loaded.loaded
        return
    assert not loaded.loaded
    assert outcome.status == fresh.status
    if fresh.path is not None:
        np.testing.assert_array_equal(outcome.path, fresh.path)


@pytest.mark.parametrize("n", [2, 3])
def test_edges_that_were_never_proved_lead_to_no_path(n, tmp_path):
    cspace, file = cage(n, 8.0), tmp_path / "a.roadmap"
    query = configuration(cspace, *[0.0] * n), configuration(cspace, *[6.5] * n)
    honest = HighwayRoadmap(cspace, RoadmapParameters(refine=0))
    assert honest.solve(*query, never).status == "exhausted"
    # From outside, so that there are edges on both sides of the walls and through them.
    honest.solve(*query[::-1], never)
    honest.save(file)
    changed(file, crossings=at((slice(None), 0), 1.0))
    believes(cspace, file, query, proved=True)
    liar = HighwayRoadmap.load(file, cspace)
    graph = explored_graph(liar)
    first, last = graph.configurations[graph.edges.T]
    assert len(graph.edges) > 10
    assert cspace.are_motions_valid(first, last).all()


def test_intervals_that_are_not_free_lead_to_no_path(tmp_path):
    cspace, file = cage(2, 8.0), tmp_path / "a.roadmap"
    query = configuration(cspace, 0.0, 0.0), configuration(cspace, 0.0, 6.5)
    honest = HighwayRoadmap(cspace, RoadmapParameters(refine=0))
    honest.solve(*query, never)
    honest.save(file)
    changed(file, intervals=lambda array: array * 0.0 + [-8.0, 8.0])
    believes(cspace, file, query, proved=False)


def test_passages_through_walls_lead_to_no_path(tmp_path):
    cspace, file = gap_scene(), tmp_path / "a.roadmap"
    query = gap_query(cspace)
    honest = HighwayRoadmap(cspace)
    assert honest.solve(*query, never).status == "solved"
    honest.save(file)
    header, arrays = members(file)
    poses, sizes = arrays["passages[0].poses"], arrays["passages[0].sizes"]
    ends = np.cumsum(sizes)
    inner = np.ones(len(poses), dtype=bool)
    inner[np.concatenate([ends - sizes, ends - 1])] = False
    poses[inner, 1] += 0.1
    # Nothing but the passages leads across.
    for k in range(len(header["levels"])):
        arrays[f"levels[{k}].crossings"][:, 0] = 0.0
    # Only a query that was stopped goes on with the passages of before.
    header["state"]["unanswered"] = [cspace.poses(ends).tolist() for ends in query]
    rewrite(file, header, arrays)
    believes(cspace, file, query, proved=True)
