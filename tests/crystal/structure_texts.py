"""Texts of small PDB files."""

CELL = "CRYST1   20.000   30.000   40.000  90.00  90.00  90.00 P 21 21 21    4\n"


def atom_line(serial, residue, number, place, *, atom="CA", chain="A", occupancy=1.0, other=" "):
    x, y, z = place
    element = "H" if atom.startswith("H") else atom[0]
    kind = "HETATM" if residue == "HOH" else "ATOM  "
    return (
        f"{kind}{serial:5d}  {atom:<3s}{other}{residue} {chain}{number:4d}    "
        f"{x:8.3f}{y:8.3f}{z:8.3f}{occupancy:6.2f}{10.0:6.2f}          {element:>2s}\n"
    )


def chain_text(count=12, chain="A"):
    """A chain of alanines along x, with C-alphas and one more atom each."""
    lines = []
    for k in range(count):
        lines.append(atom_line(2 * k, "ALA", k + 1, (3.8 * k, 0.0, 0.0), chain=chain))
        beta = (3.8 * k, 1.5 * (-1) ** k, 0.5)
        lines.append(atom_line(2 * k + 1, "ALA", k + 1, beta, atom="CB", chain=chain))
    return "".join(lines)
