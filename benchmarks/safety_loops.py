"""Compiled loops that take an articulated robot's state check apart, to time it from inside."""

from __future__ import annotations

import numba

from ellipsoid_planning.kernels.kinematics import new_frames, place_robot
from ellipsoid_planning.kernels.layout import new_placed, part_rows
from ellipsoid_planning.kernels.self_collision import first_self_contact, new_body, new_order
from ellipsoid_planning.kernels.validity import part_is_free


@numba.njit(error_model="numpy")
def placed_only(scene, kinematics, rows, out):
    """Forward kinematics and the parts' places alone."""
    frames, placed = new_frames(kinematics), new_placed(scene)
    for k in range(rows.shape[0]):
        place_robot(part_rows(scene), kinematics, rows[k], frames, placed)
        out[k] = placed[0, 0] > 0.0


@numba.njit(error_model="numpy")
def environment(scene, kinematics, rows, out):
    """Forward kinematics, and all parts against the world, none left out."""
    frames, placed = new_frames(kinematics), new_placed(scene)
    for k in range(rows.shape[0]):
        place_robot(part_rows(scene), kinematics, rows[k], frames, placed)
        out[k] = True
        for i in range(placed.shape[0]):
            free = part_is_free(scene, placed, i)
            out[k] = out[k] and free


@numba.njit(error_model="numpy")
def self_collision(scene, kinematics, rows, out):
    """Forward kinematics, and the parts against each other."""
    frames, placed = new_frames(kinematics), new_placed(scene)
    order, body = new_order(kinematics), new_body()
    for k in range(rows.shape[0]):
        place_robot(part_rows(scene), kinematics, rows[k], frames, placed)
        out[k] = first_self_contact(scene, kinematics, frames, placed, order, body)[0] < 0
