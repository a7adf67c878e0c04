"""From articulated robots to the flat array that kernels read (see kernels.kinematics)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.packing import pack_parts
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.geometry.rows import body_row, part_row
from ellipsoid_planning.kernels import kinematics as layout
from ellipsoid_planning.kernels import layout as scene_layout
from ellipsoid_planning.robots.articulated import FIXED_BASE, ArticulatedRobot
from ellipsoid_planning.robots.joint import BALL, CONTINUOUS, FIXED, PRISMATIC, REVOLUTE, Joint
from ellipsoid_planning.robots.reach import joint_reaches, robot_reach
from ellipsoid_planning.robots.tree import joints_in_order
from ellipsoid_planning.world import World

Array = NDArray[np.float64]

_KINDS = {
    REVOLUTE: layout.REVOLUTE,
    CONTINUOUS: layout.CONTINUOUS,
    PRISMATIC: layout.PRISMATIC,
    BALL: layout.BALL,
}
# A joint, fixed or not, adds up to 10 units of rounding times what hangs on it: 3 for each of a
# row's entries, for each of two matrix products and a sum. ROUNDING is 32 units, and the scene's
# scale grows by this share for each joint.
_ROUNDING_PER_JOINT = 0.3


@dataclass(frozen=True, eq=False)
class _Placement:
    """Where a link's frame stands in its body's frame."""

    body: int
    rotation: Array
    position: Array


@dataclass(frozen=True, eq=False)
class Bodies:
    """The robot's parts in the frames of their bodies.

    Attributes:
        parts: (P, PART), see kernels.layout.
        owners: (P,), the body of each.
        shapes: (P, SHAPE), see kernels.kinematics.
        joints: (J, JOINT), see kernels.kinematics.
    """

    parts: Array
    owners: Array
    shapes: Array
    joints: Array


def _three(position: Array, rotation: Array) -> tuple[Array, Array]:
    n = len(position)
    at, turned = np.zeros(3), np.eye(3)
    at[:n], turned[:n, :n] = position, rotation
    return at, turned


def _aligned(joint: Joint) -> Array:
    """A rotation (3, 3) whose z axis is the joint's axis."""
    if joint.axis is None:
        return np.eye(3)
    axis = np.zeros(3)
    axis[: len(joint.axis)] = joint.axis
    # The coordinate axis that is farthest from the joint's makes a safe second one.
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    first = np.cross(helper, axis)
    first /= np.linalg.norm(first)
    return np.column_stack([first, np.cross(axis, first), axis])


def _joint_row(joint: Joint, parent: _Placement, value: int, align: Array, reach: float) -> Array:
    at, turned = _three(joint.position, joint.rotation)
    row = np.zeros(layout.JOINT)
    row[layout.JOINT_KIND] = _KINDS[joint.type]
    row[layout.JOINT_PARENT], row[layout.JOINT_VALUE] = parent.body, value
    row[layout.JOINT_LOW], row[layout.JOINT_HIGH] = joint.lower, joint.upper
    first = layout.JOINT_ROTATION
    row[first : first + 9] = (parent.rotation @ turned @ align).ravel()
    first = layout.JOINT_TRANSLATION
    row[first : first + 3] = parent.rotation @ at + parent.position
    row[layout.JOINT_REACH] = reach
    return row


def _tangents(kind: str) -> int:
    """How many numbers of a step a joint takes."""
    return 3 if kind == BALL else 1


def bodies_of(robot: ArticulatedRobot) -> Bodies:
    """The bodies of ``robot``: links that cannot move against each other are one."""
    reaches, weights = joint_reaches(robot), robot.joint_weights
    values = {name: part.start - robot.base_size + 7 for name, part in robot.joint_slices.items()}
    places = {robot.root: _Placement(0, np.eye(3), np.zeros(3))}
    rows: list[Array] = []
    tangent = 6
    for joint in joints_in_order(robot.joints, robot.root):
        parent = places[joint.parent]
        if joint.type == FIXED:
            at, turned = _three(joint.position, joint.rotation)
            places[joint.child] = _Placement(
                parent.body, parent.rotation @ turned, parent.rotation @ at + parent.position
            )
            continue
        align = _aligned(joint)
        row = _joint_row(joint, parent, values[joint.name], align, reaches[joint.name])
        row[layout.JOINT_WEIGHT] = weights[robot.joint_names.index(joint.name)]
        row[layout.JOINT_TANGENT] = tangent
        tangent += _tangents(joint.type)
        rows.append(row)
        places[joint.child] = _Placement(len(rows), align.T, np.zeros(3))
    stand = [places[link] for link in robot.part_links]
    return Bodies(
        np.array([_part_row(*pair) for pair in zip(robot.parts, stand, strict=True)]),
        np.array([float(place.body) for place in stand]),
        np.array([_shape_row(*pair) for pair in zip(robot.parts, stand, strict=True)]),
        np.array(rows).reshape(-1, layout.JOINT),
    )


