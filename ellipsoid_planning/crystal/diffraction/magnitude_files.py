"""Measured magnitudes: reading them for a model."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.diffraction.data_checks import check_crystal
from ellipsoid_planning.crystal.diffraction.magnitudes import Magnitudes
from ellipsoid_planning.crystal.diffraction.reflection_table import (
    INTENSITY,
    MAGNITUDE,
    UNCERTAINTY,
    ReflectionTable,
    read_table,
)
from ellipsoid_planning.crystal.diffraction.reflections import Reflections, absent, representatives
from ellipsoid_planning.crystal.diffraction.structure_factors import reflections_of
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.errors import ScenarioError

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

# Names of columns, best first; compared without case, hyphens and underscores.
MEASURED = (
    "FP",
    "F",
    "FOBS",
    "FO",
    "FMEASAU",
    "FMEAS",
    "I",
    "IMEAN",
    "IOBS",
    "INTENSITYMEAS",
    "FSQUAREDMEAS",
)
CALCULATED = (
    "FC",
    "FCALC",
    "FCALCAU",
    "INTENSITYCALC",
    "FSQUAREDCALC",
)


def read_magnitudes(
    path: str | Path,
    model: PackingModel,
    column: str | None = None,
    *,
    skip_missing: bool = False,
    block: str | None = None,
) -> Magnitudes:
    """Read the magnitudes that a model is compared with from an MTZ, CIF or mmCIF file.

    Equivalent reflections are averaged; those beyond the model's resolution, and those that its
    group forbids, are left out. For a planar model the reflections with l = 0 are read.

    Args:
        path: the file.
        model: the packing model; the file's cell and group, if it tells them, must be its own.
        column: which column; by default the first there is of `MEASURED`, else the only one of
            its kind, else the first of `CALCULATED`. Intensities are made magnitudes by their
            square root.
        skip_missing: leave reflections without a value, or with an intensity below 0, out.
        block: of a CIF file, its data block; by default the first with reflections.

    Raises:
        ScenarioError: names the file, the column, and the reflection whose magnitude is missing
            or negative; or the cell's length or angle, or the group, that is not the model's.
        CrystalError: if gemmi is missing.
    """
    table = read_table(path, block)
    notes = (*table.notes, *check_crystal(table, model))
    name = column or _choose(table)
    if name not in table.columns or table.kinds[name] not in (MAGNITUDE, INTENSITY):
        raise ScenarioError(
            f"expected a column of magnitudes or intensities, {name!r} is none; {_offer(table)}",
            file=table.file,
        )
    wanted = reflections_of(model)
    places = _places(table, model, wanted.indices)
    usable = _usable(table, name, places, skip_missing)
    left = int(np.sum((places >= 0) & ~usable))
    if left:
        notes += (f"{left} reflections have no usable value in {name} and are left out",)
    places[~usable] = -1
    return replace(_merge(table, name, places, wanted), notes=notes)


def _offer(table: ReflectionTable) -> str:
    fit = [name for name, kind in table.kinds.items() if kind in (MAGNITUDE, INTENSITY)]
    return f"the file has {', '.join(fit)}" if fit else "the file has no such column"


def _choose(table: ReflectionTable) -> str:
    plain = {name.upper().replace("-", "").replace("_", ""): name for name in table.columns}
    usable = {key: n for key, n in plain.items() if table.kinds[n] in (MAGNITUDE, INTENSITY)}
    for key in MEASURED:
        if key in usable:
            return usable[key]
    others = [name for key, name in usable.items() if key not in CALCULATED]
    for kind in (MAGNITUDE, INTENSITY):
        found = [name for name in others if table.kinds[name] == kind]
        if len(found) == 1:
            return found[0]
        if found:
            break
    for key in CALCULATED:
        if key in usable and not others:
            return usable[key]
    raise ScenarioError(
        f"expected one column of magnitudes or intensities; {_offer(table)}, name the right one"
        if usable
        else "expected a column of magnitudes or intensities; the file has none (Friedel mates in "
        "columns of their own, as F(+) and F(-), are to be averaged first)",
        file=table.file,
    )


def _places(table: ReflectionTable, model: PackingModel, wanted: Integers) -> Integers:
    """(N,), which of the model's reflections each row is; -1 for none of them."""
    n = model.dimension
    flat = np.all(table.indices[:, n:] == 0, axis=1)
    own = table.indices[:, :n]
    whole = {tuple(h): place for place, h in enumerate(wanted.tolist())}
    standing = representatives(model.group, own).tolist()
    places = np.array([whole.get(tuple(h), -1) for h in standing], dtype=np.int64)
    places[~flat | absent(model.group, own)] = -1
    if not np.any(places >= 0):
        raise ScenarioError(
            f"no reflection is within the model's resolution of {model.resolution:g}; the model's "
            "unit of length may be another one than the data's",
            file=table.file,
        )
    return places


