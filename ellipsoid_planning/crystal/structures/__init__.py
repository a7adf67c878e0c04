"""Packing models of real molecules: their structures, domains and ellipsoids."""
