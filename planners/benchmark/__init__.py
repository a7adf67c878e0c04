"""Campaigns of planning runs, measured by OMPL's own benchmark, every path checked again.

A campaign is problems × contenders × runs. Each run has a watched process of its own, so that a
planner that hangs, aborts or eats the memory costs that run only, and is recorded as what it is.
The logs of the runs are merged into OMPL's log format and read into SQLite by OMPL's own reader.
"""
