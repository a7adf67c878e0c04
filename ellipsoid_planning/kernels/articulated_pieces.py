"""Pieces of motions of articulated robots: the robot in the middle, and at both tangents.

See articulated_motion for what is proved of them.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .articulated_rates import (
    BOUND_ANGLE_ERROR,
    BOUND_PLACE_ERROR,
    BOUND_SPEED,
    BOUND_SPIN,
    BOUNDS,
    LOCAL,
    LOCAL_ACCELERATION,
    LOCAL_TURN,
    set_local_bounds,
)
from .compile import inlined, kernel
from .kinematics import (
    FRAME_SPIN,
    FRAME_TRANSLATION,
    FRAME_VELOCITY,
    WIDTH,
    body_frames,
    body_velocities,
    new_frames,
    owners_of,
    place_on_frames,
)
from .layout import (
    BODY,
    PART_REACH,
    PLACED,
    PLACED_CENTRE,
    PLACED_MATRIX,
    ROUNDING,
    SCALE,
    new_placed,
    part_rows,
)
from .linear import cross

_DEPTH = 48
_MOST_PIECES = 100000


class MotionWorkspace(NamedTuple):
    """Arrays that proofs of motions work in."""

    row: NDArray[np.float64]
    start: NDArray[np.float64]
    rates: NDArray[np.float64]
    all_rates: NDArray[np.float64]
    frames: NDArray[np.float64]
    bounds: NDArray[np.float64]
    local: NDArray[np.float64]
    placed: NDArray[np.float64]
    before: NDArray[np.float64]
    after: NDArray[np.float64]
    left: NDArray[np.bool_]
    stack: NDArray[np.float64]
    order: NDArray[np.int64]
    body: NDArray[np.float64]
    room: NDArray[np.float64]
    pieces: NDArray[np.int64]


@kernel
def new_motion_workspace(scene, kinematics):
    """A workspace for the robot of ``scene`` and ``kinematics``.

    ``pieces`` (2,) counts the pieces of one motion looked at, and says how many it may take.
    """
    width, parts = int(kinematics[WIDTH]), part_rows(scene).shape[0]
    frames = new_frames(kinematics)
    pieces = np.zeros(2, dtype=np.int64)
    pieces[1] = _MOST_PIECES
    return MotionWorkspace(
        np.empty(width),
        np.empty(width),
        np.empty(width),
        np.empty(width),
        frames,
        np.empty((frames.shape[0], BOUNDS)),
        np.empty((frames.shape[0], LOCAL)),
        new_placed(scene),
        np.empty((parts, PLACED)),
        np.empty((parts, PLACED)),
        np.empty((_DEPTH + 1, parts), dtype=np.bool_),
        np.empty((_DEPTH, 2)),
        np.arange(parts),
        np.empty((1, BODY)),
        np.empty(parts),
        pieces,
    )


@kernel
def _extrapolate(frames, b, placed, i, half, before, after):
    """Write placed part ``i`` of body ``b`` moved on along its tangent by ∓ ``half``."""
    f, c, m = frames[b], PLACED_CENTRE, PLACED_MATRIX
    sx, sy, sz = f[FRAME_SPIN], f[FRAME_SPIN + 1], f[FRAME_SPIN + 2]
    x, y, z = placed[i, c], placed[i, c + 1], placed[i, c + 2]
    t = FRAME_TRANSLATION
    dx, dy, dz = cross(sx, sy, sz, x - f[t], y - f[t + 1], z - f[t + 2])
    dx += f[FRAME_VELOCITY]
    dy += f[FRAME_VELOCITY + 1]
    dz += f[FRAME_VELOCITY + 2]
    before[i, c], before[i, c + 1], before[i, c + 2] = x - half * dx, y - half * dy, z - half * dz
    after[i, c], after[i, c + 1], after[i, c + 2] = x + half * dx, y + half * dy, z + half * dz
    for k in range(3):
        x, y, z = placed[i, m + k], placed[i, m + 3 + k], placed[i, m + 6 + k]
        dx, dy, dz = cross(sx, sy, sz, x, y, z)
        before[i, m + k], after[i, m + k] = x - half * dx, x + half * dx
        before[i, m + 3 + k], after[i, m + 3 + k] = y - half * dy, y + half * dy
        before[i, m + 6 + k], after[i, m + 6 + k] = z - half * dz, z + half * dz


@inlined
def place_piece(scene, kinematics, work, level, half):
    """Place the robot in the middle of a piece, and the parts that are left at both tangents.

    ``work.room`` receives what their points may leave their tangents by: by their acceleration, by
    the error of the row that the tangents start from, and by rounding. The last has two parts: s
    and the tangents' ends are rounded by less than 2⁻⁵² of the way, coordinates by some 30
    roundings (see layout); the scale has a share for each joint, since kinematics round at each.
    """
    parts, owners = part_rows(scene), owners_of(kinematics)
    body_frames(kinematics, work.row, work.frames)
    body_velocities(kinematics, work.rates, work.frames)
    place_on_frames(parts, owners, work.frames, work.placed)
    set_local_bounds(
        scene, kinematics, work.start, work.rates, work.frames, half, work.bounds, work.local
    )
    for i in range(parts.shape[0]):
        if work.left[level, i]:
            b = int(owners[i])
            reach = parts[i, PART_REACH]
            bend = work.local[b, LOCAL_ACCELERATION] + work.local[b, LOCAL_TURN] * reach
            speed = work.bounds[b, BOUND_SPEED] + abs(work.bounds[b, BOUND_SPIN]) * reach
            error = work.bounds[b, BOUND_PLACE_ERROR] + work.bounds[b, BOUND_ANGLE_ERROR] * reach
            work.room[i] = (
                0.5 * bend * half * half + error + 2.0 * ROUNDING * (scene[SCALE] + speed)
            )
            _extrapolate(work.frames, b, work.placed, i, half, work.before, work.after)
