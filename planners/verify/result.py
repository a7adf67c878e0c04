"""Asks of a result everything that a path must keep and everything that the result states."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.result import PathResult, PlanResult
from ellipsoid_planning.scenario import Scenario
from planners.verify.body_checks import (
    body_checks,
    open_checks,
    smallest_clearance,
    stated_check,
)
from planners.verify.coordinates import Turn, coordinates
from planners.verify.fcl_agreement import fcl_contacts
from planners.verify.judged import described, differences, mismatch
from planners.verify.motion import lengths
from planners.verify.report import Check, VerificationReport
from planners.verify.sampling import sample_path, sample_path_itself
from planners.verify.whole_motions import WholeMotions, prove_motions

Array = NDArray[np.float64]

SAME_STATE = 1e-9
"""How far states may differ that should be the same, as a fraction of the scene's size."""

SAME_LENGTH = 1e-6
ROUNDING = 1e-12

_NEARLY = 0.99  # of a stated clearance is proved; all of it would take for ever


def verify_result(result: PlanResult, scenario: Scenario | None = None) -> VerificationReport:
    """Check a result's path, independently of the kernels.

    Samples look for contacts and measure the clearance; between them `whole_motions` proves that
    nothing is met, and says so where it cannot. A contact, a lost clearance or an overstated one
    fails only when it is certain beyond rounding; so does everything else.

    Args:
        result: what a planner found.
        scenario: what to judge it against; by default the scenario that the result carries.
    """
    against = _against(result.scenario, scenario)
    judged = result.scenario if scenario is None else scenario
    if result.path is None:
        missing = Check("path", passed=False, detail=f"there is none, status {result.status!r}")
        return VerificationReport((missing,), scenario=against)
    problem = mismatch(result.scenario, judged)
    if problem is not None:
        return VerificationReport((Check("robot", passed=False, detail=problem),), scenario=against)
    path, size = result.path.configurations, _size(judged)
    states = [*_state_checks(judged, path, size), _length_check(result.scenario, result.path)]
    return _judged(judged, result.path, states, against, size)


def _against(carried: Scenario, given: Scenario | None) -> str:
    if given is None:
        return f"the result's own, {described(carried)}; --scenario judges it against yours"
    different = differences(carried, given)
    note = f"; the result's own has other {', '.join(different)}" if different else ""
    return f"yours, {described(given)}{note}"


def _judged(
    scenario: Scenario, stated: PathResult, states: list[Check], against: str, size: float
) -> VerificationReport:
    """The report on a path, given the checks that only look at its states."""
    path = stated.configurations
    sampled, itself = sample_path(scenario, path), sample_path_itself(scenario, path)
    tested, contacts = fcl_contacts(scenario, sampled.configurations, sampled.lower, size)
    samples = len(sampled.configurations)
    if itself is not None:
        rows, lower = itself.configurations, itself.lower
        more, found = fcl_contacts(scenario, rows, lower, size, itself=True)
        tested, contacts, samples = tested + more, contacts + found, samples + len(rows)
    whole = prove_motions(scenario, path, _needed(scenario.clearance, size))
    bodies = body_checks(sampled, itself, whole)
    agreement = Check("FCL", contacts == 0, f"sees {contacts} contacts in {tested} configurations")
    smallest, place = smallest_clearance(sampled, whole)
    clearances = list(_clearance_checks(scenario, stated, (smallest, place), whole, size))
    # A clearance that is lost for certain leaves nothing open.
    between = open_checks(whole) if clearances[0].passed else ()
    return VerificationReport(
        (*states, *bodies, *clearances, *between, agreement),
        samples=samples,
        sampled_clearance=smallest,
        resolved=whole.resolved,
        fcl_samples=tested,
        scenario=against,
    )


def _needed(clearance: float, size: float) -> float:
    """The clearance to prove; what rounding hides of a required one is not missed."""
    return max(clearance - ROUNDING * size, 0.0)


def _size(scenario: Scenario) -> float:
    """The length that tolerances refer to: the longest extent of anything in the scene."""
    bodies = (*scenario.world.arenas, *scenario.world.obstacles)
    reaches = [float(np.max(np.abs(body.centre)) + np.max(body.semi_axes)) for body in bodies]
    return max([float(np.max(scenario.world.high - scenario.world.low)), *reaches])


def _state_checks(scenario: Scenario, path: Array, size: float) -> Iterator[Check]:
    for which, state, wanted in (
        ("start", path[0], scenario.start),
        ("goal", path[-1], scenario.goal),
    ):
        apart = _apart(scenario, state, wanted)
        yield Check(which, apart <= SAME_STATE * size, f"{apart:.3g} from the scenario's")
    known = coordinates(scenario.robot)
    if known.quaternions:
        norms = [np.linalg.norm(path[:, turn.place], axis=1) for turn in known.quaternions]
        error = float(np.max(np.abs(np.array(norms) - 1.0)))
        yield Check("quaternions", error <= SAME_STATE, f"of unit length within {error:.3g}")
    base = path[:, : known.position]
    low, high = scenario.world.low[: known.position], scenario.world.high[: known.position]
    worst = float(np.max(np.maximum(low - base, base - high), initial=-np.inf))
    passed = worst <= ROUNDING * size
    yield Check("bounds", passed, f"beyond them by {worst:.6g}" if not passed else "kept")
    joints = [turn for turn in (*known.numbers, *known.angles) if turn.joint]
    if joints:
        yield _limit_check(path, joints)


def _limit_check(path: Array, joints: list[Turn]) -> Check:
    """Joints move between their values at states, so that states tell it all."""
    worst, name = -np.inf, ""
    for joint in joints:
        values = path[:, joint.place]
        beyond = float(np.max(np.maximum(joint.lower - values, values - joint.upper)))
        if beyond > worst:
            worst, name = beyond, joint.joint
    passed = worst <= SAME_STATE
    detail = "kept" if passed else f"joint {name!r} is beyond its own by {worst:.6g}"
    return Check("limits", passed, detail)


def _apart(scenario: Scenario, one: Array, other: Array) -> float:
    """How far apart two configurations are, with turns in radians."""
    return lengths(scenario.robot, np.array([one, other]))[0]


def _length_check(scenario: Scenario, path: PathResult) -> Check:
    length, travel = lengths(scenario.robot, path.configurations)
    error = max(abs(path.length - length), abs(path.base_travel - travel))
    detail = f"stated {path.length:.9g}, measured {length:.9g}"
    return Check("length", error <= SAME_LENGTH * (1.0 + length), detail)


def _clearance_checks(
    scenario: Scenario,
    stated: PathResult,
    found: tuple[float, str],
    whole: WholeMotions,
    size: float,
) -> Iterator[Check]:
    smallest, place = found
    doubt = ROUNDING * size
    kept = smallest >= scenario.clearance - doubt
    detail = f"{smallest:.9g} {place}, required {scenario.clearance:g}"
    yield Check("clearance", kept, detail)
    least = stated.min_clearance
    detail = f"stated at least {least:.9g}, sampled {smallest:.9g}"
    honest = least <= smallest + doubt
    needed = _NEARLY * least
    if honest and whole.proved and _needed(scenario.clearance, size) < needed < np.inf:
        proof = prove_motions(scenario, stated.configurations, needed, itself=False)
        yield stated_check(proof, least, detail, doubt)
    else:
        yield Check("stated clearance", honest, detail)
