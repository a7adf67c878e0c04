"""Families of scenarios with one narrow passage of exactly known clearance."""

from ellipsoid_planning.families.catalogue import family_names, make_family, make_family_scene
from ellipsoid_planning.families.scene import FamilyScene, Gate

__all__ = ["FamilyScene", "Gate", "family_names", "make_family", "make_family_scene"]
