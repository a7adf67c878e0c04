"""The configuration space of a robot among ellipsoids, characterised in closed form."""

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.space import CSpace

__all__ = ["ArticulatedCSpace", "CSpace"]