def _usable(
    table: ReflectionTable, name: str, places: Integers, skip_missing: bool
) -> NDArray[np.bool_]:
    values = table.columns[name]
    intensity = table.kinds[name] == INTENSITY
    within = places >= 0
    missing = within & ~np.isfinite(values)
    negative = within & (values < 0.0)
    skipped = missing | negative if intensity else missing
    if not intensity and np.any(negative):
        _refuse(table, name, negative, "a magnitude of 0 or more")
    if not skip_missing:
        remedy = "; complete the data, or leave those out (--skip-missing)"
        _refuse(table, name, missing, "a magnitude", remedy)
        remedy = "; make magnitudes of the intensities, or leave those out (--skip-missing)"
        _refuse(table, name, negative, "an intensity of 0 or more", remedy)
    return within & ~skipped


def _refuse(
    table: ReflectionTable, name: str, rows: NDArray[np.bool_], expected: str, remedy: str = ""
) -> None:
    """Raise an error that names the first of ``rows``, if there is one."""
    found = np.flatnonzero(rows)
    if not len(found):
        return
    value = table.columns[name][found[0]]
    more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
    raise ScenarioError(
        f"reflection {tuple(table.indices[found[0]].tolist())}{more}: expected {expected}, got "
        f"{'none' if np.isnan(value) else format(value, 'g')}{remedy}",
        file=table.file,
        field=name,
    )


def _merge(table: ReflectionTable, name: str, places: Integers, wanted: Reflections) -> Magnitudes:
    rows = places >= 0
    counts = np.bincount(places[rows], minlength=len(wanted))
    values, sigmas = _magnitudes(table, name)
    sums = np.bincount(places[rows], values[rows], len(wanted))
    found = counts > 0
    merged = None
    if sigmas is not None and np.all(np.isfinite(sigmas[rows]) & (sigmas[rows] >= 0.0)):
        squares = np.bincount(places[rows], sigmas[rows] ** 2, len(wanted))
        merged = np.sqrt(squares[found]) / counts[found]
    return Magnitudes(
        wanted.subset(found),
        sums[found] / counts[found],
        merged,
        source=f"{table.file}: {name}",
        relative=True,
        missing=wanted.indices[~found],
    )


def _magnitudes(table: ReflectionTable, name: str) -> tuple[Array, Array | None]:
    """Magnitudes (N,) and their uncertainties; of intensities by error propagation."""
    values, sigmas = table.columns[name], _uncertainties(table, name)
    if table.kinds[name] != INTENSITY:
        return values, sigmas
    sizes = np.sqrt(np.maximum(values, 0.0))
    if sigmas is None:
        return sizes, None
    # 2 F dF = dI, and where F is about 0, F is known to the root of dI.
    with np.errstate(invalid="ignore"):
        return sizes, sigmas / (sizes + np.sqrt(sizes**2 + sigmas))


def _uncertainties(table: ReflectionTable, name: str) -> Array | None:
    for tag in (f"SIG{name}", f"SIG_{name}", f"{name}_sigma", f"{name}_su"):
        if table.kinds.get(tag) == UNCERTAINTY:
            return table.columns[tag]
    stem = name.removesuffix("_au").removesuffix("_meas")
    for tag in (f"{stem}_meas_sigma_au", f"{stem}_meas_sigma", f"{stem}_sigma", f"{stem}_su"):
        if table.kinds.get(tag) == UNCERTAINTY:
            return table.columns[tag]
    return None
