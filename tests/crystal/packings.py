"""Packing models as texts to change, and a slow twin of the collision test."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.packing.model_build import model_of
from ellipsoid_planning.scenario_files import parse_document
from tests.oracles import signed_gaps

MARGIN = 0.3  # bodies farther apart than this are not looked at closely

ONE_BODY = """\
format: 1
name: one body
dimension: {dimension}
group: {group}
cell: {cell}
molecule:
  parts:
    - {{semi_axes: {semi_axes}, position: {position}}}
search: {search}
diffraction: {{resolution: 1}}
"""


def model_from(text: str) -> PackingModel:
    return model_of(*parse_document(text, "model.yaml"))


def one_body(*arguments: Any, **named: Any) -> PackingModel:
    return model_from(one_body_text(*arguments, **named))


def one_body_text(
    group: str,
    cell: str,
    semi_axes: list[float],
    search: str = "{}",
    position: list[float] | None = None,
) -> str:
    at = position or [0.0] * len(semi_axes)
    return ONE_BODY.format(
        dimension=len(semi_axes),
        group=group,
        cell=cell,
        semi_axes=semi_axes,
        search=search,
        position=at,
    )


def smallest_gap(model: PackingModel, configuration: Any, reach: int = 2) -> float:
    """Smallest signed gap between a molecule and its copies within ``reach`` cells.

    Written from the definition: every operation and every lattice vector near, all pairs of
    parts, in plain numpy.
    """
    n = model.dimension
    bodies = [(b.centre, b.matrix) for b in model.molecule.bodies(configuration)]
    rotations, translations = model.group.cartesian(model.cell)
    links = model.molecule.robot.part_links
    radii = np.array([np.linalg.norm(a, ord=2) for _, a in bodies])
    offsets, firsts, seconds = [], [], []
    steps = np.array(list(itertools.product(range(-reach, reach + 1), repeat=n)))
    lattice = steps @ model.cell.basis.T
    for g, (q, t) in enumerate(zip(rotations, translations, strict=True)):
        for i, j in itertools.product(range(len(bodies)), repeat=2):
            found = q @ bodies[j][0] + t - bodies[i][0] + lattice
            near = np.linalg.norm(found, axis=1) <= radii[i] + radii[j] + MARGIN
            if g == 0 and not watched(model, links[i], links[j]):
                near &= np.any(steps != 0, axis=1)
            for offset in found[near]:
                offsets.append(offset)
                firsts.append(bodies[i][1])
                seconds.append(q @ bodies[j][1])
    if not offsets:
        return MARGIN
    gaps, _ = signed_gaps(np.array(offsets), np.array(firsts), np.array(seconds))
    return min(float(np.min(gaps)), MARGIN)


def watched(model: PackingModel, first: str, second: str) -> bool:
    robot = model.molecule.robot
    if first == second or frozenset((first, second)) in robot.ignored:
        return False
    return all({joint.parent, joint.child} != {first, second} for joint in robot.joints)


__all__ = ["model_from", "one_body", "one_body_text", "smallest_gap", "watched"]
