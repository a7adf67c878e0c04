"""Domains of a molecule by ranges of residues, and the hinges where its chains cross over."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.structures.residue_ranges import (
    FORM,
    Residue,
    ResidueRange,
    chosen_atoms,
    parse_range,
    sequence,
)
from ellipsoid_planning.crystal.structures.structure import CrystalStructure
from ellipsoid_planning.errors import CrystalError, ScenarioError

Array = NDArray[np.float64]

TRACE = ("CA", "P")  # the atom of each residue that stands for it: in proteins, in nucleic acids


@dataclass(frozen=True)
class Domain:
    """A part of a molecule that moves as one body."""

    name: str
    ranges: tuple[ResidueRange, ...]

    def __str__(self) -> str:
        texts: list[str] = []
        for index, entry in enumerate(self.ranges):
            repeated = index > 0 and self.ranges[index - 1].chain == entry.chain
            texts.append(entry.residues if repeated and entry.first is not None else str(entry))
        return f"{self.name}={'+'.join(texts)}"


@dataclass(frozen=True, eq=False)
class Hinge:
    """Where chains cross from one domain to another.

    Attributes:
        first: the name of one domain.
        second: the name of the other one.
        points: the centroids of the C-alphas of each crossing, shape (k, 3) [Å].
        crossings: the residues on both sides of each, such as ``A/79-80``.
    """

    first: str
    second: str
    points: Array
    crossings: tuple[str, ...]

    @property
    def centre(self) -> Array:
        """The middle of the crossings, shape (3,) [Å]."""
        return np.asarray(self.points.mean(axis=0))

    @property
    def axis(self) -> Array | None:
        """The unit vector (3,) along two or more crossings; None for a single one.

        A turn about it keeps two chains where they cross, so that they stay whole.
        """
        away = self.points - self.centre
        if len(self.points) < 2 or np.abs(away).max() < 1e-6:
            return None
        direction = np.linalg.svd(away)[2][0]
        return np.asarray(direction * np.sign(direction[np.argmax(np.abs(direction))]))


def parse_domain(text: str) -> Domain:
    """Read ``NAME=CHAIN/FIRST-LAST+…``.

    A range without a chain is in that of the range before; a chain alone is all of it (``1/`` and
    ``-/`` if it is named so), a number alone is one residue. Numbers may have insertion codes
    (``80A-95``); ``/1-90`` is in a chain without a name.

    Raises:
        CrystalError: it is written otherwise; says how it should be.
    """
    name, equals, listed = text.partition("=")
    if not equals or not name.strip() or not listed.strip():
        raise CrystalError(f"domain {text!r}: {FORM}")
    ranges: list[ResidueRange] = []
    for entry in listed.split("+"):
        ranges.append(parse_range(entry.strip(), ranges[-1].chain if ranges else None, text))
    return Domain(name.strip(), tuple(ranges))


def assign(structure: CrystalStructure, domains: Sequence[Domain]) -> NDArray[np.int64]:
    """For each atom the index of its domain, -1 for none, shape (m,).

    Only atoms of polymers belong to domains.

    Raises:
        CrystalError: there is no domain, or two have one name.
        ScenarioError: a chain is not in the file, a range has no residues there, or domains
            overlap; names the file, the domain and the remedy.
    """
    names = [domain.name for domain in domains]
    if not names:
        raise CrystalError(f"expected at least one domain; {FORM}")
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise CrystalError(
            f"domain {twice!r}: there are two of this name; rename one, or join their ranges by +"
        )
    owners = np.full(len(structure.atoms), -1, dtype=np.int64)
    for index, domain in enumerate(domains):
        chosen = _chosen(structure, domain)
        _check_overlap(structure, domains, owners, chosen, index)
        owners[chosen] = index
    return owners


def _chosen(structure: CrystalStructure, domain: Domain) -> NDArray[np.bool_]:
    """Which atoms (m,) are in the domain."""
    chosen = np.zeros(len(structure.atoms), dtype=np.bool_)
    for part in domain.ranges:
        chosen |= chosen_atoms(structure, part, str(domain))
    return chosen


def _check_overlap(
    structure: CrystalStructure,
    domains: Sequence[Domain],
    owners: NDArray[np.int64],
    chosen: NDArray[np.bool_],
    index: int,
) -> None:
    taken = np.flatnonzero(chosen & (owners >= 0))
    if len(taken):
        other = domains[int(owners[taken[0]])]
        raise ScenarioError(
            f"residue {structure.atoms.residue_name(taken[0])} is also in the domain {other}; "
            "domains must not overlap, change one of the ranges",
            file=structure.file,
            field=f"domain {domains[index]}",
        )


def find_hinges(
    structure: CrystalStructure, domains: Sequence[Domain], owners: NDArray[np.int64]
) -> tuple[Hinge, ...]:
    """The hinges of all pairs of domains that a chain joins, in the order of the chains.

    Residues between two domains that belong to none are a linker; its middle is the point.

    Args:
        structure: the molecule.
        domains: its domains.
        owners: of `assign`.
    """
    points: dict[tuple[int, int], list[Array]] = {}
    crossings: dict[tuple[int, int], list[str]] = {}
    for chain, rows in _traces(structure):
        for start, stop in _crossings(owners[rows]):
            first, second = sorted((int(owners[rows[start]]), int(owners[rows[stop]])))
            middle = structure.atoms.positions[rows[start : stop + 1]].mean(axis=0)
            points.setdefault((first, second), []).append(middle)
            before, after = (structure.atoms.residue_name(rows[k]) for k in (start, stop))
            crossings.setdefault((first, second), []).append(f"{chain}/{before}-{after}")
    return tuple(
        Hinge(domains[i].name, domains[j].name, np.array(found), tuple(crossings[i, j]))
        for (i, j), found in points.items()
    )


def _traces(structure: CrystalStructure) -> list[tuple[str, NDArray[np.int64]]]:
    """For each chain the rows of the atoms that stand for its residues, in sequence."""
    atoms = structure.atoms
    traced = atoms.polymer & np.isin(atoms.names, TRACE)
    traces = []
    for chain in structure.chains:
        rows = np.flatnonzero(traced & (atoms.chains == chain))
        firsts: dict[Residue, int] = {}  # the first of alternative positions
        for row in rows.tolist():
            firsts.setdefault(atoms.residue(row), row)
        traces.append((chain, np.array([firsts[one] for one in sequence(list(firsts))], int)))
    return traces


def _crossings(owners: NDArray[np.int64]) -> list[tuple[int, int]]:
    """Places of residues, each the last one of a domain and the first one of the next domain."""
    owned = np.flatnonzero(owners >= 0)
    pairs = zip(owned[:-1].tolist(), owned[1:].tolist(), strict=True)
    return [(i, j) for i, j in pairs if owners[i] != owners[j]]
