"""What a verification found, in words and numbers."""

from __future__ import annotations

from dataclasses import dataclass

VERIFIED = "verified"
NOT_VERIFIED = "not verified"
NOT_RESOLVED = "not resolved"


@dataclass(frozen=True)
class Check:
    """One question about a path.

    Attributes:
        name: what was checked.
        passed: the answer.
        detail: the numbers behind it.
        open: True if it did not pass because it could not be decided.
    """

    name: str
    passed: bool
    detail: str
    open: bool = False


@dataclass(frozen=True)
class VerificationReport:
    """The outcome of a verification.

    Attributes:
        checks: every question that was asked, in order.
        samples: how many configurations were tested.
        sampled_clearance: the smallest distance to an obstacle or an arena's boundary at any of
            them; never below the path's true clearance but by rounding. Not positive in
            contact, infinite without bodies.
        resolved: the fraction of the path, by the robot's largest travel, that is proved free
            between the samples, too.
        fcl_samples: how many configurations FCL tested as well.
        scenario: which scenario the path was judged against, in words.
    """

    checks: tuple[Check, ...]
    samples: int = 0
    sampled_clearance: float = float("nan")
    resolved: float = 0.0
    fcl_samples: int = 0
    scenario: str = ""

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return all(check.passed for check in self.checks)

    @property
    def failures(self) -> tuple[Check, ...]:
        """The checks that did not pass."""
        return tuple(check for check in self.checks if not check.passed)

    @property
    def verdict(self) -> str:
        """`VERIFIED`, `NOT_RESOLVED` if all that is wrong is open questions, or `NOT_VERIFIED`."""
        if self.passed:
            return VERIFIED
        return NOT_RESOLVED if all(check.open for check in self.failures) else NOT_VERIFIED
