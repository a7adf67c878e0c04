"""Finding and reading the meshes that a URDF names."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

from ellipsoid_planning.errors import GeometryError, UrdfError
from ellipsoid_planning.geometry import solids
from ellipsoid_planning.geometry.solids import Solid
from ellipsoid_planning.sizes import MOST_LENGTH, check_coordinates
from planners.importing.libraries import library

# A package's URDF is rarely deeper in it than this.
ANCESTORS = 3
FORMATS = (".dae", ".glb", ".gltf", ".obj", ".off", ".ply", ".stl")
"""Of meshes; the library also reads archives, which a stranger's could fill the memory with."""


@dataclass(frozen=True, eq=False)
class MeshFiles:
    """Reads meshes; each file once.

    Attributes:
        urdf: the file that names them.
        mesh_dir: where to look first.
    """

    urdf: Path
    mesh_dir: Path | None = None
    _loaded: dict[Path, Any] = field(default_factory=dict)

    def solid(self, link: str, filename: str, scale: Any) -> Solid:
        """The mesh of a file name or URL, scaled.

        Raises:
            UrdfError: naming the link and the file: it is missing or cannot be read.
        """
        path = self._find(link, filename)
        if path not in self._loaded:
            self._loaded[path] = _read(link, path)
        loaded = self._loaded[path]
        factors = np.ones(3) if scale is None else np.asarray(scale, dtype=float) * np.ones(3)
        vertices = np.asarray(loaded.vertices, dtype=float)
        if np.abs(vertices).max() <= MOST_LENGTH:  # products of others may overflow
            vertices = vertices * factors
        try:
            check_coordinates(vertices, "vertices")
            return solids.mesh(vertices, loaded.faces)
        except GeometryError as error:
            raise UrdfError(f"{self.urdf}: link {link!r}: mesh {path}: {error}") from None

    def _find(self, link: str, filename: str) -> Path:
        looked = dict.fromkeys(self._candidates(filename))
        for path in looked:
            if path.is_file():
                return self._checked(link, path)
        folders = ", ".join(dict.fromkeys(str(path.parent) for path in looked)) or "nowhere"
        raise UrdfError(
            f"{self.urdf}: link {link!r}: the mesh {filename!r} is not there; looked in {folders}; "
            "give the folder of its package, or of the meshes, with --mesh-dir"
        )

    def _checked(self, link: str, path: Path) -> Path:
        """A mesh that a URDF, which may be a stranger's, can have read."""
        real = path.resolve()
        folder = self.urdf.resolve().parent
        allowed = [folder, *[above for above in list(folder.parents)[:ANCESTORS] if above.name]]
        if self.mesh_dir is not None:
            allowed.append(self.mesh_dir.resolve())
        if not any(real.is_relative_to(place) for place in allowed):
            raise UrdfError(
                f"{self.urdf}: link {link!r}: the mesh {path} lies outside of the URDF's folder "
                f"and the {ANCESTORS} above it; if you trust the file, name the mesh's folder with "
                "--mesh-dir"
            )
        if path.suffix.lower() not in FORMATS:
            raise UrdfError(
                f"{self.urdf}: link {link!r}: cannot read the mesh {path}: expected one of the "
                f"formats {', '.join(FORMATS)}; convert it"
            )
        return path

    def _candidates(self, filename: str) -> Iterator[Path]:
        """Where a file name may point: in --mesh-dir first, then beside the URDF and above it."""
        scheme, separator, rest = filename.partition("://")
        name = Path(unquote(rest) if separator else filename)
        if scheme == "file" or name.is_absolute():
            yield name
            name = Path(*name.parts[1:])
        names = [name]
        if separator and scheme != "file" and len(name.parts) > 1:
            names.append(Path(*name.parts[1:]))  # without the package's name
        folder = self.urdf.resolve().parent
        folders = [folder, *list(folder.parents)[:ANCESTORS]] if separator else [folder]
        for place in ([self.mesh_dir] if self.mesh_dir is not None else []) + folders:
            yield from (place / candidate for candidate in names)
        if self.mesh_dir is not None:
            yield self.mesh_dir / name.name


def _read(link: str, path: Path) -> Any:
    trimesh = library("trimesh")
    try:
        loaded = trimesh.load(path, force="mesh", process=False, skip_materials=True)
        faces = len(loaded.faces)
    except Exception as error:  # noqa: BLE001 (the readers of a dozen formats raise anything)
        raise UrdfError(
            f"link {link!r}: cannot read the mesh {path}: {type(error).__name__} {error}"
        ) from None
    if not faces:
        raise UrdfError(f"link {link!r}: the mesh {path} has no triangles")
    if path.suffix.lower() == ".dae":
        # COLLADA tells its unit, and ROS's tools heed it; trimesh only notes it.
        loaded.apply_scale(_metres(loaded))
    return loaded


def _metres(loaded: Any) -> float:
    number = str(loaded.metadata.get("units", "")).partition("*")[0]
    try:
        return float(number)
    except ValueError:
        return 1.0
