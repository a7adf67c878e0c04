"""The collision geometry of a link as solids in the link's frame."""

from __future__ import annotations

from typing import Any

import numpy as np

from ellipsoid_planning.errors import GeometryError, UrdfError
from ellipsoid_planning.geometry import solids
from ellipsoid_planning.geometry.solids import Solid
from planners.importing.mesh_files import MeshFiles
from planners.importing.urdf_text import Description


def link_solids(description: Description, link: Any, meshes: MeshFiles) -> tuple[Solid, ...]:
    """All collision geometry of one of yourdfpy's links, in the link's frame.

    Raises:
        UrdfError: naming the link: a size is not positive, a mesh is missing.
    """
    found = []
    for index, collision in enumerate(link.collisions):
        is_capsule = (link.name, index) in description.capsules
        pose = np.eye(4) if collision.origin is None else collision.origin
        try:
            solid = _solid(link.name, collision.geometry, is_capsule=is_capsule, meshes=meshes)
            found.append(solid.transform(pose[:3, :3], pose[:3, 3]))
        except GeometryError as error:
            raise UrdfError(f"{description.file}: link {link.name!r}: {error}") from None
    return tuple(found)


def _solid(link: str, geometry: Any, *, is_capsule: bool, meshes: MeshFiles) -> Solid:
    if geometry.sphere is not None:
        return solids.sphere(geometry.sphere.radius)
    if geometry.box is not None:
        return solids.box(geometry.box.size)
    if geometry.cylinder is not None:
        build = solids.capsule if is_capsule else solids.cylinder
        return build(geometry.cylinder.radius, geometry.cylinder.length)
    if not geometry.mesh.filename:
        raise UrdfError(f"{meshes.urdf}: link {link!r}: a <mesh> without a filename")
    return meshes.solid(link, geometry.mesh.filename, geometry.mesh.scale)
