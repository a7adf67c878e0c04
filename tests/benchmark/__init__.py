"""Tests of benchmark campaigns."""
