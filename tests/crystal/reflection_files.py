"""Files of reflections for the cell of the model rabbit-p212121, written for tests."""

import gemmi
import numpy as np

HEADER = """\
data_test
_cell.length_a {a}
_cell.length_b 22.00(1)
_cell.length_c 22
_cell.angle_alpha 90
_cell.angle_beta 90
_cell.angle_gamma {gamma}
_symmetry.space_group_name_H-M '{group}'
loop_
_refln.index_h
_refln.index_k
_refln.index_l
"""
FIT = {"a": 22, "gamma": 90, "group": "P 21 21 21"}
ROWS = "_refln.F_meas_au\n1 0 1 3.0\n2 0 0 4.0\n"


def cif_text(text=ROWS, **changes):
    return HEADER.format(**(FIT | changes)) + text


def write(folder, text, **changes):
    path = folder / "data.cif"
    path.write_text(cif_text(text, **changes))
    return path


def write_mtz(path, rows, columns, group="P 21 21 21", cell=(22, 22, 22, 90, 90, 90), missing=None):
    """``missing`` is the number that stands for a missing value; NaN without it."""
    mtz = gemmi.Mtz(with_base=True)
    mtz.spacegroup = gemmi.find_spacegroup_by_name(group)
    mtz.set_cell_for_all(gemmi.UnitCell(*cell))
    mtz.add_dataset("data")
    for label, kind in columns:
        mtz.add_column(label, kind)
    mtz.set_data(np.array(rows, dtype=np.float32))
    if missing is not None:
        mtz.valm = missing
    mtz.write_to_file(str(path))
    return path
