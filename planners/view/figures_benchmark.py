"""The figures of a benchmark."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from planners.benchmark.campaign import Campaign
from planners.benchmark.run import RunRecord
from planners.benchmark.summary import Row


def write_figures(
    folder: Path, campaign: Campaign, records: Sequence[RunRecord], rows: Sequence[Row]
) -> list[Path]:
    """Draw the figures."""
    del folder, campaign, records, rows
    return []
