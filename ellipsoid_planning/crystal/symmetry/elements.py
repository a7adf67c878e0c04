"""Sets of a group's elements: whether they are a subgroup, a normal one, and if not, why not."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup
from ellipsoid_planning.errors import CrystalError


@dataclass(frozen=True)
class Verdict:
    """The answer to a question about some elements of a group.

    Indices count from zero; the message counts from one, as the thesis does.

    Attributes:
        holds: yes or no.
        product: two factors and their product that falls outside the set, when it is no subgroup.
        conjugate: g, h and g h g^-1 that falls outside, when it is a subgroup but not normal.
        message: the answer and its reason in words.
    """

    holds: bool
    product: tuple[int, int, int] | None
    conjugate: tuple[int, int, int] | None
    message: str


def is_subgroup(group: SpaceGroup, elements: Iterable[int]) -> Verdict:
    """Whether elements, given by their indices from zero, are a subgroup (app. A).

    A finite set is one when it holds all products of its elements. The thesis' own message shows
    a conjugate here; what it computes is the product of the two, the second first.

    Raises:
        CrystalError: there are no elements, one occurs twice, or the group has none of that index.
    """
    chosen = checked_elements(group, elements)
    inside = _inside(group, chosen)
    products = group.table[np.ix_(chosen, chosen)]
    outside = np.argwhere(~inside[products])
    if len(outside) == 0:
        return Verdict(True, None, None, f"Yes, it is a subgroup of {group.name}.")
    i, j = (chosen[place] for place in outside[0])
    k = int(group.table[i, j])
    message = (
        f"No, it is not a subgroup of {group.name}: g_{i + 1} o g_{j + 1} = g_{k + 1} "
        f"({group.operations[k]}) is not among the elements."
    )
    return Verdict(False, (i, j, k), None, message)


def is_normal(group: SpaceGroup, elements: Iterable[int]) -> Verdict:
    """Whether elements, given by their indices from zero, are a normal subgroup (app. A).

    Raises:
        CrystalError: as for `is_subgroup`.
    """
    chosen = checked_elements(group, elements)
    subgroup = is_subgroup(group, chosen)
    if not subgroup.holds:
        message = subgroup.message.replace("not a subgroup", "not even a subgroup")
        return Verdict(False, subgroup.product, None, message)
    inside = _inside(group, chosen)
    products = group.table[:, chosen]
    conjugates = group.table[products, group.inverses[:, None]]
    outside = np.argwhere(~inside[conjugates])
    if len(outside) == 0:
        return Verdict(True, None, None, f"Yes, it is a normal subgroup of {group.name}.")
    g, place = (int(entry) for entry in outside[0])
    h, k = chosen[place], int(conjugates[g, place])
    message = (
        f"No, it is a subgroup but not a normal one of {group.name}: "
        f"g_{g + 1} o g_{h + 1} o g_{g + 1}^-1 = g_{k + 1} ({group.operations[k]}) "
        "is not among the elements."
    )
    return Verdict(False, None, (g, h, k), message)


def checked_elements(group: SpaceGroup, elements: Iterable[int]) -> list[int]:
    """The indices as a list, in the order given.

    Raises:
        CrystalError: there are none, one occurs twice, or the group has none of that index.
    """
    chosen = [int(element) for element in elements]
    if not chosen:
        raise CrystalError(f"{group.name}: expected at least one element, got none")
    for element in chosen:
        if not 0 <= element < group.order:
            raise CrystalError(
                f"{group.name}: there is no element {element + 1}; they are numbered from 1 to "
                f"{group.order}"
            )
        if chosen.count(element) > 1:
            raise CrystalError(f"{group.name}: element {element + 1} is given more than once")
    return chosen


def _inside(group: SpaceGroup, chosen: list[int]) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    inside = np.zeros(group.order, dtype=bool)
    inside[chosen] = True
    return inside
