"""What is drawn of a packed cell is what is there."""

import base64
import dataclasses
import itertools
import json
import re

import numpy as np
import pytest
import umsgpack
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import Ellipse as EllipsePatch

from ellipsoid_planning.crystal.packing.copies import copies, middle_of
from ellipsoid_planning.crystal.packing.overlaps import overlaps
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.geometry import Ellipsoid
from planners.view import crystal_colours as palette
from planners.view.colours import rgb
from planners.view.crystal_cell import drawn_cell, pretty_group
from planners.view.crystal_page import MOLECULE, page_of_cell
from planners.view.crystal_space import along, oblique, rendered, window
from planners.view.figures_crystal import draw_cell
from planners.view.ray_image import NOBODY
from tests.crystal.drawn_models import NAMES, colliding, in_group, target_of


def test_each_cell_has_one_copy_for_each_operation():
    for name, sides in itertools.product(NAMES, ((1, 1, 1), (2, 1, 3))):
        model, q = target_of(name)
        n = model.dimension
        low = np.array([-1.0, 0.25, 0.5])[:n]
        found = copies(model, q, low, low + sides[:n])
        assert len(found) == model.group.order * np.prod(sides[:n])
        assert len({(copy.operation, copy.lattice) for copy in found}) == len(found)
        turns, shifts = model.group.cartesian(model.cell)
        for copy in found:
            moved = shifts[copy.operation] + model.cell.cartesian(copy.lattice)
            middle = turns[copy.operation] @ middle_of(model, q) + moved
            place = model.cell.fractional(middle)
            assert np.all(place >= low - 1e-8) and np.all(place < low + sides[:n])
            for body, first in zip(copy.bodies, model.molecule.bodies(q), strict=True):
                turned = turns[copy.operation] @ first.shape_matrix @ turns[copy.operation].T
                np.testing.assert_allclose(body.shape_matrix, turned, atol=1e-9)
                centre = turns[copy.operation] @ first.centre + moved
                np.testing.assert_allclose(body.centre, centre, atol=1e-9)


def test_middles_on_a_border_are_counted_once():
    model, q = target_of("rabbit-p1")
    place = model.cell.fractional(middle_of(model, q))
    for side in (0.0, 1e-13, -1e-13):
        assert len(copies(model, q, place + side, place + side + 2.0)) == 8


