"""Ellipsoids and what can be said about two of them in closed form."""

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid

__all__ = ["Ellipsoid"]
