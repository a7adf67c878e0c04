"""Medians, quartiles and bounds; text, Markdown and CSV say the same."""

import csv
import io
import math

import pytest

from planners.benchmark.campaign import Campaign
from planners.benchmark.contenders import Contender
from planners.benchmark.growth import growths
from planners.benchmark.problems import Problem
from planners.benchmark.summary import Quantile, quartiles, summarised
from planners.benchmark.tables import cells, duration, markdown, notes, summary_csv
from tests.benchmark.runs import record

LIMIT = 10.0


def test_quartiles_without_failures_are_numpys():
    import numpy as np

    values = [0.3, 0.1, 2.0, 0.7, 0.2, 0.9]
    found = quartiles(values)
    expected = np.quantile(values, [0.25, 0.5, 0.75])
    assert [found.first.value, found.median.value, found.third.value] == pytest.approx(expected)
    assert not found.third.is_bound


def test_failures_count_as_the_limit_at_least():
    found = quartiles([1.0, 2.0], 2, LIMIT)
    assert found.first == Quantile(1.75)
    assert found.median == Quantile(6.0, is_bound=True)
    assert found.third == Quantile(10.0, is_bound=True)
    assert quartiles([10.4], 1, LIMIT).third == Quantile(10.4, is_bound=True)
    assert quartiles([], 3, LIMIT).first == Quantile(LIMIT, is_bound=True)
    assert math.isnan(quartiles([]).median.value)


@pytest.fixture
def rows():
    contenders = (Contender("RRT", "plugin", "RRT (plugin)"), Contender("RRT", "fcl", "RRT (fcl)"))
    problems = (Problem("wall", ({},)), Problem("empty", ({},)))
    records = [
        record("RRT (plugin)", run, seconds=0.002 * (run + 1), length=5.0, clearance=0.25)
        for run in range(3)
    ]
    records.append(record("RRT (fcl)", 0, "not free", reason="it hits", seconds=0.01))
    records.append(record("RRT (fcl)", 1, "timeout", seconds=10.1))
    return summarised(Campaign(problems, contenders, 3, LIMIT, 100.0, 1), records)


def test_the_summary_counts_what_happened(rows):
    assert [(row.label, row.solved, row.runs) for row in rows] == [
        ("RRT (plugin)", 3, 3),
        ("RRT (fcl)", 0, 2),
    ]
    assert rows[1].failures == (("timeout", 1), ("not free", 1))
    assert rows[1].not_free == ("wall/RRT-fcl/000",)
    assert rows[1].time.median == Quantile(LIMIT, is_bound=True)
    assert any("wall/RRT-fcl/000" in note for note in notes(rows))


def test_markdown_and_csv_say_the_same(rows):
    lines = [line.strip("| ").split(" | ") for line in markdown(rows).splitlines()]
    table = list(csv.DictReader(io.StringIO(summary_csv(rows))))
    for line, entry, row in zip(lines[2:4], table, rows, strict=True):
        assert line[1] == entry["label"] == row.label
        assert line[2] == f"{entry['solved']}/{entry['runs']}"
    assert lines[2][4] == "4 ms (3\N{EN DASH}5)"
    assert float(table[0]["time_median"]) == pytest.approx(0.004)
    assert (table[0]["time_median_is_bound"], table[1]["time_median_is_bound"]) == ("False", "True")
    assert cells(rows[1])[4] == ">10 s"
    assert table[1]["failures"] == "1 timeout; 1 not free"
    assert "> counts" not in markdown(rows)
    assert "wall/RRT-fcl/000" in markdown(rows)


def test_times_in_units_that_suit():
    assert [duration(t) for t in (2e-6, 1.5e-3, 0.25, 3.0, 61.25)] == [
        "2 µs",
        "1.5 ms",
        "250 ms",
        "3 s",
        "61.2 s",
    ]


def test_scenes_of_one_clearance_have_no_growth():
    contender = Contender("RRT", "plugin", "RRT")
    problems = [Problem(f"gap-{k}", ({},), "gap-2d", 1e-2) for k in range(2)]
    records = [record("RRT", 0, problem=f"gap-{k}", seconds=0.1 + k) for k in range(2)]
    rows = summarised(Campaign(tuple(problems), (contender,), 1, LIMIT, 1.0, 1), records)
    (growth,) = growths(rows)
    assert math.isnan(growth.exponent)


def test_the_growth_of_a_family():
    contender = Contender("RRT", "plugin", "RRT")
    problems = [Problem(f"gap-{c:g}", ({},), "gap-2d", c) for c in (1e-1, 1e-2, 1e-3, 1e-4)]
    records = [
        record("RRT", run, problem=f"gap-{c:g}", seconds=1e-3 * c**-0.5)
        for c in (1e-1, 1e-2, 1e-3)
        for run in range(2)
    ]
    records.extend(record("RRT", run, "timeout", "gap-0.0001", seconds=10.0) for run in range(2))
    rows = summarised(Campaign(tuple(problems), (contender,), 2, LIMIT, 1.0, 1), records)
    (growth,) = growths(rows)
    assert growth.exponent == pytest.approx(0.5)
    assert (growth.largest, growth.smallest, growth.first_failure) == (1e-1, 1e-3, 1e-4)
    sentence = (
        "gap-2d, RRT: time ~ clearance^-0.50 from 1e-1 to 1e-3, first failure at clearance 1e-4"
    )
    assert sentence in notes(rows)
