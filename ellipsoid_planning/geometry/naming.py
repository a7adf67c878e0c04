"""Names for bodies that have none, so that every message can point at one."""

from __future__ import annotations

from collections.abc import Sequence

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid


def numbered(bodies: Sequence[Ellipsoid], kind: str) -> tuple[Ellipsoid, ...]:
    """Return the bodies with unnamed ones called "kind 1", "kind 2", … by their place."""
    return tuple(
        body if body.name else body.with_name(f"{kind} {index}")
        for index, body in enumerate(bodies, start=1)
    )
