"""The 17 plane groups, by generators (International Tables, volume A, section 2.1)."""

from __future__ import annotations

from ellipsoid_planning.crystal.symmetry.operation import Operation

# Number, full symbol and generators modulo the lattice; hexagonal axes have gamma = 120 degrees.
PLANE_GROUPS: tuple[tuple[int, str, tuple[str, ...]], ...] = (
    (1, "p1", ()),
    (2, "p2", ("-x,-y",)),
    (3, "pm", ("-x,y",)),
    (4, "pg", ("-x,y+1/2",)),
    (5, "cm", ("x+1/2,y+1/2", "-x,y")),
    (6, "p2mm", ("-x,-y", "-x,y")),
    (7, "p2mg", ("-x,-y", "-x+1/2,y")),
    (8, "p2gg", ("-x,-y", "-x+1/2,y+1/2")),
    (9, "c2mm", ("x+1/2,y+1/2", "-x,-y", "-x,y")),
    (10, "p4", ("-x,-y", "-y,x")),
    (11, "p4mm", ("-x,-y", "-y,x", "-x,y")),
    (12, "p4gm", ("-x,-y", "-y,x", "-x+1/2,y+1/2")),
    (13, "p3", ("-y,x-y",)),
    (14, "p3m1", ("-y,x-y", "-y,-x")),
    (15, "p31m", ("-y,x-y", "y,x")),
    (16, "p6", ("-y,x-y", "-x,-y")),
    (17, "p6mm", ("-y,x-y", "-x,-y", "-y,-x")),
)
SHORT_SYMBOLS = {
    "pmm": "p2mm",
    "pmg": "p2mg",
    "pgg": "p2gg",
    "cmm": "c2mm",
    "p4m": "p4mm",
    "p4g": "p4gm",
    "p6m": "p6mm",
}


def generate(generators: tuple[Operation, ...], dimension: int) -> tuple[Operation, ...]:
    """All products of the generators modulo the lattice, the identity first.

    The order is that in which they are found: powers of the first generators come first.
    """
    found = [Operation.identity(dimension)]
    known = set(found)
    for count in range(1, len(generators) + 1):
        place = 0
        while place < len(found):
            for generator in generators[:count]:
                product = (generator @ found[place]).modulo()
                if product not in known:
                    known.add(product)
                    found.append(product)
            place += 1
    return tuple(found)
