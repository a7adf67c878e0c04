"""Robots made of ellipsoids."""

from ellipsoid_planning.robots.articulated import ArticulatedRobot, Link
from ellipsoid_planning.robots.joint import Joint
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.robots.robot import Robot

__all__ = ["ArticulatedRobot", "Joint", "Link", "RigidRobot", "Robot"]
