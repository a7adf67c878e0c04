"""The libraries of the extra ``import``, loaded when they are needed."""

from __future__ import annotations

import importlib
from typing import Any

from ellipsoid_planning.errors import UrdfError


def library(name: str) -> Any:
    """A module of the extra ``import``.

    Raises:
        UrdfError: saying how to install it.
    """
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        raise UrdfError(
            f"importing robots needs {error.name}, which is not installed; "
            'run: pip install "ellipsoid-planning[import]"'
        ) from None
