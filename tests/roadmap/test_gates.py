"""Gates of whole worlds against dense boundaries: which there are, where, and what they cost."""

import itertools

import numpy as np
import pytest
from scipy.optimize import minimize

from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import centring
from ellipsoid_planning.roadmap.gates import GateFinder, probe
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.world import World
from tests.oracles import body_of, signed_gaps, sphere_grid
from tests.random_scenes import rotation, semi_axes, unit_vector
from tests.roadmap.scenes import body


def space(obstacles, parts, arenas=(), *, rotates=False):
    n = parts[0].dimension
    world = World(np.full(n, -50.0), np.full(n, 50.0), tuple(obstacles), tuple(arenas))
    return CSpace(world, RigidRobot(tuple(parts), rotates=rotates))


def gates_of(cspace, widest=1.0):
    """Gates, how many combinations were looked at, and how many pairs of bodies."""
    work = centring.new_workspace(cspace.scene)
    finder = GateFinder(cspace, *probe(cspace), widest, work)
    bodies = list(range(len(cspace.world.obstacles)))
    found = list(finder.gates(bodies, np.full(3, -1.0), np.full(3, 1.0)))
    gates = [gate for gate in found if gate is not None]
    for gate in gates:
        assert np.isfinite(gate.point).all()
        assert np.isfinite(gate.gap)
        np.testing.assert_allclose(np.linalg.norm(gate.normals, axis=1), 1.0, atol=1e-9)
    return gates, len(found), int(work.pairs[0])


def gaps_at(cspace, point):
    """Gaps (parts, obstacles) of a robot that does not turn."""
    gaps = []
    for part in cspace.robot.bodies_at(point):
        pairs = [(body_of(b), body_of(part)) for b in cspace.world.obstacles]
        c = np.array([p.centre - b.centre for b, p in pairs])
        a1, a2 = (np.array([pair[k].matrix for pair in pairs]) for k in (0, 1))
        gaps.append(signed_gaps(c, a1, a2)[0])
    return np.array(gaps)


def sums_boundaries(cspace, count):
    """Boundary points (count, n) of every C-obstacle, by (part, obstacle)."""
    n = cspace.dimension
    u = sphere_grid(count, n)
    return {
        (i, j): b.support_points(u)
        + part.transform(np.eye(n), -part.centre).support_points(u)
        - part.centre
        for (i, part), (j, b) in itertools.product(
            enumerate(cspace.robot.parts), enumerate(cspace.world.obstacles)
        )
    }


def closest_pairs(cspace, widest, count=600):
    """Half the distance of every two C-obstacles that are apart, and their midpoints."""
    found = []
    sums = sums_boundaries(cspace, count)
    for (first, one), (second, other) in itertools.combinations(sums.items(), 2):
        apart = np.linalg.norm(one[:, None] - other[None], axis=2)
        a, b = np.unravel_index(np.argmin(apart), apart.shape)
        middle = 0.5 * (one[a] + other[b])
        gaps = gaps_at(cspace, middle)
        # Boundaries that cross come near to each other too.
        if min(gaps[first], gaps[second]) > 1e-2 and 0.5 * apart[a, b] < widest:
            found.append((0.5 * apart[a, b], middle))
    return found


def random_bodies(rng, n, count, spread, size=(0.5, 1.5)):
    return [
        body(
            rng.uniform(*size) * semi_axes(rng, n, "mild", 3.0),
            rng.uniform(-spread, spread, n),
            rotation(rng, n),
        )
        for _ in range(count)
    ]


@pytest.mark.parametrize("parts", [1, 2])
@pytest.mark.parametrize("seed", [1, 2])
def test_planar_gates_are_half_way_between_closest_points(parts, seed):
    """Part i against body a and part j against body b, in every combination."""
    rng = np.random.default_rng(seed)
    robot = random_bodies(rng, 2, parts, 0.8, (0.3, 0.5))
    cspace = space(random_bodies(rng, 2, 6, 4.0), robot)
    expected = closest_pairs(cspace, 0.9)
    gates, _, _ = gates_of(cspace)
    assert len(expected) >= 3
    for gap, point in expected:
        near = [
            gate
            for gate in gates
            if abs(gate.gap - gap) < 2e-3 and np.linalg.norm(gate.point[:2] - point) < 0.1
        ]
        assert near, (gap, point)
    for gate in gates:
        gaps = gaps_at(cspace, gate.point[:2])
        # Two of the gaps there are the gate's.
        assert np.sum(np.abs(gaps - gate.gap) < 1e-3 + 2e-3 * gate.gap) >= 2
        assert gate.point[2] == 0.0


