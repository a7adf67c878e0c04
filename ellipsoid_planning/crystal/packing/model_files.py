"""Where packing models and targets are: paths, and the names of bundled ones."""

from __future__ import annotations

import difflib
from pathlib import Path

from ellipsoid_planning.errors import ScenarioError

FOLDER = "crystals"


def bundled_models() -> dict[str, Path]:
    """Return the bundled packing models and targets by name, in alphabetical order."""
    return {file.stem: file for file in _bundled("*.yaml")}


def _bundled(pattern: str) -> list[Path]:
    package = Path(__file__).parents[2]
    # A wheel carries the files inside the package; a checkout has them beside it.
    for place in (package / "_scenarios", package.parent / "scenarios"):
        files = sorted((place / FOLDER).glob(pattern))
        if files:
            return files
    return []


def locate_data(path_or_name: str | Path) -> Path:
    """Return a data file: a path, or the file name of bundled data, such as dd-peptidase.mtz."""
    path = Path(path_or_name)
    bundled = {file.name: file for file in _bundled("*") if file.suffix != ".yaml"}
    return path if path.exists() else bundled.get(str(path_or_name), path)


def locate_model(path_or_name: str | Path) -> Path:
    """Return the file that a path or the name of a bundled model or target points at.

    Raises:
        ScenarioError: if there is neither such a file nor such a bundled one.
    """
    path = Path(path_or_name)
    if path.is_file():
        return path
    bundled, text = bundled_models(), str(path_or_name)
    if text in bundled:
        return bundled[text]
    if path.is_dir():
        raise ScenarioError("expected a packing model's file, got a folder", file=text)
    close = difflib.get_close_matches(path.stem, list(bundled), n=3, cutoff=0.5)
    hint = f"did you mean {' or '.join(close)}?" if close else f"bundled are {', '.join(bundled)}"
    raise ScenarioError(f"no such file, and no bundled model of this name; {hint}", file=text)
