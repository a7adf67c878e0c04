"""Placing the robot's parts: rotated matrices, centres and box half-extents."""

import math

from .compile import kernel
from .layout import (
    PART_CENTRE,
    PART_MATRIX,
    PLACED_CENTRE,
    PLACED_EXTENT,
    PLACED_MATRIX,
    part_rows,
)
from .linear import rotation_matrix


@kernel
def place_part(parts, i, x, y, z, rotation, placed, row):
    """Write part ``i``, moved by (rotation, (x, y, z)), to ``placed[row]``."""
    r00, r01, r02, r10, r11, r12, r20, r21, r22 = rotation
    tx, ty, tz = parts[i, PART_CENTRE], parts[i, PART_CENTRE + 1], parts[i, PART_CENTRE + 2]
    placed[row, PLACED_CENTRE] = x + (r00 * tx + r01 * ty + r02 * tz)
    placed[row, PLACED_CENTRE + 1] = y + (r10 * tx + r11 * ty + r12 * tz)
    placed[row, PLACED_CENTRE + 2] = z + (r20 * tx + r21 * ty + r22 * tz)
    for k in range(3):
        a = parts[i, PART_MATRIX + k]
        b = parts[i, PART_MATRIX + 3 + k]
        c = parts[i, PART_MATRIX + 6 + k]
        placed[row, PLACED_MATRIX + k] = r00 * a + r01 * b + r02 * c
        placed[row, PLACED_MATRIX + 3 + k] = r10 * a + r11 * b + r12 * c
        placed[row, PLACED_MATRIX + 6 + k] = r20 * a + r21 * b + r22 * c
    for k in range(3):
        a = placed[row, PLACED_MATRIX + 3 * k]
        b = placed[row, PLACED_MATRIX + 3 * k + 1]
        c = placed[row, PLACED_MATRIX + 3 * k + 2]
        placed[row, PLACED_EXTENT + k] = math.sqrt(a * a + b * b + c * c)


@kernel
def place(scene, x, y, z, qx, qy, qz, qw, placed):
    """Write all parts of the robot at base position (x, y, z), quaternion q, to ``placed``."""
    parts = part_rows(scene)
    rotation = rotation_matrix(qx, qy, qz, qw)
    for i in range(parts.shape[0]):
        place_part(parts, i, x, y, z, rotation, placed, i)
