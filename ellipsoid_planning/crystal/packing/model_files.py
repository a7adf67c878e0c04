"""Where packing models and targets are: paths, and the names of bundled ones."""

from __future__ import annotations

from pathlib import Path

from ellipsoid_planning.scenario_files import bundled_files, located


def bundled_models() -> dict[str, Path]:
    """Return the bundled packing models and targets by name, in alphabetical order."""
    return {file.stem: file for file in bundled_files("crystals/*.yaml")}


def locate_data(path_or_name: str | Path) -> Path:
    """Return a data file: a path, or the file name of bundled data, such as dd-peptidase.mtz."""
    path = Path(path_or_name)
    bundled = {file.name: file for file in bundled_files("crystals/*") if file.suffix != ".yaml"}
    return path if path.exists() else bundled.get(str(path_or_name), path)


def locate_model(path_or_name: str | Path) -> Path:
    """Return the file that a path or the name of a bundled model or target points at.

    Raises:
        ScenarioError: if there is neither such a file nor such a bundled one.
    """
    return located(path_or_name, bundled_models(), "model", "packing model's file")