@pytest.mark.parametrize("rotates", [True, False])
def test_three_spheres_leave_a_hole_that_no_pair_sees(rotates):
    angles = np.radians([90, 210, 330])
    far = 1.9 / np.sqrt(3)
    spheres = [body(np.ones(3), far * np.array([np.cos(t), np.sin(t), 0.0])) for t in angles]
    cspace = space(spheres, [body([0.05, 0.05, 0.05])], rotates=rotates)
    gates, _, _ = gates_of(cspace)
    assert len(gates) == 1
    assert len(gates[0].normals) == 3
    assert gates[0].gap == pytest.approx(far - 1.05, rel=1e-6)
    np.testing.assert_allclose(gates[0].point, 0.0, atol=1e-4)


def smallest_ball(cspace, bodies):
    """The least largest gap of some bodies, by scipy, and all their gaps there, and where."""

    (part,) = cspace.robot.parts
    obstacles = [cspace.world.obstacles[k] for k in bodies]
    centres = np.array([obstacle.centre for obstacle in obstacles])
    a1 = np.array([obstacle.matrix for obstacle in obstacles])
    a2 = np.broadcast_to(part.matrix, a1.shape)

    def gaps(x):
        return signed_gaps(x[:3] + part.centre - centres, a1, a2)

    start = centres.mean(axis=0)
    found = minimize(
        lambda x: x[3],
        np.append(start, gaps(start)[0].max()),
        jac=lambda _: np.eye(4)[3],
        constraints={
            "type": "ineq",
            "fun": lambda x: x[3] - gaps(x)[0],
            "jac": lambda x: np.column_stack([-gaps(x)[1], np.ones(len(bodies))]),
        },
        method="SLSQP",
        options={"ftol": 1e-12, "maxiter": 100},
    )
    return float(found.x[3]), gaps(found.x)[0], found.x[:3]


def test_spatial_gates_are_centres_of_smallest_balls():
    triples = 0
    for seed in (3, 4):
        rng = np.random.default_rng(seed)
        cspace = space(random_bodies(rng, 3, 7, 1.8), [body([0.2, 0.1, 0.15])])
        gates, _, _ = gates_of(cspace, 0.6)
        for gate in gates:
            near = np.abs(gaps_at(cspace, gate.point) - gate.gap) < 3e-3
            assert near.sum() >= len(gate.normals)
        for count in (2, 3):
            for bodies in itertools.combinations(range(7), count):
                gap, gaps, point = smallest_ball(cspace, list(bodies))
                # Only what is a gate beyond doubt: open, not wide, and bounded by all of them.
                if not 0.01 < gap < 0.59 or gaps.min() < (1 - 1e-6) * gap:
                    continue
                triples += count == 3
                assert any(
                    abs(gate.gap - gap) < 1e-4 and np.linalg.norm(gate.point - point) < 1e-2
                    for gate in gates
                ), (bodies, gap)
    assert triples >= 4


def test_a_robot_that_turns_has_the_gates_of_a_ball_within_it():
    gap = 0.3
    bodies = [body([1.0, 2.0], [x, 0.0]) for x in (-1.0 - gap, 1.0 + gap)]
    cspace = space(bodies, [body([0.8, 0.1]), body([0.5, 0.2], [0.5, 0.0])], rotates=True)
    gates, _, _ = gates_of(cspace)
    assert len(gates) == 1
    assert gates[0].gap == pytest.approx(gap - 0.2, rel=1e-6)
    np.testing.assert_allclose(gates[0].point, 0.0, atol=1e-4)


# --------------------------------------------------------------------------- arenas


