"""Left and right coset spaces of a subgroup."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.symmetry.elements import is_subgroup
from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup
from ellipsoid_planning.errors import CrystalError

Coset = tuple[int, ...]


@dataclass(frozen=True)
class CosetSpaces:
    """The cosets of a subgroup H, each by the indices of its elements, ascending, from zero.

    Attributes:
        left: the sets g H, the subgroup itself first.
        right: the sets H g, likewise.
        matches: for each left coset the place of the same set among the right ones, else None.
    """

    left: tuple[Coset, ...]
    right: tuple[Coset, ...]
    matches: tuple[int | None, ...]

    @property
    def agree(self) -> bool:
        """Whether every left coset is a right one, that is, whether the subgroup is normal."""
        return None not in self.matches


def coset_spaces(group: SpaceGroup, elements: Iterable[int]) -> CosetSpaces:
    """Both coset spaces of the subgroup with these elements (indices from zero).

    Raises:
        CrystalError: the elements are no subgroup; says which product is missing.
    """
    chosen = list(elements)
    verdict = is_subgroup(group, chosen)
    if not verdict.holds:
        i, j, k = (number + 1 for number in verdict.product or ())
        raise CrystalError(
            f"{group.name}: only subgroups have cosets, and these elements are none: "
            f"g_{i} o g_{j} = g_{k} ({group.operations[k - 1]}) is not among them; add it"
        )
    left = _classes(group.table[:, chosen])
    right = _classes(group.table[chosen, :].T)
    places = {coset: place for place, coset in enumerate(right)}
    return CosetSpaces(left, right, tuple(places.get(coset) for coset in left))


def _classes(products: NDArray[np.int64]) -> tuple[Coset, ...]:
    """The different sets among the rows, in the order of their smallest elements."""
    rows = {tuple(sorted(row)) for row in products.tolist()}
    # The subgroup holds the identity, element 0, and so comes first.
    return tuple(sorted(rows))
