"""From a scene in the passage's own frame to a scenario in the world's frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.families.draws import Draws
from ellipsoid_planning.families.shapes import Shape
from ellipsoid_planning.families.turns import configuration
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.scenario import Scenario
from ellipsoid_planning.world import World

Array = NDArray[np.float64]

FARTHEST_SHIFT = 3.0
BOUNDS_MARGIN = 0.1


@dataclass(frozen=True, eq=False)
class Request:
    """What a family is asked for.

    Attributes:
        clearance: free play divided by the robot's width at the passage.
        dimension: n.
        draws: what the seed draws.
        blocked: whether the passage is narrower than the robot by `clearance` instead.
    """

    clearance: float
    dimension: int
    draws: Draws
    blocked: bool = False

    @property
    def signed_clearance(self) -> float:
        """The clearance, negative when the passage is blocked."""
        return -self.clearance if self.blocked else self.clearance


@dataclass(frozen=True, eq=False)
class Gate:
    """The tightest place of a passage and the pose that fits it best.

    Attributes:
        position: (n,) of the robot's base (in a `Layout`: of its main part's centre).
        rotation: (n, n), base to world (in a `Layout`: main part's frame to the passage's).
        travel: (n,), unit vector along the passage.
        width: of the robot at the passage.
        play: how much wider the passage is; negative when it is blocked.
    """

    position: Array
    rotation: Array
    travel: Array
    width: float
    play: float

    @property
    def configuration(self) -> Array:
        """The pose as a configuration (d,)."""
        return configuration(self.position, self.rotation)


@dataclass(frozen=True, eq=False)
class Layout:
    """A scene in the passage's frame, poses being those of the robot's main part.

    Attributes:
        shape: the robot.
        arena: that all stays in.
        passage: the bodies that form the passage.
        clutter: the other bodies.
        start, goal: position (n,) and rotation (n, n).
        gates: along the way.
        open_arena: the arena of the scene without the passage, if it forms the passage.
        turned: rotation (n, n) of the canonical scene.
    """

    shape: Shape
    arena: Ellipsoid
    passage: tuple[Ellipsoid, ...]
    clutter: tuple[Ellipsoid, ...]
    start: tuple[Array, Array]
    goal: tuple[Array, Array]
    gates: tuple[Gate, ...]
    open_arena: Ellipsoid | None = None
    turned: Array | None = None


@dataclass(frozen=True, eq=False)
class FamilyScene:
    """A scenario of a family and where its gates are, along the way from start to goal."""

    scenario: Scenario
    gates: tuple[Gate, ...]


class Placement:
    """The rigid motion of a whole scene: x -> rotation @ x + translation."""

    def __init__(self, layout: Layout, draws: Draws) -> None:
        n = layout.arena.dimension
        usual = np.eye(n) if layout.turned is None else layout.turned
        self.rotation = draws.rotation(usual)
        self.translation = draws.vector(np.zeros(n), FARTHEST_SHIFT)
        self._shape = layout.shape

    def body(self, body: Ellipsoid) -> Ellipsoid:
        """A body in the world frame."""
        return body.transform(self.rotation, self.translation)

    def pose(self, centre: Array, rotation: Array) -> tuple[Array, Array]:
        """The base's pose in the world frame of a main part's pose in the passage's."""
        base, turned = self._shape.base(centre, rotation)
        return self.rotation @ base + self.translation, self.rotation @ turned

    def gate(self, gate: Gate) -> Gate:
        """A gate in the world frame."""
        position, rotation = self.pose(gate.position, gate.rotation)
        return Gate(position, rotation, self.rotation @ gate.travel, gate.width, gate.play)


def place(
    layout: Layout, draws: Draws, name: str, description: str, *, without_passage: bool
) -> FamilyScene:
    """Move a scene into the world frame; `description` is filled up with where the gates are."""
    placement = Placement(layout, draws)
    arena, obstacles = layout.arena, (*layout.passage, *layout.clutter)
    if without_passage:
        arena, obstacles = layout.open_arena or arena, layout.clutter
    gates = tuple(placement.gate(gate) for gate in layout.gates)
    scenario = Scenario(
        name=name,
        world=_world(placement.body(arena), tuple(placement.body(body) for body in obstacles)),
        robot=layout.shape.robot(),
        start=configuration(*placement.pose(*layout.start)),
        goal=configuration(*placement.pose(*layout.goal)),
        description=description + _gates_text(gates),
    )
    return FamilyScene(scenario, gates)


def _world(arena: Ellipsoid, obstacles: tuple[Ellipsoid, ...]) -> World:
    """The world; the bounds are no walls, they only enclose the arena."""
    axes = np.eye(arena.dimension)
    margin = BOUNDS_MARGIN * float(arena.semi_axes.min())
    low, high = -arena.support(-axes) - margin, arena.support(axes) + margin
    return World(low, high, obstacles, (arena,))


def _gates_text(gates: tuple[Gate, ...]) -> str:
    text = "The base fits best at " if len(gates) == 1 else "The base fits best in turn at "
    return text + "; ".join(_gate_text(gate) for gate in gates) + "."


def _gate_text(gate: Gate) -> str:
    pose = gate.configuration
    if len(gate.position) == 2:
        turned = f"yaw_deg {np.degrees(pose[2]):.10g}"
    else:
        turned = f"quaternion {_numbers(pose[3:])}"
    return (
        f"position {_numbers(gate.position)}, {turned} (travelling along {_numbers(gate.travel)})"
    )


def _numbers(values: Array) -> str:
    return "[" + ", ".join(f"{value:.10g}" for value in values + 0.0) + "]"
