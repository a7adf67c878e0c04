"""Safety functions of robots made of links (thesis 6.4): exact ones, and tabulated ones."""

from ellipsoid_planning.safety.exact import ExactSafety
from ellipsoid_planning.safety.function import SafetyFunction, SafetyReport, TableReport
from ellipsoid_planning.safety.resolution import TableParameters
from ellipsoid_planning.safety.tabulated import TabulatedSafety

__all__ = [
    "ExactSafety",
    "SafetyFunction",
    "SafetyReport",
    "TableParameters",
    "TableReport",
    "TabulatedSafety",
]
