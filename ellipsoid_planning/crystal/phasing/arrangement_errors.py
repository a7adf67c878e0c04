"""How far an arrangement that was found is from the true one (thesis (3.18), (3.19))."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.phasing.body_fit import body_unit
from ellipsoid_planning.crystal.phasing.equivalents import Equivalents
from ellipsoid_planning.kernels.molecule import TURN

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ArrangementErrors:
    """Errors of an arrangement, modulo what diffraction cannot tell apart.

    Attributes:
        configuration: (K,), the equivalent of the arrangement that is nearest to the target.
        isometry: the isometry of the crystal that leads to it, as a triplet.
        motion: E_h, the sum over domains of √(tr(ΔR J ΔRᵀ) + M |Δt|²).
        turning: the same without M |Δt|², as (3.18) has it for P1.
        mean_turn: MAE of the angles [rad], 0 if there are none.
        largest_turn: E_max [rad].
        mean_shift: MAE₂, of the shifts [length], None if the model has none.
        distance: root mean square of how far the bodies' centres are away [length].
    """

    configuration: Array
    isometry: str
    motion: float
    turning: float
    mean_turn: float
    largest_turn: float
    mean_shift: float | None
    distance: float

    @property
    def mae_deg(self) -> float:
        """MAE of the angles [degree]."""
        return math.degrees(self.mean_turn)

    @property
    def e_max_deg(self) -> float:
        """E_max of the angles [degree]."""
        return math.degrees(self.largest_turn)

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, under the thesis' names where it has them; angles in degrees."""
        return {
            "E_h": self.motion,
            "E_h_turns": self.turning,
            "MAE_deg": self.mae_deg,
            "E_max_deg": self.e_max_deg,
            "MAE_shifts": self.mean_shift,
            "RMSD_centres": self.distance,
            "isometry": self.isometry,
        }


def arrangement_errors(
    model: PackingModel, configuration: ArrayLike, target: ArrayLike
) -> ArrangementErrors:
    """The errors of a configuration (K,) against a target (K,): those of its best equivalent.

    The best is the one whose coordinates differ least, by root mean square, shifts measured by the
    largest semi-axis. E_h is no judge of that: to it a spheroid that turned about its axis moved.
    """
    true = np.asarray(target, dtype=float)
    best = min(
        (
            (_distance(model, same, true), number, same, one.isometry.triplet())
            for number, one in enumerate(_equivalents(model).near(configuration, true))
            for same in _spellings(model, one.configuration)
        ),
        key=lambda entry: entry[:2],
    )
    return plain_errors(model, best[2], true, best[3])


def _spellings(model: PackingModel, configuration: Array) -> tuple[Array, ...]:
    """A configuration, and the one with the other three Euler angles of the same rotation."""
    first, last = model.grid.shift_count, model.grid.base_count - 1
    if last - first != 2 or model.dimension == 2:
        return (configuration,)
    other = configuration.copy()
    other[[first, last]] += math.pi
    same_axes = np.array_equal(model.molecule.axes[first], model.molecule.axes[last])
    other[first + 1] = (0.0 if same_axes else math.pi) - other[first + 1]
    return configuration, other


def plain_errors(
    model: PackingModel, configuration: Array, target: Array, isometry: str = ""
) -> ArrangementErrors:
    """The errors of one configuration as it is, angles modulo whole turns."""
    angles, shifts = _differences(model, configuration, target)
    motion, turning = motion_error(model, configuration, target)
    return ArrangementErrors(
        configuration,
        isometry,
        motion,
        turning,
        float(angles.mean()) if len(angles) else 0.0,
        float(angles.max()) if len(angles) else 0.0,
        float(shifts.mean()) if len(shifts) else None,
        _centre_distance(model, configuration, target),
    )


def _centre_distance(model: PackingModel, first: Array, second: Array) -> float:
    centres = [model.molecule.placed(q)[0] for q in (first, second)]
    return float(np.sqrt(np.mean(np.sum((centres[0] - centres[1]) ** 2, axis=1))))


def _differences(model: PackingModel, first: Array, second: Array) -> tuple[Array, Array]:
    """Absolute differences of angles, modulo whole turns, and of shifts."""
    away = np.abs(first - second)
    turns = model.molecule.kinds == TURN
    return np.abs((away[turns] + math.pi) % (2.0 * math.pi) - math.pi), away[~turns]


def _distance(model: PackingModel, first: Array, second: Array) -> float:
    angles, shifts = _differences(model, first, second)
    return float(
        np.hypot(np.linalg.norm(angles), np.linalg.norm(shifts) / body_unit(model.molecule))
    )


def motion_error(model: PackingModel, first: ArrayLike, second: ArrayLike) -> tuple[float, float]:
    """E_h of two configurations with translations, and without.

    A domain is a link; M is density times volume, and J the integral of ρ x xᵀ in its principal
    frame: M a²/5, in the plane M a²/4. The norm is then the root of ∫ρ |g x - h x|² dx.
    """
    n = model.dimension
    ball = math.pi if n == 2 else 4.0 * math.pi / 3.0
    masses = model.molecule.densities * ball
    masses = masses * [float(np.prod(part.semi_axes)) for part in model.parts]
    (centres, matrices), (others, turned) = map(model.molecule.placed, (first, second))
    # tr(ΔR diag(a²) ΔRᵀ) is |ΔA|² for A = R diag(a).
    turns = ((matrices - turned)[:, :n, :n] ** 2).sum(axis=(1, 2)) * masses / (n + 2.0)
    shifts = ((centres - others) ** 2).sum(axis=1) * masses
    links = model.molecule.robot.part_links
    names = {name: number for number, name in enumerate(dict.fromkeys(links))}
    domain = np.array([names[name] for name in links])
    motion, turning = np.bincount(domain, turns + shifts), np.bincount(domain, turns)
    return float(np.sqrt(motion).sum()), float(np.sqrt(turning).sum())


@lru_cache(maxsize=8)
def _equivalents(model: PackingModel) -> Equivalents:
    return Equivalents(model)
