"""Ellipsoids for the domains of a molecule.

Atoms count as balls of uniform density, each with its mass. The ellipsoid of uniform density
with their second moments, semi-axes √(5 λ) for the eigenvalues λ of the covariance, scatters
alike at low resolution. It is larger than the protein, because that is no ellipsoid, so that
neighbours in a crystal overlap a little; scaled to the volume that the protein has by its mass
they overlap less. Ellipsoids around all atoms are there for comparison: they overlap far too much.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.crystal.structures.contacts import closest_contacts
from ellipsoid_planning.crystal.structures.domains import Domain, Hinge, assign, find_hinges
from ellipsoid_planning.crystal.structures.structure import Atoms, CrystalStructure
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.geometry.directions import unit_directions
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.enclosing import enclosing_ellipsoid, grown_around
from ellipsoid_planning.geometry.rounds import Rounds

Array = NDArray[np.float64]
Rows = NDArray[np.int64]

SHAPES = ("moments", "volume", "enclosing")
SPECIFIC_VOLUME = 0.73  # of proteins [cm³/g]; Matthews, J. Mol. Biol. 33 (1968) 491
DALTON = 1.66053907  # [1e-24 g]
VOLUME_OF_DALTON = SPECIFIC_VOLUME * DALTON  # 1.21 [Å³/Da]
BALL = 4.0 / 3.0 * math.pi
MOST_ROUNDS = 100
MOST_SCALE = 1000.0  # and its inverse the least
STEPS = 1000  # of scales, in 1
MARGIN = 0.1  # of such a step
DEPTHS = 10  # of overlap, in 1 Å
SURFACE_POINTS = 30  # on each atom, where the smallest ellipsoid is looked for
ROUGH = 1e-3


@dataclass(frozen=True, eq=False)
class DomainFit:
    """One domain's ellipsoids.

    Attributes:
        domain: its name and residues.
        ellipsoids: in the crystal's Cartesian frame [Å].
        atoms: how many it has.
        residues: how many it has.
        mass: with hydrogens [Da].
        electrons: with hydrogens.
        frame: the ellipsoid of the whole domain's second moments; its axes are those of the domain.
    """

    domain: Domain
    ellipsoids: tuple[Ellipsoid, ...]
    atoms: int
    residues: int
    mass: float
    electrons: float
    frame: Ellipsoid

    @property
    def volume(self) -> float:
        """What a protein of this mass takes up without solvent [Å³]."""
        return VOLUME_OF_DALTON * self.mass

    @property
    def ellipsoid_volume(self) -> float:
        """The sum over its ellipsoids [Å³]; overlaps count twice."""
        return BALL * sum(float(np.prod(body.semi_axes)) for body in self.ellipsoids)

    @property
    def density(self) -> float:
        """Electrons per volume, so that the ellipsoids have as many as the domain [1/Å³]."""
        return self.electrons / self.ellipsoid_volume


@dataclass(frozen=True, eq=False)
class MoleculeFit:
    """A molecule as ellipsoids at its deposited place.

    Attributes:
        structure: what was fitted.
        shape: ``moments``, ``volume`` or ``enclosing``.
        scale: by which the semi-axes were multiplied in the end.
        domains: in the given order.
        hinges: between domains that a chain joins.
        left_out: how many residues of polymers are in no domain.
    """

    structure: CrystalStructure
    shape: str
    scale: float
    domains: tuple[DomainFit, ...]
    hinges: tuple[Hinge, ...]
    left_out: int

    @property
    def ellipsoids(self) -> tuple[Ellipsoid, ...]:
        """Those of all domains, in their order."""
        return tuple(body for domain in self.domains for body in domain.ellipsoids)


def fit_domains(
    structure: CrystalStructure,
    domains: Sequence[Domain],
    shape: str = "moments",
    parts: int = 1,
    scale: float = 1.0,
) -> MoleculeFit:
    """Fit ellipsoids to the domains of a molecule.

    Args:
        structure: the molecule, as deposited.
        domains: of residues; see `parse_domain`.
        shape: ``moments``: the second moments of the domain's atoms; ``volume``: the same, scaled
            to the volume of its mass; ``enclosing``: the smallest ones around its atoms.
        parts: how many ellipsoids each domain is cut into.
        scale: multiplies all semi-axes in the end.

    Raises:
        CrystalError: an unknown shape, no positive number or scale, or domains that cannot be
            found or fitted; see `assign`.
    """
    _check(shape, parts, scale)
    owners = assign(structure, domains)
    fits = tuple(
        _fit(structure.atoms, np.flatnonzero(owners == index), domain, shape, parts, scale)
        for index, domain in enumerate(domains)
    )
    left = np.flatnonzero(structure.atoms.polymer & (owners < 0))
    hinges = find_hinges(structure, domains, owners)
    return MoleculeFit(structure, shape, scale, fits, hinges, _residues(structure.atoms, left))


def deepest_overlap(fit: MoleculeFit) -> float:
    """How deep ellipsoids of different molecules reach into each other as deposited [Å].

    Rounded up to a tenth; 0 if none meet.
    """
    structure = fit.structure
    contacts = closest_contacts(fit.ellipsoids, structure.cell, structure.group)
    depth = max((-contact.gap for contact in contacts), default=0.0)
    return max(0.0, math.ceil(DEPTHS * depth) / DEPTHS)


def loosened(fit: MoleculeFit) -> MoleculeFit:
    """The same fit at the largest scale, up to the present one, that keeps all copies apart.

    Rounded down to a thousandth.

    Raises:
        CrystalError: if no scale does, because two ellipsoids have one centre.
    """
    structure = fit.structure
    contacts = closest_contacts(fit.ellipsoids, structure.cell, structure.group)
    if not contacts:
        return fit
    scale = math.floor(STEPS * fit.scale * contacts[0].factor - MARGIN) / STEPS
    if scale <= 0.0:
        first, second = contacts[0].first, contacts[0].second
        raise CrystalError(
            f"{structure.file}: the ellipsoids {first!r} and {second!r} of two molecules have the "
            "same centre; is the molecule on a symmetry element, or the group too large?"
        )
    domains = [entry.domain for entry in fit.domains]
    parts = max(len(entry.ellipsoids) for entry in fit.domains)
    return fit_domains(structure, domains, fit.shape, parts, scale)


def _check(shape: str, parts: int, scale: float) -> None:
    if shape not in SHAPES:
        raise CrystalError(f"shape {shape!r}: expected one of {', '.join(SHAPES)}")
    if parts < 1:
        raise CrystalError(f"parts {parts}: expected at least one ellipsoid for each domain")
    if not 1.0 / MOST_SCALE <= scale <= MOST_SCALE:
        raise CrystalError(
            f"scale {scale:g}: expected a number from {1.0 / MOST_SCALE:g} to {MOST_SCALE:g}"
        )


def _residues(atoms: Atoms, rows: Rows) -> int:
    return len({(str(atoms.chains[row]), *atoms.residue(row)) for row in rows})


def _fit(
    atoms: Atoms, rows: Rows, domain: Domain, shape: str, parts: int, scale: float
) -> DomainFit:
    groups = clusters(atoms.positions[rows], atoms.masses[rows], parts)
    names = [domain.name] if len(groups) == 1 else [f"{domain.name} {k + 1}" for k in range(parts)]
    fitted = enclosing if shape == "enclosing" else moments
    bodies = [fitted(atoms, rows[group], name) for group, name in zip(groups, names, strict=False)]
    mass = float(atoms.masses[rows].sum())
    factor = scale
    if shape == "volume":
        total = BALL * sum(float(np.prod(body.semi_axes)) for body in bodies)
        factor *= (VOLUME_OF_DALTON * mass / total) ** (1.0 / 3.0)
    scaled = tuple(
        Ellipsoid(body.centre, body.rotation, body.semi_axes * factor, body.name) for body in bodies
    )
    counts = len(rows), _residues(atoms, rows)
    electrons = float(atoms.electrons[rows].sum())
    return DomainFit(domain, scaled, *counts, mass, electrons, moments(atoms, rows, domain.name))


def moments(atoms: Atoms, rows: Rows, name: str = "") -> Ellipsoid:
    """The ellipsoid of uniform density with the centre and second moments of some atoms.

    Atoms are balls of uniform density; a single one gives that ball.
    """
    weights = atoms.masses[rows] / atoms.masses[rows].sum()
    centre = weights @ atoms.positions[rows]
    away = atoms.positions[rows] - centre
    covariance = (away * weights[:, None]).T @ away
    covariance += np.eye(3) * float(weights @ atoms.radii[rows] ** 2) / 5.0
    return Ellipsoid.from_shape_matrix(5.0 * covariance, centre, name)


def enclosing(atoms: Atoms, rows: Rows, name: str = "") -> Ellipsoid:
    """An ellipsoid around some atoms as balls, about the smallest one."""
    from scipy.spatial import ConvexHull

    centres, radii = atoms.positions[rows], atoms.radii[rows]
    directions = unit_directions(3, SURFACE_POINTS)
    surface = (centres[:, None] + radii[:, None, None] * directions).reshape(-1, 3)
    outer = surface[ConvexHull(surface).vertices]
    body = enclosing_ellipsoid(outer, tolerance=ROUGH, name=name).ellipsoid
    balls = Rounds(centres, np.eye(3) * radii[:, None, None])
    return grown_around(body, outer, balls)


def clusters(points: Array, weights: Array, count: int) -> list[Rows]:
    """At most so many compact groups of points (m, 3): the rows of each.

    The widest group is halved across its longest axis until there are enough; then points move
    to the nearest centre (Lloyd's algorithm). Always the same for the same points.
    """
    labels = np.zeros(len(points), dtype=np.int64)
    for new in range(1, min(count, len(points))):
        spreads = [_longest(points[labels == k], weights[labels == k]) for k in range(new)]
        widest = int(np.argmax([spread for spread, _ in spreads]))
        here = np.flatnonzero(labels == widest)
        along = points[here] @ spreads[widest][1]
        middle = float(weights[here] @ along / weights[here].sum())
        labels[here[along > middle]] = new
        labels = _settled(points, weights, labels, new + 1)
    return [np.flatnonzero(labels == k) for k in range(int(labels.max()) + 1)]


def _longest(points: Array, weights: Array) -> tuple[float, Array]:
    """The total spread (mass times variance) along the longest axis, and that axis."""
    away = points - np.average(points, axis=0, weights=weights)
    values, axes = np.linalg.eigh((away * weights[:, None]).T @ away)
    return float(values[-1]), np.asarray(axes[:, -1])


def _settled(points: Array, weights: Array, labels: Rows, count: int) -> Rows:
    for _ in range(MOST_ROUNDS):
        centres = [
            np.average(points[labels == k], axis=0, weights=weights[labels == k])
            for k in range(count)
        ]
        squares = np.sum((points[:, None] - np.array(centres)) ** 2, axis=2)
        nearest: Rows = np.argmin(squares, axis=1)
        if np.array_equal(nearest, labels) or len(np.unique(nearest)) < count:
            return labels
        labels = nearest
    return labels
