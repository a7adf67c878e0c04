"""Motion planning for robots made of ellipsoids, with proved collision-free paths."""

__version__ = "0.1.0"
