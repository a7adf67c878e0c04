"""How much the Gaussian mixtures of a crystal's parts overlap, and the gradient of that.

The integral over space of the product of two Gaussians N(x; μ₁, Σ₁) N(x; μ₂, Σ₂) is
N(μ₁ − μ₂; 0, Σ₁ + Σ₂) (thesis, equation 3.16 with its middle factor inverted). A part of matrix A
(A = R diag(a)) is a mixture of Gaussians of covariance A Aᵀ / b_k and masses c_k. A part i of the
molecule meets a part j of its copy under the operation x ↦ Q_g x + t_g and the lattice vector v;
every v that brings the two centres within ``tails[i, j]``, and has no component beyond ``span``, is
looked at. Forces are gradients here,
not their negatives; a turn of the part about ω changes Σ by [ω]Σ − Σ[ω].

Symmetric matrices are rows of 6 numbers: xx, xy, xz, yy, yz, zz. Planar molecules lie in z = 0, and
there the third row and column of Σ₁ + Σ₂ are those of the identity: all formulas then are those of
the plane.
"""

import math

import numpy as np

from .compile import kernel, released
from .molecule import FRAME, POSED, SHIFT, motion_axes, place_frames, pose_parts

SYMMETRIC = 6
# A row of a pair's table: factor, precision (6), sum of f, sum of f u uᵀ (6), 1/b_k, 1/b_l.
FACTOR, PRECISION, OVERLAP, OUTER, FIRST, SECOND = 0, 1, 7, 8, 14, 15
TERM = 16
# exp of minus this is near the end of double precision's range.
NOTHING = 700.0


@kernel
def covariance(matrix, out, i):
    """Fill row i of ``out`` with A Aᵀ of ``matrix`` (A, row-major)."""
    m = 0
    for row in range(3):
        for column in range(row, 3):
            out[i, m] = (
                matrix[3 * row] * matrix[3 * column]
                + matrix[3 * row + 1] * matrix[3 * column + 1]
                + matrix[3 * row + 2] * matrix[3 * column + 2]
            )
            m += 1


@kernel
def turned_part(operations, g, posed, j, copy):
    """Fill ``copy`` (POSED) with part j under operation g, no lattice vector added."""
    for row in range(3):
        a, b, c = operations[g, 3 * row], operations[g, 3 * row + 1], operations[g, 3 * row + 2]
        copy[row] = a * posed[j, 0] + b * posed[j, 1] + c * posed[j, 2] + operations[g, 9 + row]
        for column in range(3):
            m = 3 + column
            copy[m + 3 * row] = a * posed[j, m] + b * posed[j, m + 3] + c * posed[j, m + 6]


@kernel
def set_term(first, i, second, b, c, mass, planar, terms, row):
    """Fill a row of ``terms`` for the covariances ``first[i] / b`` and ``second[0] / c``."""
    xx = first[i, 0] / b + second[0, 0] / c
    xy = first[i, 1] / b + second[0, 1] / c
    xz = first[i, 2] / b + second[0, 2] / c
    yy = first[i, 3] / b + second[0, 3] / c
    yz = first[i, 4] / b + second[0, 4] / c
    zz = first[i, 5] / b + second[0, 5] / c
    if planar:
        xz, yz, zz = 0.0, 0.0, 1.0
    p0, p1, p2 = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    determinant = xx * p0 + xy * p1 + xz * p2
    terms[row, PRECISION] = p0 / determinant
    terms[row, PRECISION + 1] = p1 / determinant
    terms[row, PRECISION + 2] = p2 / determinant
    terms[row, PRECISION + 3] = (xx * zz - xz * xz) / determinant
    terms[row, PRECISION + 4] = (xy * xz - xx * yz) / determinant
    terms[row, PRECISION + 5] = (xx * yy - xy * xy) / determinant
    circles = 2.0 * math.pi if planar else math.sqrt(2.0 * math.pi) ** 3
    terms[row, FACTOR] = mass / (circles * math.sqrt(determinant))
    for m in range(OVERLAP, OVERLAP + 1 + SYMMETRIC):
        terms[row, m] = 0.0
    terms[row, FIRST], terms[row, SECOND] = 1.0 / b, 1.0 / c


@kernel
def add_overlap(terms, x, y, z, weight, force):
    """Add the overlap of two parts whose centres differ by (x, y, z) to ``terms``, ``force``."""
    for row in range(terms.shape[0]):
        u = terms[row, 1] * x + terms[row, 2] * y + terms[row, 3] * z
        v = terms[row, 2] * x + terms[row, 4] * y + terms[row, 5] * z
        w = terms[row, 3] * x + terms[row, 5] * y + terms[row, 6] * z
        exponent = 0.5 * (x * u + y * v + z * w)
        if exponent > NOTHING:
            continue
        f = weight * terms[row, FACTOR] * math.exp(-exponent)
        terms[row, OVERLAP] += f
        force[0] += f * u
        force[1] += f * v
        force[2] += f * w
        terms[row, OUTER] += f * u * u
        terms[row, OUTER + 1] += f * u * v
        terms[row, OUTER + 2] += f * u * w
        terms[row, OUTER + 3] += f * v * v
        terms[row, OUTER + 4] += f * v * w
        terms[row, OUTER + 5] += f * w * w


