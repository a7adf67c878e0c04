"""Phasing by packing: refinement, errors, and long searches in pieces."""
