"""The pictures of the thesis' chapter 3, with our numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from benchmarks.phasing_cases import free_numbers, grid_targets, random_targets
from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.diffraction.magnitudes import simulate
from ellipsoid_planning.crystal.diffraction.ranking import Ranker
from ellipsoid_planning.crystal.packing.gaussian_mixture import GaussianMixture
from ellipsoid_planning.crystal.packing.model import PackingModel, load_model, load_target
from ellipsoid_planning.crystal.packing.potential import GaussianPotential
from ellipsoid_planning.crystal.packing.potential_candidates import (
    candidate_counts,
    candidates_by_potential,
)
from ellipsoid_planning.crystal.phasing.trace import trend
from planners.crystal.parameters import Refinement
from planners.crystal.refine import refine
from planners.view import colours
from planners.view.crystal_cell import drawn_cell
from planners.view.crystal_tables import TARGET, candidates_rows, error_columns
from planners.view.figures_crystal import draw_cell
from planners.view.figures_crystal_candidates import draw_candidates
from planners.view.figures_crystal_map import draw_potential_map
from planners.view.figures_crystal_molecule import draw_molecule
from planners.view.figures_crystal_potential import draw_candidate_counts, draw_mixture
from planners.view.figures_crystal_trends import draw_trends, trends_of

SPREADS = np.array([0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.4])
STEPS_DEG = (30, 40, 60)
SPREAD = 0.2  # m_b, the thesis' value
THREADS = 2
BEST, SHOWN = 10, 3
TRIALS = {"rabbit-p1": 20, "rabbit-p212121": 10}
TREES = Refinement(method="rrt", reach=1.0)
SEED = 1


@cache
def model_of(name: str) -> PackingModel:
    """A bundled model, read once."""
    return load_model(name)


@cache
def ranker_of(name: str) -> tuple[Callable[[FourierCost], Ranker], np.ndarray]:
    """How to rank the free arrangements of a model's grid, and their numbers."""
    search, numbers = free_numbers(model_of(name))
    return lambda cost: Ranker(search, cost), numbers


def figure_3_4() -> Figure:
    """A single Gaussian and the mixture, in one dimension."""
    x = np.linspace(-4.0, 4.0, 401)
    mixture = GaussianMixture(1.16)
    pairs = list(zip(mixture.amplitudes(1), mixture.exponents, strict=True))
    drawn = Figure(figsize=(6.0, 3.6), layout="constrained")
    axes = drawn.add_subplot()
    root = math.sqrt(2.0 * math.pi)
    axes.plot(x, np.exp(-0.5 * x * x) / root, color=colours.GOAL, label="one Gaussian")
    both = sum(a * np.exp(-0.5 * b * x * x) for a, b in pairs) / root
    axes.plot(x, both, color=colours.ROBOT, label="mixture, $m_b$ = 1.16")
    axes.axvspan(-1.0, 1.0, color="#ececec", label="the body")
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_ylim(bottom=0.0)
    axes.legend(frameon=False, fontsize=9)
    return drawn


def figure_3_6() -> Figure:
    """How many candidates there are for each m_b and grid."""
    counts = candidate_counts(
        model_of("rabbit-plane"), SPREADS, np.radians(STEPS_DEG), threads=THREADS
    )
    named = zip(STEPS_DEG, counts, strict=True)
    return draw_candidate_counts({f"{step}° grid": (SPREADS, row) for step, row in named})


def figure_3_7() -> Figure:
    """The mixture's contours and the molecule."""
    model = model_of("rabbit-plane")
    return draw_mixture(model, np.zeros(3), GaussianMixture(SPREAD))


def figure_3_8() -> Figure:
    """Where the planar rabbit is free, and GCF; the thesis' θ₃ = -90° is a left ear at 90°."""
    potential = GaussianPotential(model_of("rabbit-plane"), GaussianMixture(SPREAD))
    return draw_potential_map(potential, "yaw_deg", "right_ear_deg", {"left_ear_deg": 90.0})


def figure_3_9() -> Figure:
    """Candidates of the planar rabbit's target."""
    model = model_of("rabbit-plane")
    target = load_target("rabbit-plane-target", model)
    cost = FourierCost(model, simulate(model, target))
    kept = candidates_by_potential(model, GaussianMixture(SPREAD), threads=THREADS).kept
    costs = cost.values(kept)
    order = np.argsort(costs, kind="stable")[:BEST]
    return _candidates(model, target, kept[order], costs[order], (2, 2))


