"""Checks a planned path again, with arithmetic of its own: none of the kernels is used.

Where the kernels prove a motion free in closed form, this package samples it densely, in plain
numpy. What it reports rests on things that anyone can check: a direction in which two bodies lie
apart, or a point that lies in both.
"""

from planners.verify.report import Check, VerificationReport
from planners.verify.result import verify_result

__all__ = ["Check", "VerificationReport", "verify_result"]