@kernel
def add_copies(i, posed, copy, same, identity, own, reach, span, crystal, planar, terms, force):
    """Add the overlaps of part i with all lattice copies of ``copy`` within ``reach``.

    ``same`` says that the copy is of part i itself, ``identity`` that no operation moved it: then
    one of each two opposite lattice vectors counts twice. ``own`` keeps the pair of no lattice
    vector in, unless it is the part itself: that overlap never changes.
    """
    _, basis, inverse, reaches = crystal
    x, y, z = copy[0] - posed[i, 0], copy[1] - posed[i, 1], copy[2] - posed[i, 2]
    half = same and identity
    d0 = inverse[0, 0] * x + inverse[0, 1] * y + inverse[0, 2] * z
    d1 = inverse[1, 0] * x + inverse[1, 1] * y + inverse[1, 2] * z
    d2 = inverse[2, 0] * x + inverse[2, 1] * y + inverse[2, 2] * z
    w0, w1, w2 = reach * reaches[0] + 1e-9, reach * reaches[1] + 1e-9, reach * reaches[2] + 1e-9
    low0, high0 = max(math.ceil(-w0 - d0), -span), min(math.floor(w0 - d0), span)
    low1, high1 = max(math.ceil(-w1 - d1), -span), min(math.floor(w1 - d1), span)
    low2, high2 = max(math.ceil(-w2 - d2), -span), min(math.floor(w2 - d2), span)
    if planar:
        low2, high2 = 0, 0
    for v0 in range(0 if half else low0, high0 + 1):
        for v1 in range(low1, high1 + 1):
            if half and v0 == 0 and v1 < 0:
                continue
            for v2 in range(low2, high2 + 1):
                none = v0 == 0 and v1 == 0 and v2 == 0
                if (half and v0 == 0 and v1 == 0 and v2 < 0) or (
                    none and identity and (same or not own)
                ):
                    continue
                px = x + basis[0, 0] * v0 + basis[0, 1] * v1 + basis[0, 2] * v2
                py = y + basis[1, 0] * v0 + basis[1, 1] * v1 + basis[1, 2] * v2
                pz = z + basis[2, 0] * v0 + basis[2, 1] * v1 + basis[2, 2] * v2
                if px * px + py * py + pz * pz > reach * reach:
                    continue
                weight = 1.0 if none or not half else 2.0
                add_overlap(terms, px, py, pz, weight, force)


@kernel
def give_back(terms, column, weight, operations, g, turned, force, wrenches, p):
    """Add a pair's gradient to part p: to rows of force (3) and of ∂/∂Σ (6).

    ``column`` is ``FIRST`` or ``SECOND``. With ``turned``, what acts on the copy is turned back by
    Q_gᵀ.
    """
    s = np.zeros((3, 3))
    for row in range(terms.shape[0]):
        scale = 0.5 * weight * terms[row, column]
        m = 0
        for k in range(3):
            for n in range(k, 3):
                value = terms[row, OUTER + m] - terms[row, OVERLAP] * terms[row, PRECISION + m]
                s[k, n] += scale * value
                m += 1
    s[1, 0], s[2, 0], s[2, 1] = s[0, 1], s[0, 2], s[1, 2]
    sign = -weight if turned else weight
    if not turned:
        for k in range(3):
            wrenches[p, k] += sign * force[k]
        m = 3
        for k in range(3):
            for n in range(k, 3):
                wrenches[p, m] += s[k, n]
                m += 1
        return
    q = operations[g]
    m = 3
    for k in range(3):
        wrenches[p, k] += sign * (q[k] * force[0] + q[3 + k] * force[1] + q[6 + k] * force[2])
        for n in range(k, 3):
            for a in range(3):
                for b in range(3):
                    wrenches[p, m] += q[3 * a + k] * s[a, b] * q[3 * b + n]
            m += 1


