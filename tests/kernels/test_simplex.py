"""Proximal steps against optimality conditions, enumerated active sets and scipy."""

import itertools

import numpy as np
import pytest
from scipy.optimize import minimize

from ellipsoid_planning.kernels.simplex import SPARE_ACTIVE
from ellipsoid_planning.kernels.simplex import minimise as kernel

MOST_ACTIVE = 6 + SPARE_ACTIVE


def minimised(rows, size):
    """Step (6,), weights (count,) of all rows, and what the kernel promises."""
    matrix = np.full((MOST_ACTIVE, MOST_ACTIVE + 2), np.nan)
    active = np.full(MOST_ACTIVE + 1, -1)
    weights, step = np.full(MOST_ACTIVE, np.nan), np.full(6, np.nan)
    before = rows.copy()
    promised = kernel(rows, len(rows), size, matrix, active, weights, step)
    np.testing.assert_array_equal(rows, before)
    used = int(active[MOST_ACTIVE])
    assert 1 <= used <= MOST_ACTIVE
    assert len(set(active[:used])) == used
    shares = np.zeros(len(rows))
    shares[active[:used]] = weights[:used]
    return step, shares, promised


def values_at(rows, step):
    return rows[:, 0] + rows[:, 1:7] @ step


def excess(rows, size, step, shares):
    """How much the best step could gain on this one: the gap between primal and dual values."""
    primal = values_at(rows, step).min() - step @ step / (2.0 * size)
    moved = shares @ rows[:, 1:7]
    dual = shares @ rows[:, 0] + 0.5 * size * moved @ moved
    return dual - primal


def assert_optimal(rows, size, rtol=1e-9):
    step, shares, promised = minimised(rows, size)
    assert np.isfinite(step).all()
    assert shares.min() >= 0.0
    assert shares.sum() == pytest.approx(1.0, rel=1e-9)
    np.testing.assert_allclose(
        step, size * shares @ rows[:, 1:7], atol=1e-9 * size * np.abs(rows[:, 1:7]).max()
    )
    assert promised == pytest.approx(values_at(rows, step).min(), rel=1e-12, abs=1e-15)
    scale = np.abs(rows[:, 0]).max() + size * np.square(rows[:, 1:7]).sum(axis=1).max()
    assert -1e-12 * scale <= excess(rows, size, step, shares) <= rtol * scale
    return step


def random_rows(rng, count, dimension, spread=1.0):
    """Rows of unit gradients of robots that move in the first few of six ways."""
    rows = np.zeros((count, 8))
    rows[:, 0] = spread * rng.uniform(-0.2, 1.0, count)
    gradients = rng.normal(size=(count, dimension))
    rows[:, 1 : 1 + dimension] = gradients / np.linalg.norm(gradients, axis=1, keepdims=True)
    # What is behind the gradients is not the kernel's business.
    rows[:, 7] = np.nan
    return rows


@pytest.mark.parametrize("dimension", [1, 2, 3, 6])
@pytest.mark.parametrize("size", [1e-6, 1e-2, 1.0, 100.0])
def test_steps_are_optimal(dimension, size):
    rng = np.random.default_rng(1)
    for count in (1, 2, 3, 5, 8, 14, 32):
        for _ in range(8):
            assert_optimal(random_rows(rng, count, dimension), size)


@pytest.mark.parametrize("dimension", [2, 3, 6])
def test_steps_are_those_of_enumerated_active_sets(dimension):
    rng = np.random.default_rng(2)
    for _ in range(20):
        rows, size = random_rows(rng, 6, dimension), 10.0 ** rng.uniform(-2, 1)
        step, _, _ = minimised(rows, size)
        np.testing.assert_allclose(step, by_enumeration(rows, size), atol=1e-8)


def by_enumeration(rows, size):
    """The best step of those that make a few rows equal, weights not negative."""
    best, least = np.zeros(6), np.inf
    for count in range(1, len(rows) + 1):
        for used in itertools.combinations(range(len(rows)), count):
            g, gradients = rows[list(used), 0], rows[list(used), 1:7]
            system = np.zeros((count + 1, count + 1))
            system[:count, :count] = size * gradients @ gradients.T
            system[:count, count] = system[count, :count] = 1.0
            found = np.linalg.lstsq(system, np.append(-g, 1.0), rcond=1e-12)[0][:count]
            if found.min() < -1e-12 or abs(found.sum() - 1.0) > 1e-9:
                continue
            moved = found @ gradients
            value = found @ g + 0.5 * size * moved @ moved
            if value < least and values_at(rows, size * moved).min() >= (
                values_at(rows[list(used)], size * moved).max() - 1e-9
            ):
                least, best = value, size * moved
    return best


