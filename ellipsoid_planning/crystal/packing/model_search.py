"""From the search block of a packing model to its grid of arrangements."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.packing.grid import ArrangementGrid
from ellipsoid_planning.crystal.packing.model_format import (
    OrientationBlock,
    RangeBlock,
    SearchBlock,
)
from ellipsoid_planning.crystal.packing.molecule import EULER_NAMES, Coordinate, Molecule
from ellipsoid_planning.crystal.packing.ranges import Range
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell
from ellipsoid_planning.errors import CrystalError, GridError
from ellipsoid_planning.robots.joint import CONTINUOUS, Joint
from ellipsoid_planning.scenario_origin import Origin, Path

SHIFTS = ("x", "y", "z")
DEGREE = math.pi / 180.0
ORIENTATION: Path = ("search", "orientation")
ANGLE_KEYS = ("yaw_deg", *(f"{name}_deg" for name in EULER_NAMES))

MOST_POSES = 10**7  # of the base: a table has them all
MOST_ARRANGEMENTS = 10**14  # weeks of a core; their numbers stay exact as floats


@dataclass(frozen=True, eq=False)
class SearchGrid:
    """Builds the grid of one document, and says where in it an error comes from."""

    block: SearchBlock
    molecule: Molecule
    cell: UnitCell
    origin: Origin

    def grid(self) -> ArrangementGrid:
        """The grid of all coordinates: shifts, turns, joints.

        Raises:
            ScenarioError: at the first thing that is wrong with the block.
        """
        shifts = self._shifts()
        turned, turns = self._turns()
        ranges = (*shifts, *turned, *self._joints())
        grid = ArrangementGrid(ranges, self.molecule.base_count, len(shifts), turns)
        if grid.base_poses > MOST_POSES or grid.count > MOST_ARRANGEMENTS:
            raise self.origin.error(
                ("search",),
                f"expected at most {MOST_POSES:.0e} poses of the molecule's base and "
                f"{MOST_ARRANGEMENTS:.0e} arrangements, got {grid.base_poses:.3g} and "
                f"{grid.count:.3g}; choose larger steps",
            )
        return grid

    def _shifts(self) -> list[Range]:
        ranges = []
        for axis, name in enumerate(SHIFTS):
            block = getattr(self.block.position, name)
            if block is not None:
                limits = 0.0, float(self.cell.lengths[axis])
                ranges.append(self._range(block, ("search", "position", name), limits, 1.0))
        return ranges

    def _turns(self) -> tuple[list[Range], NDArray[np.float64] | None]:
        block = self.block.orientation
        if block is None:
            return [], None
        planar = self.molecule.dimension == 2
        wanted = ANGLE_KEYS[:1] if planar else ANGLE_KEYS[1:]
        self._check_angles(block, wanted)
        if block.grid is not None:
            return self._rotations(block)
        ranges = []
        for key in wanted:
            full = math.pi if key == "beta_deg" else 2.0 * math.pi
            place = (*ORIENTATION, key)
            ranges.append(self._range(getattr(block, key), place, (0.0, full), DEGREE))
        return ranges, None

    def _check_angles(self, block: OrientationBlock, wanted: tuple[str, ...]) -> None:
        """Either a grid, or the dimension's angles, and no others."""
        if block.grid is None and block.resolution_deg is not None:
            problem = "only a grid has a resolution; name a grid, or remove this"
            raise self.origin.error((*ORIENTATION, "resolution_deg"), problem)
        for key in ANGLE_KEYS:
            given = getattr(block, key) is not None
            place = (*ORIENTATION, key)
            if given and block.grid is not None:
                problem = "a grid goes through all rotations; remove this, or the grid"
                raise self.origin.error(place, problem)
            if given and key not in wanted:
                raise self.origin.error(
                    place,
                    f"expected {', '.join(wanted)} because the dimension is "
                    f"{self.molecule.dimension}; remove this",
                )
        for key in wanted:
            if getattr(block, key) is None and block.grid is None:
                problem = "this key is missing; add it, or name a grid"
                raise self.origin.error((*ORIENTATION, key), problem)

    def _rotations(self, block: OrientationBlock) -> tuple[list[Range], NDArray[np.float64]]:
        """Ranges of the Euler angles, and those of a grid of all rotations (r, 3)."""
        from ellipsoid_planning.groups import grid_by_name

        place: Path = (*ORIENTATION, "grid")
        if self.molecule.dimension == 2 or block.euler != "ZXZ" or block.resolution_deg is None:
            raise self.origin.error(
                place,
                "expected a grid of rotations in space, with resolution_deg and the Euler angles "
                "ZXZ; add resolution_deg, or give ranges of angles",
            )
        try:
            grid = grid_by_name(block.grid or "", resolution_deg=block.resolution_deg)
        except GridError as error:
            raise self.origin.error(place, str(error)) from None
        turns = _euler_zxz(grid.quaternions())
        step = math.radians(block.resolution_deg)
        ends = [(-math.pi, math.pi), (0.0, math.pi), (-math.pi, math.pi)]
        return [
            Range(low, high, step, column)
            for (low, high), column in zip(ends, turns.T, strict=True)
        ], turns

    def _joints(self) -> list[Range]:
        coordinates = {c.key: c for c in self.molecule.coordinates[self.molecule.base_count :]}
        given: Mapping[str, RangeBlock] = self.block.joints
        for key in given:
            if key not in coordinates:
                raise self.origin.error(
                    ("search", "joints", key),
                    f"{key!r} is no joint's key; expected {', '.join(coordinates) or 'none'}",
                    at_key=True,
                )
        joints = {joint.name: joint for joint in self.molecule.robot.joints}
        return [
            self._joint(coordinate, joints[coordinate.name], given.get(key))
            for key, coordinate in coordinates.items()
        ]

    def _joint(self, coordinate: Coordinate, joint: Joint, block: RangeBlock | None) -> Range:
        place: Path = ("search", "joints", coordinate.key)
        unit = DEGREE if coordinate.turns else 1.0
        rounding = 1e-9 * max(abs(joint.lower), abs(joint.upper))
        range_ = (
            Range.fixed(0.0)
            if block is None
            else self._range(block, place, (joint.lower, joint.upper), unit)
        )
        below, above = range_.lower < joint.lower - rounding, range_.upper > joint.upper + rounding
        if joint.type != CONTINUOUS and (below or above):
            got = f"{range_.lower / unit:g} to {range_.upper / unit:g}"
            if block is None:
                got = "none, so that the joint would stand at 0"
            raise self.origin.error(
                place,
                f"expected a range within the joint's limits {joint.lower / unit:g} to "
                f"{joint.upper / unit:g}, got {got}; correct it",
            )
        return range_

    def _range(
        self, block: RangeBlock, path: Path, limits: tuple[float, float], unit: float
    ) -> Range:
        lower = limits[0] / unit if block.lower is None else block.lower
        upper = limits[1] / unit if block.upper is None else block.upper
        try:
            return Range.of(lower, upper, block.step, block.nodes).scaled(unit)
        except CrystalError as error:
            raise self.origin.error(path, str(error)) from None


def _euler_zxz(quaternions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Euler angles ZXZ [rad] (r, 3); the third is zero where only a sum of angles counts."""
    from scipy.spatial.transform import Rotation

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # scipy warns where the second angle is 0 or π
        return np.asarray(Rotation.from_quat(quaternions).as_euler("ZXZ"))
