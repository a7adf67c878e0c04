"""The shapes of a robot's bodies, each in a frame of its own, so that identical ones are found.

A *body* is what forward kinematics moves as one: a link with what is fixed to it. Its shape is told
in a frame at its middle, along the axes of its first part, or with z along its axis of revolution;
two bodies whose parts, in order, are the same in such frames share a table.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.kernels import layout
from ellipsoid_planning.safety.orientation_grid import DIRECTION, HEADING, NOTHING, QUATERNION

Array = NDArray[np.float64]

SAME = 1e-9
"""Numbers that differ by less than this share of a link's size are the same."""
_SAME_SQUARE = 1e-13
"""The like for squares of semi-axes."""
_SLACK = 1e-6
"""Far more, as a share of a link's size, than what is the same differs by: √3e-13 + 3e-9."""
_MIDDLE_STEPS = 400


@dataclass(frozen=True, eq=False)
class Shape:
    """The parts of a body in their own frame.

    Attributes:
        centres: (k, 3).
        matrices: (k, 3, 3), A of each part: the part is its centre + A times the unit ball.
        vector: how an orientation is looked up, see safety.orientation_grid.
        faces: of its grid.
    """

    centres: Array
    matrices: Array
    vector: int
    faces: int

    @property
    def radius(self) -> float:
        """No point of the body is farther than this from the middle."""
        away = np.linalg.norm(self.centres, axis=1)
        return float((away + _axes(self.matrices).max(axis=1)).max())

    @property
    def lever(self) -> float:
        """How far a turn by one radian takes the body out of itself, at most.

        Turned by an angle φ, the body lies within ``lever`` · φ of where it was: the support
        function of an ellipsoid about its centre changes by at most its largest less its
        smallest semi-axis for each radian.
        """
        axes = _axes(self.matrices)
        least = axes[:, :2].min(axis=1) if self.is_planar else axes.min(axis=1)
        own = axes.max(axis=1) - least
        return float((np.linalg.norm(self.centres, axis=1) + own).max())

    @property
    def is_planar(self) -> bool:
        """Whether the parts are flat, in z = 0."""
        return not np.any(self.matrices[:, 2])

    def part_rows(self) -> Array:
        """The parts as rows (k, PART) of kernels.layout."""
        rows = np.zeros((len(self.centres), layout.PART))
        rows[:, layout.PART_CENTRE : layout.PART_CENTRE + 3] = self.centres
        rows[:, layout.PART_MATRIX : layout.PART_MATRIX + 9] = self.matrices.reshape(-1, 9)
        rows[:, layout.PART_RADIUS] = _axes(self.matrices).max(axis=1)
        away = np.linalg.norm(self.centres, axis=1)
        rows[:, layout.PART_REACH] = away + rows[:, layout.PART_RADIUS]
        return rows

    def numbers(self) -> Array:
        """Everything that tells shapes from each other."""
        kind = np.array([self.vector, self.faces], dtype=float)
        return np.concatenate([kind, self.centres.ravel(), self.matrices.ravel()])

    def is_same(self, other: Shape) -> bool:
        """Whether the two may share a table; `slack` covers what they differ by."""
        own, others = self.numbers(), other.numbers()
        return own.shape == others.shape and bool(
            np.all(own[:2] == others[:2]) and np.abs(own - others).max() <= SAME * self.radius
        )

    @property
    def slack(self) -> float:
        """Bodies that share this shape's table lie within this distance of it."""
        return _SLACK * self.radius


@dataclass(frozen=True, eq=False)
class PlacedShape:
    """A shape, and where its frame stands in the body's.

    Attributes:
        shape: the body's shape.
        middle: (3,), the frame's origin.
        turn: (3, 3), from the shape's frame to the body's.
    """

    shape: Shape
    middle: Array
    turn: Array


def shape_of(rows: Array, planar: bool, turns: bool) -> PlacedShape:
    """The shape of a body from the rows (k, PART) of its parts.

    They are given as they are turned at a neutral configuration, where planar parts are flat.
    ``turns`` tells whether the body's orientation can change at all; if not, the shape's frame is
    not turned.
    """
    centres = rows[:, layout.PART_CENTRE : layout.PART_CENTRE + 3]
    matrices = rows[:, layout.PART_MATRIX : layout.PART_MATRIX + 9].reshape(-1, 3, 3)
    middle = centres.mean(axis=0)
    if not _is_symmetric(Shape(centres - middle, matrices, NOTHING, 1)):
        middle = _middle(centres, _axes(matrices), planar)
    if not turns:
        shape = Shape(centres - middle, matrices, NOTHING, 1)
        return PlacedShape(shape, middle, np.eye(3))
    first = _frame(matrices[0], planar)
    own = Shape((centres - middle) @ first, first.T @ matrices, HEADING, 4)
    if planar:
        return PlacedShape(_planar(own), middle, first)
    shape, turn = _spatial(own)
    return PlacedShape(shape, middle, first @ turn)


