"""Three-dimensional vectors, matrices and quaternions as scalars."""

import math

from .compile import kernel


@kernel
def norm(x, y, z):
    """Euclidean norm; no overflow guard is needed at the sizes of scenes."""
    return math.sqrt(x * x + y * y + z * z)


@kernel
def transposed_times(rows, i, first, x, y, z):
    """Aᵀ v for the row-major matrix A that starts at ``rows[i, first]``."""
    return (
        rows[i, first] * x + rows[i, first + 3] * y + rows[i, first + 6] * z,
        rows[i, first + 1] * x + rows[i, first + 4] * y + rows[i, first + 7] * z,
        rows[i, first + 2] * x + rows[i, first + 5] * y + rows[i, first + 8] * z,
    )


@kernel
def times(rows, i, first, x, y, z):
    """A v for the row-major matrix A that starts at ``rows[i, first]``."""
    return (
        rows[i, first] * x + rows[i, first + 1] * y + rows[i, first + 2] * z,
        rows[i, first + 3] * x + rows[i, first + 4] * y + rows[i, first + 5] * z,
        rows[i, first + 6] * x + rows[i, first + 7] * y + rows[i, first + 8] * z,
    )


@kernel
def gram(a, b, c, d, e, f, g, h, k):
    """A Aᵀ of the row-major matrix A as (xx, xy, xz, yy, yz, zz)."""
    return (
        a * a + b * b + c * c,
        a * d + b * e + c * f,
        a * g + b * h + c * k,
        d * d + e * e + f * f,
        d * g + e * h + f * k,
        g * g + h * h + k * k,
    )


@kernel
def shape_matrix(rows, i, first):
    """Σ = A Aᵀ of the row-major matrix A that starts at ``rows[i, first]``, as :func:`gram`."""
    return gram(
        rows[i, first],
        rows[i, first + 1],
        rows[i, first + 2],
        rows[i, first + 3],
        rows[i, first + 4],
        rows[i, first + 5],
        rows[i, first + 6],
        rows[i, first + 7],
        rows[i, first + 8],
    )


@kernel
def rotation_matrix(qx, qy, qz, qw):
    """The nine entries, row-major, of the rotation of a quaternion (x, y, z, w) of any length."""
    s = 2.0 / (qx * qx + qy * qy + qz * qz + qw * qw)
    return (
        1.0 - s * (qy * qy + qz * qz),
        s * (qx * qy - qz * qw),
        s * (qx * qz + qy * qw),
        s * (qx * qy + qz * qw),
        1.0 - s * (qx * qx + qz * qz),
        s * (qy * qz - qx * qw),
        s * (qx * qz - qy * qw),
        s * (qy * qz + qx * qw),
        1.0 - s * (qx * qx + qy * qy),
    )


@kernel
def product(px, py, pz, pw, qx, qy, qz, qw):
    """The quaternion product p q (first q, then p)."""
    return (
        pw * qx + px * qw + py * qz - pz * qy,
        pw * qy - px * qz + py * qw + pz * qx,
        pw * qz + px * qy - py * qx + pz * qw,
        pw * qw - px * qx - py * qy - pz * qz,
    )


@kernel
def cross(ax, ay, az, bx, by, bz):
    """The vector product a × b."""
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@kernel
def solve_positive(xx, xy, xz, yy, yz, zz, u, v, w):
    """M⁻¹ (u, v, w) of a positive definite M by LDLᵀ: (x, y, z, quadratic form, positive).

    The quadratic form (u,v,w)ᵀM⁻¹(u,v,w) is a sum of positive terms and backward stable, so it is
    exact for a matrix within a few roundings of M. ``positive`` is False if a pivot is not.
    """
    if not xx > 0.0:
        return 0.0, 0.0, 0.0, 0.0, False
    l1, l2 = xy / xx, xz / xx
    second = yy - l1 * xy
    if not second > 0.0:
        return 0.0, 0.0, 0.0, 0.0, False
    m = yz - l1 * xz
    l3 = m / second
    third = zz - l2 * xz - l3 * m
    if not third > 0.0:
        return 0.0, 0.0, 0.0, 0.0, False
    b = v - l1 * u
    c = w - l2 * u - l3 * b
    z = c / third
    y = b / second - l3 * z
    x = u / xx - l1 * y - l2 * z
    return x, y, z, u * u / xx + b * b / second + c * c / third, True
