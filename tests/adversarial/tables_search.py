"""States in the very corners of a safety table's cells, where a body touches an obstacle by a hair.

A table is made for the middles of its cells, and what lies between is covered by growing the link.
So the link is put where it is farthest from what the table was made for, on either side of the
seam between cells, and the obstacle is put where the link went.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.safety import TableParameters, TabulatedSafety
from ellipsoid_planning.safety import orientation_grid as grids
from ellipsoid_planning.safety.planning import plan_tables
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World
from tests import random_scenes
from tests.adversarial.articulated_judge import Long, rotations, separations, turns
from tests.adversarial.outcome import Counterexample, Outcome

Array = Any
Rng = np.random.Generator

SHAPES = ("needle", "disc", "mild", "sphere")
BOX = 3.0


def _world(n: int, *bodies: Ellipsoid) -> World:
    """Two small bodies at the corners keep the table's box where it is."""
    corners = [Ellipsoid.from_semi_axes([0.01] * n, [s * BOX] * n) for s in (-1.0, 1.0)]
    return World(np.full(n, -BOX), np.full(n, BOX), (*corners, *bodies))


def _corner(rng: Rng, plan: Any, n: int) -> tuple[Array, Array, Array]:
    """A configuration (d,) in the corner of a cell, and the way (n,) there from its line."""
    table, placed = plan.tables[0], plan.shapes[0]
    grid, lines = table.resolution.orientations, table.resolution.lines
    turn = np.eye(3)
    if grid.vector != grids.NOTHING:
        edges = rng.choice(grids._edges(grid.cells), grid.vector - 1)
        own = np.append(edges, 1.0)[None] / np.linalg.norm(np.append(edges, 1.0))
        vector = grids._turned(own, grid.vector, int(rng.integers(grid.faces)))
        vector = vector + 10.0 ** rng.uniform(-17, -9) * rng.normal(size=vector.shape)
        turn = _rotation(rng, grid.vector, vector[0])
    body = turn @ placed.turn.T
    cells = [int(rng.integers(count)) for count in lines.counts]
    sides = rng.integers(0, 2, size=3)
    middle = lines.low + (np.array(cells) + sides) * lines.spacing
    middle = np.nextafter(middle, middle + rng.normal(size=3))
    middle[lines.axis] = rng.uniform(lines.low[lines.axis], lines.high[lines.axis])
    way = (2.0 * sides - 1.0) * lines.spacing
    way[lines.axis] = 0.0
    at = (middle - body @ placed.middle)[:n]
    if n == 2:
        return np.append(at, np.arctan2(body[1, 0], body[0, 0])), way[:n], body[:n, :n]
    return np.append(at, Rotation.from_matrix(body).as_quat()), way, body


def _rotation(rng: Rng, kind: int, vector: Array) -> Array:
    if kind == grids.QUATERNION:
        return Rotation.from_quat(vector).as_matrix()
    if kind == grids.HEADING:
        return Rotation.from_rotvec([0, 0, np.arctan2(vector[1], vector[0])]).as_matrix()
    tilt = Rotation.align_vectors([vector], [[0.0, 0.0, 1.0]])[0]
    return (tilt * Rotation.from_rotvec([0, 0, rng.uniform(-np.pi, np.pi)])).as_matrix()


def _gap(part: Ellipsoid, obstacle: Ellipsoid, configuration: Array) -> float:
    """The signed gap of the robot's one part and an obstacle, in extended precision."""
    n = len(part.centre)
    turn = turns if n == 2 else rotations
    values = Long(1) * (configuration[2:3] if n == 2 else configuration[None, 3:])
    rotation = turn(values)[0]
    c = configuration[:n] + rotation @ (Long(1) * part.centre) - Long(1) * obstacle.centre
    first, second = Long(1) * obstacle.matrix, rotation @ (Long(1) * part.matrix)
    return float(separations(c[None], first[None], second[None])[0])


def search(n: int, shape: str, seed: int) -> Outcome:
    """A link, its table's grid, and some corners of its cells."""
    rng = np.random.default_rng([seed, n, SHAPES.index(shape)])
    ratio = 3.0 if shape == "mild" else 10.0 ** rng.uniform(0.3, 3.0)
    axes = np.asarray(random_scenes.semi_axes(rng, n, shape, ratio))
    part = Ellipsoid(
        rng.uniform(-0.3, 0.3, size=n), random_scenes.rotation(rng, n), 0.5 * axes / axes.max()
    )
    robot = RigidRobot((part,))
    parameters = TableParameters(
        orientations=int(rng.integers(1, 60)), lines=int(rng.integers(1, 60))
    )
    plan = plan_tables(CSpace(_world(n), robot), parameters)
    total = Outcome()
    for _ in range(4):
        configuration, way, turn = _corner(rng, plan, n)
        u = -way if rng.uniform() < 0.7 else random_scenes.unit_vector(rng, n)
        u = u + float(rng.choice([0.0, 0.3])) * rng.normal(size=n) * np.linalg.norm(u)
        total += _touched(rng, robot, parameters, configuration, u / np.linalg.norm(u), turn)
    return total


def _touched(
    rng: Rng, robot: RigidRobot, parameters: Any, configuration: Array, u: Array, turn: Array
) -> Outcome:
    """The table's answer where an obstacle touches the robot from against u by a hair."""
    (part,), n = robot.parts, robot.dimension
    hair = float(rng.choice([-1, 1])) * 10.0 ** rng.uniform(-9, -1)
    matrix, own = turn @ part.matrix, random_scenes.rotation(rng, n)
    body = Ellipsoid(np.zeros(n), own, 10.0 ** rng.uniform(-2, -0.5) * rng.uniform(0.1, 1, size=n))
    reach = sum(m @ (m.T @ u) / np.linalg.norm(m.T @ u) for m in (matrix, body.matrix))
    centre = configuration[:n] + turn @ part.centre - reach + hair * u
    if np.any(np.abs(centre) > BOX - 1.0):  # it would move the table's box
        return Outcome()
    body = Ellipsoid(centre, own, body.semi_axes)
    cspace = CSpace(_world(n, body), robot)
    safety = TabulatedSafety(cspace, parameters, keep=False, workers=1)
    told, gap = bool(safety.answers([configuration])[0, 0]), _gap(part, body, configuration)
    false: tuple[Counterexample, ...] = ()
    if (told or cspace.is_valid(configuration)) and gap < 0.0:
        what = f"called safe, but {-gap:.3g} deep at {configuration.tolist()}"
        false = (
            Counterexample(
                what, Scenario("corner", cspace.world, robot, configuration, configuration)
            ),
        )
    return Outcome(1, int(told), false)


SEARCHES: dict[str, Callable[[int], Outcome]] = {
    f"tables: {n}-D, {shape}": lambda seed, n=n, shape=shape: search(n, shape, seed)
    for n in (2, 3)
    for shape in SHAPES
}
"""Searches by name: each decides some corners of one table."""
