"""Crystals: space-group calculations (thesis app. A), packing and phasing by packing (ch. 3)."""

from ellipsoid_planning.crystal.symmetry.catalogue import space_group
from ellipsoid_planning.crystal.symmetry.group_text import space_group_from_text
from ellipsoid_planning.crystal.symmetry.operation import Operation
from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell

__all__ = [
    "Operation",
    "SpaceGroup",
    "UnitCell",
    "space_group",
    "space_group_from_text",
]
