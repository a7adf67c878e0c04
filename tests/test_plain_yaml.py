"""The quick reader gives what the general one gives, or nothing."""

import json

import numpy as np
import pytest

from ellipsoid_planning.errors import ScenarioError
from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.orientation_forms import rotation_from_form
from ellipsoid_planning.orientation_lists import rotations_from_forms
from ellipsoid_planning.plain_yaml import plain_data
from ellipsoid_planning.scenario import Scenario, bundled_scenarios, load_scenario
from ellipsoid_planning.scenario_bodies import quick_bodies
from ellipsoid_planning.scenario_places import read_yaml

TEXT = """\
# A comment: with {signs}.
a: {x y: [1, -2.5, 1e-3], "b c": 'it', e: {f: true}}
c: 3  # and another
list:
- 1
- {d: no, e: [null, "a: b"]}
-  name: rock 1
   deep:
     - [1,
        2]
words: one, two (three)
text: >-
  one # two
  three: four

last: 0
"""
PIECES = [
    *("\n", "\n\n", " ", "  ", ":", ": ", "-", "- ", "#", " #", ",", "[", "]", "{", "}", "'", '"'),
    *(
        "true",
        "True",
        "null",
        "~",
        "yes",
        "y",
        "&a ",
        "*a",
        "!t ",
        "|",
        ">-",
        "%",
        "---",
        "...",
        "@",
    ),
    *(
        "1e5",
        "01",
        "1_0",
        ".5",
        "1.",
        "+1",
        "-0",
        "0x1F",
        "0o7",
        ".inf",
        "NaN",
        "Infinity",
        "1e400",
    ),
    *(
        "2001-01-01",
        "<<",
        "=",
        "? ",
        "`",
        "é",
        "\u00a0",
        "\u2028",
        "\t",
        "\\",
        "\x07",
        "k: v",
        "\n- ",
    ),
]


def general(text):
    try:
        return read_yaml(text)[0]
    except ScenarioError as error:
        return error


def mutated(text, rng):
    for _ in range(rng.choice([1, 1, 2, 3])):
        place = int(rng.integers(len(text) + 1))
        cut = place + int(rng.choice([0, 0, 1, 2, 8]))
        text = text[:place] + [*PIECES, ""][rng.integers(len(PIECES) + 1)] + text[cut:]
    return text


def test_plain_texts_are_read_quickly():
    assert plain_data(TEXT)["list"][1] == {"d": "no", "e": [None, "a: b"]}
    assert repr(plain_data(TEXT)) == repr(general(TEXT))
    for name, file in bundled_scenarios().items():
        text = file.read_text(encoding="utf-8")
        assert repr(plain_data(text)) == repr(general(text)), name
    document = load_scenario("rabbit-2d-open").to_dict()
    for indent in (None, 1):
        assert repr(plain_data(json.dumps(document, indent=indent))) == repr(document)


def test_changed_texts_are_read_alike_or_left_to_the_general_reader():
    rng, accepted = np.random.default_rng(5), 0
    compact = json.dumps(plain_data(TEXT), indent=1)
    for _ in range(1500):
        text = mutated([TEXT, TEXT, compact][rng.integers(3)], rng)
        quick = plain_data(text)
        if quick is not None:
            accepted += 1
            assert repr(quick) == repr(general(text)), text
    assert accepted > 200


@pytest.mark.parametrize(
    "text",
    [
        "a: 1\na: 2",
        "{a: 1, a: 2}",
        '{"a": 1, "a": 2}',
        '{"a"\n: 1}',
        "a: [1 2]",
        "a: {b:1}",
        "a: &b 1",
        "a: 012",
        "a: 1_000",
        "a: True",
        "{true: 1}",
        "a: .nan",
        "a: -Infinity",
        "a:\n",
        "a: b\n  c: d",
        "a: b: c",
        "a: 'it''s'",
        '"a\\n": 1',
        "a: x\n\tb: y",
        "a: " + "[" * 5000,
        "a: " + "1" * 5000,
        "k" * 1100 + ": 1",
        "",
    ],
)
def test_what_is_unusual_is_left_to_the_general_reader(text):
    assert plain_data(text) is None


