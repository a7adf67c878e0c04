"""Tests of importing robots."""