def _part_row(part: Ellipsoid, place: _Placement) -> Array:
    row = part_row(part)
    centre, matrix = scene_layout.PART_CENTRE, scene_layout.PART_MATRIX
    at = place.rotation @ row[centre : centre + 3] + place.position
    row[centre : centre + 3] = at
    row[matrix : matrix + 9] = (place.rotation @ row[matrix : matrix + 9].reshape(3, 3)).ravel()
    row[scene_layout.PART_REACH] = float(np.linalg.norm(at)) + row[scene_layout.PART_RADIUS]
    return row


def _shape_row(part: Ellipsoid, place: _Placement) -> Array:
    row = body_row(part)
    first, second = scene_layout.BODY_MATRIX, scene_layout.BODY_INVERSE
    matrix = place.rotation @ row[first : first + 9].reshape(3, 3)
    inverse = row[second : second + 9].reshape(3, 3) @ place.rotation.T
    return np.concatenate([matrix.ravel(), inverse.ravel()])


def may_meet(
    robot: ArticulatedRobot, owners: Array, apart: frozenset[frozenset[str]] = frozenset()
) -> NDArray[np.bool_]:
    """Which parts (P, P) self-collision is about: not of one body, neighbours or ignored links.

    Nor of the pairs of links in ``apart``, which are known never to meet.
    """
    joined = {frozenset((joint.parent, joint.child)) for joint in robot.joints}
    joined |= robot.ignored | apart
    links = robot.part_links
    pairs = np.zeros((len(links), len(links)), dtype=np.bool_)
    for i, first in enumerate(links):
        for j, second in enumerate(links):
            pairs[i, j] = owners[i] != owners[j] and frozenset((first, second)) not in joined
    return pairs


def pack_kinematics(
    robot: ArticulatedRobot, bodies: Bodies, apart: frozenset[frozenset[str]] = frozenset()
) -> Array:
    """The kinematics as one flat array, read-only; links in ``apart`` are not tested."""
    header = np.zeros(layout.KINEMATICS_HEADER)
    header[layout.JOINT_COUNT] = len(bodies.joints)
    header[layout.PARTS] = len(bodies.parts)
    header[layout.WIDTH] = 7 + robot.configuration_size - robot.base_size
    header[layout.STEP_SIZE] = 6 + sum(_tangents(joint.type) for joint in robot.moving_joints)
    header[layout.BASE_MOVES] = robot.base != FIXED_BASE
    header[layout.ROBOT_REACH] = robot_reach(robot)
    pairs = may_meet(robot, bodies.owners, apart).astype(float)
    tables = (bodies.joints, bodies.owners, bodies.shapes, pairs)
    packed = np.concatenate([header, *(table.ravel() for table in tables)])
    packed.setflags(write=False)
    return packed


def rounding_share(robot: ArticulatedRobot) -> float:
    """By how much more kinematics round than a single rigid motion does; fixed joints count."""
    return 1.0 + _ROUNDING_PER_JOINT * len(robot.joints)


def pack_articulated_scene(
    world: World, robot: ArticulatedRobot, bodies: Bodies, clearance: float
) -> Array:
    """The scene as one flat array, read-only (kernels.layout); parts in their bodies' frames.

    Raises:
        GeometryError: if the clearance leaves nothing of an arena.
    """
    reach = robot_reach(robot)
    scene = pack_parts(world, bodies.parts, reach, clearance).copy()
    if robot.base == FIXED_BASE:
        at = np.zeros(3)
        at[: world.dimension] = robot.position
        for first in (scene_layout.LOW, scene_layout.HIGH):
            scene[first : first + 3] = at
        own = float(np.linalg.norm(at)) + reach
        scene[scene_layout.SCALE] = max(float(scene[scene_layout.SCALE]), own)
    scene[scene_layout.SCALE] *= rounding_share(robot)
    scene.setflags(write=False)
    return scene
