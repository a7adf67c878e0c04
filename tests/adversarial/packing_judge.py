"""The least gap between a body and its copies in a crystal, in extended precision.

Written from the definition: the group's operations on fractional coordinates, the cell's basis, and
the molecule's shifts along the cell's axes and turns about its own.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from tests.adversarial.articulated_judge import Long, about, inverse_of, separations, turns

Array = Any


def placed(model: Any, configuration: Any) -> tuple[Array, Array]:
    """Centre (n,) and matrix (n, n) of the molecule's one body."""
    n, (part,) = model.dimension, model.parts
    basis = Long(1) * model.cell.basis
    at, turn = np.zeros(n, dtype=Long), np.eye(n, dtype=Long)
    axes = iter("ZXZ")
    for value, coordinate in zip(configuration, model.molecule.coordinates, strict=True):
        angle = Long(1) * np.array([value])
        if coordinate.name in ("x", "y", "z"):
            along = basis[:, "xyz".index(coordinate.name)]
            at = at + angle[0] * along / np.sqrt(along @ along)
        elif n == 2:
            turn = turn @ turns(angle)[0]
        else:
            turn = turn @ about(np.eye(3)["XYZ".index(next(axes))], angle)[0]
    return at + turn @ (Long(1) * part.centre), turn @ (Long(1) * part.matrix)


def least_gap(model: Any, configuration: Any) -> Array:
    """The least signed gap to any copy, the body itself aside, up to 0.4 of its size."""
    c, m = placed(model, configuration)
    basis, n = Long(1) * model.cell.basis, model.dimension
    inverse = inverse_of(model.cell.basis)
    radius = 2 * float(np.linalg.norm(m.astype(float), 2))
    reach = np.ceil(radius * np.linalg.norm(inverse.astype(float), axis=1)).astype(int) + 1
    steps = np.array(list(itertools.product(*[range(-k, k + 1) for k in reach])))
    offsets, copies = [], []
    for g, (turn, shift) in enumerate(
        zip(model.group.rotations, model.group.translations, strict=True)
    ):
        whole = basis @ (Long(1) * turn) @ inverse
        away = inverse @ (whole @ c - c) + Long(1) * shift
        # An exact multiple is taken off before anything is rounded.
        lattice = steps - np.rint(away.astype(float))
        found = (away + lattice[lattice.any(1) | (g > 0)]) @ basis.T
        found = found[(found * found).sum(1) <= (1.2 * radius) ** 2]
        offsets.append(found)
        copies.append(np.broadcast_to(whole @ m, (len(found), n, n)))
    offsets, copies = np.concatenate(offsets), np.concatenate(copies)
    if not len(offsets):
        return Long(0.2 * radius)
    found = separations(offsets, np.broadcast_to(m, copies.shape), copies).min()
    return min(found, Long(0.2 * radius))
