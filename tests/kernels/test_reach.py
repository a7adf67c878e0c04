"""How far a proof reaches: the root of its parabola, never farther, whatever cancels."""

from __future__ import annotations

import math
from decimal import Decimal, localcontext

import numpy as np
import pytest

from ellipsoid_planning.kernels.motion import _reach


def root(value: float, slope: float, bend: float) -> float:
    """The positive root of value + slope Δ − bend Δ²/2 in 80 digits."""
    with localcontext() as context:
        context.prec = 80
        f, s, k = Decimal(value), Decimal(slope), Decimal(bend)
        return float((s + (s * s + 2 * k * f).sqrt()) / k)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_it_ends_just_before_the_root(sign: float) -> None:
    rng = np.random.default_rng(1)
    for _ in range(3000):
        value, bend = 10 ** rng.uniform(-32, 1), 10 ** rng.uniform(-12, 6)
        slope = sign * 10 ** rng.uniform(-12, 4)
        reach, truth = _reach(value, slope, bend), root(value, slope, bend)
        assert truth * (1 - 2e-6) <= reach <= truth, (value, slope, bend)


def test_a_value_of_the_last_bit_reaches_no_farther_than_its_bend_allows() -> None:
    """root − slope is 0 here: its quotient reached to infinity."""
    assert _reach(2.5e-29, 0.14461737771562577, 23.95) == pytest.approx(
        2 * 0.14461737771562577 / 23.95, rel=2e-6
    )


def test_what_is_no_number_or_too_large_reaches_nowhere() -> None:
    assert _reach(1.0, 1.0, math.inf) == 0.0
    assert _reach(1.0, math.nan, 1.0) == 0.0
    assert _reach(1.0, 1.0, math.nan) == 0.0
    assert _reach(1e10, 1.0, 1e300) == 0.0
    assert _reach(1e-300, -1e-170, 1e-300) <= 1e-130
    assert _reach(1.0, 1.0, 0.0) == math.inf
