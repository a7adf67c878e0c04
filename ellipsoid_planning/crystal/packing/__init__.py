"""Packing: models of molecules in crystals, and which arrangements are free (thesis 3.4)."""
