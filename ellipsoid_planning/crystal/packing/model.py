"""Packing models: a molecule in the cell of a crystal, and the arrangements to look at."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.packing.grid import ArrangementGrid
from ellipsoid_planning.crystal.packing.molecule import Molecule
from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.kernels import layout
from ellipsoid_planning.kernels.molecule import FRAME
from ellipsoid_planning.scenario_origin import Origin

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PackingModel:
    """A molecule, its crystal, and a grid of arrangements.

    Attributes:
        name, description: as in the file.
        group: the space group, or plane group.
        cell: the unit cell, in the same unit of length as the molecule; what was rounded in it
            is corrected, so that the group keeps it exactly.
        molecule: the molecule, with its K coordinates.
        grid: the arrangements that are searched; its ranges bound the coordinates.
        resolution: the smallest spacing d_min of the lattice planes that are compared.
        overlap: how deep [length] parts may reach into each other in a free arrangement; 0 for
            hard bodies. Ellipsoids that stand for soft ones, as a protein's domains, need some.
        slack: how much deeper at the nodes of the grid, which are not the arrangements looked
            for but near them; they are candidates, and what is refined from them is free.
        origin: the file it was read from, for messages and for its fingerprint.

    Raises:
        CrystalError: if the cell contradicts the group, or overlap or slack would let a part
            vanish in another.
    """

    name: str
    group: SpaceGroup
    cell: UnitCell
    molecule: Molecule
    grid: ArrangementGrid
    resolution: float
    description: str = ""
    overlap: float = 0.0
    slack: float = 0.0
    document: Mapping[str, Any] = field(default_factory=dict, repr=False)
    origin: Origin = field(default_factory=Origin, repr=False)

    def __post_init__(self) -> None:
        sizes = {self.group.dimension, self.cell.dimension, self.molecule.dimension}
        if len(sizes) > 1:
            raise CrystalError(
                f"expected a group, a cell and a molecule of one dimension, got group "
                f"{self.group.dimension}, cell {self.cell.dimension}, molecule "
                f"{self.molecule.dimension}"
            )
        object.__setattr__(self, "cell", self.group.fitted_cell(self.cell))
        check_depth(self.overlap, self.molecule)
        check_depth(self.slack, self.molecule)

    @property
    def dimension(self) -> int:
        """The dimension n, 2 or 3."""
        return self.molecule.dimension

    @property
    def keys(self) -> tuple[str, ...]:
        """The coordinates' keys in files, in the order of configurations."""
        return tuple(coordinate.key for coordinate in self.molecule.coordinates)

    @cached_property
    def crystal(self) -> tuple[Array, Array, Array, Array]:
        """What kernels read: operations (m, 12), basis, its inverse (3, 3), reaches (3,)."""
        rotations, translations = self.group.cartesian(self.cell)
        operations = np.zeros((len(rotations), FRAME))
        n = self.dimension
        for row, rotation, translation in zip(operations, rotations, translations, strict=True):
            whole = np.eye(3)
            whole[:n, :n] = rotation
            row[:9], row[9 : 9 + n] = whole.ravel(), translation
        basis = np.eye(3)
        basis[:n, :n] = self.cell.basis
        if n == 2:  # no copies above or below the plane
            basis[2, 2] = 8.0 * float(np.linalg.norm(self.cell.basis, axis=0).max())
            basis[2, 2] += 8.0 * max(float(part.semi_axes.max()) for part in self.parts)
        inverse = np.linalg.inv(basis).astype(float)
        return operations, basis, inverse, np.sqrt((inverse**2).sum(axis=1))

    @property
    def parts(self) -> tuple[Any, ...]:
        """The molecule's parts, in their links' frames."""
        return self.molecule.robot.parts

    @cached_property
    def required(self) -> float:
        """The gap [length] from which on bodies count as free: rounding, less the overlap."""
        _, basis, _, _ = self.crystal
        n = self.dimension
        edges = np.linalg.norm(basis[:n, :n], axis=0)
        size = edges.max() + sum(float(part.semi_axes.max()) for part in self.parts)
        share = layout.ROUNDING * self._rounding_share
        return float(share * 4.0 * size + self.loss * self.lever) - self.overlap

    @cached_property
    def loss(self) -> float:
        """What rounding loses [length per length] of places far from the origin.

        More so in flat cells, whose lattice vectors nearly cancel.
        """
        _, basis, _, reaches = self.crystal
        n = self.dimension
        stretch = float(np.linalg.norm(basis[:n, :n], axis=0) @ reaches[:n])
        return layout.ROUNDING * self._rounding_share * stretch

    @property
    def _rounding_share(self) -> float:
        """By how much more the molecule's kinematics round than a single motion does.

        A coordinate or fixed joint adds up to 10 units of rounding times what hangs on it: 3 for
        each entry of two matrix products, and some for a turn; ROUNDING is 32 units.
        """
        robot = self.molecule.robot
        return 1.0 + 0.3 * (len(self.molecule.coordinates) + len(robot.joints))

    @cached_property
    def lever(self) -> float:
        """How far [length] from the origin the parts' centres can come in the grid's ranges."""
        whole = self.molecule
        ends = [max(abs(r.lower), abs(r.upper)) for r in self.grid.ranges]
        shifts = sum(end for end, c in zip(ends, whole.coordinates, strict=True) if not c.turns)
        links = float(np.linalg.norm(whole.origins[:, 9:], axis=1).sum())
        return float(shifts + links + np.linalg.norm(whole.parts[:, :3], axis=1).max())

    def is_free(self, configuration: ArrayLike) -> bool:
        """Whether no two copies of the molecule, nor parts that should not, meet.

        True is proved (a direction for each pair that could touch); what rounding might have
        decided counts as a collision.

        Args:
            configuration: (K,), angles [rad].
        """
        from ellipsoid_planning.crystal.packing.collisions import arrangements_free

        values = np.asarray(configuration, dtype=float)
        self.molecule.frames(values)
        return bool(arrangements_free(self, values[None])[0])

    def are_free(self, configurations: ArrayLike) -> NDArray[np.bool_]:
        """:meth:`is_free` of many configurations (m, K).

        Raises:
            CrystalError: if the shape is another, or a value is not finite.
        """
        from ellipsoid_planning.crystal.packing.collisions import arrangements_free

        return arrangements_free(self, np.asarray(configurations, dtype=float))

    def values_of(self, configuration: ArrayLike) -> dict[str, float]:
        """A configuration (K,) as files give it: by key, angles in degrees."""
        return dict(zip(self.keys, self.in_file_units(configuration).tolist(), strict=True))

    def in_file_units(self, configurations: ArrayLike) -> Array:
        """Configurations (..., K) as files give them: angles in degrees."""
        values = np.asarray(configurations, dtype=float)
        turns = [coordinate.turns for coordinate in self.molecule.coordinates]
        return np.where(turns, np.degrees(values), values)

    def configuration(self, values: Mapping[str, float]) -> Array:
        """The configuration (K,) of values by key, angles in degrees.

        Raises:
            CrystalError: if a key is missing or unknown.
        """
        unknown = [key for key in values if key not in self.keys]
        missing = [key for key in self.keys if key not in values]
        if unknown or missing:
            what = f"{unknown[0]!r} is no coordinate" if unknown else f"{missing[0]!r} is missing"
            raise CrystalError(f"{what}; the coordinates of {self.name} are {', '.join(self.keys)}")
        given = np.array([values[key] for key in self.keys], dtype=float)
        turns = [coordinate.turns for coordinate in self.molecule.coordinates]
        return np.where(turns, np.radians(given), given)


