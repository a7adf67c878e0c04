"""Every kernel benchmark as a case: a topic, a method, and what to call."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.pair_cases import pair_cases
from benchmarks.scene_cases import scene_cases
from benchmarks.scenes import samples


@dataclass(frozen=True)
class Case:
    """One thing to time; methods of one topic do the same work on the same inputs.

    Attributes:
        topic: what is computed, once per operation.
        method: by whom.
        operations: how many of them one call of ``run`` does.
        run: does them.
    """

    topic: str
    method: str
    operations: int
    run: Callable[[], Any]


OURS = "this project"
"""The method that the others are compared with; it is the first of each topic."""


def all_cases() -> list[Case]:
    """All cases, those of one topic together, ours first."""
    found = [*pair_cases(), *scene_cases(samples())]
    return [Case(*fields) for fields in found]


def agreement(case: Case) -> Any:
    """What the case finds, for a look at whether methods agree: a number of hits, or None."""
    result = case.run()
    return None if result is None else int(np.count_nonzero(result))
