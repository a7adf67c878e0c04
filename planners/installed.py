"""Planners of other installed packages, which name them in an entry point."""

from __future__ import annotations

import site
import sysconfig
from functools import cache

GROUP = "ellipsoid_planning.planners"
"""The entry points' group: ``MyPlanner = "my_package.my_module:MyPlanner"``."""


@cache
def installed_planners() -> dict[str, str]:
    """``module:Class`` by name.

    Only where packages are installed is looked for them, not on all of Python's path: that often
    begins with the current folder, where anybody's files may lie, and a folder of metadata among
    them would be enough to register a module beside it.
    """
    from importlib.metadata import distributions

    points = (
        point
        for distribution in distributions(path=_install_folders())
        for point in distribution.entry_points
        if point.group == GROUP and ":" in point.value
    )
    return {point.name: point.value for point in points}


def _install_folders() -> list[str]:
    folders = [sysconfig.get_path("purelib"), sysconfig.get_path("platlib")]
    folders += site.getsitepackages()
    if site.ENABLE_USER_SITE:
        folders.append(site.getusersitepackages())
    return list(dict.fromkeys(folders))
