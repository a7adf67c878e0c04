"""Robots from other descriptions: URDF."""

from planners.importing.report import ImportedRobot, JointReport, LinkReport
from planners.importing.urdf import import_urdf

__all__ = ["ImportedRobot", "JointReport", "LinkReport", "import_urdf"]