def figure_3_10() -> Figure:
    """The planar rabbit's target."""
    model = model_of("rabbit-plane")
    return draw_cell(drawn_cell(model, load_target("rabbit-plane-target", model)))


def figure_3_11() -> Figure:
    """Collisions in P1."""
    return _colliding("rabbit-p1", (2, 1, 1))


def figure_3_12() -> Figure:
    """A target on the grid in P1: it is the first candidate."""
    return _on_the_grid("rabbit-p1")


def figure_3_13() -> Figure:
    """A target off the grid in P1."""
    return _ranked("rabbit-p1", load_target("rabbit-p1-target", model_of("rabbit-p1")))


def figure_3_14() -> Figure:
    """Errors while trees refine the best candidate in P1."""
    return _trends("rabbit-p1")


def figure_3_15() -> Figure:
    """Degrees of freedom."""
    return draw_molecule(model_of("rabbit-p212121"))


def figure_3_16() -> Figure:
    """Collisions in P2₁2₁2₁."""
    return _colliding("rabbit-p212121", (1, 1, 1))


def figure_3_17() -> Figure:
    """A target on the grid in P2₁2₁2₁."""
    return _on_the_grid("rabbit-p212121")


def figure_3_18() -> Figure:
    """A target off the grid in P2₁2₁2₁."""
    name = "rabbit-p212121"
    return _ranked(name, load_target(f"{name}-target", model_of(name)))


def figure_3_19() -> Figure:
    """Errors while trees refine the best candidate in P2₁2₁2₁."""
    return _trends("rabbit-p212121")


def _colliding(name: str, cells: tuple[int, int, int]) -> Figure:
    model = model_of(name)
    drawn = np.random.default_rng(SEED).integers(model.grid.count, size=100)
    found = model.grid.configurations(drawn)
    return draw_cell(drawn_cell(model, found[~model.are_free(found)][0], cells))


def _on_the_grid(name: str) -> Figure:
    target = grid_targets(model_of(name), ranker_of(name)[1], 1, SEED)[0]
    return _ranked(name, target)


def _ranked(name: str, target: np.ndarray) -> Figure:
    model = model_of(name)
    ranker, numbers = ranker_of(name)
    ranking = ranker(FourierCost(model, simulate(model, target))).rank(numbers, BEST)
    return _candidates(model, target, ranking.configurations, ranking.costs, (1, 1, 1))


def _candidates(
    model: PackingModel,
    target: np.ndarray,
    configurations: np.ndarray,
    costs: np.ndarray,
    cells: tuple[int, ...],
) -> Figure:
    errors = error_columns(model, configurations, target)
    table = candidates_rows(model, configurations, costs, target, errors)
    panels = [(TARGET, target)]
    for index, one in enumerate(configurations[:SHOWN]):
        panels.append((f"candidate {index + 1}, FCF {costs[index]:.4g}", one))
    return draw_candidates(model, panels, table, cells, model.name)


def _trends(name: str) -> Figure:
    model = model_of(name)
    ranker, numbers = ranker_of(name)
    refined = []
    for target in random_targets(model, TRIALS[name], SEED):
        cost = FourierCost(model, simulate(model, target))
        first = ranker(cost).rank(numbers, 1).configurations[0]
        refined.append(trend(refine(cost, first, TREES).trace, model, target))
    return draw_trends(trends_of(refined), f"{name}, trees around the best candidate")


FIGURES: dict[str, Callable[[], Figure]] = {
    "3.4": figure_3_4,
    "3.6": figure_3_6,
    "3.7": figure_3_7,
    "3.8": figure_3_8,
    "3.9": figure_3_9,
    "3.10": figure_3_10,
    "3.11": figure_3_11,
    "3.12": figure_3_12,
    "3.13": figure_3_13,
    "3.14": figure_3_14,
    "3.15": figure_3_15,
    "3.16": figure_3_16,
    "3.17": figure_3_17,
    "3.18": figure_3_18,
    "3.19": figure_3_19,
}
