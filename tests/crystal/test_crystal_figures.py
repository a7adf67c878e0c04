"""Figures of candidates, trends, potentials and degrees of freedom."""

import numpy as np
import pytest

from ellipsoid_planning.crystal.packing.gaussian_mixture import GaussianMixture
from ellipsoid_planning.crystal.packing.potential import GaussianPotential
from ellipsoid_planning.crystal.phasing.trace import Trace, trend
from ellipsoid_planning.errors import CrystalError
from planners.view.crystal_tables import candidates_rows, candidates_table, error_columns
from planners.view.figures_crystal import picture_of_cell
from planners.view.figures_crystal_candidates import picture_of_candidates
from planners.view.figures_crystal_map import draw_potential_map
from planners.view.figures_crystal_molecule import motions, picture_of_molecule
from planners.view.figures_crystal_potential import draw_candidate_counts, picture_of_mixture
from planners.view.figures_crystal_trends import (
    ErrorTrend,
    draw_trends,
    picture_of_trends,
    trends_of,
)
from tests.crystal.drawn_models import target_of


@pytest.mark.parametrize("suffix", ["png", "svg", "pdf"])
def test_formats(suffix):
    first = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}[suffix]
    model, q = target_of("rabbit-plane")
    errors = {"MAE [°]": [1.0, 2.0]}
    trend = ErrorTrend.of("MAE", "°", [([0, 5], [3.0, 1.0]), ([0, 2], [4.0, 2.0])])
    for content in (
        picture_of_cell(model, q, suffix),
        picture_of_candidates(model, [q, q + 0.1], [0.1, 0.2], suffix, q, errors, shown=2),
        picture_of_trends([trend], suffix),
    ):
        assert content.startswith(first)


def test_candidates_are_listed_with_their_target():
    model, q = target_of("rabbit-p1")
    titles, rows = candidates_rows(model, [q, q + 0.1], [0.5, 1.0], q, {"E_h": [1, 2]})
    assert titles[0] == "candidate" and titles[-2:] == ["FCF", "E_h"]
    assert [row[0] for row in rows] == ["target", "1", "2"]
    assert rows[0][1:4] == ["33.42", "47.89", "13.02"]
    assert rows[2][-2:] == ["1", "2"]
    assert candidates_table(model, [q], [0.5]).row_count == 1
    with pytest.raises(CrystalError, match="one a candidate, got 1"):
        candidates_rows(model, [q, q], [0.5, 1.0], errors={"E_h": [1.0]})
    with pytest.raises(CrystalError, match="expected candidates"):
        candidates_rows(model, [q[:2]], [0.5])


def test_trends_keep_the_last_error_of_trials_that_stopped():
    trend = ErrorTrend.of("MAE", "°", [([0, 4], [8.0, 4.0]), ([0, 1, 2], [6.0, 5.0, 1.0])])
    np.testing.assert_array_equal(trend.steps, [0, 1, 2, 4])
    np.testing.assert_array_equal(trend.values, [[8, 8, 8, 4], [6, 5, 1, 1]])
    stopped = ErrorTrend(
        "E_h", "", np.arange(3), np.array([[3.0, 2.0, np.nan], [5.0, np.nan, np.nan]])
    )
    np.testing.assert_array_equal(stopped.filled(), [[3, 2, 2], [5, 5, 5]])
    (axes,) = draw_trends([trend]).axes
    median = next(line for line in axes.lines if line.get_label() == "median")
    np.testing.assert_allclose(median.get_ydata(), [7.0, 6.5, 4.5, 2.5])
    with pytest.raises(CrystalError, match="first step"):
        ErrorTrend("E_h", "", np.arange(2), np.array([[np.nan, 1.0]])).filled()
    with pytest.raises(CrystalError, match="at least one"):
        draw_trends([])


def test_refinements_become_trends():
    model, q = target_of("rabbit-p212121")
    trace = Trace()
    for shift, cost in ((0.3, 3.0), (0.4, 4.0), (0.1, 1.0)):
        trace.add(q + shift, cost)
    drawn = trends_of([trend(trace, model, q)])
    assert [one.name for one in drawn] == ["FCF", "E_h", "MAE", "E_max", "MAE₂"]
    np.testing.assert_array_equal(drawn[0].steps, [0, 2])
    np.testing.assert_allclose(drawn[0].values, [[3.0, 1.0]])
    np.testing.assert_allclose(drawn[4].values, [[0.3, 0.1]], rtol=1e-6)
    columns = error_columns(model, [q, q + 0.1], q)
    assert list(columns) == ["E_h", "MAE [°]", "E_max [°]", "MAE₂"]
    assert columns["MAE [°]"][0] < 1e-6 < columns["MAE [°]"][1] < np.degrees(0.1) + 1e-6
    assert [one.name for one in trends_of([trend(trace, model)])] == ["FCF"]
    with pytest.raises(CrystalError, match="one refinement"):
        trends_of([])


def test_the_map_of_the_potential_is_that_of_the_model():
    model, _ = target_of("rabbit-plane")
    potential = GaussianPotential(model, GaussianMixture(1.6))
    drawn = draw_potential_map(potential, fixed={"left_ear_deg": 90}, pixels=7)
    shown = [np.asarray(axes.images[0].get_array()) for axes in drawn.axes[:2]]
    for row, column in ((0, 0), (3, 5), (6, 2)):
        yaw, ear = (column + 0.5) / 7 * 180, -90 + (row + 0.5) / 7 * 180
        q = model.configuration({"yaw_deg": yaw, "right_ear_deg": ear, "left_ear_deg": 90})
        assert bool(shown[0][row, column]) == model.is_free(q)
        assert shown[1][row, column] == pytest.approx(potential.value(q))
    for fixed, message in (({"x": 1.0}, "'x' is no coordinate"), ({"yaw_deg": 0.0}, "not held")):
        with pytest.raises(CrystalError, match=message):
            draw_potential_map(potential, "yaw_deg", "right_ear_deg", fixed, pixels=2)


def test_contours_and_counts():
    model, q = target_of("rabbit-plane")
    assert picture_of_mixture(model, q, GaussianMixture(0.2), "png").startswith(b"\x89PNG")
    with pytest.raises(CrystalError, match="3-dimensional"):
        picture_of_mixture(*target_of("rabbit-p1"), GaussianMixture(0.2), "png")
    (axes,) = draw_candidate_counts({"30°": ([0.1, 0.2, 0.4], [10, 48, 20])}).axes
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), [10, 48, 20])
    assert [text.get_text() for text in axes.texts] == ["48 at 0.2"]


def test_degrees_of_freedom_have_the_axes_about_which_they_move():
    for name in ("rabbit-plane", "rabbit-p212121"):
        model, q = target_of(name)
        found = motions(model, q)
        assert len(found) == len(model.keys)
        centres = model.molecule.placed(q)[0]
        for k, motion in enumerate(found):
            moved = model.molecule.placed(q + 1e-6 * np.eye(len(q))[k])[0]
            rate = (moved - centres) / 1e-6
            turns = model.molecule.coordinates[k].turns
            expected = np.cross(motion.direction, centres - motion.point)
            expected = expected if turns else np.tile(motion.direction, (len(centres), 1))
            still = np.linalg.norm(rate, axis=1) < 1e-7
            np.testing.assert_allclose(rate[~still], expected[~still], atol=1e-4)
        assert picture_of_molecule(model, "png").startswith(b"\x89PNG")
