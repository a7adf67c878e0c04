"""From documents to packing models and targets."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from ellipsoid_planning.crystal.catalogue import space_group
from ellipsoid_planning.crystal.grid import ArrangementGrid
from ellipsoid_planning.crystal.model import PackingModel
from ellipsoid_planning.crystal.model_format import (
    OrientationBlock,
    PackingModelBlock,
    RangeBlock,
    TargetBlock,
)
from ellipsoid_planning.crystal.molecule import EULER_NAMES, Molecule, molecule_of
from ellipsoid_planning.crystal.ranges import Range
from ellipsoid_planning.crystal.unit_cell import UnitCell
from ellipsoid_planning.errors import CrystalError, ScenarioError
from ellipsoid_planning.robots.articulated import FREE_BASE, ArticulatedRobot, Link
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.scenario_entries import Entries
from ellipsoid_planning.scenario_format_robot import Pose
from ellipsoid_planning.scenario_origin import Origin, Path
from ellipsoid_planning.scenario_problems import scenario_error, shown
from ellipsoid_planning.scenario_robot import robot_of

SHIFTS = ("x", "y", "z")
FULL_TURN = 2.0 * math.pi


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
        cell = self._cell()
        self._at(("cell",), group.check_cell, cell)
        molecule = self._molecule(cell)
        self._check_size(molecule, cell, group.order)
        return PackingModel(
            block.name,
            group,
            cell,
            molecule,
            self._grid(molecule, cell),
            float(block.diffraction.resolution),
            block.description,
            document,
            self._origin,
        )

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
            robot = ArticulatedRobot((Link("molecule", robot.parts),), ())
        if robot.base != FREE_BASE:
            raise self._origin.error(
                ("molecule", "base"),
                f"expected a free base, got {robot.base}; the search says what moves: leave "
                "search.position and search.orientation out",
            )
        names = {link.name for link in robot.links}
        for name in self._block.diffraction.densities:
            if name not in names:
                raise self._origin.error(
                    ("diffraction", "densities", name),
                    f"{name!r} is no link; the links are {', '.join(sorted(names))}",
                )
        shifts = [k for k, name in enumerate(SHIFTS) if getattr(search.position, name) is not None]
        if 2 in shifts and self._block.dimension == 2:
            raise self._origin.error(("search", "position", "z"), "there is no z in the plane")
        turns = "" if search.orientation is None else search.orientation.euler
        return self._at(
            ("molecule",),
            molecule_of,
            robot,
            cell.basis,
            shifts,
            turns,
            self._block.diffraction.densities,
        )

    def _check_size(self, molecule: Molecule, cell: UnitCell, copies: int) -> None:
        largest = max(float(np.prod(part.semi_axes)) for part in molecule.robot.parts)
        largest *= molecule.volume / sum(
            float(np.prod(part.semi_axes)) for part in molecule.robot.parts
        )
        if copies * largest >= cell.volume:
            raise self._origin.error(
                ("cell",),
                f"the largest part of the molecule has a volume of {largest:.6g}, and {copies} "
                f"copies of it do not fit into the cell's {cell.volume:.6g}; enlarge the cell or "
                "shrink the molecule",
            )

    def _grid(self, molecule: Molecule, cell: UnitCell) -> ArrangementGrid:
        block = self._block.search
        shifts = [name for name in SHIFTS if getattr(block.position, name) is not None]
        ranges = [
            self._shift(name, getattr(block.position, name), float(cell.lengths["xyz".index(name)]))
            for name in shifts
        ]
        turned, turns = self._turns(block.orientation)
        joints = self._joints(molecule)
        return ArrangementGrid((*ranges, *turned, *joints), molecule.base_count, len(shifts), turns)

    def _shift(self, name: str, block: RangeBlock, length: float) -> Range:
        return self._range(block, ("search", "position", name), (0.0, length), 1.0)

    def _turns(
        self, block: OrientationBlock | None
    ) -> tuple[list[Range], NDArray[np.float64] | None]:
        place: Path = ("search", "orientation")
        if block is None:
            return [], None
        planar = self._block.dimension == 2
        wanted = ("yaw",) if planar else EULER_NAMES
        given = {name: getattr(block, f"{name}_deg") for name in ("yaw", *EULER_NAMES)}
        for name, value in given.items():
            if value is not None and name not in wanted:
                raise self._origin.error(
                    (*place, f"{name}_deg"),
                    f"expected {', '.join(f'{key}_deg' for key in wanted)} because the dimension "
                    f"is {self._block.dimension}; remove it",
                )
        if block.grid is not None:
            return self._grid_turns(block, planar, place)
        radians = math.pi / 180.0
        ranges = []
        for name in wanted:
            at = (*place, f"{name}_deg")
            if given[name] is None:
                raise self._origin.error(at, "this key is missing; add it, or name a grid")
            limits = (None, math.pi) if name == "beta" and not planar else (0.0, FULL_TURN)
            full = (0.0 if limits[0] is None else limits[0], limits[1])
            ranges.append(self._range(given[name], at, full, radians))
        return ranges, None

    def _grid_turns(
        self, block: OrientationBlock, planar: bool, place: Path
    ) -> tuple[list[Range], NDArray[np.float64]]:
        from scipy.spatial.transform import Rotation

        from ellipsoid_planning.errors import GridError
        from ellipsoid_planning.groups import grid_by_name

        if planar or block.euler != "ZXZ" or block.resolution_deg is None:
            raise self._origin.error(
                (*place, "grid"),
                "expected a grid of rotations in space, with resolution_deg and the Euler angles "
                "ZXZ; add resolution_deg, or give ranges of angles",
            )
        try:
            grid = grid_by_name(block.grid or "", resolution_deg=block.resolution_deg)
        except GridError as error:
            raise self._origin.error((*place, "grid"), str(error)) from None
        with np.errstate(all="ignore"):
            turns = _euler(Rotation.from_quat(grid.quaternions()))
        step = math.radians(block.resolution_deg)
        whole = [(-math.pi, math.pi), (0.0, math.pi), (-math.pi, math.pi)]
        return [Range(low, high, step, np.array([0.0])) for low, high in whole], turns

    def _joints(self, molecule: Molecule) -> list[Range]:
        keys = {c.key: c for c in molecule.coordinates[molecule.base_count :]}
        given = self._block.search.joints
        for key in given:
            if key not in keys:
                raise self._origin.error(
                    ("search", "joints", key),
                    f"{key!r} is no joint's key; expected one of {', '.join(keys) or 'none'}",
                    at_key=True,
                )
        limits = {joint.name: joint for joint in molecule.robot.joints}
        ranges = []
        for key, coordinate in keys.items():
            if key not in given:
                ranges.append(Range.fixed(0.0))
                continue
            joint = limits[coordinate.name]
            unit = math.pi / 180.0 if coordinate.turns else 1.0
            place: Path = ("search", "joints", key)
            ranges.append(self._range(given[key], place, (joint.lower, joint.upper), unit))
        return ranges

    def _range(
        self, block: RangeBlock, path: Path, limits: tuple[float, float], unit: float
    ) -> Range:
        lower = limits[0] if block.lower is None else block.lower * unit
        upper = limits[1] if block.upper is None else block.upper * unit
        rounding = 1e-9 * max(abs(limits[0]), abs(limits[1]))
        if path[1] == "joints" and not (
            limits[0] - rounding <= lower and upper <= limits[1] + rounding
        ):
            raise self._origin.error(
                path,
                f"expected a range within the joint's limits {limits[0] / unit:g} to "
                f"{limits[1] / unit:g}, got {lower / unit:g} to {upper / unit:g}; shorten it",
            )
        step = upper - lower if block.step is None else block.step * unit
        return self._at(path, Range.of, lower, upper, step, block.nodes)


def _euler(rotations: Any) -> NDArray[np.float64]:
    """Euler angles ZXZ [rad] (r, 3), the first zero where only a sum of angles counts."""
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # scipy warns where the second angle is 0 or π
        return np.asarray(rotations.as_euler("ZXZ"))
