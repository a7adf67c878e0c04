"""Refinements that are kept: a killed run does none of them twice."""

from __future__ import annotations

import hashlib
import io
import zipfile
from dataclasses import astuple
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.array_members import BROKEN, packed_array
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
        refined = None if content is None else _refined(content)
        if refined is not None:
            return refined
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


def _refined(content: bytes) -> Refined | None:
    """The refinement that was kept; None for what is none of ours, which is done again."""
    try:
        data = _members(content)
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
    except (TypeError, *BROKEN):
        return None


def _members(content: bytes) -> dict[str, NDArray[Any]]:
    archive = zipfile.ZipFile(io.BytesIO(content))
    return {
        member.filename.removesuffix(".npy"): packed_array(archive, member).read()
        for member in archive.infolist()
    }
