"""Compiled kernels: numba functions on plain arrays, three-dimensional, scalar and unrolled.

Kernels never raise, never allocate in hot loops, and return status codes or write to ``out``.
Planar problems are embedded: bodies lie in the plane z = 0, obstacles and arenas get a positive
third semi-axis and robot parts a third semi-axis of zero, which changes nothing within the plane.
"""
