"""The folder of a campaign: finished runs are kept there at once, and found again."""

from __future__ import annotations

import json

from ellipsoid_planning import atomic, input_files
from ellipsoid_planning.errors import EllipsoidPlanningError
from ellipsoid_planning.run_folder import RunFolder
from planners.benchmark.campaign import Campaign, differences
from planners.benchmark.run import RunRecord, RunTask

RUNS = "runs"
RECORD = "record.json"
RESULT = "RESULT.json"
LOG = "ompl.log"


class Store(RunFolder):
    """Finished runs, one folder each: ``runs/PROBLEM/CONTENDER/NUMBER/``.

    It holds ``RESULT.json`` with the path, ``ompl.log``, and ``record.json``, which is written
    last: a run is finished when its record is there.
    """

    manifest = "campaign.json"
    what = "campaign"

    def check(self, campaign: Campaign) -> None:
        """Check that the folder can take this campaign, or holds a part of it, writing nothing.

        Raises:
            EllipsoidPlanningError: it cannot be written to, holds something else, or a campaign
                of other settings; the message names them.
        """
        self.check_settings(campaign.settings(), differences)

    def open(self, campaign: Campaign) -> None:
        """Create what is not there yet.

        Raises:
            EllipsoidPlanningError: it cannot be created.
        """
        self.write_settings(campaign.settings())

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
            data = json.loads(input_files.read_text(folder / RECORD))
            log = folder / LOG
            text = input_files.read_text(log) if log.exists() else None
            return RunRecord(**data, log=text)
        except (OSError, ValueError, TypeError):
            return None
