"""Symmetry of crystals: cells, exact operations, groups, subgroups and cosets (thesis app. A)."""