def orientations(form, rng, count):
    for k in range(count):
        angles = (rng.uniform(-1, 1, 3) * rng.choice([1, 180, 1000])).tolist()
        angles[k % 3] = [angles[0], 0.0, -0.0, 90.0, 180.0][k % 5]
        if form == "yaw_deg":
            yield angles[0]
        elif form == "axis_angle":
            yield {"axis": [1.0, *angles[1:]], "angle_deg": angles[0]}
        elif form == "quaternion":
            quaternion = rng.normal(size=4)
            yield (quaternion / np.linalg.norm(quaternion)).round(4 + k % 13).tolist()
        else:
            yield angles


@pytest.mark.parametrize(
    "form", ["yaw_deg", "quaternion", "rpy_deg", "axis_angle", "euler_zxz_deg"]
)
def test_bodies_in_a_list_are_those_built_one_by_one_to_the_last_bit(form):
    rng = np.random.default_rng(2)
    values = list(orientations(form, rng, 300))
    n = 2 if form == "yaw_deg" else 3
    many = rotations_from_forms(form, values)
    assert many.tobytes() == np.array([rotation_from_form(form, v) for v in values]).tobytes()
    data = [
        {"semi_axes": [1, 2.5, 3][:n], "position": [0.1, k, -1][:n], "orientation": {form: value}}
        for k, value in enumerate(values)
    ]
    made, written = quick_bodies(data, n, "rock")
    assert [form for _, form in written] == [{form: value} for value in values]
    for k, body in enumerate(made):
        one = Ellipsoid.from_semi_axes(
            data[k]["semi_axes"], data[k]["position"], rotation_from_form(form, values[k])
        )
        assert body.name == f"rock {k + 1}"
        for own, other in zip(
            (body.centre, body.rotation, body.semi_axes),
            (one.centre, one.rotation, one.semi_axes),
            strict=True,
        ):
            assert own.tobytes() == other.tobytes()
            assert not own.flags.writeable


@pytest.mark.parametrize(
    "change",
    [
        {"semi_axes": [1, True]},
        {"semi_axes": [1, -1.0]},
        {"semi_axes": [1, "1"]},
        {"semi_axes": [1, 2, 3]},
        {"semi_axes": [1, float("nan")]},
        {"semi_axes": [1, 10**400]},
        {"semi_axes": None},
        {"position": [0, 1e13]},
        {"position": None},
        {"orientation": None},
        {"orientation": {}},
        {"orientation": {"yaw_deg": True}},
        {"orientation": {"yaw_deg": float("inf")}},
        {"orientation": {"rpy_deg": [0, 0, 0]}},
        {"name": 3},
        {"colour": "red"},
    ],
)
def test_a_list_with_anything_odd_is_left_to_the_models(change):
    body = {"semi_axes": [1, 2], "position": [0, 0], "orientation": {"yaw_deg": 30}}
    assert quick_bodies([body], 2, "rock") is not None
    assert quick_bodies([body, {**body, **change}], 2, "rock") is None


def test_an_error_far_down_a_list_names_its_place(tmp_path):
    text = bundled_scenarios()["maze-2d"].read_text(encoding="utf-8")
    file = tmp_path / "maze.yaml"
    file.write_text(text.replace("[50, 50]}", "[50, x]}"), encoding="utf-8")
    with pytest.raises(ScenarioError, match=r"maze\.yaml:29:41: obstacles\[5\]\.position\[1\]"):
        load_scenario(file)


def test_orientations_are_written_as_they_were_read():
    document = load_scenario("rabbit-3d-cluttered").to_dict()
    document["obstacles"][0]["orientation"] = {"rpy_deg": [10.0, 20.0, 30.0]}
    assert Scenario.from_dict(document).to_dict() == document
