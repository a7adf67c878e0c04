"""Quadratic programmes over the simplex, as proximal steps need them (see centring).

    minimise over λ ≥ 0, Σλ = 1:  Σ λ_k g_k + s/2 |Σ λ_k ∇g_k|²

by an active set: solve on the rows in use, walk there until a weight vanishes, take in the row
that is violated most. Its optimum is the step s Σ λ_k ∇g_k that raises the smallest of the
linear functions g_k + ∇g_k·step the most, less |step|²/(2 s).
"""

import math

from .compile import inlined, kernel

# Rows in use at most: as many as can be independent, the dimension of steps and one more, and
# another that has come in before one of them leaves.
SPARE_ACTIVE = 2
_ROUNDS = 40
_RIDGE = 1e-13


@inlined
def _factorise(matrix, count, rows, active, size, dimension):
    """Cholesky factor of s(∇g·∇g + 1) over the active rows, in the lower half of ``matrix``."""
    for a in range(count):
        for b in range(a + 1):
            # As the weights' sum is given, a constant changes nothing; without it, rows whose
            # gradients depend on each other would be singular.
            total = size
            for m in range(dimension):
                total += size * rows[active[a], 1 + m] * rows[active[b], 1 + m]
            if a == b:
                total *= 1.0 + _RIDGE
            for m in range(b):
                total -= matrix[a, m] * matrix[b, m]
            if a == b:
                matrix[a, a] = math.sqrt(max(total, 1e-16 * size))
            else:
                matrix[a, b] = total / matrix[b, b]


@inlined
def _solve(matrix, count, column):
    """Solve with the factor in ``matrix``; right-hand side and solution stand in a column."""
    for a in range(count):
        for m in range(a):
            matrix[a, column] -= matrix[a, m] * matrix[m, column]
        matrix[a, column] /= matrix[a, a]
    for k in range(count):
        a = count - 1 - k
        for m in range(a + 1, count):
            matrix[a, column] -= matrix[m, a] * matrix[m, column]
        matrix[a, column] /= matrix[a, a]


@kernel
def minimise(rows, count, size, matrix, active, weights, step):
    """Write the best ``step`` (d,); rows (count, ≥ 1 + d) hold g and ∇g.

    ``active`` (most + 1,) and ``weights`` (most,), most = d + SPARE_ACTIVE, receive the rows in
    use, their number last, and their weights λ. ``matrix`` (most, most + 2) is workspace.

    Returns the smallest of the linear functions at the step.
    """
    used, dimension, most_active = 1, step.shape[0], weights.shape[0]
    active[0], weights[0] = 0, 1.0
    for k in range(count):
        if rows[k, 0] < rows[active[0], 0]:
            active[0] = k
    ones, linear = most_active, most_active + 1
    for _ in range(_ROUNDS):
        _factorise(matrix, used, rows, active, size, dimension)
        first, second = 0.0, 0.0
        for a in range(used):
            matrix[a, ones], matrix[a, linear] = 1.0, -rows[active[a], 0]
        _solve(matrix, used, ones)
        _solve(matrix, used, linear)
        for a in range(used):
            first += matrix[a, ones]
            second += matrix[a, linear]
        level = (1.0 - second) / first
        share, leaving = 1.0, -1
        for a in range(used):
            target = matrix[a, linear] + level * matrix[a, ones]
            matrix[a, linear] = target
            if target < 0.0 and weights[a] < share * (weights[a] - target):
                share, leaving = weights[a] / (weights[a] - target), a
        for a in range(used):
            weights[a] += share * (matrix[a, linear] - weights[a])
        if leaving >= 0:
            used -= 1
            active[leaving], weights[leaving] = active[used], weights[used]
            continue
        for m in range(dimension):
            step[m] = 0.0
            for a in range(used):
                step[m] += size * weights[a] * rows[active[a], 1 + m]
        lowest, entering, highest = math.inf, -1, -math.inf
        for k in range(count):
            value = rows[k, 0]
            for m in range(dimension):
                value += rows[k, 1 + m] * step[m]
            if value < lowest:
                lowest, entering = value, k
        for a in range(used):
            value = rows[active[a], 0]
            for m in range(dimension):
                value += rows[active[a], 1 + m] * step[m]
            highest = max(highest, value)
        if used == most_active or highest - lowest <= 1e-11 * (
            abs(highest) + abs(lowest) + 1e-6 * size
        ):
            break
        known = False
        for a in range(used):
            known = known or active[a] == entering
        if known:
            break
        active[used], weights[used] = entering, 0.0
        used += 1
    active[most_active] = used
    promised = math.inf
    for k in range(count):
        value = rows[k, 0]
        for m in range(dimension):
            value += rows[k, 1 + m] * step[m]
        promised = min(promised, value)
    return promised
