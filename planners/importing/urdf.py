"""From a URDF to a robot of ellipsoids."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ellipsoid_planning.errors import GeometryError, UrdfError
from ellipsoid_planning.geometry.covering import cover, union_volume
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.solids import Solid
from ellipsoid_planning.robots.articulated import BASES, FIXED_BASE, FREE_BASE, ArticulatedRobot
from ellipsoid_planning.robots.articulated import Link as RobotLink
from ellipsoid_planning.robots.joint import FIXED
from ellipsoid_planning.scenario_joints import keyed_joints
from planners.importing.contacts import contacts
from planners.importing.joints import INDEPENDENT, MIMICS, ConvertedJoint, converted_joints
from planners.importing.libraries import library
from planners.importing.link_solids import link_solids
from planners.importing.mesh_files import MeshFiles
from planners.importing.report import ImportedRobot, LinkReport
from planners.importing.urdf_text import Description, read_description

FLOATING = "floating"
HULL_DIRECTIONS = 2_000


def import_urdf(
    file: str | Path,
    *,
    mesh_dir: str | Path | None = None,
    parts: int = 1,
    base: str = FIXED_BASE,
    mimic: str = INDEPENDENT,
) -> ImportedRobot:
    """Turn a URDF's collision geometry into enclosing ellipsoids, and carry its joints over.

    Every link is covered wholly by at most ``parts`` ellipsoids, see `geometry.covering.cover`:
    one encloses all its geometry with the minimum volume. Lengths stay in metres.

    Args:
        file: the URDF.
        mesh_dir: where to look for meshes first; then beside the URDF, and for URLs with a
            package also above it.
        parts: the most ellipsoids a link gets.
        base: "fixed", "translating" or "free".
        mimic: "independent" drops the coupling of mimic joints, "fixed" holds them where their
            leader's value is 0.

    Raises:
        UrdfError: the URDF or a mesh cannot be read, a joint is of a type that is not supported,
            or no link has geometry.
    """
    _check_options(parts, base, mimic)
    description = read_description(Path(file))
    links, joints = _without_floating_root(description, base)
    converted = converted_joints(description, joints, mimic)
    meshes = MeshFiles(description.file, None if mesh_dir is None else Path(mesh_dir))
    built = [_link(description, link, meshes, parts) for link in links]
    if not any(link.parts for link, _ in built):
        raise UrdfError(
            f"{description.file}: no link has collision geometry, so that there is nothing to "
            "enclose; add <collision> elements"
        )
    try:
        robot = ArticulatedRobot(
            tuple(link for link, _ in built), tuple(entry.joint for entry in converted), base
        )
        keyed_joints(robot)
    except GeometryError as error:
        raise UrdfError(f"{description.file}: {error}{_held(converted)}") from None
    always, touching = contacts(robot)
    robot = replace(robot, ignored=frozenset(frozenset(pair) for pair in always))
    return ImportedRobot(
        str(description.robot.name),
        robot,
        tuple(report for _, report in built),
        tuple(entry.report for entry in converted),
        tuple(always),
        tuple(touching),
    )


def _held(converted: Sequence[ConvertedJoint]) -> str:
    """Which joints were fixed, for a robot that has none that moves."""
    if any(entry.joint.type != FIXED for entry in converted):
        return ""
    fixed = [
        entry.report for entry in converted if entry.report.type != FIXED and not entry.joint.notice
    ]
    return "".join(f"; joint {joint.name!r}: {joint.fate}" for joint in fixed)


def _check_options(parts: int, base: str, mimic: str) -> None:
    if parts < 1:
        raise UrdfError(f"parts: expected at least 1 ellipsoid a link, got {parts}")
    for name, value, known in (("base", base, BASES), ("mimic", mimic, MIMICS)):
        if value not in known:
            raise UrdfError(f"{name}: expected one of {', '.join(known)}, got {value!r}")


def _without_floating_root(description: Description, base: str) -> tuple[list[Any], list[Any]]:
    """Links and joints without a root that has no geometry and lets the robot float.

    That is how URDFs say that the base is free.
    """
    links, joints = list(description.robot.links), list(description.robot.joints)
    children = {joint.child for joint in joints}
    for root in (link for link in links if link.name not in children):
        below = [joint for joint in joints if joint.parent == root.name]
        if base == FREE_BASE and not root.collisions and [j.type for j in below] == [FLOATING]:
            links.remove(root)
            joints.remove(below[0])
    return links, joints


def _link(
    description: Description, link: Any, meshes: MeshFiles, parts: int
) -> tuple[RobotLink, LinkReport]:
    solids = link_solids(description, link, meshes)
    if not solids:
        return RobotLink(link.name), LinkReport(link.name, 0, 0, 0, 0.0, 0.0)
    try:
        bodies = cover(solids, parts)
    except GeometryError as error:
        raise UrdfError(f"{description.file}: link {link.name!r}: {error}") from None
    vertices = _check_inside(link.name, solids, bodies)
    volume, hull = union_volume(bodies), _hull_volume(solids)
    report = LinkReport(link.name, len(solids), vertices, len(bodies), volume, hull)
    return RobotLink(link.name, bodies), report


def _check_inside(link: str, solids: Sequence[Solid], bodies: Sequence[Ellipsoid]) -> int:
    """Check that every vertex is in one of the bodies, and count them."""
    points = np.concatenate([solid.points for solid in solids])
    inside = np.any([body.contains(points) for body in bodies], axis=0)
    if not np.all(inside):
        raise UrdfError(f"link {link!r}: {np.sum(~inside)} vertices are outside; report this")
    return len(points)


def _hull_volume(solids: Sequence[Solid]) -> float:
    """The volume of the convex hull, to half a per cent from within for several curved solids."""
    if len(solids) == 1 and solids[0].volume is not None:
        return solids[0].volume
    ball = unit_directions(3, HULL_DIRECTIONS)
    curved = [
        centre + ball @ matrix.T
        for solid in solids
        for centre, matrix in zip(solid.rounds.centres, solid.rounds.matrices, strict=True)
    ]
    spatial = library("scipy.spatial")
    points = np.concatenate([*[solid.points for solid in solids], *curved])
    try:
        return float(spatial.ConvexHull(points).volume)
    except spatial.QhullError:  # it is flat
        return 0.0
