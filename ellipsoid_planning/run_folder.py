"""The folder of a long run, which the same command goes on with: settings first, then results."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ellipsoid_planning import atomic, input_files
from ellipsoid_planning.errors import EllipsoidPlanningError
from ellipsoid_planning.leftovers import remove_partial_files

Settings = Mapping[str, Any]


class RunFolder:
    """A folder with a file of settings, on which everything else in it depends."""

    option = "--output"
    """The command's option that names the folder."""
    manifest = "settings.json"
    """The file of settings."""
    what = "run"
    """What the folder holds, in messages."""

    def __init__(self, folder: Path) -> None:
        """A store in ``folder``; nothing is touched yet."""
        self.folder = folder

    @property
    def is_open(self) -> bool:
        """Whether the folder holds a run already."""
        return (self.folder / self.manifest).is_file()

    @property
    def _where(self) -> str:
        return f"{self.option} {self.folder}"

    def check_settings(
        self, settings: Settings, differences: Callable[[Settings, Settings], list[str]]
    ) -> None:
        """Check that the folder can take a run of these settings, or holds a part, writing nothing.

        Args:
            settings: everything that results depend on.
            differences: what two settings, asked for and found, differ in, for the message.

        Raises:
            EllipsoidPlanningError: it cannot be written to, holds something else, or a run of
                other settings; the message names them.
        """
        if not self.folder.exists():
            parent = self.folder.resolve().parent
            if not parent.is_dir():
                raise EllipsoidPlanningError(
                    f"{self._where}: the folder {str(parent)!r} does not exist; create it first"
                )
            self._check_access(parent)
            return
        if not self.folder.is_dir():
            raise EllipsoidPlanningError(f"{self._where}: expected a folder, this is a file")
        self._check_access(self.folder)
        if not any(self.folder.iterdir()):
            return
        if not self.is_open:
            raise EllipsoidPlanningError(
                f"{self._where}: the folder holds other files; name a new or empty folder"
            )
        different = differences(settings, self.found_settings())
        if different:
            raise EllipsoidPlanningError(
                f"{self._where}: it holds a {self.what} of other settings "
                f"({', '.join(different)}); give the same ones to go on with it, "
                "or name a new folder"
            )

    def _check_access(self, folder: Path) -> None:
        if not os.access(folder, os.W_OK | os.X_OK):
            raise EllipsoidPlanningError(
                f"{self._where}: the folder {str(folder)!r} cannot be written to"
            )

    def found_settings(self) -> Settings:
        """The settings of the run that the folder holds.

        Raises:
            EllipsoidPlanningError: they cannot be read.
        """
        file = self.folder / self.manifest
        try:
            settings = json.loads(input_files.read_text(file))
        except (OSError, ValueError):
            settings = None
        if not isinstance(settings, dict):
            raise EllipsoidPlanningError(f"{file}: it cannot be read; name a new folder")
        return settings

    def write_settings(self, settings: Settings) -> None:
        """Create the folder and write the settings; what killed runs left half-written goes.

        Raises:
            EllipsoidPlanningError: it cannot be created.
        """
        try:
            self.folder.mkdir(exist_ok=True)
            for folder, _, _ in os.walk(self.folder):
                remove_partial_files(Path(folder))
            text = json.dumps(settings, indent=1) + "\n"
            atomic.write_text(self.folder / self.manifest, text)
        except OSError as error:
            raise EllipsoidPlanningError(
                f"{self._where}: cannot write there: {error.strerror}"
            ) from None