def check_depth(depth: float, molecule: Molecule) -> None:
    """Check how deep a molecule's parts may reach into others.

    Raises:
        CrystalError: if a part could vanish in another one.
    """
    thinnest = min(float(part.semi_axes.min()) for part in molecule.robot.parts)
    if not 0.0 <= depth < thinnest:
        raise CrystalError(
            f"expected a depth from 0 to less than the smallest semi-axis {thinnest:g}, got "
            f"{depth:g}; lower it"
        )


def load_model(path_or_name: str | Path) -> PackingModel:
    """Return the packing model of a YAML file, or of a bundled model's name.

    Raises:
        ScenarioError: with file, field, line and column at the first thing that is wrong.
    """
    from ellipsoid_planning.crystal.packing.model_build import model_of
    from ellipsoid_planning.crystal.packing.model_files import locate_model
    from ellipsoid_planning.scenario_files import read_document

    document, origin = read_document(locate_model(path_or_name))
    return model_of(document, origin)


def load_target(path_or_name: str | Path, model: PackingModel) -> Array:
    """Return the configuration (K,) of a target's YAML file, or of a bundled target's name.

    Raises:
        ScenarioError: as `load_model`; also for coordinates that the model does not have.
    """
    from ellipsoid_planning.crystal.packing.model_build import target_of
    from ellipsoid_planning.crystal.packing.model_files import locate_model
    from ellipsoid_planning.scenario_files import read_document

    document, origin = read_document(locate_model(path_or_name))
    return target_of(document, origin, model)
