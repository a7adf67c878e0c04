"""What came of a case, for any kind of robot."""

from __future__ import annotations

from typing import NamedTuple

from ellipsoid_planning.scenario import Scenario


class Counterexample(NamedTuple):
    """A scenario whose motion from start to goal was decided wrongly, and how."""

    what: str
    scenario: Scenario


class Outcome(NamedTuple):
    """How many motions (or lines) were tried and certified, and what was wrong.

    ``false`` are certificates of what collides, ``refused`` what is free by more than the tolerance
    and was not certified.
    """

    tried: int = 0
    certified: int = 0
    false: tuple[Counterexample, ...] = ()
    refused: tuple[Counterexample, ...] = ()

    def __add__(self, other: Outcome) -> Outcome:  # type: ignore[override]
        """Both together."""
        return Outcome(*(a + b for a, b in zip(self, other, strict=True)))
