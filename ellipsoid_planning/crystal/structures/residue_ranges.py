"""Ranges of residues as text, and the residues of a structure that they name."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import CrystalError, ScenarioError

if TYPE_CHECKING:
    from ellipsoid_planning.crystal.structures.structure import CrystalStructure

Residue = tuple[int, str]  # number and insertion code, "" for none

RANGE = re.compile(
    r"(?:(?P<chain>[^/]*)/)?"
    r"(?:(?P<first>-?\d+)(?P<first_code>[A-Za-z]?)"
    r"(?:-(?P<last>-?\d+)(?P<last_code>[A-Za-z]?))?)?"
)
PLAIN_CHAIN = re.compile(r"[^/\d+-][^/]*")  # no number, so that it needs no stroke
FORM = (
    "expected NAME=CHAIN/FIRST-LAST+…, such as alpha=A/80-190+301-310; a whole chain that is "
    "named by a number or a sign as 1/"
)


@dataclass(frozen=True)
class ResidueRange:
    """Residues of one chain, both ends included; None: all of it.

    An end without an insertion code takes all residues of its number.
    """

    chain: str
    first: int | None = None
    last: int | None = None
    first_code: str = ""
    last_code: str = ""

    def __str__(self) -> str:
        if self.first is None:
            return self.chain if PLAIN_CHAIN.fullmatch(self.chain) else f"{self.chain}/"
        return f"{self.chain}/{self.residues}"

    @property
    def residues(self) -> str:
        """The range without its chain."""
        return f"{self.first}{self.first_code}-{self.last}{self.last_code}"


def parse_range(entry: str, chain: str | None, text: str) -> ResidueRange:
    """Read ``CHAIN/FIRST-LAST``, ``CHAIN/FIRST``, ``CHAIN``, ``CHAIN/``, or one without its chain.

    Args:
        entry: the range.
        chain: of the range before, None for the first.
        text: all of the domain, for messages.

    Raises:
        CrystalError: it is written otherwise.
    """
    if PLAIN_CHAIN.fullmatch(entry):
        return ResidueRange(entry)
    found = RANGE.fullmatch(entry)
    own = chain if found is None or found["chain"] is None else found["chain"]
    if found is None or own is None or not entry:
        raise CrystalError(f"domain {text!r}: cannot read the range {entry!r}; {FORM}")
    if found["first"] is None:
        return ResidueRange(own)
    first, first_code = int(found["first"]), found["first_code"]
    last, last_code = first, first_code
    if found["last"] is not None:
        last, last_code = int(found["last"]), found["last_code"]
    if last < first:
        raise CrystalError(
            f"domain {text!r}: the range {entry!r} ends before it begins; exchange its numbers"
        )
    return ResidueRange(own, first, last, first_code, last_code)


def chosen_atoms(structure: CrystalStructure, part: ResidueRange, domain: str) -> NDArray[np.bool_]:
    """Which atoms (m,) of polymers are in a range.

    Args:
        structure: the molecule.
        part: the range.
        domain: whose it is, for messages.

    Raises:
        ScenarioError: the chain is not in the file, or has no such residues.
    """
    atoms = structure.atoms
    if part.chain not in structure.chains:
        known = ", ".join(_shown(chain) for chain in structure.chains)
        raise ScenarioError(
            f"there is no chain {part.chain!r} with a polymer; there are {known or 'none'}",
            file=structure.file,
            field=f"domain {domain}",
        )
    here = atoms.polymer & (atoms.chains == part.chain)
    if part.first is None:
        return here
    rows = np.flatnonzero(here)
    residues = list(
        zip(atoms.residues[rows].tolist(), atoms.insertions[rows].tolist(), strict=True)
    )
    order = sequence(residues)
    places = [k for k, residue in enumerate(order) if _is_within(k, residue, order, part)]
    if not places:
        raise ScenarioError(
            f"there are no residues {part.first}{part.first_code} to {part.last}{part.last_code} "
            f"in chain {_shown(part.chain)}; it has {_name(order[0])} to {_name(order[-1])}",
            file=structure.file,
            field=f"domain {domain}",
        )
    wanted = {order[k] for k in places}
    chosen = np.zeros(len(atoms), dtype=np.bool_)
    chosen[rows] = [residue in wanted for residue in residues]
    return chosen


def sequence(residues: list[Residue]) -> list[Residue]:
    """Each residue once, by number; those of one number as the file has them.

    Insertion codes are not always in alphabetical order.
    """
    return sorted(dict.fromkeys(residues), key=lambda residue: residue[0])


def _is_within(k: int, residue: Residue, order: list[Residue], part: ResidueRange) -> bool:
    first, last = (part.first, part.first_code), (part.last, part.last_code)
    if part.first is None or part.last is None or not part.first <= residue[0] <= part.last:
        return False
    if part.first_code and (first not in order or k < order.index((part.first, part.first_code))):
        return False
    return not (
        part.last_code and (last not in order or k > order.index((part.last, part.last_code)))
    )


def _name(residue: Residue) -> str:
    return f"{residue[0]}{residue[1]}"


def _shown(chain: str) -> str:
    return chain or "one without a name (written as /1-90)"