@kernel
def overlap_of_parts(posed, masses, exponents, tails, span, own, crystal, planar, wrenches):
    """The sum of all overlaps of one molecule with itself and its copies, and its gradient.

    The constant overlap of each part with itself is left out.

    Args:
        posed: (P, POSED), the molecule's parts in the world.
        masses: (c,), of the mixture's Gaussians.
        exponents: (c,), the b_k.
        tails: (P, P), the distance of centres beyond which two parts' overlap counts as none.
        span: the largest component of a lattice vector that counts.
        own: whether the overlaps within the molecule itself count.
        crystal: operations (m, 12), basis, its inverse (3, 3), the lengths of its rows (3,).
        planar: whether the molecule lies in z = 0.
        wrenches: (P, 9), filled with ∂/∂μ (3) and ∂/∂Σ (6) of each part.
    """
    operations = crystal[0]
    components = masses.size
    sigmas = np.empty((posed.shape[0], SYMMETRIC))
    other = np.empty((1, SYMMETRIC))
    copy, force = np.empty(POSED), np.empty(3)
    terms = np.empty((components * components, TERM))
    for p in range(posed.shape[0]):
        covariance(posed[p, 3:], sigmas, p)
    wrenches[:] = 0.0
    total = 0.0
    for g in range(operations.shape[0]):
        for j in range(posed.shape[0]):
            turned_part(operations, g, posed, j, copy)
            covariance(copy[3:], other, 0)
            for i in range(j + 1):
                for k in range(components):
                    for n in range(components):
                        mass = masses[k] * masses[n]
                        b, c, row = exponents[k], exponents[n], components * k + n
                        set_term(sigmas, i, other, b, c, mass, planar, terms, row)
                force[:] = 0.0
                same, identity, reach = i == j, g == 0, tails[i, j]
                add_copies(
                    i, posed, copy, same, identity, own, reach, span, crystal, planar, terms, force
                )
                # (i, g, v, j) and (j, its inverse, i) are one pair seen from two sides.
                weight = 1.0 if i == j else 2.0
                for row in range(terms.shape[0]):
                    total += weight * terms[row, OVERLAP]
                give_back(terms, FIRST, weight, operations, g, False, force, wrenches, i)
                give_back(terms, SECOND, weight, operations, g, True, force, wrenches, j)
    return total


@kernel
def collect(posed, part_frames, wrenches, parents, kinds, lines, carried, gradient):
    """Fill ``gradient`` (K,) from the parts' ``wrenches``; ``carried`` (K, 6) is scratch.

    Rows of ``carried`` are the force and the torque about the origin of all that a frame carries.
    """
    carried[:] = 0.0
    sigma = np.empty((1, SYMMETRIC))
    for p in range(part_frames.size):
        k = part_frames[p]
        if k < 0:
            continue
        fx, fy, fz = wrenches[p, 0], wrenches[p, 1], wrenches[p, 2]
        xx, xy, xz, yy, yz, zz = wrenches[p, 3:9]
        covariance(posed[p, 3:], sigma, 0)
        s0, s1, s2, s3, s4, s5 = sigma[0]
        # Σ G − G Σ is [m]; tr(G ([ω]Σ − Σ[ω])) = −2 ω·m.
        mx = (s2 * xy + s4 * yy + s5 * yz) - (xz * s1 + yz * s3 + zz * s4)
        my = (s0 * xz + s1 * yz + s2 * zz) - (xx * s2 + xy * s4 + xz * s5)
        mz = (s1 * xx + s3 * xy + s4 * xz) - (xy * s0 + yy * s1 + yz * s2)
        x, y, z = posed[p, 0], posed[p, 1], posed[p, 2]
        carried[k, 0] += fx
        carried[k, 1] += fy
        carried[k, 2] += fz
        carried[k, 3] += y * fz - z * fy - 2.0 * mx
        carried[k, 4] += z * fx - x * fz - 2.0 * my
        carried[k, 5] += x * fy - y * fx - 2.0 * mz
    for k in range(parents.size - 1, -1, -1):
        if parents[k] >= 0:
            for m in range(6):
                carried[parents[k], m] += carried[k, m]
        ax, ay, az = lines[k, 0], lines[k, 1], lines[k, 2]
        px, py, pz = lines[k, 3], lines[k, 4], lines[k, 5]
        fx, fy, fz = carried[k, 0], carried[k, 1], carried[k, 2]
        if kinds[k] == SHIFT:
            gradient[k] = ax * fx + ay * fy + az * fz
        else:
            gradient[k] = (
                ax * (carried[k, 3] - (py * fz - pz * fy))
                + ay * (carried[k, 4] - (pz * fx - px * fz))
                + az * (carried[k, 5] - (px * fy - py * fx))
            )


@released
def potentials(
    kinds,
    parents,
    origins,
    axes,
    part_frames,
    parts,
    masses,
    exponents,
    tails,
    span,
    own,
    crystal,
    planar,
    configurations,
    values,
    gradients,
):
    """Write the potential of each arrangement (m, K) to ``values`` (m,), ``gradients`` (m, K).

    The molecule's arrays are as in kernels.molecule, the mixture's as in `overlap_of_parts`. The
    potential is the sum over all molecules of one unit cell, but for each part with itself.
    """
    count = kinds.size
    frames, lines, carried = np.empty((count, FRAME)), np.empty((count, 6)), np.empty((count, 6))
    posed, wrenches = np.empty((part_frames.size, POSED)), np.empty((part_frames.size, 9))
    copies = crystal[0].shape[0]
    for index in range(configurations.shape[0]):
        place_frames(kinds, parents, origins, axes, configurations[index], frames)
        pose_parts(frames, part_frames, parts, posed)
        motion_axes(axes, frames, lines)
        values[index] = copies * overlap_of_parts(
            posed, masses, exponents, tails, span, own, crystal, planar, wrenches
        )
        collect(posed, part_frames, wrenches, parents, kinds, lines, carried, gradients[index])
        for k in range(count):
            gradients[index, k] *= copies
