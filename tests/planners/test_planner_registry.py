"""Names and parameters of planners."""

import pytest
from ompl import geometric as og

from ellipsoid_planning.errors import PlannerError
from planners.bindings import ompl_output
from planners.registry import (
    BoundPlanner,
    OwnPlanner,
    checked_parameters,
    find_planner,
    planner_names,
)
from tests.planners.planner_scenes import scenario_of, space_information

BOUND = [name for name in planner_names() if isinstance(find_planner(name), BoundPlanner)]

WITHOUT_EFFECT = {  # OMPL says so itself, or forbids the inherited setter
    "BITstar": {"setStrictQueueOrdering", "setDelayRewiringUntilInitialSolution"},
    "PRMstar": {"setMaxNearestNeighbors"},
}


def test_every_bound_planner_is_listed():
    bound = {name for name in dir(og) if hasattr(getattr(og, name), "solve")} - {"SimpleSetup"}
    assert bound == set(BOUND)


@pytest.mark.parametrize(
    ("name", "parameter"),
    [(name, parameter) for name in BOUND for parameter in find_planner(name).parameter_kinds()],
)
def test_every_parameter_reaches_its_planner(name, parameter):
    entry = find_planner(name)
    values = {parameter: entry.parameter_kinds()[parameter](1)}
    if parameter == "use_just_in_time_sampling":
        values["use_k_nearest"] = False
    if parameter == "ordered_sampling":
        values["sample_rejection"] = True
    with ompl_output("silent"):
        planner = entry.allocate(space_information(scenario_of("planar").cspace()), values)
    assert type(planner) is getattr(og, name)
    getter = "get" + entry.parameters[parameter].setter.removeprefix("set")
    assert getattr(planner, getter)() == 1


def test_a_combination_that_ompl_ignores_is_a_planner_error():
    entry = find_planner("BITstar")
    with (
        ompl_output("silent"),
        pytest.raises(PlannerError, match="is not taken, it stays at False"),
    ):
        entry.allocate(
            space_information(scenario_of("planar").cspace()), {"use_just_in_time_sampling": True}
        )


@pytest.mark.parametrize("name", BOUND)
def test_no_setter_of_a_value_is_missing_from_the_table(name):
    setters = {s for s in dir(getattr(og, name)) if s.startswith("set")} - {
        "setName",
        "setProblemDefinition",
        "setDefaultConnectionStrategy",
        "setProjectionEvaluator",
        "setup",
    }
    listed = {p.setter for p in find_planner(name).parameters.values()}
    assert setters - listed == WITHOUT_EFFECT.get(name, set())


@pytest.mark.parametrize(
    ("name", "suggestion"),
    [("RRTconnect", "RRTConnect"), ("prm", "PRM"), ("HighwayRoadMap", "HighwayRoadmap")],
)
def test_unknown_planner_is_refused_with_a_suggestion(name, suggestion):
    with pytest.raises(
        PlannerError, match=f"unknown planner '{name}'.*did you mean .*{suggestion}"
    ):
        find_planner(name)


def test_unknown_planner_without_a_close_name_lists_all():
    with pytest.raises(PlannerError, match="known: HighwayRoadmap, FreeIntervalRRTConnect, AORRTC"):
        find_planner("zzzzzz")


def test_unknown_parameter_is_refused_with_a_suggestion():
    with pytest.raises(
        PlannerError, match="RRT has no parameter 'goalbias'; did you mean goal_bias"
    ):
        checked_parameters(find_planner("RRT"), {"goalbias": 0.1})


@pytest.mark.parametrize(
    ("value", "message"),
    [("wide", "expected float, got 'wide'"), (True, "expected float"), (float("nan"), "float")],
)
def test_wrong_type_is_refused(value, message):
    with pytest.raises(PlannerError, match=message):
        checked_parameters(find_planner("RRT"), {"range": value})


def test_values_are_converted_to_the_setters_type():
    values = checked_parameters(find_planner("RRTstar"), {"range": 2, "ordering_batch_size": 3.0})
    assert values == {"range": 2.0, "ordering_batch_size": 3}
    assert isinstance(values["range"], float)
    assert isinstance(values["ordering_batch_size"], int)


def test_a_value_that_ompl_refuses_is_a_planner_error():
    entry = find_planner("FMT")
    with ompl_output("silent"), pytest.raises(PlannerError, match=r"FMT\.radius_multiplier: -1\.0"):
        entry.allocate(
            space_information(scenario_of("planar").cspace()), {"radius_multiplier": -1.0}
        )


OPTIONAL_INTEGER = (int, type(None))


@pytest.mark.parametrize(
    ("kind", "given", "taken"),
    [
        (OPTIONAL_INTEGER, None, None),
        (OPTIONAL_INTEGER, 4.0, 4),
        (float, 3, 3.0),
        ((float, type(None)), 0.5, 0.5),
        (bool, True, True),
        (str, "text", "text"),
    ],
)
def test_values_of_our_own_planners_may_be_optional(kind, given, taken, monkeypatch):
    entry = OwnPlanner("Fake", "nowhere")
    monkeypatch.setattr(OwnPlanner, "parameter_kinds", lambda _: {"value": kind})
    monkeypatch.setattr(OwnPlanner, "check_values", lambda *_: None)
    result = checked_parameters(entry, {"value": given})["value"]
    assert result == taken
    assert type(result) is type(taken)


@pytest.mark.parametrize(
    ("kind", "given"),
    [(OPTIONAL_INTEGER, True), (OPTIONAL_INTEGER, 4.5), (bool, 1), (str, 1), (float, None)],
)
def test_wrong_types_for_our_own_planners_are_refused(kind, given, monkeypatch):
    monkeypatch.setattr(OwnPlanner, "parameter_kinds", lambda _: {"value": kind})
    with pytest.raises(PlannerError, match=r"Fake\.value: expected"):
        checked_parameters(OwnPlanner("Fake", "nowhere"), {"value": given})


def test_ordered_sampling_alone_is_refused_because_it_ends_the_process():
    si = space_information(scenario_of("planar").cspace())
    entry = find_planner("RRTstar")
    with pytest.raises(PlannerError, match="needs informed_sampling or sample_rejection"):
        entry.allocate(si, {"ordered_sampling": True})
    entry.allocate(si, {"ordered_sampling": True, "sample_rejection": True})
