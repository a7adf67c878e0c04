"""The script that draws the figures of the thesis' chapter 3."""

import pytest

from benchmarks.chapter3_figures import FIGURES


@pytest.mark.parametrize("name", ["3.4", "3.7", "3.10"])
def test_a_figure_is_drawn(name, tmp_path):
    file = tmp_path / "figure.png"
    FIGURES[name]().savefig(file, dpi=50)
    assert file.stat().st_size > 5000


def test_all_of_them_are_there():
    assert {int(name.split(".")[1]) for name in FIGURES} == {4, *range(6, 20)}