def narrowest_at_the_wall(arena, obstacle, radius, count=60_000):
    """Local minima of the width of the way between an obstacle and a wall, and their middles."""
    angle = np.linspace(0, 2 * np.pi, 4001)[:-1]
    inner = obstacle.support_points(np.column_stack([np.cos(angle), np.sin(angle)]))
    turn = np.linspace(0, 2 * np.pi, count // 10, endpoint=False)
    wall = arena.centre + np.column_stack([np.cos(turn), np.sin(turn)]) @ arena.matrix.T
    chunks = [
        np.linalg.norm(inner[k : k + 200, None] - wall[None], axis=2)
        for k in range(0, len(inner), 200)
    ]
    away = np.concatenate([chunk.min(axis=1) for chunk in chunks])
    foot = np.concatenate([wall[chunk.argmin(axis=1)] for chunk in chunks])
    lowest = (away < np.roll(away, 1)) & (away <= np.roll(away, -1))
    return [(0.5 * away[k] - radius, 0.5 * (inner[k] + foot[k])) for k in np.flatnonzero(lowest)]


@pytest.mark.parametrize("turn", [0.0, 0.4, 1.2])
def test_planar_gates_at_a_wall_are_near_the_narrowest_places(turn):
    arena = body([6.0, 4.0], [0.3, -0.2], turn)
    for place, axes in (([0.5, 1.5], [2.0, 1.0]), ([2.5, 0.0], [0.9, 2.5])):
        obstacle = body(axes, place, 0.3)
        radius = 0.1
        cspace = space([obstacle], [body([radius, radius])], [arena])
        gates, _, _ = gates_of(cspace, 2.0)
        expected = narrowest_at_the_wall(arena, obstacle, radius)
        expected = [(gap, point) for gap, point in expected if gap < 1.5]
        assert expected
        for gap, point in expected:
            # Directions are tried that are six degrees apart.
            assert any(
                abs(gate.gap - gap) < 0.1 and np.linalg.norm(gate.point[:2] - point) < 0.3
                for gate in gates
            ), (gap, point)


def test_a_spatial_gate_at_a_wall():
    """A ball over the bottom of a bowl leaves its narrowest way right below itself."""
    arena = body([5.0, 4.0, 3.0])
    for gap in (0.02, 0.2):
        radius = 0.15
        ball = body([0.8, 0.8, 0.8], [0.0, 0.0, -2.2 + 2 * gap + 2 * radius])
        cspace = space([ball], [body(np.full(3, radius))], [arena])
        gates, _, _ = gates_of(cspace)
        below = np.array([0.0, 0.0, -3.0 + gap + radius])
        assert min(np.linalg.norm(gate.point - below) for gate in gates) <= 0.4
        assert min(abs(gate.gap - gap) for gate in gates) <= 0.1


# --------------------------------------------------------------------------- none, and cost


@pytest.mark.parametrize("n", [2, 3])
def test_bodies_that_overlap_have_no_gates(n):
    bodies = [body(np.ones(n), 0.3 * unit_vector(np.random.default_rng(4), n)) for _ in range(3)]
    same = [bodies[0]] * 3
    for obstacles in (bodies, same):
        gates, _, looked = gates_of(space(obstacles, [body(np.full(n, 0.1))]))
        assert gates == []
        assert looked <= 500


@pytest.mark.parametrize("n", [2, 3])
def test_bodies_that_are_far_from_each_other_cost_nothing(n):
    rng = np.random.default_rng(5)
    ticks = np.arange(-40, 41, 20.0)
    places = np.stack(np.meshgrid(*[ticks] * n), axis=-1).reshape(-1, n)
    obstacles = [body(rng.uniform(0.5, 1.5, n), place) for place in places]
    gates, tried, looked = gates_of(space(obstacles, [body(np.full(n, 0.3))]), widest=1.0)
    assert (gates, tried, looked) == ([], 0, 0)


@pytest.mark.parametrize("n", [2, 3])
def test_gates_wider_than_asked_for_are_left_out(n):
    obstacles = [body(np.ones(n), [x, *[0.0] * (n - 1)]) for x in (-2.0, 2.0)]
    cspace = space(obstacles, [body(np.full(n, 0.5))])
    assert gates_of(cspace, widest=0.49)[0] == []
    (gate,) = gates_of(cspace, widest=0.51)[0]
    assert gate.gap == pytest.approx(0.5, rel=1e-6)


def test_no_bodies_no_gates():
    assert gates_of(space([], [body([0.5, 0.4])], [body([3.0, 2.0])]))[:2] == ([], 0)
