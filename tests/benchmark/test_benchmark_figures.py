"""The figures: what is drawn where, and that timeouts look like timeouts."""

from itertools import pairwise

import pytest

from planners.benchmark.campaign import Campaign
from planners.benchmark.contenders import line_up
from planners.benchmark.problems import Problem
from planners.benchmark.summary import summarised
from planners.view.figures_benchmark import write_figures
from planners.view.figures_benchmark_family import draw_family
from planners.view.figures_benchmark_style import spread, styles
from planners.view.figures_benchmark_success import draw_success
from tests.benchmark.runs import record

LIMIT = 10.0
CLEARANCES = (1e-1, 1e-2, 1e-3)


@pytest.fixture
def campaign():
    problems = tuple(Problem(f"gap-{c:g}", ({},), "gap-2d", c) for c in CLEARANCES)
    contenders = line_up(["HighwayRoadmap", "RRT"], ["plugin", "fcl"]).contenders
    return Campaign(problems, contenders, 3, LIMIT, 100.0, 1)


@pytest.fixture
def records(campaign):
    found = []
    for task in campaign.tasks():
        fails = task.label == "RRT (fcl)" and task.problem != "gap-0.1"
        path = {} if fails else {"length": 5.0 + task.run, "clearance": 1e-3}
        status = "timeout" if fails else "solved"
        seconds = LIMIT if fails else 0.01 * (task.run + 1)
        found.append(record(task.label, task.run, status, task.problem, seconds=seconds, **path))
    return found


def open_markers(axes):
    """Points of all white markers on an axes."""
    return [
        (float(x), float(y))
        for line in axes.get_lines()
        if line.get_marker() not in ("None", "") and line.get_color() == "white"
        for x, y in zip(line.get_xdata(), line.get_ydata(), strict=True)
    ]


def test_timeouts_are_open_markers_at_the_limit(campaign, records):
    rows = summarised(campaign, records)
    drawn = draw_family("gap-2d", rows, LIMIT, styles(campaign.contenders))
    lanes, panel = drawn.axes
    assert open_markers(panel) == [(1e-2, LIMIT)]
    assert [x for x, _ in open_markers(lanes)] == [1e-2, 1e-3]
    assert panel.get_xscale() == panel.get_yscale() == "log"
    assert panel.xaxis_inverted()
    texts = {text.get_text() for axes in drawn.axes for text in axes.texts}
    assert {"HighwayRoadmap", "RRT (plugin)", "RRT (fcl)"} <= texts


def test_without_timeouts_there_are_no_lanes(campaign, records):
    rows = summarised(campaign, [run for run in records if run.label != "RRT (fcl)"])
    drawn = draw_family("gap-2d", rows, LIMIT, styles(campaign.contenders))
    assert len(drawn.axes) == 1
    assert open_markers(drawn.axes[0]) == []


def test_success_grows_to_the_share_of_solved_runs(campaign, records):
    own = [run for run in records if run.problem == "gap-0.01"]
    drawn = draw_success("gap", own, LIMIT, styles(campaign.contenders))
    ends = sorted(line.get_ydata()[-1] for line in drawn.axes[0].get_lines())
    assert ends == [0.0, 1.0, 1.0]


def test_every_figure_is_written(campaign, records, tmp_path):
    rows = summarised(campaign, records)
    files = write_figures(tmp_path / "figures", campaign, records, rows)
    assert sorted(path.name for path in files) == sorted(
        [
            "gap-2d.png",
            *(f"gap-{c:g}-{kind}.png" for c in CLEARANCES for kind in ("boxes", "success")),
        ]
    )
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in files)


def test_nothing_solved_is_drawn_too(campaign, records, tmp_path):
    failed = [run for run in records if not run.solved]
    files = write_figures(tmp_path / "figures", campaign, failed, summarised(campaign, failed))
    assert len(files) == 5


def test_labels_are_spread_in_order_within_bounds():
    places = spread([0.5, 0.5, 0.51, 0.99, 1.2], 0.1, 0.0, 1.0)
    assert places == sorted(places)
    assert min(b - a for a, b in pairwise(places)) >= 0.1 - 1e-6
    assert places[0] >= 0.0
    assert places[-1] <= 1.0 + 1e-6
