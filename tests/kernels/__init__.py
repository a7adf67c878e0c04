"""Hostile tests of the kernels through their public wrappers."""
