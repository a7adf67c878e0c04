"""The finite groups of rotations: cyclic, dihedral, tetrahedral, octahedral and icosahedral.

The symmetry axes of the last three are those of Platonic solids whose twofold (tetrahedral,
icosahedral) or fourfold axes (octahedral) are x, y and z, as in section 4.3 of the thesis.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.errors import GridError
from ellipsoid_planning.groups.quaternions import canonical, inverse, product, unit

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

_SAME = 1e-9  # quaternions of different elements differ by far more


@dataclass(frozen=True, eq=False)
class FiniteGroup:
    """A finite group of rotations; element 0 is the identity.

    Attributes:
        name: such as "icosahedral".
        quaternions: (n, 4), one of each pair ±q, read-only.
    """

    name: str
    quaternions: Array

    def __post_init__(self) -> None:
        q = canonical(unit(self.quaternions))
        order = np.argsort(-np.abs(q[:, 3]), kind="stable")  # the identity first
        q = q[order]
        q.setflags(write=False)
        object.__setattr__(self, "quaternions", q)

    def __len__(self) -> int:
        return len(self.quaternions)

    @cached_property
    def table(self) -> Indices:
        """The multiplication table (n, n): ``table[i, j]`` is the element "i after j".

        Raises:
            GridError: a product is not an element, so this is no group.
        """
        q = self.quaternions
        return self.index(product(q[:, None], q[None]))

    @cached_property
    def inverses(self) -> Indices:
        """The inverse of each element, (n,)."""
        return self.index(inverse(self.quaternions))

    def index(self, rotations: ArrayLike) -> Indices:
        """Which elements the rotations (..., 4) are; GridError when one is none of them."""
        overlap = np.abs(np.asarray(rotations, dtype=float) @ self.quaternions.T)
        if not np.all(overlap.max(axis=-1) > 1.0 - _SAME):
            raise GridError(f"a rotation is not an element of the group {self.name}")
        return overlap.argmax(axis=-1)

    def nearest(self, rotations: ArrayLike) -> Indices:
        """The element nearest to each of the rotations (..., 4), by the traces of thesis (4.4)."""
        return np.abs(np.asarray(rotations, dtype=float) @ self.quaternions.T).argmax(axis=-1)

    def conjugate(self, rotation: ArrayLike, name: str | None = None) -> FiniteGroup:
        """The group g H g^-1 for the rotation g (4,), elements in the same order."""
        g = unit(rotation)
        turned = product(product(g, self.quaternions), inverse(g))
        return FiniteGroup(name or f"conjugate of {self.name}", turned)

    def is_subgroup_of(self, other: FiniteGroup) -> bool:
        """Whether every element is one of ``other``."""
        overlap = np.abs(self.quaternions @ other.quaternions.T)
        return bool(np.all(overlap.max(axis=1) > 1.0 - _SAME))

    def intersection_order(self, other: FiniteGroup) -> int:
        """How many rotations the two groups share; 1 is the identity alone."""
        overlap = np.abs(self.quaternions @ other.quaternions.T)
        return int(np.count_nonzero(overlap.max(axis=1) > 1.0 - _SAME))


def _turns(count: int) -> Array:
    half = np.pi * np.arange(count) / count
    zero = np.zeros(count)
    return np.column_stack([zero, zero, np.sin(half), np.cos(half)])


@cache
def cyclic(order: int) -> FiniteGroup:
    """The turns about z by multiples of 360° / order."""
    if order < 1:
        raise GridError(f"a cyclic group has at least 1 element, not {order}")
    return FiniteGroup(f"cyclic-{order}", _turns(order))


@cache
def dihedral(order: int) -> FiniteGroup:
    """The 2 order rotations of a regular prism over an order-gon: axis z, half turns about x."""
    if order < 1:
        raise GridError(f"a dihedral group has at least 2 elements; its order is not {order}")
    flip = product(_turns(order), np.array([1.0, 0.0, 0.0, 0.0]))
    return FiniteGroup(f"dihedral-{order}", np.vstack([_turns(order), flip]))


def _signs(count: int) -> Array:
    return np.array(list(itertools.product([1.0, -1.0], repeat=count)))


@cache
def tetrahedral() -> FiniteGroup:
    """The 12 rotations of a regular tetrahedron."""
    halves = 0.5 * np.column_stack([_signs(3), np.ones(8)])
    return FiniteGroup("tetrahedral", np.vstack([np.eye(4), halves]))


@cache
def octahedral() -> FiniteGroup:
    """The 24 rotations of a cube."""
    rows = []
    for i, j in itertools.combinations(range(4), 2):
        for sign in (1.0, -1.0):
            row = np.zeros(4)
            row[[i, j]] = math.sqrt(0.5) * sign, math.sqrt(0.5)
            rows.append(row)
    return FiniteGroup("octahedral", np.vstack([tetrahedral().quaternions, rows]))


@cache
def icosahedral() -> FiniteGroup:
    """The 60 rotations of a regular icosahedron."""
    return FiniteGroup("icosahedral", icosahedral_rotations())


def icosahedral_rotations() -> Array:
    """The 60 rotations of the icosahedral group as quaternions (60, 4), sorted by coordinates."""
    golden = 0.5 * (1.0 + math.sqrt(5.0))
    rows = list(tetrahedral().quaternions)
    even = [p for p in itertools.permutations(range(4)) if _is_even(p)]
    for first, second in _signs(2):
        values = 0.5 * np.array([golden * first, second, 1.0 / golden, 0.0])
        rows += [values[list(p)] for p in even]
    return np.unique(np.round(canonical(np.array(rows)), 15) + 0.0, axis=0)


def _is_even(permutation: tuple[int, ...]) -> bool:
    return bool(np.linalg.det(np.eye(len(permutation))[list(permutation)]) > 0.0)


_PLATONIC = {"tetrahedral": tetrahedral, "octahedral": octahedral, "icosahedral": icosahedral}


def group_by_name(name: str) -> FiniteGroup:
    """``tetrahedral``, ``octahedral``, ``icosahedral``, ``cyclic-N`` or ``dihedral-N``.

    Raises:
        GridError: there is no such group.
    """
    kind, _, order = name.partition("-")
    if name in _PLATONIC:
        return _PLATONIC[name]()
    if kind in {"cyclic", "dihedral"} and order.isdecimal() and int(order) > 0:
        return cyclic(int(order)) if kind == "cyclic" else dihedral(int(order))
    known = ", ".join([*_PLATONIC, "cyclic-N", "dihedral-N"])
    raise GridError(f"unknown group of rotations {name!r}; known are {known}")
