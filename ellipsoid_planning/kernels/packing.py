"""Which arrangements of a molecule in a crystal keep all its copies apart.

The crystal's group is m operations x ↦ Q_g x + t_g (Cartesian) times the lattice B Z³. A part i of
the molecule and a part j of its copy under (g, v) are far apart unless the lattice vector v brings
their centres within the sum of their radii; |(B⁻¹x)_k| ≤ |x| |row k of B⁻¹| bounds v exactly, so
every copy that can touch is looked at and no other. Two parts are apart only where a separating
direction is proved, see `separation`.

Bodies are rows of ``BODY`` numbers (centre, A, inverse of A, radius; see layout), their smallest
semi-axis stands at ``INSCRIBED``. Operations are frames: Q row-major, t; what
is posed in one is its image.
"""

import math

import numpy as np

from .compile import kernel, released
from .layout import (
    BODY,
    BODY_CENTRE,
    BODY_INVERSE,
    BODY_MATRIX,
    BODY_RADIUS,
    PLACED,
    PLACED_CENTRE,
    PLACED_MATRIX,
    ROUNDING,
)
from .linear import norm
from .molecule import FRAME, place_frames, pose_part
from .separation import CONVERGE, DECIDE, separation

INSCRIBED = BODY_RADIUS + 1


@kernel
def apart(bodies, i, copy, j, required):
    """Whether body i and body ``copy[0]`` (of the shape of j) are proved ``required`` apart.

    With a negative ``required`` they may overlap by that depth: some direction is proved in which
    they need not be moved farther than that to come apart.
    """
    x = copy[0, PLACED_CENTRE] - bodies[i, BODY_CENTRE]
    y = copy[0, PLACED_CENTRE + 1] - bodies[i, BODY_CENTRE + 1]
    z = copy[0, PLACED_CENTRE + 2] - bodies[i, BODY_CENTRE + 2]
    distance = math.sqrt(x * x + y * y + z * z)
    if distance <= bodies[i, INSCRIBED] + bodies[j, INSCRIBED] + required:
        return False
    reach = bodies[i, BODY_RADIUS] + bodies[j, BODY_RADIUS] + required
    if distance > reach * (1.0 + ROUNDING):
        return True
    lam = bodies[i, BODY_RADIUS] / (bodies[i, BODY_RADIUS] + bodies[j, BODY_RADIUS])
    # Where they may overlap by so much, the best direction counts even though they meet.
    mode = DECIDE if required >= 0.0 else CONVERGE
    value, _, _, _, _ = separation(bodies, i, copy, 0, lam, required, mode)
    return value > required


@kernel
def copies_apart(bodies, i, j, same, operations, basis, inverse, reaches, required, copy):
    """Whether body i is apart from every copy of body j but the molecule's own.

    Args:
        bodies: (b, BODY).
        i: a row of ``bodies``.
        j: another one, or the same.
        same: whether they are the same part; then half of the translations suffices.
        operations: (m, FRAME), the identity first.
        basis: (3, 3), B.
        inverse: (3, 3), its inverse.
        reaches: (3,), the lengths of the rows of ``inverse``.
        required: the distance to be proved, see `apart`.
        copy: (1, PLACED), scratch.
    """
    reach = bodies[i, BODY_RADIUS] + bodies[j, BODY_RADIUS] + required
    slack = reach * (1.0 + ROUNDING)
    for g in range(operations.shape[0]):
        pose_part(operations, g, bodies, j, copy, 0)  # no lattice vector yet
        x = copy[0, PLACED_CENTRE] - bodies[i, BODY_CENTRE]
        y = copy[0, PLACED_CENTRE + 1] - bodies[i, BODY_CENTRE + 1]
        z = copy[0, PLACED_CENTRE + 2] - bodies[i, BODY_CENTRE + 2]
        d0 = inverse[0, 0] * x + inverse[0, 1] * y + inverse[0, 2] * z
        d1 = inverse[1, 0] * x + inverse[1, 1] * y + inverse[1, 2] * z
        d2 = inverse[2, 0] * x + inverse[2, 1] * y + inverse[2, 2] * z
        # Fractional coordinates are rounded; widen by far more than that (far from the cell by
        # what is required beyond contact, see arrangements_free).
        w0, w1, w2 = (
            slack * reaches[0] + 1e-9,
            slack * reaches[1] + 1e-9,
            slack * reaches[2] + 1e-9,
        )
        first = math.ceil(-w0 - d0)
        if same and g == 0:
            first = max(first, 0)
        for v0 in range(first, math.floor(w0 - d0) + 1):
            for v1 in range(math.ceil(-w1 - d1), math.floor(w1 - d1) + 1):
                for v2 in range(math.ceil(-w2 - d2), math.floor(w2 - d2) + 1):
                    if g == 0 and v0 == 0 and v1 == 0 and (v2 == 0 or (same and v2 < 0)):
                        continue
                    if g == 0 and same and v0 == 0 and v1 < 0:
                        continue
                    sx = basis[0, 0] * v0 + basis[0, 1] * v1 + basis[0, 2] * v2
                    sy = basis[1, 0] * v0 + basis[1, 1] * v1 + basis[1, 2] * v2
                    sz = basis[2, 0] * v0 + basis[2, 1] * v1 + basis[2, 2] * v2
                    px, py, pz = x + sx, y + sy, z + sz
                    if px * px + py * py + pz * pz > slack * slack:
                        continue
                    copy[0, PLACED_CENTRE] = bodies[i, BODY_CENTRE] + px
                    copy[0, PLACED_CENTRE + 1] = bodies[i, BODY_CENTRE + 1] + py
                    copy[0, PLACED_CENTRE + 2] = bodies[i, BODY_CENTRE + 2] + pz
                    if not apart(bodies, i, copy, j, required):
                        return False
    return True


