"""Articulated robots: kinematics, validity and certified motions, against slow twins."""