def test_reflections_keep_shapes():
    model = in_group("rabbit-p1", "P-1", [40, 40, 40])
    q = np.zeros(len(model.keys))
    for copy in copies(model, q, [0, 0, 0], [1, 1, 1]):
        for body, first in zip(copy.bodies, model.molecule.bodies(q), strict=True):
            np.testing.assert_allclose(body.shape_matrix, first.shape_matrix, atol=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_overlaps_are_there_where_an_arrangement_is_not_free(name):
    model, target = target_of(name)
    rng = np.random.default_rng(1)
    for q in [target, *model.grid.configurations(rng.integers(model.grid.count, size=6))]:
        cell = drawn_cell(model, q, (1,) * model.dimension)
        assert (not cell.overlaps) == model.is_free(q)
        for overlap in cell.overlaps:
            assert overlap.first.contains(overlap.inside)
            assert overlap.second.contains(overlap.inside)
            directions = rng.normal(size=(50, model.dimension))
            directions /= np.linalg.norm(directions, axis=1)[:, None]
            edge = overlap.boundary(directions)
            if model.dimension == 3:
                edge = np.concatenate([edge, overlap.surface(12, 4).reshape(-1, 3)])
            for body in (overlap.first, overlap.second):
                reach = np.linalg.norm((edge - body.centre) @ np.linalg.inv(body.matrix).T, axis=1)
                assert np.all(reach < 1.0 + 1e-9)


def test_parts_that_may_overlap_do_not_count():
    model, q = target_of("rabbit-p1")
    face, ear, _ = model.molecule.bodies(q)
    grown = Ellipsoid(face.centre, face.rotation, 1.0001 * face.semi_axes)
    assert grown.contains(ear.centre)
    assert overlaps(model, copies(model, q, *_home(model, q))) == []


def _home(model, q):
    corner = model.cell.fractional(middle_of(model, q)) - 0.5
    return corner, corner + 1.0


def test_planar_figures_have_an_ellipse_for_each_body_and_yellow_for_each_overlap():
    model, target = target_of("rabbit-plane")
    for q in (target, colliding(model)):
        cell = drawn_cell(model, q, (2, 3))
        axes = draw_cell(cell).axes[0]
        drawn = [patch for patch in axes.patches if isinstance(patch, EllipsePatch)]
        assert len(drawn) == 3 * 6
        centres = {tuple(np.round(patch.center, 6)) for patch in drawn}
        expected = {tuple(np.round(b.centre, 6)) for c in cell.copies for b in c.bodies}
        assert centres == expected
        yellow = np.array([*rgb(palette.OVERLAP), 1.0])
        lit = [p for p in axes.patches if np.allclose(p.get_facecolor(), yellow)]
        assert len(lit) == len(cell.overlaps)
        assert bool(lit) != model.is_free(cell.configuration)


def test_plane_groups_have_a_colour_for_each_operation():
    model = in_group("rabbit-plane", "p6", [30, 30], [120])
    cell = drawn_cell(model, target_of("rabbit-plane")[1], (1, 1))
    axes = draw_cell(cell).axes[0]
    drawn = [patch for patch in axes.patches if isinstance(patch, EllipsePatch)]
    faces = {patch.get_facecolor()[:3] for patch in drawn}
    assert {rgb(hue) for hue in cell.hues} <= faces
    assert len(set(palette.operation_colours(192))) == 192
    assert palette.OVERLAP not in palette.operation_colours(192)


def test_spatial_views_show_bodies_where_they_project():
    model, q = target_of("rabbit-p212121")
    cell = drawn_cell(model, q)
    for camera in (oblique(cell), along(cell, 2)):
        low, high = window(cell, camera)
        image = rendered(cell, camera, low, high, 300)
        bodies = [(i, body) for i, copy in enumerate(cell.copies) for body in copy.bodies]
        # The nearest point of all bodies is seen, and none is nearer than the picture's depth.
        tops = [(camera.axes(body.support_points(camera.back)[None])[0], i) for i, body in bodies]
        nearest, owner = max(tops, key=lambda top: top[0][2])
        column, row = ((nearest[:2] - low) / image.spacing).astype(int)
        assert image.owners[row, column] in {owner, NOBODY}  # or an edge of the cell
        for point, _ in tops:
            column, row = ((point[:2] - low) / image.spacing).astype(int)
            assert image.depths[row, column] > point[2] - 0.01 * (high - low).max()


def test_a_ray_image_meets_bodies_exactly():
    model, q = target_of("rabbit-p1")
    cell = drawn_cell(model, q)
    camera = oblique(cell)
    low, high = window(cell, camera)
    image = rendered(cell, camera, low, high, 120)
    body = Ellipsoid.from_semi_axes([3.0, 2.0, 1.0], cell.copies[0].bodies[0].centre)
    alone = type(image)(camera, low, high, 120)
    alone.add(body, "#ffffff", 0)
    area = np.isfinite(alone.depths).sum() * alone.spacing**2
    plane = np.array([camera.right, camera.up]) @ body.matrix
    assert area == pytest.approx(np.pi * np.sqrt(np.linalg.det(plane @ plane.T)), rel=0.02)
    rows, columns = np.nonzero(np.isfinite(alone.depths))
    across, up = (low + (np.column_stack([columns, rows]) + 0.5) * alone.spacing).T
    depth = alone.depths[rows, columns]
    points = camera.centre + np.column_stack([across, up, depth]) @ np.array(
        [camera.right, camera.up, camera.back]
    )
    reach = np.linalg.norm((points - body.centre) @ np.linalg.inv(body.matrix).T, axis=1)
    np.testing.assert_allclose(reach, 1.0, atol=1e-9)


def test_overlaps_are_yellow_in_space():
    model, _ = target_of("rabbit-p1")
    cell = drawn_cell(model, colliding(model), (1, 1, 1))
    camera = oblique(cell)
    low, high = window(cell, camera)
    colours = rendered(cell, camera, low, high, 200).colours
    yellow = (colours[..., 0] > 0.6) & (colours[..., 1] > 0.55) & (colours[..., 2] < 0.35)
    assert cell.overlaps
    assert yellow.sum() > 20


def test_a_spatial_picture_has_a_view_from_a_corner_and_one_along_each_axis():
    drawn = draw_cell(drawn_cell(*target_of("rabbit-p1")))
    assert [axes.get_title() for axes in drawn.axes[1:]] == ["along a", "along b", "along c"]


def commands_of(page):
    listed = json.loads(re.search(r"of (\[.*?\])\)\s", page, re.DOTALL).group(1))
    return [umsgpack.unpackb(base64.b64decode(command)) for command in listed]


def test_the_page_holds_all_bodies():
    for name, cells in (("rabbit-plane", (3, 2)), ("rabbit-p212121", (1, 1, 1))):
        model, q = target_of(name)
        cell = drawn_cell(model, q, cells)
        page = page_of_cell(model, q, cells, lines=["<from a test>"])
        assert "&lt;from a test&gt;" in page
        assert "default-src 'none'" in page
        commands = commands_of(page)
        assert not re.search(r"<(?:link|iframe|img|script)[^>]*(?:src|href)=", page)
        bodies = [c for c in commands if c["type"] == "set_object" and "/cell/" not in c["path"]]
        assert len(bodies) == len(cell.copies) * 3
        placed = {
            tuple(np.round(np.array(c["matrix"]).reshape(4, 4).T[: model.dimension, 3], 5))
            for c in commands
            if c["type"] == "set_transform" and c["path"].count("/") > 3
        }
        expected = {tuple(np.round(b.centre, 5)) for c in cell.copies for b in c.bodies}
        assert placed == expected
        assert sum(f"/{MOLECULE}/" in c["path"] for c in bodies) == 3
        edges = sum("/cell/" in c["path"] for c in commands if c["type"] == "set_object")
        assert edges == len(cell.home_edges()) + len(cell.neighbour_lines())


def test_the_page_shows_overlaps():
    for name in ("rabbit-plane", "rabbit-p1"):
        model, _ = target_of(name)
        q = colliding(model)
        cell = drawn_cell(model, q, (1,) * model.dimension)
        commands = commands_of(page_of_cell(model, q, (1,) * model.dimension))
        assert sum("/overlaps/" in c["path"] for c in commands) == len(cell.overlaps) > 0


def test_edges_of_cells():
    model, q = target_of("rabbit-p212121")
    cell = drawn_cell(model, q, (2, 1, 1))
    assert len(cell.home_edges()) == 12
    assert len(cell.neighbour_lines()) == 8
    plane = drawn_cell(*target_of("rabbit-plane"))
    assert len(plane.home_edges()) == 4
    assert len(plane.neighbour_lines()) == 24 - 4


def test_soft_bodies_may_overlap_as_deep_as_the_model_says():
    model, _ = target_of("rabbit-plane")
    soft = dataclasses.replace(model, overlap=0.9)
    rng = np.random.default_rng(3)
    ends = np.array([(r.lower, r.upper) for r in model.grid.ranges])
    draws = rng.uniform(ends[:, 0], ends[:, 1], (2000, len(ends)))
    q = draws[soft.are_free(draws) & ~model.are_free(draws)][0]
    assert drawn_cell(model, q).overlaps and not drawn_cell(soft, q).overlaps
    assert "free of overlaps deeper than 0.9" in drawn_cell(soft, q).headline()


def test_bad_cells_are_refused():
    model, q = target_of("rabbit-plane")
    for cells, message in (((2,), "expected 2 whole"), ((0, 1), "from 1 on"), ((99, 99), "fewer")):
        with pytest.raises(CrystalError, match=message):
            drawn_cell(model, q, cells)
    with pytest.raises(CrystalError, match="configuration of 3"):
        drawn_cell(model, q[:2])


def test_group_names_have_subscripts():
    for group, lengths, name in (
        ("P212121", [60, 60, 60], "P2₁2₁2₁"),
        ("P1", [60, 60, 60], "P1"),
        ("P41", [60, 60, 60], "P4₁"),
        ("P4322", [60, 60, 60], "P4₃22"),
        ("P432", [60, 60, 60], "P432"),
        ("P4132", [60, 60, 60], "P4₁32"),
    ):
        assert pretty_group(in_group("rabbit-p1", group, lengths)) == name


def test_figures_render_without_warnings():
    model, q = target_of("rabbit-plane")
    FigureCanvasAgg(draw_cell(drawn_cell(model, q), "title $ & <text>")).draw()
