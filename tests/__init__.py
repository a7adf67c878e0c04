"""Tests of the planner; the oracles of the kernels are in this folder."""
