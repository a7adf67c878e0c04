"""All subgroups of a factor group, by joining cyclic ones.

Sets of elements are bit masks. A subgroup of k generators is the join of one of k - 1 generators
with a cyclic one, so that going on from one subgroup of each conjugacy class, and taking all
conjugates of what comes out, finds everything; the thesis tries all 2^m sets instead.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup

Table = list[list[int]]


@dataclass(frozen=True)
class Subgroup:
    """A subgroup; indices count from zero.

    Attributes:
        elements: its elements' indices in the group, ascending.
        generators: as few elements as generate it; none for the trivial subgroup.
        normal: whether it is its own only conjugate.
        conjugacy_class: the number of its class, from zero, in the order of `all_subgroups`.
    """

    elements: tuple[int, ...]
    generators: tuple[int, ...]
    normal: bool
    conjugacy_class: int

    @property
    def order(self) -> int:
        """The number of its elements."""
        return len(self.elements)


def all_subgroups(group: SpaceGroup) -> tuple[Subgroup, ...]:
    """All subgroups, the trivial one and the group itself among them.

    They are sorted by order and class; conjugate ones stand together.
    """
    classes = sorted(_classes(_Factor(group)), key=_class_key)
    return tuple(
        Subgroup(_members(mask), generators, len(members) == 1, number)
        for number, members in enumerate(classes)
        for mask, generators in sorted(members.items(), key=lambda item: _members(item[0]))
    )


def class_count(subgroups: tuple[Subgroup, ...]) -> int:
    """The number of conjugacy classes among all subgroups of a group."""
    return 1 + max(subgroup.conjugacy_class for subgroup in subgroups)


Members = dict[int, tuple[int, ...]]  # generators by mask, of one conjugacy class


def _class_key(members: Members) -> tuple[int, tuple[int, ...]]:
    first = min(_members(mask) for mask in members)
    return len(first), first


def _classes(factor: _Factor) -> list[Members]:
    """All conjugacy classes, those of fewer generators first."""
    cyclic = factor.cyclic_subgroups()
    trivial: Members = {1: ()}
    found, known = [trivial], {1}
    level = [trivial]
    while level:
        following: list[Members] = []
        for members in level:
            mask, generators = next(iter(members.items()))
            for joined, added in factor.joins(mask, generators, cyclic):
                if joined not in known:
                    following.append(factor.conjugates(joined, (*generators, added)))
                    known.update(following[-1])
        found += following
        level = following
    return found


class _Factor:
    """The multiplication of the factor group, for masks."""

    def __init__(self, group: SpaceGroup) -> None:
        self.table: Table = group.table.tolist()
        self.inverses: list[int] = group.inverses.tolist()
        self.order = group.order

    def cyclic_subgroups(self) -> dict[int, int]:
        """One generator by mask, the trivial subgroup left out."""
        found: dict[int, int] = {}
        for element in range(1, self.order):
            mask, power = 1, element
            while power:
                mask |= 1 << power
                power = self.table[element][power]
            found.setdefault(mask, element)
        return found

    def joins(
        self, mask: int, generators: tuple[int, ...], cyclic: dict[int, int]
    ) -> Iterator[tuple[int, int]]:
        """The joins of a subgroup with all cyclic ones, each with the added generator."""
        where, cosets = self._left_cosets(mask)
        for other, added in cyclic.items():
            if other & ~mask:
                yield self._orbit((*generators, added), where, cosets), added

    def _left_cosets(self, mask: int) -> tuple[list[int], list[tuple[int, int]]]:
        """The coset of each element, and of each coset a representative and its mask."""
        inside = _members(mask)
        where = [-1] * self.order
        cosets: list[tuple[int, int]] = []
        for element in range(self.order):
            if where[element] < 0:
                members = [self.table[element][other] for other in inside]
                for member in members:
                    where[member] = len(cosets)
                cosets.append((element, sum(1 << member for member in members)))
        return where, cosets

    def _orbit(
        self, generators: tuple[int, ...], where: list[int], cosets: list[tuple[int, int]]
    ) -> int:
        """The subgroup that these generate: the cosets that they reach from the first one."""
        rows = [self.table[generator] for generator in generators]
        reached, seen, mask = [0], {0}, cosets[0][1]
        for coset in reached:
            representative = cosets[coset][0]
            for row in rows:
                following = where[row[representative]]
                if following not in seen:
                    seen.add(following)
                    reached.append(following)
                    mask |= cosets[following][1]
        return mask

    def conjugates(self, mask: int, generators: tuple[int, ...]) -> Members:
        """All conjugates of a subgroup with their generators, the subgroup itself first."""
        inside = _members(mask)
        found: Members = {}
        for element in range(self.order):
            row, back = self.table[element], self.inverses[element]
            image = sum(1 << self.table[row[member]][back] for member in inside)
            if image not in found:
                found[image] = tuple(self.table[row[other]][back] for other in generators)
        return found


def _members(mask: int) -> tuple[int, ...]:
    """The places of the bits, ascending."""
    return tuple(place for place in range(mask.bit_length()) if mask >> place & 1)
