"""From validated entries of the format to vectors, rotations and ellipsoids of one dimension."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import GeometryError, ScenarioError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.orientation_forms import (
    PLANAR_FORMS,
    SPATIAL_FORMS,
    quaternion_from_form,
    rotation_from_form,
)
from ellipsoid_planning.scenario_blocks import Body, Orientation
from ellipsoid_planning.scenario_origin import Origin, Path


class Entries:
    """Reads the entries of one document and remembers orientations as they were written."""

    def __init__(self, dimension: int, origin: Origin) -> None:
        self.dimension = dimension
        self._origin = origin
        self._orientations: list[tuple[object, Mapping[str, Any]]] = []

    def error(self, path: Path, problem: str, *, at_key: bool = False) -> ScenarioError:
        """The error for the entry at `path`, with its place in the file."""
        return self._origin.error(path, problem, at_key=at_key)

    def origin(self) -> Origin:
        """The document's origin, with the orientations that were remembered."""
        return replace(self._origin, orientations=tuple(self._orientations))

    def remember(self, owner: object, written: Mapping[str, Any]) -> None:
        """Keep the orientation of an object as it was written, to write it so again."""
        if written:
            self._orientations.append((owner, written))

    def vector(self, values: Sequence[float] | None, path: Path) -> list[float]:
        """As many numbers as the dimension; None is the origin."""
        if values is None:
            return [0.0] * self.dimension
        if len(values) != self.dimension:
            raise self.error(
                path,
                f"expected {self.dimension} numbers because the dimension is {self.dimension}, "
                f"got {len(values)}; correct this or the dimension",
            )
        return [float(value) for value in values]

    def bodies(self, bodies: Sequence[Body], path: Path, kind: str) -> tuple[Ellipsoid, ...]:
        """The ellipsoids of a list; those without a name are numbered."""
        return tuple(
            self._body(body, (*path, index), body.name or f"{kind} {index + 1}")
            for index, body in enumerate(bodies)
        )

    def _body(self, body: Body, path: Path, name: str) -> Ellipsoid:
        semi_axes = self.vector(body.semi_axes, (*path, "semi_axes"))
        position = self.vector(body.position, (*path, "position"))
        rotation, written = self.rotation(body.orientation, (*path, "orientation"))
        ellipsoid = Ellipsoid.from_semi_axes(semi_axes, position, rotation, name)
        self.remember(ellipsoid, written)
        return ellipsoid

    def rotation(
        self, orientation: Orientation | None, path: Path
    ) -> tuple[NDArray[np.float64], dict[str, Any]]:
        """Return the rotation (n, n) and the orientation as written, empty for none."""
        form, value = self.form(orientation, path)
        if not form:
            return np.eye(self.dimension), {}
        return self._checked(rotation_from_form, form, value, path), {form: value}

    def quaternion(self, orientation: Orientation | None, path: Path) -> list[float]:
        """The unit quaternion (x, y, z, w) of an orientation in space; None is the identity."""
        form, value = self.form(orientation, path)
        if not form:
            return [0.0, 0.0, 0.0, 1.0]
        values: list[float] = self._checked(quaternion_from_form, form, value, path).tolist()
        return values

    def form(self, orientation: Orientation | None, path: Path) -> tuple[str, Any]:
        """The form in which an orientation is written, and its value; "" for none."""
        if orientation is None:
            return "", None
        ((form, value),) = orientation.model_dump(exclude_unset=True).items()
        allowed = PLANAR_FORMS if self.dimension == 2 else SPATIAL_FORMS
        if form not in allowed:
            raise self.error(
                (*path, form),
                f"expected {' or '.join(allowed)} because the dimension is {self.dimension}, "
                f"got {form}; write the orientation in one of these forms",
                at_key=True,
            )
        return form, value

    def _checked(self, convert: Any, form: str, value: Any, path: Path) -> NDArray[np.float64]:
        try:
            return np.asarray(convert(form, value))
        except GeometryError as error:
            raise self.error((*path, form), str(error)) from None