def _axes(matrices: Array) -> Array:
    """Semi-axes (k, 3) of matrices (k, 3, 3) with orthogonal columns."""
    return np.linalg.norm(matrices, axis=1)


def _middle(centres: Array, axes: Array, planar: bool) -> Array:
    """The point (3,) for which a shape's lever is (nearly) smallest.

    Badoiu and Clarkson (2003): go towards the farthest, less far every time. Among equals the
    first part is the farthest, so that rounding decides nothing.
    """
    own = axes.max(axis=1) - (axes[:, :2] if planar else axes).min(axis=1)
    middle = centres[0].copy()
    for step in range(_MIDDLE_STEPS if len(centres) > 1 else 0):
        levers = np.linalg.norm(centres - middle, axis=1) + own
        far = int(np.argmax(levers >= levers.max() * (1.0 - SAME)))
        away = centres[far] - middle
        distance = float(np.linalg.norm(away))
        if distance > 0.0:
            # The farthest point of the ball of that part.
            middle = middle + away * ((1.0 + own[far] / distance) / (step + 2.0))
    return middle


def _frame(matrix: Array, planar: bool) -> Array:
    """A rotation (3, 3) whose columns are the part's axes, the longest first."""
    axes = _axes(matrix[None])[0]
    if planar:
        x = matrix[:, int(axes[1] > axes[0] * (1.0 + SAME))]
        x = x / np.linalg.norm(x)
        return np.array([[x[0], -x[1], 0.0], [x[1], x[0], 0.0], [0.0, 0.0, 1.0]])
    # In the part's own order where axes are equal but for rounding.
    order = sorted(range(3), key=lambda k: -round(float(axes[k] / axes.max()) / SAME))
    columns = matrix[:, order] / axes[order]
    columns[:, 2] *= np.sign(np.linalg.det(columns))
    return columns


def _planar(own: Shape) -> Shape:
    if _is_ball(own):
        return _ball(own)
    return Shape(own.centres, own.matrices, HEADING, 2 if _is_symmetric(own) else 4)


def _is_ball(own: Shape) -> bool:
    return own.lever <= SAME * own.radius


def _ball(own: Shape) -> Shape:
    """The same balls around the middle, along the coordinate axes."""
    unit = np.diag([1.0, 1.0, 0.0 if own.is_planar else 1.0])
    matrices = _axes(own.matrices).max(axis=1)[:, None, None] * unit
    return Shape(np.zeros_like(own.centres), matrices, NOTHING, 1)


def _is_symmetric(own: Shape) -> bool:
    """Whether every part has its mirror image in the middle."""
    squares = own.matrices @ own.matrices.transpose(0, 2, 1)
    size = own.radius
    for centre, square in zip(own.centres, squares, strict=True):
        opposite = np.abs(own.centres + centre).max(axis=1) <= SAME * size
        alike = np.abs(squares - square).max(axis=(1, 2)) <= _SAME_SQUARE * size**2
        if not np.any(opposite & alike):
            return False
    return True


def _spatial(own: Shape) -> tuple[Shape, Array]:
    """The shape and the rotation from its frame to that of ``own``."""
    if _is_ball(own):
        return _ball(own), np.eye(3)
    for axis in (0, 2, 1):
        if _is_revolved(own, axis):
            turn = np.roll(np.eye(3), 2 - axis, axis=1)  # z goes to that axis
            faces = 3 if _is_symmetric(own) else 6
            return _revolved(own, axis, faces), turn
    # A single part looks the same after half-turns about its axes.
    faces = 1 if len(own.centres) == 1 else 4
    return Shape(own.centres, own.matrices, QUATERNION, faces), np.eye(3)


def _is_revolved(own: Shape, axis: int) -> bool:
    """Whether every part is a body of revolution about this coordinate axis."""
    others, size = [k for k in range(3) if k != axis], own.radius
    squares = own.matrices @ own.matrices.transpose(0, 2, 1)
    mixed = squares - squares * np.eye(3)
    round_ = np.abs(squares[:, others[0], others[0]] - squares[:, others[1], others[1]])
    return bool(
        np.abs(own.centres[:, others]).max() <= SAME * size
        and np.abs(mixed).max() <= _SAME_SQUARE * size**2
        and round_.max() <= _SAME_SQUARE * size**2
    )


def _revolved(own: Shape, axis: int, faces: int) -> Shape:
    """The same parts about the z axis, exactly round and on it."""
    others = [k for k in range(3) if k != axis]
    squares = np.diagonal(own.matrices @ own.matrices.transpose(0, 2, 1), axis1=1, axis2=2)
    centres, matrices = np.zeros_like(own.centres), np.zeros_like(own.matrices)
    centres[:, 2] = own.centres[:, axis]
    matrices[:, 0, 0] = matrices[:, 1, 1] = np.sqrt(squares[:, others].max(axis=1))
    matrices[:, 2, 2] = np.sqrt(squares[:, axis])
    return Shape(centres, matrices, DIRECTION, faces)
