"""Structure factors by the textbook's formula, with no kernel of the package but placement."""

import itertools
import math

import numpy as np
from scipy.special import j1, spherical_jn


def lattice_points(model, spacing):
    """Reflections (R, 3) in the reciprocal space of planes at least ``spacing`` apart."""
    n = model.dimension
    reach = math.ceil(model.cell.lengths.max() / spacing) + 1
    indices = np.array(list(itertools.product(range(-reach, reach + 1), repeat=n)), dtype=float)
    vectors = np.zeros((len(indices), 3))
    vectors[:, :n] = indices @ model.cell.reciprocal.T
    lengths = np.linalg.norm(vectors, axis=1)
    return vectors[(lengths > 1e-9) & (lengths <= 1.0 / spacing)]


def structure_factors(model, configuration, vectors):
    """F (R,) of the cell's whole content, densities times volumes of ellipsoids."""
    n = model.dimension
    ball = math.pi if n == 2 else 4.0 * math.pi / 3.0
    centres, matrices = model.molecule.placed(configuration)
    found = np.zeros(len(vectors), dtype=complex)
    for row in model.crystal[0]:
        rotation, shift = row[:9].reshape(3, 3), row[9:]
        for part, density, centre, matrix in zip(
            model.parts, model.molecule.densities, centres, matrices, strict=True
        ):
            x = 2.0 * np.pi * np.linalg.norm(vectors @ rotation @ matrix, axis=1)
            form = 2.0 * j1(x) / x if n == 2 else 3.0 * spherical_jn(1, x) / x
            phase = np.exp(2j * np.pi * (vectors @ (rotation @ centre + shift)))
            found += density * ball * float(np.prod(part.semi_axes)) * form * phase
    return found


def magnitudes(model, configuration, vectors):
    """|F| (R,)."""
    return np.abs(structure_factors(model, configuration, vectors))


def random_configurations(model, count, seed):
    """Arrangements (count, K) anywhere in the model's ranges, free or not."""
    rng = np.random.default_rng(seed)
    lower = [one.lower for one in model.grid.ranges]
    upper = [one.upper for one in model.grid.ranges]
    return rng.uniform(lower, upper, (count, len(lower)))
