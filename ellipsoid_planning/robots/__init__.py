"""Robots made of ellipsoids."""

from ellipsoid_planning.robots.rigid import RigidRobot

__all__ = ["RigidRobot"]
