"""Marks of these tests."""

from __future__ import annotations

import pytest


def pytest_configure(config: pytest.Config) -> None:
    """Register the mark of the tests that draw thousands of samples."""
    config.addinivalue_line("markers", "statistical: a statistical test with fixed seeds (slow)")
