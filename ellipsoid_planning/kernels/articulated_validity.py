"""Validity of configurations of articulated robots (thesis 6.4: the exact safety function).

The links stand where forward kinematics puts them; they are tested one by one, each against the
obstacles that a broad phase leaves, and the first unsafe one ends the test.
"""

from .compile import kernel
from .kinematics import new_frames, place_robot, within_limits
from .layout import new_placed, part_rows
from .self_collision import first_self_contact, new_body, new_order
from .validity import in_bounds, is_rotation, placed_clearance, placed_is_free


@kernel
def row_is_free(scene, kinematics, row, frames, placed, order, body):
    """Whether a configuration's row is proved free: limits, bounds, world and self-collision."""
    if not (
        in_bounds(scene, row[0], row[1], row[2])
        and is_rotation(row[3], row[4], row[5], row[6])
        and within_limits(kinematics, row)
    ):
        return False
    place_robot(part_rows(scene), kinematics, row, frames, placed)
    if not placed_is_free(scene, placed):
        return False
    return first_self_contact(scene, kinematics, frames, placed, order, body)[0] < 0


@kernel
def articulated_is_free(scene, kinematics, row):
    """:func:`row_is_free` of one row, with workspaces of its own."""
    return row_is_free(
        scene,
        kinematics,
        row,
        new_frames(kinematics),
        new_placed(scene),
        new_order(kinematics),
        new_body(),
    )


@kernel
def are_articulated_free(scene, kinematics, rows, out):
    """:func:`row_is_free` of every row (m, 7 + V)."""
    frames, placed = new_frames(kinematics), new_placed(scene)
    order, body = new_order(kinematics), new_body()
    for k in range(rows.shape[0]):
        out[k] = row_is_free(scene, kinematics, rows[k], frames, placed, order, body)


@kernel
def articulated_clearance(scene, kinematics, row):
    """Lower bound of the distance of all parts from obstacles and arena boundaries.

    As kernels.validity.clearance_of; the robot's parts against each other do not count.
    """
    frames, placed = new_frames(kinematics), new_placed(scene)
    place_robot(part_rows(scene), kinematics, row, frames, placed)
    return placed_clearance(scene, placed)
