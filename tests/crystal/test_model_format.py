import math
import re

import numpy as np
import pytest

from ellipsoid_planning.crystal.packing.model import load_model, load_target
from ellipsoid_planning.crystal.packing.model_build import target_of
from ellipsoid_planning.crystal.packing.model_files import bundled_models, locate_data
from ellipsoid_planning.crystal.packing.model_format import packing_model_schema
from ellipsoid_planning.crystal.packing.ranges import Range
from ellipsoid_planning.errors import CrystalError, ScenarioError
from ellipsoid_planning.scenario_files import parse_document
from tests.crystal.packings import model_from, one_body_text

P1 = bundled_models()["rabbit-p1"].read_text(encoding="utf-8")
ONE_BODY_TEXT = one_body_text("P1", "{lengths: [9, 9, 9]}", [1.0, 1.0, 1.0])
PLANE = bundled_models()["rabbit-plane"].read_text(encoding="utf-8")


def changed(text, old, new):
    assert old in text
    return text.replace(old, new, 1)


# What is replaced by what, the field of the error, and what its message says.
SPATIAL = [
    ("search:", "packing: {overlap: 2.5}\nsearch:", "packing.overlap", "semi-axis 2.5, got 2.5"),
    ("search:", "search:\n  slack: 9", "search.slack", "semi-axis 2.5, got 9"),
    ("group: P1", "group: P1x", "group", "P1x"),
    ("group: P1", "group: p4", "group", "dimension 3.*space group"),
    ("group: P1", "group: P6", "cell", "120"),
    ("[14, 14, 14]", "[14, 14]", "cell.lengths", "expected 3 numbers"),
    ("[14, 14, 14]", "[14, -14, 14]", "cell.lengths[1]", "positive"),
    ("{lengths: [14, 14, 14]}", "{lengths: [14, 14, 14], angles_deg: [10, 10, 170]}", "cell", "."),
    ("[14, 14, 14]", "[10, 10, 10]", "cell", "largest part.*1206.*do not fit into.*1000"),
    ("dimension: 3", "dimension: 4", "dimension", "2 or 3"),
    ("format: 1", "format: 2", "format", "this version reads format 1"),
    ("molecule:", "robot:", "robot", "rename this key to molecule"),
    ("search:", "serach:", "serach", "did you mean 'search'"),
    ("parent: head", "parent: haed", "molecule.joints[0].parent", "'haed' is no link"),
    ("semi_axes: [6, 6, 8]", "semi_axes: [6, 6]", "molecule.links[0].parts[0].semi_axes", "3 num"),
    (
        "alpha_deg: {lower: 0, upper: 90, step: 10}\n",
        "\n",
        "search.orientation.alpha_deg",
        "add it",
    ),
    ("step: 10}\n    beta", "step: 7}\n    beta", "search.orientation.alpha_deg", "divides .* 90"),
    ("step: 10}\n    beta", "step: 0}\n    beta", "search.orientation.alpha_deg.step", "positive"),
    (
        "lower: 0, upper: 90, step: 10}\n    beta",
        "lower: 90, upper: 0, step: 10}\n    beta",
        "search.orientation.alpha_deg",
        "lower < upper, got 90 and 0",
    ),
    (
        "lower: 0, upper: 90, step: 10}\n    beta",
        "lower: 20, upper: 20, step: 10}\n    beta",
        "search.orientation.alpha_deg",
        "this value alone write lower: 15, upper: 25, step: 10",
    ),
    (
        "left_roll_deg: {step: 10}",
        "left_rol_deg: {step: 10}",
        "search.joints.left_rol_deg",
        "no joint's key.*left_roll_deg",
    ),
    (
        "left_roll_deg: {step: 10}",
        "left_roll_deg: {lower: -40, step: 10}",
        "search.joints.left_roll_deg",
        "limits -30 to 30, got -40 to 30",
    ),
    (
        "left_roll_deg: {step: 10}",
        "left_roll_deg: {lower: -30}",
        "search.joints.left_roll_deg.step",
        "missing",
    ),
    (
        "diffraction: {resolution: 4.6}",
        "diffraction: {resolution: 0}",
        "diffraction.resolution",
        "positive",
    ),
    (
        "{resolution: 4.6}",
        "{resolution: 4.6, densities: {hed: 2}}",
        "diffraction.densities.hed",
        "'hed' is no link",
    ),
    (
        "search:\n",
        "search:\n  position: {w: {step: 1}}\n",
        "search.position.w",
        "expected one of x",
    ),
    (
        "orientation:\n",
        "orientation:\n    yaw_deg: {step: 10}\n",
        "search.orientation.yaw_deg",
        "dimension is 3",
    ),
    (
        "orientation:\n",
        "orientation:\n    grid: 600-cell\n",
        "search.orientation.alpha_deg",
        "goes through all rotations",
    ),
    (
        "orientation:\n",
        "orientation:\n    resolution_deg: 9\n",
        "search.orientation.resolution_deg",
        "only a grid",
    ),
    ("orientation:\n", "orientation:\n    euler: ZZX\n", "molecule", "three Euler axes"),
    ("group: P1", "group: true", "group", "symbol or number, got true"),
    ("group: P1", "group: 19.0", "group", "symbol or number, got 19.0"),
    ("[14, 14, 14]", "[14, 14, 14, 14]", "cell.lengths", "at most 3 numbers, got 4"),
    ("[14, 14, 14]", "[14, 1e200, 14]", "cell", "length b from 1e-100 to"),
    (
        "step: 10}\n    beta",
        "step: 1e-300}\n    beta",
        "search.orientation.alpha_deg",
        "larger step",
    ),
    ("step: 10}\n    beta", "step: 0.0001}\n    beta", "search", "larger steps"),
    ("semi_axes: [6, 6, 8]", "semi_axes: [1e-6, 1e-6, 8e6]", "cell", "long.*cells"),
    (
        "position: [0, 0, 8]",
        "position: [0, 0, 1e300]",
        "molecule.joints[0].origin.position[2]",
        "1e\\+12",
    ),
    ("name: left_roll\n      ", "name: alpha\n      ", "molecule.joints[0].name", "rename this"),
]