def test_steps_are_those_of_scipy():
    rng = np.random.default_rng(3)
    for count in (4, 12, 30):
        rows, size = random_rows(rng, count, 6), 0.7
        found = minimize(
            lambda x, size=size: x[:6] @ x[:6] / (2 * size) - x[6],
            np.append(np.zeros(6), rows[:, 0].min()),
            jac=lambda x, size=size: np.append(x[:6] / size, -1.0),
            constraints={
                "type": "ineq",
                "fun": lambda x, rows=rows: values_at(rows, x[:6]) - x[6],
                "jac": lambda _, rows=rows: np.column_stack([rows[:, 1:7], -np.ones(len(rows))]),
            },
            method="SLSQP",
            options={"ftol": 1e-14, "maxiter": 500},
        )
        step, _, promised = minimised(rows, size)
        np.testing.assert_allclose(step, found.x[:6], atol=1e-6)
        assert promised == pytest.approx(found.x[6], abs=1e-8)


def test_one_row_is_a_gradient_step():
    rows = random_rows(np.random.default_rng(4), 1, 6)
    step, shares, promised = minimised(rows, 0.3)
    np.testing.assert_allclose(step, 0.3 * rows[0, 1:7], rtol=1e-14)
    assert shares[0] == pytest.approx(1.0, rel=1e-14)
    assert promised == pytest.approx(rows[0, 0] + 0.3, rel=1e-14)


@pytest.mark.parametrize("copies", [2, 5, 32])
def test_equal_rows_change_nothing(copies):
    rng = np.random.default_rng(5)
    for count in (1, 3, 6):
        rows = random_rows(rng, count, 3)
        once, _, _ = minimised(rows, 0.5)
        many = np.repeat(rows, copies, axis=0)[:32]
        step = assert_optimal(many, 0.5)
        if len(many) == count * copies:
            np.testing.assert_allclose(step, once, atol=1e-6)


def test_walls_face_to_face_leave_no_step_but_to_the_middle():
    rows = np.zeros((2, 8))
    rows[:, 0], rows[:, 1] = [0.1, 0.3], [1.0, -1.0]
    for size in (0.1, 1.0, 1e3):
        step, shares, promised = minimised(rows, size)
        np.testing.assert_allclose(step, [0.1, 0, 0, 0, 0, 0], atol=1e-12)
        assert promised == pytest.approx(0.2, rel=1e-12)
        np.testing.assert_allclose(shares, 0.5, atol=0.1 / size + 1e-9)


@pytest.mark.parametrize("tilt", [0.0, 1e-12, 1e-9, 1e-6, 1e-3])
@pytest.mark.parametrize("size", [1e-3, 1.0, 100.0])
def test_gradients_that_nearly_depend_on_each_other(tilt, size):
    """Walls that are nearly parallel, as in a slot, and gaps as small as their angles."""
    rng = np.random.default_rng(6)
    for count in (3, 6, 12):
        rows = np.zeros((count, 8))
        rows[:, 1] = np.where(np.arange(count) % 2, 1.0, -1.0)
        rows[:, 2:7] = tilt * rng.normal(size=(count, 5))
        rows[:, 0] = 1e-6 * rng.uniform(size=count)
        step, shares, _ = minimised(rows, size)
        assert np.isfinite(step).all()
        assert shares.sum() == pytest.approx(1.0, rel=1e-9)
        # Of what could be gained, at most a hundredth is missed.
        best = -minimised_slowly(rows, size)
        gained = values_at(rows, step).min() - step @ step / (2.0 * size)
        start = rows[:, 0].min()
        assert gained - start >= 0.99 * (best - start) - 1e-13


def minimised_slowly(rows, size):
    """Minus the best value, by exact active sets of up to three rows or many random starts."""
    least = np.inf
    for count in (1, 2, 3, 4):
        for used in itertools.combinations(range(len(rows)), count):
            g, gradients = rows[list(used), 0], rows[list(used), 1:7]
            system = np.zeros((count + 1, count + 1))
            system[:count, :count] = size * gradients @ gradients.T
            system[:count, count] = system[count, :count] = 1.0
            found = np.linalg.lstsq(system, np.append(-g, 1.0), rcond=1e-15)[0][:count]
            step = size * found @ gradients
            value = values_at(rows, step).min() - step @ step / (2.0 * size)
            least = min(least, -value)
    return least


def test_no_gradients_at_all():
    rows = np.zeros((3, 8))
    rows[:, 0] = [0.3, 0.1, 0.2]
    step, _, promised = minimised(rows, 1.0)
    assert (step == 0.0).all()
    assert promised == 0.1


@pytest.mark.parametrize("scale", [1e-9, 1e-3, 1e6])
def test_the_unit_of_length_does_not_matter(scale):
    rng = np.random.default_rng(7)
    for count in (3, 10):
        rows = random_rows(rng, count, 6)
        step, _, _ = minimised(rows, 0.4)
        scaled = rows.copy()
        scaled[:, 0] *= scale
        other, _, _ = minimised(scaled, 0.4 * scale)
        np.testing.assert_allclose(other / scale, step, rtol=1e-6, atol=1e-9)
