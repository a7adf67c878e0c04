"""Scenario files and results for the tests of the command line."""

import pytest

from tests.cli.command import run

SCENARIO = """\
format: 1
name: two pillars
dimension: 2
bounds: {low: [-10, -10], high: [10, 10]}
arena:
  - {name: yard, semi_axes: [12, 12]}
obstacles:
  - {name: left, semi_axes: [1, 3], position: [0, -4]}
  - {name: right, semi_axes: [1, 3], position: [0, 4]}
robot:
  parts:
    - {name: hull, semi_axes: [1, 0.4]}
    - {name: mast, semi_axes: [0.2, 0.6], position: [0.5, 0]}
start: {position: [-6, 1], orientation: {yaw_deg: 90}}
goal: {position: [6, -1], orientation: {yaw_deg: -90}}
planner: {name: RRTConnect}
"""


@pytest.fixture
def scenario_file(tmp_path):
    """Writes the scenario, with texts replaced, to a file."""

    def write(*replacements):
        text = SCENARIO
        for old, new in replacements:
            assert old in text
            text = text.replace(old, new)
        file = tmp_path / "two-pillars.yaml"
        file.write_text(text, encoding="utf-8")
        return file

    return write


@pytest.fixture(scope="session")
def result_file(tmp_path_factory):
    """A result that `plan` wrote."""
    folder = tmp_path_factory.mktemp("result")
    source = folder / "scenario.yaml"
    source.write_text(SCENARIO, encoding="utf-8")
    done = run("plan", source, "--seed", 1, "--output", folder / "result.json")
    assert done.returncode == 0, done.stderr
    return folder / "result.json"
