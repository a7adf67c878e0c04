"""Bad input: one message that names file and field, exit 2, nothing written."""

import pytest

from ellipsoid_planning.errors import EllipsoidPlanningError
from planners.cli.outputs import check_outputs
from tests.cli.command import refused, run

PLACE = "two-pillars.yaml:"


def plan(scenario, *options):
    """`plan` with all its outputs asked for; none must appear."""
    folder = scenario.parent
    before = set(folder.iterdir())
    outputs = [f"--{kind}={folder / 'out'}.{kind}" for kind in ("csv", "html")]
    done = run("plan", scenario, *outputs, "--output", folder / "out.json", *options)
    assert set(folder.iterdir()) == before
    return done


# What is replaced in the scenario, and what the message must hold.
BAD_SCENARIOS = {
    "broken YAML": ("high: [10, 10]}", "high: [10, 10}", (PLACE + "4",)),
    "unknown key": ("name: two pillars", "nam: two pillars", (PLACE + "2", "nam", "unknown key")),
    "missing key": ("goal: {position: [6, -1]", "planer: {position: [6, -1]", ("planer",)),
    "missing goal": ("goal: {position: [6, -1], orientation: {yaw_deg: -90}}\n", "", ("goal",)),
    "wrong dimension": (
        "semi_axes: [1, 3], position: [0, -4]",
        "semi_axes: [1, 3, 2], position: [0, -4]",
        (PLACE + "8", "obstacles[0].semi_axes"),
    ),
    "zero axis": ("semi_axes: [1, 0.4]", "semi_axes: [1, 0]", ("robot.parts[0].semi_axes",)),
    "negative axis": ("semi_axes: [1, 0.4]", "semi_axes: [1, -2]", ("robot.parts[0].semi_axes",)),
    "infinite axis": ("semi_axes: [1, 0.4]", "semi_axes: [1, .inf]", ("finite",)),
    "axis not a number": ("semi_axes: [1, 0.4]", "semi_axes: [1, .nan]", (PLACE + "12",)),
    "start in collision": (
        "start: {position: [-6, 1]",
        "start: {position: [-1, 3]",
        ("start", "part 'hull' hits obstacle 'right' by"),
    ),
    "goal out of bounds": ("goal: {position: [6, -1]", "goal: {position: [16, -1]", ("goal",)),
    "start leaves the arena": (
        "start: {position: [-6, 1]",
        "start: {position: [-9.5, 9]",
        ("start", "part 'hull' leaves arena 'yard' by"),
    ),
    "robot too large": (
        "semi_axes: [1, 0.4]",
        "semi_axes: [13, 0.4]",
        ("robot.parts[0]", "cannot fit the arena"),
    ),
    "unknown planner": ("{name: RRTConnect}", "{name: RTRConnect}", ("RTRConnect", "RRTConnect?")),
    "unknown parameter": (
        "{name: RRTConnect}",
        "{name: RRTConnect, rang: 2}",
        ("rang", "did you mean range?"),
    ),
}


@pytest.mark.parametrize("case", BAD_SCENARIOS)
def test_bad_scenarios(case, scenario_file):
    old, new, words = BAD_SCENARIOS[case]
    assert refused(plan(scenario_file((old, new))), *words)


@pytest.mark.parametrize(("scale", "accepted"), [(1.0005, True), (1.01, False)])
def test_quaternions_that_are_nearly_or_not_of_unit_length(scale, accepted, tmp_path):
    from ellipsoid_planning.scenario import bundled_scenarios

    text = bundled_scenarios()["rabbit-3d-open"].read_text(encoding="utf-8")
    assert "0.7071067811865476, 0.7071067811865476]" in text
    half = 0.7071067811865476 * scale
    file = tmp_path / "turned.yaml"
    file.write_text(text.replace("0.7071067811865476", repr(half)), encoding="utf-8")
    done = run("plan", file, "--planner", "RRTConnect")
    if accepted:
        assert done.returncode == 0, done.stderr
    else:
        assert refused(done, "turned.yaml:", "goal.orientation.quaternion")