@pytest.mark.parametrize(("old", "new", "field", "message"), SPATIAL)
def test_what_is_wrong_is_said_with_its_place(old, new, field, message):
    with pytest.raises(ScenarioError) as raised:
        model_from(changed(P1, old, new))
    error = raised.value
    assert error.field == field
    assert error.file == "model.yaml"
    assert error.line is not None
    assert re.search(message, str(error)), str(error)


def test_a_molecule_that_may_not_turn_is_refused():
    text = ONE_BODY_TEXT.replace("parts:", "rotates: false\n  parts:")
    with pytest.raises(ScenarioError, match="the search says what moves") as raised:
        model_from(text)
    assert raised.value.field == "molecule.rotates"


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ("group: p1", "group: P1", "group"),
        ("search:\n", "search:\n  position: {z: {step: 1}}\n", "search.position.z"),
        ("yaw_deg: {lower", "beta_deg: {lower", "search.orientation.beta_deg"),
        ("yaw_deg: {lower: 0, upper: 180, step: 30}", "grid: 600-cell", "search.orientation.grid"),
    ],
)
def test_what_the_plane_does_not_have_is_refused(old, new, field):
    with pytest.raises(ScenarioError) as raised:
        model_from(changed(PLANE, old, new))
    assert raised.value.field == field


@pytest.mark.parametrize("name", bundled_models())
def test_bundled_files_read(name):
    if name.endswith("-target"):
        model = load_model(name.removesuffix("-target"))
        assert len(load_target(name, model)) == len(model.molecule.coordinates)
    else:
        assert load_model(name).grid.count > 0


@pytest.mark.parametrize(
    ("old", "new", "field", "message"),
    [
        ("yaw_deg", "yaw", "configuration", "'yaw' is no coordinate.*yaw_deg"),
        ("  left_ear_deg: 3.03\n", "", "configuration", "'left_ear_deg' is missing"),
        ("100.82", "[1]", "configuration.yaw_deg", "number"),
        ("100.82", ".nan", "configuration.yaw_deg", "finite"),
        ("configuration:", "configurations:", "configurations", "did you mean"),
    ],
)
def test_wrong_targets_are_refused_with_their_place(old, new, field, message):
    text = bundled_models()["rabbit-plane-target"].read_text(encoding="utf-8")
    document, origin = parse_document(changed(text, old, new), "target.yaml")
    with pytest.raises(ScenarioError, match=message) as raised:
        target_of(document, origin, load_model("rabbit-plane"))
    assert raised.value.field == field


def test_an_unknown_name_suggests_the_bundled_ones(tmp_path):
    with pytest.raises(ScenarioError, match="did you mean rabbit-p1"):
        load_model("rabit-p1")
    with pytest.raises(ScenarioError, match="got a folder"):
        load_model(tmp_path)


def test_bundled_data_is_found_by_its_file_name(tmp_path):
    assert locate_data("dd-peptidase.mtz").is_file()
    assert locate_data("dd-peptidase.pdb.gz").is_file()
    own = tmp_path / "dd-peptidase.mtz"
    own.write_text("mine")
    assert locate_data(own) == own
    assert not locate_data("nothing.mtz").exists()


def test_values_in_file_units_come_back():
    model = load_model("rabbit-p212121")
    q = load_target("rabbit-p212121-target", model)
    values = model.values_of(q)
    assert values["x"] == q[0]
    assert values["alpha_deg"] == pytest.approx(math.degrees(q[3]))
    np.testing.assert_allclose(model.configuration(values), q, rtol=1e-15)
    with pytest.raises(CrystalError, match="'x' is missing"):
        model.configuration({key: v for key, v in values.items() if key != "x"})


def test_joints_that_are_not_searched_stand_at_zero():
    model = model_from(changed(P1, "    left_roll_deg: {step: 10}\n", ""))
    assert model.grid.count == 944_784 // 6
    assert set(model.grid.configurations([0, 5000])[:, 3]) == {0.0}
    text = changed(P1, "    left_roll_deg: {step: 10}\n", "")
    with pytest.raises(ScenarioError, match=r"limits 10 to 30, got none.*stand at 0"):
        model_from(changed(text, "lower_deg: -30", "lower_deg: 10"))


def test_ranges_have_centres_or_ends():
    centres = Range.of(0, 90, 30)
    np.testing.assert_allclose(centres.values, [15, 45, 75])
    np.testing.assert_allclose(Range.of(0, 4, 1, "ends").values, [0, 1, 2, 3, 4])
    np.testing.assert_allclose(centres.cells, [[0, 30], [30, 60], [60, 90]])
    np.testing.assert_allclose(Range.fixed(2.0).cells, [[2, 2]])
    np.testing.assert_allclose(centres.scaled(0.1).values, [1.5, 4.5, 7.5])


def test_the_schema_names_every_block():
    schema = packing_model_schema()
    assert {"group", "cell", "molecule", "search", "diffraction"} <= set(schema["properties"])
