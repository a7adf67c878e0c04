import itertools
import math

import numpy as np
import pytest

from ellipsoid_planning.crystal.packing.grid_search import GridSearch
from ellipsoid_planning.crystal.packing.model import load_model, load_target
from ellipsoid_planning.crystal.symmetry.catalogue import space_group
from ellipsoid_planning.crystal.symmetry.unit_cell import UnitCell
from ellipsoid_planning.errors import CrystalError
from tests.crystal.packings import model_from, one_body, one_body_text, smallest_gap

HAIR = 1e-9


def draws(model, count, seed):
    rng = np.random.default_rng(seed)
    ends = np.array([(r.lower, r.upper) for r in model.grid.ranges])
    return rng.uniform(ends[:, 0], ends[:, 1], (count, len(ends)))


# --- one arrangement ----------------------------------------------------------------------------

CHAIN = """\
format: 1
name: chain
dimension: 3
group: {group}
cell: {cell}
molecule:
  links:
    - {{name: base, parts: [{{semi_axes: [1.5, 0.8, 0.6]}}, {{semi_axes: [0.5, 0.5, 1.2]}}]}}
    - {{name: arm, parts: [{{semi_axes: [1.2, 0.4, 0.5], position: [1.2, 0, 0]}}]}}
    - {{name: hand, parts: [{{semi_axes: [0.9, 0.3, 0.3], position: [0.9, 0, 0]}}]}}
    - {{name: tail, parts: [{{semi_axes: [0.9, 0.3, 0.3], position: [-0.9, 0, 0]}}]}}
  joints:
    - {{name: shoulder, type: revolute, parent: base, child: arm, axis: [0, 0, 1],
       origin: {{position: [1.4, 0, 0]}}, limit: {{lower_deg: -90, upper_deg: 90}}}}
    - {{name: wrist, type: revolute, parent: arm, child: hand, axis: [0, 1, 0],
       origin: {{position: [2.2, 0, 0]}}, limit: {{lower_deg: -150, upper_deg: 150}}}}
    - {{name: rump, type: revolute, parent: base, child: tail, axis: [0, 1, 1],
       origin: {{position: [-1.3, 0, 0]}}, limit: {{lower_deg: -90, upper_deg: 90}}}}
search:
  position: {{x: {{step: {step}, nodes: ends}}, z: {{lower: 0, upper: 2, step: 1}}}}
  orientation:
    alpha_deg: {{lower: 0, upper: 360, step: 90}}
    beta_deg: {{lower: 0, upper: 180, step: 60}}
    gamma_deg: {{lower: 0, upper: 360, step: 120}}
  joints: {{shoulder_deg: {{step: 60}}, wrist_deg: {{step: 100}}, rump_deg: {{step: 45}}}}
diffraction: {{resolution: 2}}
"""
CRYSTALS = [
    ("P1", "{lengths: [4, 4.5, 5], angles_deg: [75, 100, 62]}", 1.0),
    ("P21", "{lengths: [6, 5, 5], angles_deg: [90, 105, 90]}", 2.0),
    ("P212121", "{lengths: [7, 7, 7.5]}", 3.5),
    ("P31", "{lengths: [7, 7, 7], angles_deg: [90, 90, 120]}", 3.5),
    ("P-1", "{lengths: [6, 5, 6], angles_deg: [75, 100, 62]}", 2.0),
    ("C2", "{lengths: [10, 5, 7], angles_deg: [90, 100, 90]}", 5.0),
]


@pytest.mark.parametrize(("group", "cell", "step"), CRYSTALS)
def test_free_means_that_no_pair_of_copies_meets(group, cell, step):
    model = model_from(CHAIN.format(group=group, cell=cell, step=step))
    arrangements = draws(model, 40, 11)
    free = model.are_free(arrangements)
    gaps = np.array([smallest_gap(model, q, reach=3) for q in arrangements])
    assert np.all(np.abs(gaps) > 1e-8), "ambiguous cases prove nothing"
    np.testing.assert_array_equal(free, gaps > 0)
    assert 2 <= free.sum() <= 38


@pytest.mark.parametrize("name", ["rabbit-plane", "rabbit-p1"])
def test_the_rabbits_agree_with_the_slow_twin(name):
    model = load_model(name)
    arrangements = draws(model, 60, 12)
    free = model.are_free(arrangements)
    gaps = np.array([smallest_gap(model, q, reach=3) for q in arrangements])
    np.testing.assert_array_equal(free, gaps > 0)
    assert free.any() and not free.all()


