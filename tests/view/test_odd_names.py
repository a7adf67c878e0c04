"""Names are shown as they are written: nothing of them runs, and nothing of them is lost."""

import csv
import io
import sys

import numpy as np
import pytest

from ellipsoid_planning.csv_text import csv_text
from ellipsoid_planning.result import PathResult, PlanResult
from planners.benchmark.tables import _markdown_row
from planners.cli import terminal
from planners.cli.outputs import write_csv
from planners.cli.tables import report_table, result_table
from planners.verify.report import Check, VerificationReport
from planners.view.figures import draw
from planners.view.meshcat_page import scene_html
from tests.view.chromium import photograph
from tests.view.odd_names import FORMULA, IMAGE, MARKUP, MATHS, RAN, TAG, odd_scenario


def result_of(scenario):
    """A path straight from start to goal."""
    path = PathResult.from_configurations(
        scenario.robot, [scenario.start, scenario.goal], min_clearance=0.0, certified=True
    )
    return PlanResult(scenario, IMAGE, "solved", path=path)


@pytest.mark.parametrize("name", [TAG, IMAGE])
def test_a_page_runs_nothing_of_the_names(name, tmp_path):
    page = scene_html(odd_scenario(name=name, description=TAG), result_of(odd_scenario()))
    assert RAN in page
    assert page.count("<script>") == 2
    _, messages = photograph(page, tmp_path)
    assert messages == []


def test_the_watch_for_scripts_works(tmp_path):
    page = scene_html(odd_scenario(), None).replace("</body>", f"{TAG}</body>")
    _, messages = photograph(page, tmp_path)
    assert any(RAN in message for message in messages)


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self):
        return True


def test_a_spinner_takes_no_markup(monkeypatch):
    monkeypatch.setattr(sys, "stderr", Terminal())
    with terminal.working(MARKUP):
        pass
    with terminal.stages(MARKUP) as update:
        update(MARKUP)


def test_tables_show_names_as_they_are(monkeypatch):
    shown = io.StringIO()
    monkeypatch.setattr(sys, "stdout", shown)
    report = VerificationReport((Check(MARKUP, passed=True, detail=MARKUP),), scenario=MARKUP)
    terminal.result_console().print(result_table(result_of(odd_scenario())), report_table(report))
    assert shown.getvalue().count(MARKUP) == 4


def test_figures_show_dollars():
    drawn = draw(odd_scenario(name=MATHS))
    assert drawn.get_suptitle() == MATHS.replace("$", r"\$")
    drawn.savefig(io.BytesIO(), format="png", dpi=20)


def test_no_cell_of_a_csv_is_a_formula():
    odd = [FORMULA, "+1+1", "-cmd", "@sum(A1)", "\t=1", "\r=1", "plain", "-1.5", -1.5, None]
    (row,) = csv.reader(io.StringIO(csv_text([odd]), newline=""))
    texts = ["'=1+1", "'+1+1", "'-cmd", "'@sum(A1)", "'\t=1", "'\r=1", "plain"]
    assert row == [*texts, "-1.5", "-1.5", ""]


def test_the_csv_of_a_path_goes_on_beyond_half_a_turn(tmp_path):
    write_csv(result_of(odd_scenario()), tmp_path / "path.csv")
    with (tmp_path / "path.csv").open(encoding="utf-8", newline="") as stream:
        header, *rows = csv.reader(stream)
    assert header == ["travelled", "x", "y", "yaw", f"'{FORMULA}"]
    values = np.array(rows, dtype=float)
    assert values[0, 3:] == pytest.approx([3.0, 3.0])
    assert values[-1, 3:] == pytest.approx([2 * np.pi - 3.0, 2 * np.pi - 2.0])
    assert np.max(np.abs(np.diff(values[:, 3:], axis=0))) < 0.1


def test_markdown_shows_text_as_it_is():
    assert _markdown_row(["a|b", "<b>x</b>", "[l](u) *s* `c`\n|"]) == (
        r"| a\|b | &lt;b&gt;x&lt;/b&gt; | \[l\](u) \*s\* \`c\` \| |"
    )
