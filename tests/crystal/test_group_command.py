"""``group ...``: operations, tables, subgroups and cosets; bad input refused with one message."""

import csv
import json

import numpy as np
import pytest

from ellipsoid_planning.crystal import space_group, space_group_from_text
from tests.cli.command import refused, run


def test_show_tells_kind_and_operations(tmp_path):
    file, sheet = tmp_path / "ops.txt", tmp_path / "ops.csv"
    done = run("group", "show", "P212121", "--json", "--output", file, "--csv", sheet)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert (found["name"], found["number"], found["order"]) == ("P212121", 19, 4)
    flags = [found[key] for key in ("symmorphic", "bieberbach", "sohncke", "enantiomorphic")]
    assert flags == [False, True, True, False]
    assert found["elements"] == [str(op) for op in space_group(19).operations]
    assert space_group_from_text(file).operations == space_group(19).operations
    rows = list(csv.reader(sheet.read_text().splitlines()))
    assert [row[1] for row in rows[1:]] == found["elements"]
    again = run("group", "show", "--file", file)
    assert again.returncode == 0, again.stderr
    assert "P212121 (no. 19)" in again.stdout


def test_the_table_counts_from_one(tmp_path):
    sheet = tmp_path / "table.csv"
    done = run("group", "table", "P4132", "--json", "--csv", sheet)
    assert done.returncode == 0, done.stderr
    expected = space_group("P4132").table + 1
    assert np.array_equal(json.loads(done.stdout)["table"], expected)
    assert np.array_equal(np.loadtxt(sheet, delimiter=",", dtype=int), expected)
    text = run("group", "table", "p4").stdout
    assert " 3 | 3 4 2 1" in text


def test_subgroups_as_the_order_wants_them(tmp_path):
    sheet = tmp_path / "subgroups.csv"
    done = run("group", "subgroups", "P4132", "--json", "--csv", sheet)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert list(found) == ["order", "classes", "subgroups"]
    assert (found["order"], found["classes"], len(found["subgroups"])) == (24, 11, 30)
    assert sum(entry["normal"] for entry in found["subgroups"]) == 4
    whole = found["subgroups"][-1]
    assert set(whole["elements"]) == {str(op) for op in space_group("P4132").operations}
    assert (whole["order"], whole["class"], whole["name"]) == (24, 10, "P4132")
    rows = list(csv.reader(sheet.read_text().splitlines()))
    assert len(rows) == 31
    assert rows[-1][6:] == [str(number) for number in range(1, 25)]


def test_questions_are_answered_by_exit_codes_too(tmp_path):
    sheet = tmp_path / "answer.csv"
    done = run("group", "is-subgroup", "P212121", "--elements", "1,2", "--csv", sheet)
    assert (done.returncode, done.stdout) == (0, "Yes, it is a subgroup of P212121.\n")
    assert sheet.read_text().splitlines()[1].startswith('P212121,1 2,1,"Yes')
    done = run("group", "is-subgroup", "P4132", "--elements", "1,2", "--json")
    assert done.returncode == 1
    found = json.loads(done.stdout)
    assert found["subgroup"] is False
    example = found["counter_example"]
    assert (example["first"], example["second"], example["result"]) == (2, 2, 3)
    done = run("group", "is-normal", "P4132", "--elements", "1,3", "--json")
    assert done.returncode == 1
    found = json.loads(done.stdout)
    assert (found["subgroup"], found["normal"]) == (True, False)
    assert found["counter_example"]["kind"] == "conjugate"
    assert run("group", "is-normal", "P212121", "--elements", "1,3").returncode == 0


def test_cosets(tmp_path):
    sheet = tmp_path / "cosets.csv"
    done = run("group", "cosets", "R32", "--elements", "1,4", "--json", "--csv", sheet)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["index"] == len(found["left"]) == len(found["right"]) == 9
    assert found["agree"] is (None not in found["matches"])
    assert len(sheet.read_text().splitlines()) == 19


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("show", "P2121"), ("P2121", "did you mean")),
        (("show",), ("NAME", "--file", "neither")),
        (("show", "P1", "--file", "ops.txt"), ("both",)),
        (("table", "--file", "missing.txt"), ("missing.txt", "no such file")),
        (("subgroups", "--file", "ops.txt"), ("ops.txt", "g_2 o g_2 =", "is not among them")),
        (("is-normal", "P4", "--elements", "1,9"), ("no element 9", "from 1 to 4")),
        (("is-subgroup", "P4", "--elements", "1;2"), ("--elements 1;2", "commas")),
        (("cosets", "P4", "--elements", "1,2"), ("only subgroups have cosets",)),
        (("show", "P4", "--csv", "nowhere/x.csv"), ("nowhere", "does not exist")),
    ],
)
def test_bad_input(arguments, words, tmp_path):
    (tmp_path / "ops.txt").write_text("x,y,z\n-x,y+1/3,-z+1/4\n-y,x,z")
    refused(run("group", *arguments, folder=tmp_path), *words)