@pytest.mark.parametrize("hair", [HAIR, -HAIR, -1e-12])
@pytest.mark.parametrize(
    ("group", "cell", "semi_axes", "position"),
    [
        ("P1", "{{lengths: [{0}, 9, 9]}}", [1.0, 1.0, 1.0], [0.3, 0.2, 0.1]),
        ("P1", "{{lengths: [{0}, 9, 9]}}", [1.0, 1e-4, 1e-4], [0.3, 0.2, 0.1]),
        ("P1", "{{lengths: [{0}, 9, 9]}}", [1.0, 3.0, 1e-5], [0.0, 0.0, 0.0]),
        ("p1", "{{lengths: [{0}, 9], angles_deg: [110]}}", [1.0, 1.0], [7.0, -3.0]),
        ("p2", "{{lengths: [9, {0}]}}", [0.5, 1.0], [2.0, 0.0]),
    ],
)
def test_neighbours_that_miss_or_touch_by_a_hair(group, cell, semi_axes, position, hair):
    model = one_body(group, cell.format(2.0 + hair), semi_axes, position=position)
    assert model.is_free([]) == (hair > 0)


def test_what_rounding_hides_far_from_the_origin_counts_as_a_collision():
    # A ball at the end of a long lever that is turned away and back, and its inverted image.
    text = """\
format: 1
name: lever
dimension: 3
group: P-1
cell: {{lengths: [10, 30, 30]}}
molecule:
  links: [{{name: a}}, {{name: b, parts: [{{semi_axes: [1, 1, 1], position: [{0!r}, 0, 0]}}]}}]
  joints: [{{name: j, type: continuous, parent: a, child: b, axis: [0, 0, 1],
    origin: {{orientation: {{axis_angle: {{axis: [0, 0, 1], angle_deg: {1}}}}}}}}}]
search: {{joints: {{j_deg: {{lower: 0, upper: 360, step: 360}}}}}}
diffraction: {{resolution: 2}}
"""
    for angle in range(5, 360, 17):
        model = model_from(text.format(1e5 + 1.0 - 1.5e-11, -angle))
        assert not model.is_free(model.configuration({"j_deg": angle})), angle
        model = model_from(text.format(1e5 + 1.0 + 1e-8, -angle))
        assert model.is_free(model.configuration({"j_deg": angle})), angle


def test_operations_are_isometries_in_flat_cells_too():
    cell = UnitCell.from_parameters([7.0, 8.0, 9.0], [90.0, 0.01, 90.0])
    rotations, _ = space_group("P21").cartesian(cell)
    np.testing.assert_allclose(rotations[1], np.diag([-1.0, 1.0, -1.0]), atol=1e-15)


@pytest.mark.parametrize("hair", [HAIR, -HAIR])
def test_turned_ellipsoids_that_miss_or_touch_by_a_hair(hair):
    rng = np.random.default_rng(4)
    for _ in range(10):
        turn = rng.uniform(0, 360, 3).tolist()
        search = (
            "{orientation: {alpha_deg: {lower: 0, upper: 720, step: 720}, "
            "beta_deg: {lower: 0, upper: 720, step: 720}, "
            "gamma_deg: {lower: 0, upper: 720, step: 720}}}"
        )
        probe = one_body("P1", "{lengths: [4, 60, 60]}", [3.0, 1.0, 0.7], search)
        q = probe.configuration(dict(zip(probe.keys, turn, strict=True)))
        matrix = probe.molecule.placed(q)[1][0]
        # The neighbour along x touches where |A⁻¹ (a, 0, 0)| = 2.
        touching = 2.0 / float(np.linalg.norm(np.linalg.inv(matrix)[:, 0]))
        cell = f"{{lengths: [{touching + hair!r}, 60, 60]}}"
        model = one_body("P1", cell, [3.0, 1.0, 0.7], search)
        assert model.is_free(q) == (hair > 0)


@pytest.mark.parametrize("hair", [HAIR, -HAIR])
@pytest.mark.parametrize(("axes", "depth"), [([1.0, 1.0, 1.0], 0.3), ([1.0, 0.4, 0.2], 0.1)])
def test_soft_bodies_may_overlap_to_a_hair(axes, depth, hair):
    text = one_body_text("P1", f"{{lengths: [{2.0 - depth + hair!r}, 9, 9]}}", axes)
    assert not model_from(text).is_free([])
    soft = text.replace("search:", f"packing: {{overlap: {depth}}}\nsearch:")
    assert model_from(soft).is_free([]) == (hair > 0)


