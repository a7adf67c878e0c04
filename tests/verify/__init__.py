"""Tests of the verification: its arithmetic against oracles, and that it can fail."""
