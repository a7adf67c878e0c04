"""The type of a space group."""

from __future__ import annotations

from collections.abc import Sequence

from ellipsoid_planning.crystal.operation import Operation


def type_number(operations: Sequence[Operation]) -> int | None:
    """The number from 1 to 230 of the type of these operations."""
    _ = operations
    return None
