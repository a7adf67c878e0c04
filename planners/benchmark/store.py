"""The folder of a campaign: finished runs are kept there at once, and found again."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ellipsoid_planning import atomic
from ellipsoid_planning.errors import EllipsoidPlanningError
from planners.benchmark.campaign import Campaign, differences
from planners.benchmark.run import RunRecord, RunTask

CAMPAIGN = "campaign.json"
RUNS = "runs"
RECORD = "record.json"
RESULT = "RESULT.json"
LOG = "ompl.log"


class Store:
    """Finished runs, one folder each: ``runs/PROBLEM/CONTENDER/NUMBER/``.

    It holds ``RESULT.json`` with the path, ``ompl.log``, and ``record.json``, which is written
    last: a run is finished when its record is there.
    """

    def __init__(self, folder: Path) -> None:
        """A store in ``folder``; nothing is touched yet."""
        self.folder = folder

    def check(self, campaign: Campaign) -> None:
        """Check that the folder can take this campaign, or holds a part of it, writing nothing.

        Raises:
            EllipsoidPlanningError: it cannot be written to, holds something else, or a campaign
                of other settings; the message names them.
        """
        where = f"--output {self.folder}"
        if not self.folder.exists():
            parent = self.folder.resolve().parent
            if not parent.is_dir():
                raise EllipsoidPlanningError(
                    f"{where}: the folder {str(parent)!r} does not exist; create it first"
                )
            self._check_access(parent)
            return
        if not self.folder.is_dir():
            raise EllipsoidPlanningError(f"{where}: expected a folder, this is a file")
        self._check_access(self.folder)
        if not any(self.folder.iterdir()):
            return
        if not (self.folder / CAMPAIGN).is_file():
            raise EllipsoidPlanningError(
                f"{where}: the folder holds other files; name a new or empty folder"
            )
        self._check_settings(campaign)

    def _check_access(self, folder: Path) -> None:
        if not os.access(folder, os.W_OK | os.X_OK):
            raise EllipsoidPlanningError(
                f"--output {self.folder}: the folder {str(folder)!r} cannot be written to"
            )

    def _check_settings(self, campaign: Campaign) -> None:
        different = differences(campaign.settings(), self._settings())
        if different:
            raise EllipsoidPlanningError(
                f"--output {self.folder}: it holds a campaign of other settings "
                f"({', '.join(different)}); give the same ones to go on with it, "
                "or name a new folder"
            )

    def _settings(self) -> Mapping[str, Any]:
        file = self.folder / CAMPAIGN
        try:
            settings = json.loads(file.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            settings = None
        if not isinstance(settings, dict):
            raise EllipsoidPlanningError(f"{file}: it cannot be read; name a new folder")
        return settings

    def open(self, campaign: Campaign) -> None:
        """Create what is not there yet.

        Raises:
            EllipsoidPlanningError: it cannot be created.
        """
        try:
            (self.folder / RUNS).mkdir(parents=True, exist_ok=True)
            text = json.dumps(campaign.settings(), indent=1) + "\n"
            atomic.write_text(self.folder / CAMPAIGN, text)
        except OSError as error:
            raise EllipsoidPlanningError(
                f"--output {self.folder}: cannot write there: {error.strerror}"
            ) from None

    def keep(self, record: RunRecord) -> None:
        """Write a finished run.

        Raises:
            EllipsoidPlanningError: it cannot be written.
        """
        folder = self.folder / RUNS / record.key
        data = record.to_dict()
        result, log = data.pop("result"), data.pop("log")
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if result is not None:
                atomic.write_text(folder / RESULT, json.dumps(result, indent=1) + "\n")
            if log is not None:
                atomic.write_text(folder / LOG, log)
            atomic.write_text(folder / RECORD, json.dumps(data, indent=1) + "\n")
        except OSError as error:
            raise EllipsoidPlanningError(
                f"{folder}: cannot write the run: {error.strerror}"
            ) from None

    def finished(self, task: RunTask) -> RunRecord | None:
        """The record of a task that was finished earlier, without its result; None if it was not.

        A record that cannot be read counts as none: the run is done again.
        """
        folder = self.folder / RUNS / task.key
        try:
            data = json.loads((folder / RECORD).read_text(encoding="utf-8"))
            log = folder / LOG
            text = log.read_text(encoding="utf-8") if log.exists() else None
            return RunRecord(**data, log=text)
        except (OSError, ValueError, TypeError):
            return None
