"""The figures of a benchmark: boxes by planner, success against time, time against clearance."""

from __future__ import annotations

import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from planners.benchmark.campaign import Campaign
from planners.benchmark.problems import Problem
from planners.benchmark.run import RunRecord
from planners.benchmark.summary import Row
from planners.view.figures_benchmark_boxes import draw_boxes
from planners.view.figures_benchmark_family import draw_family
from planners.view.figures_benchmark_style import Style, styles
from planners.view.figures_benchmark_success import draw_success
from planners.view.writing import write_whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DOTS_PER_INCH = 160


def write_figures(
    folder: Path, campaign: Campaign, records: Sequence[RunRecord], rows: Sequence[Row]
) -> list[Path]:
    """Draw all figures into ``folder``, which is made if needed, and return their files.

    A problem gets boxes of time, length and clearance by planner, and its success rate against
    time; a family of two or more clearances gets time against clearance.

    Raises:
        EllipsoidPlanningError: a file cannot be written.
    """
    looks = styles(campaign.contenders)
    written = []
    for name, own in _families(rows):
        drawn = draw_family(name, own, campaign.time_limit, looks)
        written.append(_write(drawn, folder / f"{name}.png"))
    for problem in campaign.problems:
        written.extend(_problem_figures(folder, campaign, problem, records, looks))
    return written


def _families(rows: Sequence[Row]) -> Iterable[tuple[str, list[Row]]]:
    for family in dict.fromkeys(row.family for row in rows if row.family is not None):
        own = [row for row in rows if row.family == family]
        if len({row.clearance for row in own}) > 1:
            yield family, own


def _problem_figures(
    folder: Path,
    campaign: Campaign,
    problem: Problem,
    records: Sequence[RunRecord],
    looks: dict[str, Style],
) -> Iterable[Path]:
    own = [record for record in records if record.problem == problem.name]
    if not own:
        return
    for kind, draw in (("boxes", draw_boxes), ("success", draw_success)):
        drawn = draw(problem.name, own, campaign.time_limit, looks)
        yield _write(drawn, folder / f"{problem.name}-{kind}.png")


def _write(drawn: Figure, output: Path) -> Path:
    output.parent.mkdir(exist_ok=True)
    content = io.BytesIO()
    drawn.savefig(content, format="png", dpi=DOTS_PER_INCH)
    return write_whole(output, content.getvalue())
