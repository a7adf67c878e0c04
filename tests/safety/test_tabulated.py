"""Tabulated safety functions: never wrong, the same answers as the exact one, found as they say."""

import math

import numpy as np
import pytest

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.errors import GeometryError, TableError
from ellipsoid_planning.geometry import Ellipsoid
from ellipsoid_planning.geometry.orientation import rotation_from_quaternion
from ellipsoid_planning.geometry.rows import body_rows, placed_row
from ellipsoid_planning.kernels import kinematics, layout, safety_table
from ellipsoid_planning.kernels.separation import DECIDE, separation
from ellipsoid_planning.robots import RigidRobot
from ellipsoid_planning.safety import ExactSafety, TableParameters, TabulatedSafety
from ellipsoid_planning.safety.build import fill_tables, table_scene
from ellipsoid_planning.safety.planning import plan_tables
from ellipsoid_planning.world import World
from tests.random_trees import random_configuration, random_tree
from tests.safety.scenes import COARSE, KINDS, crowd, crowded, near_contact, rigid, robot, states


@pytest.mark.parametrize("arena", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_answers_are_those_of_the_exact_function(kind, arena):
    cspace = crowded(kind, arena)
    safety, exact = TabulatedSafety(cspace, COARSE, keep=False), ExactSafety(cspace)
    drawn = np.concatenate([states(cspace, 1500), near_contact(cspace, 15)])
    found = safety.are_safe(drawn)
    assert np.array_equal(found, exact.are_safe(drawn))
    assert 10 < found.sum() < len(drawn)
    assert safety.is_safe(drawn[0]) == found[0]
    assert safety.answers(drawn).mean() > 0.1


@pytest.mark.parametrize("base", ["free", "translating", "fixed"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_trees_of_links_of_several_parts_are_answered_as_exactly(dimension, base):
    rng, open_ = np.random.default_rng([dimension, len(base)]), 0
    for seed in range(4):
        own = random_tree(rng, dimension, base)
        cspace = CSpace(crowd(dimension, 12, arena=seed == 3, seed=seed), own)
        safety = TabulatedSafety(cspace, COARSE, keep=False)
        drawn = np.array([random_configuration(rng, own) for _ in range(300)])
        assert np.array_equal(safety.are_safe(drawn), cspace.are_valid(drawn))
        answers = safety.answers(drawn)
        for row, safe in zip(drawn, answers, strict=True):
            bodies = own.bodies_at(row)
            for parts in (
                m for m, proved in zip(safety._plan.members, safe, strict=True) if proved
            ):
                assert all(_is_clear(cspace, bodies[i]) for i in parts)
        open_ += int(answers.sum())
    assert open_ > 100


@pytest.mark.parametrize("ratio", [1e3, 1e6])
@pytest.mark.parametrize("dimension", [2, 3])
def test_needles_among_needles_and_discs(dimension, ratio):
    thin, world = [1.0, 1.0 / ratio, 1.0 / ratio][:dimension], crowd(dimension, 15)
    wide = np.array([2.0 / ratio, 2.0, 2.0][:dimension])
    bodies = tuple(Ellipsoid(body.centre, body.rotation, wide) for body in world.obstacles)
    robot_ = RigidRobot((Ellipsoid.from_semi_axes(thin),))
    cspace = CSpace(World(world.low, world.high, bodies), robot_)
    safety = TabulatedSafety(cspace, COARSE, keep=False)
    drawn = np.concatenate([states(cspace, 500), near_contact(cspace, 5)])
    assert np.array_equal(safety.are_safe(drawn), cspace.are_valid(drawn))
    for row, safe in zip(drawn, safety.answers(drawn), strict=True):
        assert not safe[0] or _is_clear(cspace, cspace.robot.bodies_at(row)[0])


@pytest.mark.parametrize("clearance", [0.0, 0.05])
@pytest.mark.parametrize("kind", KINDS)
def test_no_link_is_called_safe_that_is_not(kind, clearance):
    cspace = crowded(kind, arena=kind in ("snake", "chain", "dumbbells"), clearance=clearance)
    safety = TabulatedSafety(cspace, TableParameters(memory=3000), keep=False)
    drawn = np.concatenate([states(cspace, 600, seed=9), near_contact(cspace, 10, seed=11)])
    answers = safety.answers(drawn)
    assert answers.any()
    members = safety._plan.members
    for row, safe in zip(drawn, answers, strict=True):
        bodies = cspace.robot.bodies_at(row)
        for own in (own for own, proved in zip(members, safe, strict=True) if proved):
            assert all(_is_clear(cspace, bodies[i]) for i in own)


def _is_clear(cspace, body):
    """Whether a part keeps the clearance from all obstacles and arenas, without a broad phase."""
    placed, obstacles = placed_row(body)[None], body_rows(cspace.world.obstacles)
    for j in range(len(obstacles)):
        if not separation(obstacles, j, placed, 0, 0.5, cspace.clearance_required, DECIDE)[0] > (
            cspace.clearance_required
        ):
            return False
    points = body.surface_points(300)
    return all(bool(np.all(arena.contains(points))) for arena in cspace.world.arenas)


@pytest.mark.parametrize("kind", ["snake", "chain", "spheroids", "dumbbells", "mixed spatial"])
def test_fcl_finds_no_contact_of_links_that_are_called_safe(kind):
    fcl = pytest.importorskip("planners.fcl")
    cspace = crowded(kind)
    safety, bodies = TabulatedSafety(cspace, COARSE, keep=False), fcl.FclBodies(cspace)
    drawn = np.concatenate([states(cspace, 400), near_contact(cspace, 10)])
    proved = safety.answers(drawn).all(axis=1)
    assert proved.sum() > 10
    for row in drawn[proved]:
        bodies.place_at(row)
        assert not bodies.meets_obstacle()


@pytest.mark.parametrize("kind", KINDS)
def test_looking_up_by_hand_gives_the_same(kind):
    cspace = crowded(kind)
    safety = TabulatedSafety(cspace, COARSE, keep=False)
    drawn = states(cspace, 60)
    rows, frames = cspace.poses(drawn), kinematics.new_frames(safety.kinematics)
    for row, found in zip(rows, safety.answers(drawn), strict=True):
        kinematics.body_frames(safety.kinematics, row, frames)
        assert [_slow_look_up(safety, b, frames[b]) for b in range(len(found))] == list(found)


def _slow_look_up(safety, body, frame):
    """The same from the tables themselves, the cell found by the nearest representative."""
    index, placed = safety._plan.table_of[body], safety._plan.shapes[body]
    if index < 0:
        return False
    table = safety.tables[index]
    plan, found = table.plan, table.plan.resolution
    rotation, at = frame[:9].reshape(3, 3), frame[9:12]
    middle = at + rotation @ placed.middle
    if np.any(middle < plan.safe_low) or np.any(middle > plan.safe_high):
        return True
    grid, lines = found.orientations, found.lines
    if np.any(middle < lines.low) or np.any(middle >= lines.high):
        return False
    link = safety_table.link_rows(safety.book)[body]
    row = safety_table.table_rows(safety.book)[index]
    cell = safety_table.orientation_cell(row, link, frame)
    # The cell holds the orientation: a representative within the radius of it.
    if grid.vector > 1:
        own, own_turn = rotation @ placed.turn, rotation_from_quaternion(grid.quaternions()[cell])
        assert _difference(own, own_turn, grid) <= grid.radius()
    steps = ((middle - lines.low) / lines.spacing).astype(int)
    steps[lines.axis] = 0
    number = int(np.ravel_multi_index(tuple(steps), lines.counts))
    number += cell * lines.count
    ticks = table.intervals[table.offsets[number] : table.offsets[number + 1]].astype(float)
    ends = lines.low[lines.axis] + ticks / plan.ticks_per_length
    return bool(np.any((ends[:, 0] < middle[lines.axis]) & (middle[lines.axis] < ends[:, 1])))


def _difference(first, second, grid):
    """Angle between two rotations, up to the symmetries that a grid knows."""
    if grid.vector < 4:
        column = 0 if grid.vector == 2 else 2
        cosine = float(first[:, column] @ second[:, column])
        cosine = abs(cosine) if grid.faces == grid.vector else cosine
        return math.acos(min(1.0, max(-1.0, cosine))) - 1e-7
    turns = [np.eye(3)]
    if grid.faces == 1:
        turns += [np.diag(signs) for signs in ([1, -1, -1], [-1, 1, -1], [-1, -1, 1])]
    cosine = max(0.5 * (np.trace(first @ turn @ second.T) - 1.0) for turn in turns)
    return math.acos(min(1.0, max(-1.0, cosine))) - 1e-7


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("rotates", [True, False])
def test_rigid_robots_are_robots_of_one_link(dimension, rotates):
    cspace = rigid(dimension, rotates)
    safety = TabulatedSafety(cspace, COARSE, keep=False)
    drawn = states(cspace, 1500)
    assert np.array_equal(safety.are_safe(drawn), cspace.are_valid(drawn))
    assert (safety.tables[0].plan.resolution.orientations.count == 1) == (not rotates)


def test_worlds_without_obstacles_need_no_lines():
    own = robot("snake")
    cspace = CSpace(World([-7.0, -7.0], [7.0, 7.0]), own)
    safety = TabulatedSafety(cspace, COARSE, keep=False)
    drawn = states(cspace, 300)
    assert safety.answers(drawn).all() and safety.report().memory < 10
    assert np.array_equal(safety.are_safe(drawn), cspace.are_valid(drawn))


def test_an_inflation_that_leaves_nothing_of_an_arena_leaves_everything_to_the_exact_test():
    cspace = crowded("spheroids", arena=True)
    small = World(cspace.world.low, cspace.world.high, (), (cspace.world.arenas[0],))
    tight = CSpace(small, cspace.robot, clearance=7.4)
    safety = TabulatedSafety(tight, COARSE, keep=False)
    assert table_scene(safety.tables[0].plan) is None
    assert not safety.answers(states(tight, 50)).any()


def test_states_that_are_none_are_unsafe():
    cspace = crowded("snake")
    safety = TabulatedSafety(cspace, COARSE, keep=False)
    row = next(row for row in states(cspace, 200) if safety.is_safe(row))
    for place in range(len(row)):
        for value in (math.nan, math.inf, 1e3):
            spoilt = row.copy()
            spoilt[place] = value
            if not math.isfinite(value):
                with pytest.raises(GeometryError):
                    safety.is_safe(spoilt)
            else:
                assert not safety.is_safe(spoilt) or place == 2


def test_the_number_of_threads_changes_nothing_and_progress_is_told():
    plans = plan_tables(crowded("chain"), TableParameters(memory=300_000)).tables
    told = []
    one = fill_tables(plans, 1, lambda done, total: told.append((done, total)))
    two = fill_tables(plans, 2)
    for first, second in zip(one, two, strict=True):
        assert first.offsets.tobytes() == second.offsets.tobytes()
        assert first.intervals.tobytes() == second.intervals.tobytes()
    total = sum(plan.size for plan in plans)
    assert told[-1] == (total, total) and sorted(told) == told and len(told) > 3


def test_finer_tables_answer_more():
    cspace = crowded("spheroids")
    drawn = states(cspace, 2000)
    drawn = drawn[cspace.are_valid(drawn)]
    answered = []
    for memory in (2_000, 20_000, 200_000):
        report = TabulatedSafety(cspace, TableParameters(memory=memory), keep=False).report(drawn)
        assert 0.3 * memory < report.memory < 3.0 * memory
        assert report.safe == 1.0 and report.states == len(drawn)
        assert min(report.lookup_time, report.state_time, report.exact_time) > 0.0
        answered.append(report.answered)
    assert answered == sorted(answered) and answered[-1] > 0.8


@pytest.mark.parametrize("values", [{"orientations": 0}, {"lines": -1}, {"memory": 0.5}])
def test_resolutions_that_are_none_are_refused(values):
    with pytest.raises(TableError, match="expected a positive whole number"):
        TableParameters(**values)


def test_tables_that_no_memory_holds_are_refused():
    with pytest.raises(TableError, match="expected at most"):
        TabulatedSafety(
            crowded("chain"), TableParameters(orientations=10**5, lines=10**5), keep=False
        )
    with pytest.raises(TableError, match="workers: expected"):
        fill_tables((), 0)


def test_intervals_of_a_table_keep_the_inflation():
    cspace = crowded("spheroids")
    plan = plan_tables(cspace, COARSE).tables[0]
    scene = table_scene(plan)
    assert scene[layout.CLEARANCE] > plan.resolution.inflation