@kernel
def own_apart(bodies, i, j, required, copy):
    """Whether two parts i and j of one molecule are apart."""
    for row in range(3):
        copy[0, PLACED_CENTRE + row] = bodies[j, BODY_CENTRE + row]
    for m in range(9):
        copy[0, PLACED_MATRIX + m] = bodies[j, BODY_MATRIX + m]
    return apart(bodies, i, copy, j, required)


@kernel
def pose_body(frame, k, shapes, p, bodies, i):
    """Fill row i of ``bodies`` with ``shapes[p]`` (BODY) in the frame ``frame[k]`` (FRAME)."""
    pose_part(frame, k, shapes, p, bodies, i)
    for row in range(3):
        a, b, c = frame[k, 3 * row], frame[k, 3 * row + 1], frame[k, 3 * row + 2]
        for column in range(3):
            # The inverse of R A is A⁻¹ Rᵀ.
            m = BODY_INVERSE + 3 * column
            bodies[i, m + row] = a * shapes[p, m] + b * shapes[p, m + 1] + c * shapes[p, m + 2]
    bodies[i, BODY_RADIUS] = shapes[p, BODY_RADIUS]
    bodies[i, INSCRIBED] = shapes[p, INSCRIBED]


@released
def arrangements_free(
    kinds,
    parents,
    origins,
    axes,
    part_frames,
    shapes,
    pairs,
    crystal,
    required,
    lever,
    loss,
    configurations,
    free,
):
    """Write to ``free`` (m,) whether each arrangement (m, K) keeps all copies apart.

    ``required`` covers rounding for parts within ``lever`` of the origin; for each length that one
    is farther out, coordinates and the lattice vectors that take it back lose ``loss`` more.

    The molecule's arrays are as in kernels.molecule, ``shapes`` (P, BODY) its parts in their
    frames; ``pairs`` (P, P) says at [i, j], i < j, which parts of one molecule must keep apart.
    """
    count = part_frames.size
    frames = np.empty((kinds.size, FRAME))
    bodies = np.empty((count, BODY))
    copy = np.empty((1, PLACED))
    operations, basis, inverse, reaches = crystal
    for index in range(configurations.shape[0]):
        place_frames(kinds, parents, origins, axes, configurations[index], frames)
        for p in range(count):
            if part_frames[p] < 0:
                bodies[p] = shapes[p]
            else:
                pose_body(frames, part_frames[p], shapes, p, bodies, p)
        far = lever
        for p in range(count):
            far = max(far, norm(bodies[p, 0], bodies[p, 1], bodies[p, 2]))
        wanted = required + loss * (far - lever)
        free[index] = True
        for j in range(count):
            for i in range(j + 1):
                if not free[index]:
                    break
                own = not pairs[i, j] or own_apart(bodies, i, j, wanted, copy)
                if not own or not copies_apart(
                    bodies, i, j, i == j, operations, basis, inverse, reaches, wanted, copy
                ):
                    free[index] = False


@released
def base_frames(kinds, parents, origins, axes, poses, frames):
    """Fill ``frames`` (m, FRAME) with the base's frame for its coordinates ``poses`` (m, base)."""
    chain = np.empty((kinds.size, FRAME))
    for index in range(poses.shape[0]):
        place_frames(kinds, parents, origins, axes, poses[index], chain)
        frames[index] = chain[kinds.size - 1]
