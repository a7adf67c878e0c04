"""From documents to packing models and targets."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from ellipsoid_planning.crystal.packing.model import PackingModel, check_depth
from ellipsoid_planning.crystal.packing.model_format import PackingModelBlock, TargetBlock
from ellipsoid_planning.crystal.packing.model_search import SHIFTS, SearchGrid
from ellipsoid_planning.crystal.packing.molecule import Molecule, molecule_of
from ellipsoid_planning.crystal.symmetry.catalogue import space_group
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell
from ellipsoid_planning.errors import CrystalError, ScenarioError
from ellipsoid_planning.robots.articulated import FREE_BASE, ArticulatedRobot, Link
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario_entries import Entries
from ellipsoid_planning.scenario_format_robot import Pose
from ellipsoid_planning.scenario_origin import Origin, Path
from ellipsoid_planning.scenario_problems import scenario_error, shown
from ellipsoid_planning.scenario_robot import robot_of

MOST_CELLS = 1e7  # that a part reaches through; usual are some tens
LEAST_ACCURACY = 1e-4  # of distances, in the size of the largest part


def model_of(document: Any, origin: Origin | None = None) -> PackingModel:
    """Return the packing model of a document in the format.

    Raises:
        ScenarioError: at the first thing that is wrong with the document.
    """
    origin = origin or Origin()
    return _Builder(_validated(PackingModelBlock, document, origin, "packing model"), origin).model(
        document
    )


def target_of(document: Any, origin: Origin, model: PackingModel) -> NDArray[np.float64]:
    """Return the configuration (K,) of a target's document.

    Raises:
        ScenarioError: at the first thing that is wrong with the document.
    """
    block = _validated(TargetBlock, document, origin, "target")
    try:
        return model.configuration(block.configuration)
    except CrystalError as error:
        raise origin.error(("configuration",), str(error)) from None


def _validated(kind: Any, document: Any, origin: Origin, what: str) -> Any:
    if not isinstance(document, Mapping):
        problem = f"expected a mapping with the keys of a {what}, got {shown(document)}"
        raise origin.error((), problem)
    try:
        return kind.model_validate(dict(document))
    except ValidationError as error:
        raise scenario_error(error, origin) from None


class _MoleculeEntries(Entries):
    """Entries of a robot that stands under the key ``molecule``."""

    def error(self, path: Path, problem: str, *, at_key: bool = False) -> ScenarioError:
        if path[:1] == ("robot",):
            path = ("molecule", *path[1:])
        return super().error(path, problem, at_key=at_key)


class _Builder:
    """Builds the objects of one document, and says where in it an error comes from."""

    def __init__(self, block: PackingModelBlock, origin: Origin) -> None:
        self._block = block
        self._origin = origin
        self._entries = _MoleculeEntries(block.dimension, origin)

    def model(self, document: Mapping[str, Any]) -> PackingModel:
        block = self._block
        group = self._at(("group",), space_group, block.group)
        if group.dimension != block.dimension:
            raise self._origin.error(
                ("group",),
                f"expected a group of dimension {block.dimension}, got {group.name} of dimension "
                f"{group.dimension}; name a {'plane' if block.dimension == 2 else 'space'} group",
            )
        cell = self._at(("cell",), group.fitted_cell, self._cell())
        molecule = self._molecule(cell)
        self._check_size(molecule, cell, group.order)
        self._at(("packing", "overlap"), check_depth, block.packing.overlap, molecule)
        self._at(("search", "slack"), check_depth, block.search.slack, molecule)
        self._check_extent(molecule, cell)
        model = PackingModel(
            block.name,
            group,
            cell,
            molecule,
            SearchGrid(block.search, molecule, cell, self._origin).grid(),
            float(block.diffraction.resolution),
            block.description,
            float(block.packing.overlap),
            float(block.search.slack),
            document,
            self._origin,
        )
        self._check_rounding(model)
        return model

    def _at(self, path: Path, function: Any, *arguments: Any) -> Any:
        """Call a function; its complaint is about the entry at `path`."""
        try:
            return function(*arguments)
        except ScenarioError:
            raise
        except CrystalError as error:
            raise self._origin.error(path, str(error)) from None

    def _cell(self) -> UnitCell:
        lengths = self._entries.vector(self._block.cell.lengths, ("cell", "lengths"))
        angles = self._block.cell.angles_deg
        return self._at(("cell",), UnitCell.from_parameters, lengths, angles)

    def _molecule(self, cell: UnitCell) -> Molecule:
        search = self._block.search
        robot = robot_of(self._entries, self._block.molecule, Pose.model_validate({}))
        if isinstance(robot, RigidRobot):
            if not robot.rotates:
                raise self._origin.error(
                    ("molecule", "rotates"),
                    "the search says what moves; remove this, and leave search.orientation out",
                )
            robot = ArticulatedRobot((Link("molecule", robot.parts),), ())
        if robot.base != FREE_BASE:
            raise self._origin.error(
                ("molecule", "base"),
                f"expected a free base, got {robot.base}; the search says what moves: leave "
                "search.position and search.orientation out",
            )
        self._check_densities(robot)
        shifts = [k for k, name in enumerate(SHIFTS) if getattr(search.position, name) is not None]
        if 2 in shifts and self._block.dimension == 2:
            raise self._origin.error(("search", "position", "z"), "there is no z in the plane")
        turns = "" if search.orientation is None else search.orientation.euler
        densities = self._block.diffraction.densities
        molecule: Molecule = self._at(
            ("molecule",), molecule_of, robot, cell.basis, shifts, turns, densities
        )
        self._check_names(molecule)
        return molecule

    def _check_names(self, molecule: Molecule) -> None:
        keys = [coordinate.key for coordinate in molecule.coordinates]
        joints = [joint.name for joint in molecule.robot.joints]
        for coordinate in molecule.coordinates[molecule.base_count :]:
            if keys.count(coordinate.key) > 1:
                raise self._origin.error(
                    ("molecule", "joints", joints.index(coordinate.name), "name"),
                    f"{coordinate.key} is a coordinate of the molecule's base already; rename this "
                    "joint",
                )

    def _check_densities(self, robot: ArticulatedRobot) -> None:
        names = {link.name for link in robot.links}
        for name in self._block.diffraction.densities:
            if name not in names:
                raise self._origin.error(
                    ("diffraction", "densities", name),
                    f"{name!r} is no link; the links are {', '.join(sorted(names))}",
                )

    def _check_size(self, molecule: Molecule, cell: UnitCell, copies: int) -> None:
        largest = float(molecule.part_volumes.max())
        if copies * largest >= cell.volume:
            raise self._origin.error(
                ("cell",),
                f"the largest part of the molecule has a volume of {largest:.6g}, and {copies} "
                f"copies of it do not fit into the cell's {cell.volume:.6g}; enlarge the cell or "
                "shrink the molecule",
            )

    def _check_extent(self, molecule: Molecule, cell: UnitCell) -> None:
        """Refuse parts that reach through so many cells that looking at all copies has no end."""
        reaches = np.linalg.norm(cell.reciprocal, axis=0)
        longest = max(float(part.semi_axes.max()) for part in molecule.robot.parts)
        cells = float(np.prod(1.0 + 4.0 * longest * reaches))
        if not cells <= MOST_CELLS:
            raise self._origin.error(
                ("cell",),
                f"parts of the molecule are up to {2.0 * longest:.6g} long, and that near there "
                f"are {cells:.3g} cells; expected at most {MOST_CELLS:.0e}: enlarge the cell, or "
                "shrink the molecule",
            )

    def _check_rounding(self, model: PackingModel) -> None:
        with np.errstate(over="ignore"):
            rounding = model.required + model.overlap
        length = max(float(part.semi_axes.max()) for part in model.parts)
        if not rounding <= LEAST_ACCURACY * length:
            raise self._origin.error(
                ("molecule",),
                f"the molecule's parts, {length:.3g} in size, are so far from its origin that "
                f"distances are rounded by {rounding:.3g}; move the origin into the molecule",
            )
