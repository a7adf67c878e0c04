"""A robot in a meshcat scene: nodes of links within nodes of links, and markers of joints."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from planners.view import colours, meshcat_shapes
from planners.view.embedding import Slab
from planners.view.joint_markers import JointMarker, joint_markers
from planners.view.links import link_levels, parents

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from ellipsoid_planning.geometry import Ellipsoid
    from ellipsoid_planning.robots import Robot
    from planners.view.embedding import Embedding


def place_robot(
    node: Any,
    robot: Robot,
    configuration: Any,
    embedding: Embedding,
    shades: Mapping[str, str],
    slabs: tuple[Slab, Slab],
    **look: Any,
) -> None:
    """Draw a robot that stands still, each link in its shade, in slabs of parts and joints."""
    taken: set[str] = set()
    levels, materials = link_levels(robot), _materials(shades, look)
    bodies = robot.bodies_at(configuration)
    for (body, name), link in zip(named(bodies, taken), robot.part_links, strict=True):
        lowered = Slab(slabs[0].bottom, slabs[0].top - levels[link])
        _draw_body(node[name], body, embedding, lowered, materials[link])
    poses = robot.link_poses(configuration)
    for marker in joint_markers(robot):
        at = embedding.points(marker.placed(poses), slabs[1])
        _draw_marker(node, marker, at, taken)


def hang_robot(
    node: Any,
    robot: Robot,
    embedding: Embedding,
    shades: Mapping[str, str],
    slabs: tuple[Slab, Slab],
) -> dict[str, Any]:
    """Draw a robot that can move: return the node of each link, within that of its parent."""
    nodes, taken = {robot.root: node}, {link: {*parents(robot)} for link in _links(robot)}
    for child, parent in parents(robot).items():
        nodes[child] = nodes[parent][_plain(child)]
    levels, materials = link_levels(robot), _materials(shades, {})
    for part, link in zip(robot.parts, robot.part_links, strict=True):
        ((_, name),) = named([part], taken[link])
        lowered = Slab(slabs[0].bottom, slabs[0].top - levels[link])
        _draw_body(nodes[link][name], part, embedding, lowered, materials[link])
    for marker in joint_markers(robot):
        at = embedding.points(marker.points, slabs[1])
        _draw_marker(nodes[marker.link], marker, at, taken[marker.link])
    return nodes


def named(bodies: Iterable[Ellipsoid], taken: set[str]) -> list[tuple[Ellipsoid, str]]:
    """Return each body with a name that is not `taken` yet, which it is then, and has no slash."""
    return [(body, _unique(body.name or "body", taken)) for body in bodies]


def _unique(wanted: str, taken: set[str]) -> str:
    name, count = _plain(wanted), 1
    while name in taken:
        count += 1
        name = f"{_plain(wanted)} ({count})"
    taken.add(name)
    return name


def _plain(name: str) -> str:
    return name.replace("/", "-")


def _links(robot: Robot) -> list[str]:
    return [robot.root, *parents(robot)]


def _materials(shades: Mapping[str, str], look: Mapping[str, Any]) -> dict[str, Any]:
    return {link: meshcat_shapes.material(shade, **look) for link, shade in shades.items()}


def _draw_body(node: Any, body: Ellipsoid, embedding: Embedding, slab: Slab, material: Any) -> None:
    node.set_object(meshcat_shapes.unit_shape(embedding.dimension), material)
    node.set_transform(embedding.matrix(body, slab))


def _draw_marker(node: Any, marker: JointMarker, points: np.ndarray, taken: set[str]) -> None:
    shape = meshcat_shapes.tube(points, marker.radius, sides=16)
    look = meshcat_shapes.material(colours.JOINT)
    node[_unique(f"joint {marker.joint}", taken)].set_object(shape, look)
