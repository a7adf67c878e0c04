"""What a roadmap belongs to: world, robot, clearance, and the parameters that shape it."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.roadmap.parameters import RoadmapParameters

Array = NDArray[np.float64]


def fingerprint(cspace: CSpace) -> dict[str, Any]:
    """World and robot as hashes, the clearance, and a hash of the packed scene.

    Names of bodies do not count; numbers count to their last bit.
    """
    world, robot = cspace.world, cspace.robot
    size = np.array([world.dimension, robot.rotates], dtype=float)
    fixed = np.empty(0) if robot.orientation is None else robot.orientation
    obstacles, arenas = _numbers(world.obstacles), _numbers(world.arenas)
    return {
        "world": _digest([world.low, world.high, obstacles, arenas]),
        "robot": _digest([size, fixed, _numbers(robot.parts), _joints(cspace)]),
        "clearance": cspace.clearance_required,
        "scene": _digest([cspace.scene]),
    }


def _joints(cspace: CSpace) -> Array:
    """What an articulated robot adds to its parts; nothing for rigid ones."""
    return cspace.kinematics if isinstance(cspace, ArticulatedCSpace) else np.empty(0)


def _numbers(bodies: Iterable[Ellipsoid]) -> Array:
    rows = [np.concatenate([body.centre, body.rotation.ravel(), body.semi_axes]) for body in bodies]
    return np.concatenate([np.empty(0), *rows])


def _digest(arrays: list[Array]) -> str:
    digest = hashlib.sha256()
    for array in arrays:
        # Adding zero makes −0 and 0 the same.
        values = np.ascontiguousarray(array, dtype="<f8") + 0.0
        digest.update(values.size.to_bytes(8, "little"))
        digest.update(values.tobytes())
    return digest.hexdigest()


def shape_of(parameters: RoadmapParameters, dimension: int) -> dict[str, Any]:
    """The values of those parameters that decide which layers and lines a roadmap has."""
    return {
        "layers": parameters.layer_count(dimension),
        "lines": parameters.line_count(dimension),
        "axis": parameters.axis,
        "neighbours": parameters.neighbour_count(dimension),
        "seed": parameters.seed,
        "orientations": None if parameters.orientations is None else dict(parameters.orientations),
    }


def differences(stored: dict[str, Any], present: dict[str, Any]) -> list[str]:
    """What differs between two fingerprints, in words; empty if nothing does."""
    found = [f"another {name}" for name in ("world", "robot") if stored[name] != present[name]]
    if stored["clearance"] != present["clearance"]:
        found.append(f"clearance {stored['clearance']} (here {present['clearance']})")
    if not found and stored["scene"] != present["scene"]:
        found.append("the same bodies, packed in another way")
    return found


def shape_differences(stored: dict[str, Any], present: dict[str, Any]) -> list[str]:
    """The parameters that differ, in words; empty if none does."""
    return [
        f"{name} {_shown(stored[name])} (here {_shown(value)})"
        for name, value in present.items()
        if stored[name] != value
    ]


def _shown(value: Any) -> str:
    return "null" if value is None else str(value)