def test_no_such_file():
    assert refused(run("plan", "nowhere.yaml"), "nowhere.yaml", "no such file")
    assert refused(run("plan", "rabbit-2d-opne"), "did you mean rabbit-2d-open")
    assert refused(run("show", "nowhere.json", "--html", "x.html"), "nowhere.json")
    assert refused(run("verify", "nowhere.json"), "nowhere.json")


OPTIONS = {
    "unknown planner": (("--planner", "RTRConnect"), ("RTRConnect", "RRTConnect?")),
    "unknown parameter": (("--set", "planner.rang=2"), ("rang", "did you mean range?")),
    "wrong type": (("--set", "planner.range=far"), ("RRTConnect.range", "far")),
    "no planner key": (("--set", "range=2"), ("--set range=2", "planner.key=value")),
    "no value": (("--set", "planner.range"), ("planner.key=value",)),
    "broken value": (("--set", "planner.range=[1"), ("planner.range=[1",)),
    "zero time": (("--time-limit", "0"), ("--time-limit",)),
    "no time": (("--time-limit", "nan"), ("--time-limit",)),
    "negative seed": (("--seed", "-1"), ("seed",)),
    "HighwayRoadmap with FCL": (
        ("--planner", "HighwayRoadmap", "--checker", "fcl"),
        ("HighwayRoadmap works with the plug-in checker only",),
    ),
}


@pytest.mark.parametrize("case", OPTIONS)
def test_bad_options(case, scenario_file):
    options, words = OPTIONS[case]
    assert refused(plan(scenario_file(), *options), *words)


@pytest.mark.parametrize(
    "arguments",
    [
        ("plan",),
        ("plan", "rabbit-2d-open", "--time-limit", "soon"),
        ("plan", "rabbit-2d-open", "--checker", "none"),
        ("plan", "rabbit-2d-open", "--nonsense"),
        ("figure", "rabbit-2d-open"),
        ("nonsense",),
    ],
)
def test_mistakes_in_the_command_itself(arguments):
    done = run(*arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert "Traceback" not in done.stderr
    assert "Usage:" in done.stderr


@pytest.mark.parametrize("option", ["--output", "--csv", "--html"])
def test_a_missing_output_folder_is_found_before_planning(option, scenario_file, tmp_path):
    done = run("plan", scenario_file(), option, tmp_path / "missing" / "file")
    assert refused(done, option, "missing", "does not exist")
    assert "Planning" not in done.stderr


def test_outputs_that_are_folders_or_the_same_file(scenario_file, tmp_path):
    file = scenario_file()
    assert refused(run("plan", file, "--output", tmp_path), "this is a folder")
    both = run("plan", file, "--output", tmp_path / "a", "--csv", tmp_path / "a")
    assert refused(both, "--output and --csv", "expected two files")
    below = run("plan", file, "--output", file / "a.json")
    assert refused(below, "is a file, not a folder")


@pytest.mark.parametrize("command", [("show", "--html"), ("figure", "--output")])
def test_other_commands_check_their_folder_too(command, tmp_path):
    name, option = command
    done = run(name, "rabbit-2d-open", option, tmp_path / "missing" / "file.png")
    assert refused(done, option, "does not exist")


def test_a_figure_of_an_unknown_format(tmp_path):
    done = run("figure", "rabbit-2d-open", "--output", tmp_path / "figure.docx")
    assert refused(done, "docx")
    assert not list(tmp_path.iterdir())


def test_a_read_only_folder_is_found_before_the_search(tmp_path, monkeypatch):
    monkeypatch.setattr("planners.cli.outputs.os.access", lambda *_: False)
    with pytest.raises(EllipsoidPlanningError, match=r"--output .* cannot be written to"):
        check_outputs(output=tmp_path / "free.csv")


def test_a_page_does_not_replace_a_picture(tmp_path):
    picture = tmp_path / "cell.png"
    picture.write_bytes(b"kept")
    assert refused(run("crystal", "show", "rabbit-p1", "--html", picture), "--html", ".html")
    assert picture.read_bytes() == b"kept"


def test_results_that_are_none(tmp_path):
    file = tmp_path / "result.json"
    for text, word in (("{", "broken JSON"), ("[]", "expected a result"), ("{}", "missing")):
        file.write_text(text, encoding="utf-8")
        for command in (("verify", file), ("show", file, "--html", tmp_path / "x.html")):
            assert refused(run(*command), "result.json", word)
