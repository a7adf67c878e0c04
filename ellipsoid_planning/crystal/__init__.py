"""Crystals: space-group calculations (thesis app. A), packing and phasing by packing (ch. 3)."""
