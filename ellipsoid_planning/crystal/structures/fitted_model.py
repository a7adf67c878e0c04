"""Packing models of fitted molecules, and their deposited poses as targets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.structures.contacts import contact_factor
from ellipsoid_planning.crystal.structures.distinct_poses import DistinctPoses, distinct_poses
from ellipsoid_planning.crystal.structures.domains import Hinge
from ellipsoid_planning.crystal.structures.fitting import DomainFit, MoleculeFit
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.orientation_forms import form_of_rotation

Array = NDArray[np.float64]
Document = dict[str, Any]

DIGITS = 3  # of lengths [Å]
FINE_DIGITS = 6  # of directions and densities
AXES = ("x", "y", "z")
LEAST_STEP = 1e-3  # files have few digits


@dataclass(frozen=True)
class SearchSteps:
    """How fine the arrangements of a model are, and how far its hinges turn.

    Attributes:
        shift: at most, along the cell's axes [Å].
        turn_deg: at most, of the whole molecule [degree].
        hinge_deg: the hinges turn by as much to both sides [degree]; 0: they do not turn.
        hinge_steps: in how many steps.
        resolution: the smallest spacing of the planes whose magnitudes are compared [Å].

    Raises:
        CrystalError: a step or the resolution is tiny or not positive, or the hinges' turn is
            negative or more than half a turn.
    """

    shift: float = 5.0
    turn_deg: float = 15.0
    hinge_deg: float = 15.0
    hinge_steps: int = 3
    resolution: float = 15.0

    def __post_init__(self) -> None:
        for name in ("shift", "turn_deg", "hinge_steps", "resolution"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= LEAST_STEP):
                raise CrystalError(f"{name} {value:g}: expected a number from {LEAST_STEP:g} on")
        if not 0.0 <= self.hinge_deg <= 180.0:
            raise CrystalError(
                f"hinge_deg {self.hinge_deg:g}: expected 0 (hinges are stiff) to 180 degrees"
            )


@dataclass(frozen=True, eq=False)
class FittedModel:
    """A fit as the documents of a packing model and of its target.

    Attributes:
        fit: the ellipsoids.
        steps: of the search.
        name: of the model; the target's has ``-target`` after it.
        overlap: how deep ellipsoids may reach into each other in a free arrangement [Å].
    """

    fit: MoleculeFit
    steps: SearchSteps
    name: str
    overlap: float = 0.0

    def model(self, description: str = "") -> Document:
        """The packing model's document."""
        structure = self.fit.structure
        joints = self._joints()
        return {
            "format": 1,
            "name": self.name,
            "description": description or self._description(),
            "dimension": 3,
            "group": structure.group.name,
            "cell": {
                "lengths": [round(length, DIGITS) for length in structure.cell.lengths.tolist()],
                "angles_deg": [round(angle, DIGITS) for angle in structure.cell.angles_deg],
            },
            "molecule": {
                "links": self._links(),
                "joints": joints,
                "ignore_self_collision": self._ignored(joints),
            },
            "packing": {"overlap": self.overlap},
            "search": self._search(joints),
            "diffraction": {
                "resolution": self.steps.resolution,
                "densities": {
                    domain.domain.name: round(domain.density, FINE_DIGITS)
                    for domain in self.fit.domains
                },
            },
        }

    def target(self, description: str = "") -> Document:
        """The deposited pose, in the box of poses that the model goes through."""
        root = self._root.frame
        shifts, angles = self._poses.brought_inside(root.rotation, root.centre)
        configuration = {
            axis: round(shift, DIGITS)
            for axis, shift, whole in zip(AXES, shifts.tolist(), self._poses.shifts, strict=True)
            if whole > 0.0
        }
        for name, angle in zip(("alpha", "beta", "gamma"), angles.tolist(), strict=True):
            configuration[f"{name}_deg"] = round(math.degrees(angle), DIGITS)
        for joint in self._joints():
            if joint["type"] == "revolute":
                configuration[f"{joint['name']}_deg"] = 0.0
        source = self.fit.structure.name
        return {
            "format": 1,
            "name": f"{self.name}-target",
            "description": description or f"The molecule where {source} has it.",
            "configuration": configuration,
        }

    def _description(self) -> str:
        structure = self.fit.structure
        residues = "; ".join(str(domain.domain) for domain in self.fit.domains)
        return (
            f"{structure.name} in its crystal, by ellipsoids ({self.fit.shape}, scale "
            f"{self.fit.scale:g}) of its domains {residues}. Lengths in ångström."
        )

    @property
    def _root(self) -> DomainFit:
        """The heaviest domain, which carries the others."""
        return max(self.fit.domains, key=lambda domain: domain.mass)

    @property
    def _poses(self) -> DistinctPoses:
        return distinct_poses(self.fit.structure.group, self.fit.structure.cell)

    def _tree(self) -> list[tuple[DomainFit, DomainFit, Hinge | None]]:
        """Parent, child and hinge of all domains but the root; no hinge: they move as one."""
        placed = [self._root]
        left = [domain for domain in self.fit.domains if domain is not self._root]
        tree: list[tuple[DomainFit, DomainFit, Hinge | None]] = []
        while left:
            parent, child, hinge = self._next(placed, left)
            tree.append((parent, child, hinge))
            placed.append(child)
            left.remove(child)
        return tree

    def _next(
        self, placed: Sequence[DomainFit], left: Sequence[DomainFit]
    ) -> tuple[DomainFit, DomainFit, Hinge | None]:
        for parent in placed:
            for child in left:
                names = {parent.domain.name, child.domain.name}
                for hinge in self.fit.hinges:
                    if {hinge.first, hinge.second} == names:
                        return parent, child, hinge if self.steps.hinge_deg > 0.0 else None
        return placed[0], left[0], None

    def _origins(self) -> dict[str, Array]:
        """Where each domain's link has its origin, in the crystal's frame."""
        origins = {self._root.domain.name: np.asarray(self._root.frame.centre)}
        for _, child, hinge in self._tree():
            middle = child.frame.centre if hinge is None else hinge.centre
            origins[child.domain.name] = np.asarray(middle)
        return origins

    def _links(self) -> list[Document]:
        origins, inward = self._origins(), self._root.frame.rotation.T
        parts = {
            domain.domain.name: [
                _body(body, inward, origins[domain.domain.name]) for body in domain.ellipsoids
            ]
            for domain in self.fit.domains
        }
        root = self._root.domain.name
        links: list[Document] = [{"name": root, "parts": parts[root]}]
        for _, child, hinge in self._tree():
            name = child.domain.name
            if hinge is not None and hinge.axis is None:
                links += [{"name": between} for between in _between(name)]
            links.append({"name": name, "parts": parts[name]})
        return links

    def _joints(self) -> list[Document]:
        origins, inward = self._origins(), self._root.frame.rotation.T
        tree = self._tree()
        joints: list[Document] = []
        for parent, child, hinge in tree:
            away = inward @ (origins[child.domain.name] - origins[parent.domain.name])
            name = "hinge" if len(tree) == 1 else f"hinge_{child.domain.name}"
            links = [parent.domain.name, child.domain.name]
            axes: list[Array | None] = [None]
            if hinge is not None and hinge.axis is not None:
                axes = [inward @ hinge.axis]
            elif hinge is not None:  # one point: turns about three axes
                links[1:1] = _between(child.domain.name)
                axes = list(np.eye(3))
            for k, axis in enumerate(axes):
                whole = name if len(axes) == 1 else f"{name}_{AXES[k]}"
                place = away if k == 0 else np.zeros(3)
                joints.append(self._joint(whole, links[k], links[k + 1], place, axis))
        return joints

    def _joint(
        self, name: str, parent: str, child: str, place: Array, axis: Array | None
    ) -> Document:
        joint: Document = {
            "name": name.replace(" ", "_"),
            "type": "fixed" if axis is None else "revolute",
            "parent": parent,
            "child": child,
            "origin": {"position": _rounded(place, DIGITS)},
        }
        if axis is not None:
            turn = self.steps.hinge_deg
            joint["axis"] = _rounded(axis, FINE_DIGITS)
            joint["limit"] = {"lower_deg": -turn, "upper_deg": turn}
        return joint

    def _ignored(self, joints: Sequence[Document]) -> list[list[str]]:
        """Pairs of domains that meet as deposited, and are not looked at anyway."""
        joined = [{joint["parent"], joint["child"]} for joint in joints]
        found = []
        for index, first in enumerate(self.fit.domains):
            for second in self.fit.domains[index + 1 :]:
                pair = [first.domain.name, second.domain.name]
                if set(pair) not in joined and _meet(first, second):
                    found.append(pair)
        return found

    def _search(self, joints: Sequence[Document]) -> Document:
        poses, turn = self._poses, self.steps.turn_deg
        beta, alpha = math.degrees(poses.beta), math.degrees(poses.alpha)
        search: Document = {
            "position": {
                axis: _range(0.0, round(whole, DIGITS), self.steps.shift)
                for axis, whole in zip(AXES, poses.shifts.tolist(), strict=True)
                if whole > 0.0
            },
            "orientation": {
                "alpha_deg": _range(0.0, alpha, turn),
                "beta_deg": _range(0.0, beta, turn),
                "gamma_deg": _range(0.0, 360.0, turn),
            },
        }
        moving = [joint["name"] for joint in joints if joint["type"] == "revolute"]
        if moving:
            step = round(2.0 * self.steps.hinge_deg / self.steps.hinge_steps, FINE_DIGITS)
            search["joints"] = {f"{name}_deg": {"step": step} for name in moving}
        return search


def _between(name: str) -> list[str]:
    """The links without parts between the three axes of a point."""
    return [f"{name} about x", f"{name} about y"]


def _body(body: Ellipsoid, inward: Array, origin: Array) -> Document:
    form = form_of_rotation(inward @ body.rotation)
    return {
        "name": body.name,
        "semi_axes": _rounded(body.semi_axes, DIGITS),
        "position": _rounded(inward @ (body.centre - origin), DIGITS),
        "orientation": {
            key: _rounded(np.array(value), FINE_DIGITS) if isinstance(value, list) else value
            for key, value in form.items()
        },
    }


def _meet(first: DomainFit, second: DomainFit) -> bool:
    return any(
        contact_factor(one, other) < 1.0 for one in first.ellipsoids for other in second.ellipsoids
    )


def _range(lower: float, upper: float, step: float) -> Document:
    """A range in equal steps of at most so much."""
    count = max(1, math.ceil((upper - lower) / step - 1e-9))
    return {"lower": lower, "upper": upper, "step": round((upper - lower) / count, FINE_DIGITS)}


def _rounded(vector: Array, digits: int) -> list[float]:
    # Adding zero turns -0.0 into 0.0.
    return [round(value, digits) + 0.0 for value in vector.tolist()]
