"""Cases in a whole scene: states and motions, in the kernel and through OMPL."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob
from ompl import geometric as og

from benchmarks import dense
from benchmarks.scenes import Samples
from ellipsoid_planning.cspace.poses import interpolate
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.geometry.orientation import rotation_from_quaternion
from ellipsoid_planning.kernels import motion, validity
from planners.fcl import FclBodies
from planners.setup import simple_setup
from planners.spaces import state_space, write_configuration
from planners.validity import EllipsoidValidityChecker

Array = NDArray[np.float64]
Fields = tuple[str, str, int, Callable[[], Any]]

FINE = 10
"""A finer dense check looks at this many times more states than OMPL does by default."""


def scene_cases(given: Samples) -> list[Fields]:
    """(topic, method, operations, run) of everything that concerns the whole scene."""
    ours = simple_setup(given.scenario, "plugin", cspace=given.cspace)
    theirs = simple_setup(given.scenario, "fcl", cspace=given.cspace)
    return [
        *_states(given),
        *_states_through_ompl(given, ours, theirs),
        *_motions(given, theirs),
        *_motions_through_ompl(given, ours, theirs),
    ]


def _states(given: Samples) -> list[Fields]:
    topic, count = "validity of one state", len(given.states)
    cspace, bodies = given.cspace, FclBodies(given.cspace)
    poses, out = cspace.poses(given.states), np.empty(count, dtype=np.bool_)
    scene = dense.DenseScene(cspace.world, dense.sphere())
    placements = [_placement(pose) for pose in poses]
    placed = [cspace.robot.bodies_at(state) for state in given.states]

    def ours() -> Any:
        validity.are_free(cspace.scene, poses, out)
        return out

    def by_fcl() -> Any:
        return [not _collides(bodies, *placement) for placement in placements]

    def by_numpy() -> Any:
        return [scene.is_free(parts) for parts in placed]

    return [
        (topic, "this project", count, ours),
        (topic, "python-fcl with its broad phase, without the arena", count, by_fcl),
        (topic, f"numpy, {dense.DIRECTIONS} directions", count, by_numpy),
    ]


def _placement(pose: Array) -> tuple[Array, Array]:
    return rotation_from_quaternion(pose[3:]), pose[:3]


def _collides(bodies: FclBodies, rotation: Array, position: Array) -> bool:
    bodies.place(rotation, position)
    return bodies.collide()


def _ompl_states(setup: Any, rows: Array, cspace: CSpace) -> list[ob.State]:
    states = [setup.getSpaceInformation().allocState() for _ in rows]
    for state, row in zip(states, rows, strict=True):
        write_configuration(state, row, cspace)
    return states


def _states_through_ompl(given: Samples, ours: Any, theirs: Any) -> list[Fields]:
    topic, count = "validity of one state through OMPL", len(given.states)

    def checked(setup: Any) -> Callable[[], Any]:
        si, states = setup.getSpaceInformation(), _ompl_states(setup, given.states, given.cspace)
        return lambda: [si.isValid(state) for state in states]

    return [
        (topic, "this project", count, checked(ours)),
        (topic, "python-fcl", count, checked(theirs)),
    ]


def _motions(given: Samples, setup: Any) -> list[Fields]:
    topic, count, cspace = "validity of one motion", len(given.first), given.cspace
    begin, end = cspace.poses(given.first), cspace.poses(given.last)
    proofs, bodies = np.empty(count, dtype=np.int64), FclBodies(cspace)
    coarse, fine = _along(given, setup, 1), _along(given, setup, FINE)

    placements = [[_placement(pose) for pose in poses] for poses in coarse]

    def ours() -> Any:
        motion.motions_are_free(cspace.scene, begin, end, proofs)
        return proofs > 0

    def by_fcl() -> Any:
        return [not any(_collides(bodies, *at) for at in places) for places in placements]

    return [
        (topic, "this project", count, ours),
        (topic, "our own check at OMPL's resolution", count, _sampled(cspace.scene, coarse)),
        (topic, f"our own check, {FINE} times finer", count, _sampled(cspace.scene, fine)),
        (topic, "python-fcl at OMPL's resolution, without the arena", count, by_fcl),
    ]


def _along(given: Samples, setup: Any, finer: int) -> list[Array]:
    """Poses of the states that a discrete check of each motion looks at."""
    space, robot = setup.getSpaceInformation().getStateSpace(), given.cspace.robot
    first = _ompl_states(setup, given.first, given.cspace)
    last = _ompl_states(setup, given.last, given.cspace)
    found = []
    for k in range(len(first)):
        count = finer * space.validSegmentCount(first[k], last[k])
        places = (np.arange(count) + 1.0) / count
        rows = [interpolate(robot, given.first[k], given.last[k], s) for s in places]
        found.append(given.cspace.poses(np.array(rows)))
    return found


def _sampled(scene: Array, motions: list[Array]) -> Callable[[], Any]:
    out = np.empty(max(map(len, motions)), dtype=np.bool_)

    def run() -> Any:
        found = []
        for poses in motions:
            validity.are_free(scene, poses, out)
            found.append(out[: len(poses)].all())
        return found

    return run


def _motions_through_ompl(given: Samples, ours: Any, theirs: Any) -> list[Fields]:
    topic, count = "validity of one motion through OMPL", len(given.first)

    def checked(setup: Any) -> Callable[[], Any]:
        si = setup.getSpaceInformation()
        first = _ompl_states(setup, given.first, given.cspace)
        last = _ompl_states(setup, given.last, given.cspace)
        return lambda: [si.checkMotion(a, b) for a, b in zip(first, last, strict=True)]

    return [
        (topic, "this project", count, checked(ours)),
        (topic, "our own check at OMPL's resolution", count, checked(_discrete(given.cspace))),
        (topic, "python-fcl at OMPL's resolution", count, checked(theirs)),
    ]


def _discrete(cspace: CSpace) -> Any:
    """Our own checker under OMPL's own motion validator, at its default resolution."""
    si = ob.SpaceInformation(state_space(cspace))
    si.setStateValidityChecker(EllipsoidValidityChecker(si, cspace))
    si.setup()
    return og.SimpleSetup(si)
