"""Refinements that are kept: a killed run does none of them twice."""

from __future__ import annotations

import hashlib
import io
from dataclasses import astuple

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.phasing.run_store import Keeper
from ellipsoid_planning.crystal.phasing.trace import Trace

from .parameters import Refinement
from .refine import Refined, refine

Array = NDArray[np.float64]


class KeptRefinements:
    """Refines as `refine` does, unless the store has the result; keeps what it does."""

    def __init__(self, store: Keeper) -> None:
        self._store = store

    def __call__(self, cost: FourierCost, start: Array, parameters: Refinement) -> Refined:
        """The refinement of ``start`` (K,); see `refine`."""
        name = _name(start, parameters)
        content = self._store.kept(name)
        if content is not None:
            return _refined(content)
        refined = refine(cost, start, parameters)
        self._store.keep(name, _content(refined))
        return refined


def _name(start: Array, parameters: Refinement) -> str:
    """The store belongs to one model and one target; the rest makes the name."""
    digest = hashlib.sha256(np.ascontiguousarray(start, dtype=float).tobytes())
    digest.update(repr(astuple(parameters)).encode())
    return f"refined/{digest.hexdigest()[:24]}"


def _content(refined: Refined) -> bytes:
    content = io.BytesIO()
    np.savez(
        content,
        configuration=refined.configuration,
        cost=refined.cost,
        free=refined.free,
        trace=refined.trace.configurations,
        costs=refined.trace.costs,
        rounds=refined.rounds,
        seconds=refined.seconds,
        allow_pickle=False,
    )
    return content.getvalue()


def _refined(content: bytes) -> Refined:
    with np.load(io.BytesIO(content), allow_pickle=False) as data:
        trace = Trace()
        for configuration, cost in zip(data["trace"], data["costs"], strict=True):
            trace.add(configuration, cost)
        return Refined(
            data["configuration"],
            float(data["cost"]),
            bool(data["free"]),
            trace,
            int(data["rounds"]),
            float(data["seconds"]),
        )
