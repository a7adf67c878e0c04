"""Names in figures as they are written: matplotlib would set what stands between two $ as maths."""

from __future__ import annotations


def as_written(name: str) -> str:
    """Return text that matplotlib shows as ``name``, whatever characters it has."""
    return name.replace("$", r"\$")
