"""What a campaign leaves beside its runs: logs, database, tables."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ellipsoid_planning import atomic
from ellipsoid_planning.errors import EllipsoidPlanningError
from planners.benchmark.campaign import Campaign
from planners.benchmark.database import write_database
from planners.benchmark.merge import merged_log
from planners.benchmark.run import RunRecord
from planners.benchmark.summary import Row
from planners.benchmark.tables import markdown, runs_csv, summary_csv

DATABASE = "benchmark.db"
LOGS = "logs"


def write_outputs(
    folder: Path, campaign: Campaign, records: Sequence[RunRecord], rows: Sequence[Row]
) -> list[Path]:
    """Write logs, database, CSV and Markdown into ``folder``; the files that people look at.

    Raises:
        EllipsoidPlanningError: something cannot be written.
    """
    try:
        logs = _write_logs(folder / LOGS, campaign, records)
        write_database(folder / DATABASE, logs)
        texts = {
            "summary.csv": summary_csv(rows),
            "summary.md": markdown(rows),
            "runs.csv": runs_csv(records),
        }
        for name, text in texts.items():
            atomic.write_text(folder / name, text)
    except OSError as error:
        raise EllipsoidPlanningError(f"{folder}: cannot write there: {error.strerror}") from None
    return [folder / name for name in (DATABASE, *texts)]


def _write_logs(folder: Path, campaign: Campaign, records: Sequence[RunRecord]) -> list[Path]:
    folder.mkdir(exist_ok=True)
    files = []
    for problem in campaign.problems:
        own = [record for record in records if record.problem == problem.name]
        if not own:
            continue
        text = merged_log(
            own,
            runs=campaign.runs,
            time_limit=campaign.time_limit,
            memory_limit=campaign.memory_limit,
            parameters=problem.parameters(),
        )
        files.append(folder / f"{problem.name}.log")
        atomic.write_text(files[-1], text)
    return files
