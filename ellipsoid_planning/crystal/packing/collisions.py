"""Which arrangements keep all copies of the molecule apart, one by one."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.kernels import layout, packing

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

FARTHEST = 100.0  # cells that a shift may go beyond its range


def watched_pairs(model: PackingModel) -> list[tuple[int, int]]:
    """Parts of one molecule that must keep apart: not in one limb, nor joined, nor ignored."""
    robot = model.molecule.robot
    frames = model.molecule.part_frames
    joined = {frozenset((joint.parent, joint.child)) for joint in robot.joints}
    free = joined | robot.ignored
    links = robot.part_links
    return [
        (i, j)
        for j in range(len(links))
        for i in range(j)
        if frames[i] != frames[j] and frozenset((links[i], links[j])) not in free
    ]


def _check_shifts(model: PackingModel, configurations: Array) -> None:
    """Refuse shifts so far beyond the grid's ranges that rounding would decide."""
    edge = float(model.cell.lengths.max())
    for place, (range_, of) in enumerate(
        zip(model.grid.ranges, model.molecule.coordinates, strict=True)
    ):
        most = max(abs(range_.lower), abs(range_.upper)) + FARTHEST * edge
        values = np.abs(configurations[:, place]) if not of.turns else np.zeros(0)
        if np.any(values > most):
            raise CrystalError(
                f"{model.name}: {of.name} = {values.max():.6g} is far from the cell; expected at "
                f"most {most:.6g}: take lattice vectors off"
            )


def watched(model: PackingModel) -> NDArray[np.bool_]:
    """(P, P), whether :func:`watched_pairs` has the pair [i, j], i < j."""
    count = len(model.molecule.parts)
    pairs = np.zeros((count, count), bool)
    for i, j in watched_pairs(model):
        pairs[i, j] = True
    return pairs


def shape_rows(model: PackingModel, parts: Integers) -> Array:
    """Rows (m, BODY) of parts in their coordinates' frames, for kernels.packing."""
    rows = np.zeros((len(parts), layout.BODY))
    posed = model.molecule.parts[parts]
    rows[:, layout.BODY_CENTRE : layout.BODY_CENTRE + 12] = posed
    for row, matrix in zip(rows, posed[:, 3:].reshape(-1, 3, 3), strict=True):
        axes = np.linalg.norm(matrix, axis=0)
        # A = R diag(a) has the inverse diag(1/a²) Aᵀ, exact for needles, too.
        row[layout.BODY_INVERSE : layout.BODY_INVERSE + 9] = (matrix / axes**2).T.ravel()
        used = axes[: model.dimension]
        row[layout.BODY_RADIUS], row[packing.INSCRIBED] = used.max(), used.min()
    return rows


@lru_cache(maxsize=8)
def _tables_of(model: PackingModel) -> tuple[Array, NDArray[np.bool_]]:
    """Shapes of all parts, and which pairs of them are watched: planners ask state by state."""
    return shape_rows(model, np.arange(len(model.molecule.parts))), watched(model)


def arrangements_free(model: PackingModel, configurations: Array) -> NDArray[np.bool_]:
    """Whether each arrangement (m, K) is free; True is proved.

    Raises:
        CrystalError: if the shape is another, or a value is not finite.
    """
    whole = model.molecule
    size = len(whole.coordinates)
    if configurations.ndim != 2 or configurations.shape[1] != size:
        raise CrystalError(
            f"{model.name}: expected configurations of shape (m, {size}) "
            f"({', '.join(model.keys)}), got shape {configurations.shape}"
        )
    if not np.all(np.isfinite(configurations)):
        raise CrystalError(f"{model.name}: expected configurations of finite numbers")
    _check_shifts(model, configurations)
    shapes, pairs = _tables_of(model)
    free = np.empty(len(configurations), bool)
    packing.arrangements_free(
        whole.kinds,
        whole.parents,
        whole.origins,
        whole.axes,
        whole.part_frames,
        shapes,
        pairs,
        model.crystal,
        model.required,
        model.lever,
        model.loss,
        np.ascontiguousarray(configurations),
        free,
    )
    return free