def test_soft_bodies_agree_with_the_slow_twin():
    text = CHAIN.format(group="P21", cell="{lengths: [6, 5, 5], angles_deg: [90, 105, 90]}", step=2)
    model = model_from(text.replace("search:", "packing: {overlap: 0.15}\nsearch:", 1))
    arrangements = draws(model, 60, 21)
    gaps = np.array([smallest_gap(model, q, reach=3) for q in arrangements])
    free = model.are_free(arrangements)
    # The twin's depth is that of a locally best direction: where it says free, so must we.
    assert np.all(free[gaps > -0.15])
    assert free.sum() > np.sum(gaps > 0)
    hard = model_from(text)
    assert not np.any(hard.are_free(arrangements) & ~free)


def test_slack_is_for_the_nodes_of_the_grid_alone():
    text = CHAIN.format(
        group="P1", cell="{lengths: [4, 4.5, 5], angles_deg: [75, 100, 62]}", step=1
    )
    strict, slack = model_from(text), model_from(text.replace("search:", "search:\n  slack: 0.1"))
    poses = strict.grid.base_poses
    few, more = (set(GridSearch(m).free(0, poses).tolist()) for m in (strict, slack))
    assert few < more
    extra = slack.grid.configurations(sorted(more - few))
    assert not slack.are_free(extra).any()


def test_copies_many_cells_away_are_found():
    # A long body in a short, skew cell: the copy that it meets is 20 cells along c away.
    long = one_body("P1", "{lengths: [50, 50, 1.0], angles_deg: [90, 90, 90]}", [0.4, 0.4, 0.49])
    assert long.is_free([])
    cell = "{lengths: [4, 1, 60], angles_deg: [90, 90, 4]}"
    assert smallest_gap(one_body("P1", cell, [0.06, 0.06, 1.0]), [], reach=6) < 0.2
    for size in (0.02, 0.03, 0.034, 0.04, 0.06, 0.5):
        model = one_body("P1", cell, [size, size, 1.0])
        assert model.is_free([]) == (smallest_gap(model, [], reach=7) > 0), size


def test_a_body_on_a_symmetry_element_meets_itself():
    assert not one_body("p2", "{lengths: [9, 9]}", [1.0, 0.5]).is_free([])
    assert not one_body("P-1", "{lengths: [9, 9, 9]}", [1.0, 0.5, 0.2]).is_free([])


def test_freedom_is_that_of_the_whole_crystal_not_of_where_it_stands():
    model = model_from(CHAIN.format(group="P212121", cell="{lengths: [8, 9, 7.5]}", step=2.0))
    arrangements = draws(model, 200, 5)
    shifted = arrangements.copy()
    shifted[:, 0] += 4.0  # half a cell along a normalises the group
    shifted[:, 1] -= 3 * 7.5
    np.testing.assert_array_equal(model.are_free(arrangements), model.are_free(shifted))


def test_shifts_far_from_the_cell_are_refused():
    model = load_model("rabbit-p212121")
    arrangement = model.grid.configurations([0])
    arrangement[0, 0] = 1e18
    with pytest.raises(CrystalError, match=r"x = 1e\+18 is far from the cell"):
        model.are_free(arrangement)


# --- grids --------------------------------------------------------------------------------------


def test_the_spatial_rabbit_in_p1_has_the_known_number_of_free_arrangements():
    model = load_model("rabbit-p1")
    free = GridSearch(model).free(0, model.grid.base_poses)
    assert (model.grid.count, len(free)) == (944_784, 98_845)
    volume = np.pi * 4 / 3 * (6 * 6 * 8 + 2 * 2.5 * 2.5 * 6)
    assert model.molecule.volume == pytest.approx(volume)


@pytest.mark.slow
def test_the_spatial_rabbit_in_p212121_has_the_known_number_of_free_arrangements():
    model = load_model("rabbit-p212121")
    free = GridSearch(model).free(0, model.grid.base_poses)
    assert model.grid.count == 94_478_400
    assert len(free) == 1_190_318


@pytest.mark.parametrize(("group", "cell", "step"), CRYSTALS)
def test_the_pruned_search_finds_what_looking_at_each_arrangement_finds(group, cell, step):
    model = model_from(CHAIN.format(group=group, cell=cell, step=step))
    whole = model.are_free(model.grid.configurations(np.arange(model.grid.count)))
    found = GridSearch(model).free(0, model.grid.base_poses)
    np.testing.assert_array_equal(found, np.flatnonzero(whole))
    assert len(found) > 0


