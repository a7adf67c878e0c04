"""What `plan` does with planners written in Python."""

from typing import Any, ClassVar

import numpy as np
import pytest
from ompl import base as ob

from ellipsoid_planning.errors import PlannerError
from planners import bindings, registry
from planners.registry import OwnPlanner
from planners.solve import plan
from planners.spaces import state_access
from tests.planners.planner_scenes import scenario_of

Statuses = ob.PlannerStatus.PlannerStatusType


class Scripted(ob.Planner):
    """Follows way points given as a parameter, or does whatever ``act`` says."""

    PARAMETERS: ClassVar[dict[str, Any]] = {"act": str, "seed": int, "anytime": bool}

    def __init__(self, si: ob.SpaceInformation) -> None:
        super().__init__(si, "Scripted")
        self.act, self.seed, self.anytime, self.error, self.warm = "solve", 0, False, None, False

    def warm_up(self) -> None:
        self.warm = True

    def check_parameters(self) -> None:
        if self.act == "bad":
            raise PlannerError("act: expected anything but 'bad'")

    @property
    def statistics(self) -> dict[str, Any]:
        return {"seed": self.seed, "anytime": self.anytime, "warm": self.warm, "build_time": 0.25}

    def solve(self, ptc: ob.PlannerTerminationCondition) -> ob.PlannerStatus:
        if self.act == "wait":
            while not ptc():
                pass
        if self.act == "crash":
            self.error = "Traceback:\n  somewhere\nValueError: the reason"
            return ob.PlannerStatus(Statuses.CRASH)
        if self.act == "raise":
            raise ValueError("an honest exception")
        if self.act != "solve":
            return ob.PlannerStatus(Statuses.TIMEOUT)
        si = self.getSpaceInformation()
        access = state_access(si.getStateValidityChecker().cspace)
        start = bindings.start_configurations(self, access)
        goal = bindings.goal_configurations(self, access)
        through = np.array([[-3.0, -3.2, 0.0], [3.0, -3.2, 0.0]])
        rows = np.vstack([start, through, goal])
        path = bindings.path_from_configurations(si, rows, access)
        self.getProblemDefinition().addSolutionPath(path, False, 0.0, self.getName())
        return ob.PlannerStatus(Statuses.EXACT_SOLUTION)


@pytest.fixture(autouse=True)
def scripted(monkeypatch):
    monkeypatch.setattr(OwnPlanner, "load", lambda _: Scripted)
    monkeypatch.setitem(registry._BY_NAME, "Scripted", OwnPlanner("Scripted", "here"))


def test_its_path_times_and_statistics_are_reported():
    result = plan(scenario_of("planar"), "Scripted", simplify=False, seed=9, anytime=True)
    assert result.status == "solved"
    assert result.path.certified
    assert len(result.path.configurations) == 4
    assert result.statistics == {"seed": 9, "anytime": True, "warm": True}
    assert result.time["build"] == 0.25
    assert result.time["search"] is None


def test_its_own_seed_parameter_comes_first():
    result = plan(scenario_of("planar"), "Scripted", seed=9, parameters={"seed": 4})
    assert (result.seed, result.statistics["seed"]) == (9, 4)


@pytest.mark.parametrize(("act", "status"), [("wait", "timeout"), ("give up", "exhausted")])
def test_giving_up_early_is_told_from_running_out_of_time(act, status):
    result = plan(scenario_of("planar"), "Scripted", time_limit=0.1, parameters={"act": act})
    assert result.status == status
    assert result.path is None


def test_a_bad_parameter_is_refused_before_solving():
    with pytest.raises(PlannerError, match="anything but 'bad'"):
        plan(scenario_of("planar"), "Scripted", parameters={"act": "bad"})


def test_a_crash_is_an_error_with_the_reason():
    with pytest.raises(PlannerError, match="Scripted failed: ValueError: the reason") as caught:
        plan(scenario_of("planar"), "Scripted", parameters={"act": "crash"})
    assert "somewhere" in str(caught.value.__cause__)


def test_an_exception_passes_through():
    with pytest.raises(ValueError, match="an honest exception"):
        plan(scenario_of("planar"), "Scripted", parameters={"act": "raise"})


def test_it_is_refused_with_the_fcl_checker():
    with pytest.raises(PlannerError, match="plug-in checker only"):
        plan(scenario_of("planar"), "Scripted", "fcl")
