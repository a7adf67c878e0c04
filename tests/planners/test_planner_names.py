"""What may name a planner's class: the user, installed packages, but no file."""

import sys

import pytest

from ellipsoid_planning.errors import PlannerError
from ellipsoid_planning.scenario import Scenario
from planners import installed
from planners.registry import find_planner, planner_names, registered_planner
from planners.solve import plan
from tests.planners.planner_scenes import scenario_of

MODULE = """
from ompl import base as ob


class Idle(ob.Planner):
    NEEDS_PLUGIN = True

    def __init__(self, si):
        super().__init__(si, "Idle")

    def solve(self, ptc):
        return ob.PlannerStatus(ob.PlannerStatus.PlannerStatusType.TIMEOUT)


class Greedy(Idle):
    def __init__(self, si, more):
        super().__init__(si)


number = 3
"""


@pytest.fixture
def module(tmp_path, monkeypatch):
    """The name of a module with planners that lies in the current folder, which Python searches."""
    (tmp_path / "lying_about.py").write_text(MODULE, encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.chdir(tmp_path)
    yield "lying_about"
    sys.modules.pop("lying_about", None)


def scenario_naming(planner):
    document = scenario_of("planar").to_dict()
    return Scenario.from_dict({**document, "planner": {"name": planner}})


def test_a_scenario_imports_nothing(module):
    scenario = scenario_naming(f"{module}:Idle")
    with pytest.raises(PlannerError, match=f"--planner {module}:Idle"):
        plan(scenario)
    assert module not in sys.modules


def test_the_user_names_a_class(module):
    result = plan(scenario_naming(f"{module}:Idle"), f"{module}:Idle")
    assert (result.planner, result.status) == ("Idle", "exhausted")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("os:system", "derived from ompl.base.Planner, this is builtin_function_or_method"),
        ("collections:OrderedDict", "this is the class OrderedDict"),
        ("lying_about:number", "this is int"),
        ("lying_about:Nobody", "the module lying_about has no Nobody"),
        ("no_such_module:Idle", "cannot import it: No module named 'no_such_module'"),
        (":Idle", "cannot import it"),
        ("lying_about:", "has no"),
    ],
)
def test_what_is_no_planner_is_refused(module, name, words):
    assert module
    with pytest.raises(PlannerError, match=words):
        find_planner(name)


@pytest.mark.parametrize("fault", ["raise SystemExit(0)", "1 / 0", "def", "None.gone"])
def test_a_module_that_fails_is_one_error(module, tmp_path, fault):
    (tmp_path / f"{module}.py").write_text(fault, encoding="utf-8")
    with pytest.raises(PlannerError, match="the module raised"):
        find_planner(f"{module}:Idle")


def test_a_class_must_be_constructed_from_a_space_information(module):
    with pytest.raises(PlannerError, match="constructed from a SpaceInformation alone"):
        plan(scenario_of("planar"), f"{module}:Greedy")


def register(folder, name, value):
    """What installing a package with a planner leaves in a folder."""
    metadata = folder / "somebody-1.0.dist-info"
    metadata.mkdir(parents=True)
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: somebody\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(f"[{installed.GROUP}]\n{name} = {value}\n")


@pytest.fixture
def fresh_registry():
    installed.installed_planners.cache_clear()
    yield
    installed.installed_planners.cache_clear()


@pytest.mark.usefixtures("fresh_registry")
def test_an_installed_planner_may_be_named_by_files(module, tmp_path, monkeypatch):
    packages = tmp_path / "packages"
    register(packages, "Resting", f"{module}:Idle")
    monkeypatch.setattr(installed, "_install_folders", lambda: [str(packages)])
    assert "Resting" in planner_names()
    assert registered_planner("Resting").module == module
    assert plan(scenario_naming("Resting")).planner == "Idle"


@pytest.mark.usefixtures("fresh_registry")
def test_a_folder_on_the_path_registers_nothing(module, tmp_path):
    register(tmp_path, "Resting", f"{module}:Idle")
    with pytest.raises(PlannerError, match="unknown planner 'Resting'"):
        plan(scenario_naming("Resting"))
    assert module not in sys.modules


@pytest.mark.usefixtures("fresh_registry")
def test_built_in_names_cannot_be_taken(module, tmp_path, monkeypatch):
    packages = tmp_path / "packages"
    register(packages, "RRTConnect", f"{module}:Idle")
    monkeypatch.setattr(installed, "_install_folders", lambda: [str(packages)])
    assert planner_names().count("RRTConnect") == 1
    assert type(registered_planner("RRTConnect")).__name__ == "BoundPlanner"
