"""The script that regenerates the thesis' chapter 5."""

import pytest

from benchmarks.chapter5 import rows
from benchmarks.chapter5_figures import FIGURES


def test_the_table_has_our_numbers():
    found = {figure: computed for figure, _, computed in rows()}
    assert found["5.9 (b)"] == "131.864, 165.221, 171.094, 179.085"
    assert found["5.11 (c)"].split(", ")[3] == "1626.29"
    assert found["5.15"] == "3799.8108"
    assert found["5.16"].startswith("1.668926e+07; 1.66")


@pytest.mark.parametrize("name", ["5.3", "5.6", "5.13", "5.15"])
def test_a_figure_is_drawn(name, tmp_path):
    file = tmp_path / "figure.png"
    FIGURES[name]().savefig(file, dpi=50)
    assert file.stat().st_size > 5000


def test_all_of_them_are_there():
    wanted = {*range(3, 9), 10, *range(12, 17)}
    assert {int(name.split(".")[1]) for name in FIGURES} == wanted