# A hand of two links that a fixed joint holds together: only one of them is joined to the arm.
FIXED_HAND = """\
format: 1
name: fixed hand
dimension: 2
group: p2
cell: {lengths: [9, 8], angles_deg: [80]}
molecule:
  links:
    - {name: thumb, parts: [{semi_axes: [0.2, 0.5], position: [-0.2, 1.1]}]}
    - {name: arm, parts: [{semi_axes: [1.5, 0.4]}]}
    - {name: palm, parts: [{semi_axes: [0.9, 0.5], position: [0.6, 0]}]}
  joints:
    - {name: glued, type: fixed, parent: palm, child: thumb}
    - {name: wrist, type: continuous, parent: arm, child: palm, origin: {position: [1.3, 0]}}
search:
  position: {x: {step: 1.5}}
  orientation: {yaw_deg: {step: 60}}
  joints: {wrist_deg: {lower: 0, upper: 360, step: 30}}
diffraction: {resolution: 2}
"""


def test_links_held_together_meet_others_each_by_its_own_rule():
    model = model_from(FIXED_HAND)
    whole = model.are_free(model.grid.configurations(np.arange(model.grid.count)))
    found = GridSearch(model).free(0, model.grid.base_poses)
    np.testing.assert_array_equal(found, np.flatnonzero(whole))
    gaps = [smallest_gap(model, q) for q in model.grid.configurations(np.arange(model.grid.count))]
    np.testing.assert_array_equal(whole, np.array(gaps) > 0)
    assert 0 < len(found) < model.grid.count


@pytest.mark.parametrize("wrong", [np.zeros((3, 6)), np.zeros(7), [], np.full((2, 7), np.nan)])
def test_arrangements_of_another_size_are_refused(wrong):
    with pytest.raises(CrystalError, match="expected configurations of"):
        load_model("rabbit-p1").are_free(wrong)


def test_joints_with_more_values_than_there_is_room_for_are_refused():
    text = CHAIN.format(group="P1", cell="{lengths: [9, 9, 9]}", step=3)
    model = model_from(text.replace("wrist_deg: {step: 100}", "wrist_deg: {step: 0.0001}"))
    with pytest.raises(CrystalError, match="larger steps for the joints"):
        GridSearch(model).free(0, 1)


def test_ranges_of_base_poses_add_up():
    search = GridSearch(load_model("rabbit-p1"))
    pieces = [search.free(first, first + 100) for first in range(0, 700, 100)]
    np.testing.assert_array_equal(np.concatenate(pieces), search.free(0, 700))
    assert len(search.free(5, 5)) == 0


def test_arrangements_are_numbered_as_their_configurations():
    model = load_model("rabbit-p1")
    counts = [len(r.values) for r in model.grid.ranges]
    assert math.prod(counts) == model.grid.count
    expected = itertools.islice(itertools.product(*[r.values for r in model.grid.ranges]), 5000)
    np.testing.assert_allclose(model.grid.configurations(np.arange(5000)), list(expected))
    cube = load_model("rabbit-p212121").grid
    assert cube.count == 94_478_400
    first, last = cube.configurations([0, cube.count - 1])
    np.testing.assert_allclose(first, [r.values[0] for r in cube.ranges])
    np.testing.assert_allclose(last, [r.values[-1] for r in cube.ranges])


def test_a_grid_of_all_rotations_serves_as_orientations():
    text = CHAIN.format(group="P212121", cell="{lengths: [8, 9, 7.5]}", step=4.0)
    start = text.index("  orientation:")
    end = text.index("  joints: {shoulder")
    model = model_from(
        text[:start] + "  orientation: {grid: 600-cell, resolution_deg: 40}\n" + text[end:]
    )
    found = GridSearch(model).free(0, model.grid.base_poses)
    sample = np.random.default_rng(0).integers(0, model.grid.count, 3000)
    free = model.are_free(model.grid.configurations(sample))
    np.testing.assert_array_equal(free, np.isin(sample, found))


def test_bundled_targets_are_free():
    for name in ("rabbit-plane", "rabbit-p1", "rabbit-p212121"):
        model = load_model(name)
        assert model.is_free(load_target(f"{name}-target", model))
