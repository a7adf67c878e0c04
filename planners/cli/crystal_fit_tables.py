"""What ``crystal fit`` found, as tables and as data."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.table import Table

    from ellipsoid_planning.crystal.structures.contacts import Contact
    from ellipsoid_planning.crystal.structures.fitting import MoleculeFit

MOST_ROWS = 8


def fit_report(fitted: MoleculeFit, contacts: list[Contact]) -> dict[str, Any]:
    """Everything about a fit but its model, as data for JSON."""
    structure = fitted.structure
    return {
        "structure": structure.name,
        "title": structure.title,
        "group": structure.group.name,
        "cell": {
            "lengths": structure.cell.lengths.tolist(),
            "angles_deg": list(structure.cell.angles_deg),
        },
        "shape": fitted.shape,
        "scale": fitted.scale,
        "filled": filled(fitted),
        "left_out_residues": fitted.left_out,
        "domains": [
            {
                "name": entry.domain.name,
                "residues": str(entry.domain).split("=", 1)[1],
                "residue_count": entry.residues,
                "atoms": entry.atoms,
                "mass_da": entry.mass,
                "electrons": entry.electrons,
                "ellipsoid_volume": entry.ellipsoid_volume,
                "density": entry.density,
                "ellipsoids": [
                    {
                        "name": body.name,
                        "semi_axes": body.semi_axes.tolist(),
                        "centre": body.centre.tolist(),
                        "rotation": body.rotation.tolist(),
                    }
                    for body in entry.ellipsoids
                ],
            }
            for entry in fitted.domains
        ],
        "hinges": [
            {
                "domains": [hinge.first, hinge.second],
                "crossings": list(hinge.crossings),
                "points": hinge.points.tolist(),
                "axis": None if hinge.axis is None else hinge.axis.tolist(),
            }
            for hinge in fitted.hinges
        ],
        "contacts": [
            {
                "first": contact.first,
                "second": contact.second,
                "operation": structure.group.operations[contact.operation].triplet(),
                "shift": list(contact.shift),
                "factor": contact.factor,
                "gap": contact.gap,
            }
            for contact in contacts
        ],
    }


def filled(fitted: MoleculeFit) -> float:
    """The share of the cell that the ellipsoids of all copies have; overlaps count twice."""
    total = sum(entry.ellipsoid_volume for entry in fitted.domains)
    return fitted.structure.group.order * total / fitted.structure.cell.volume


def domains_table(fitted: MoleculeFit) -> Table:
    """One row for each ellipsoid, and what they make of the cell."""
    from rich.markup import escape
    from rich.table import Table

    structure = fitted.structure
    title = f"{structure.name}, {structure.group.name}: {100.0 * filled(fitted):.0f} % of the cell"
    table = Table(title=escape(f"{title}, scale {fitted.scale:.3f}"), title_justify="left")
    table.add_column("domain", style="bold", overflow="fold")
    table.add_column("residues", overflow="fold")
    for column in ("atoms", "mass [kDa]", "semi-axes [Å]", "volume / protein's"):
        table.add_column(column, justify="right")
    for entry in fitted.domains:
        residues = str(entry.domain).split("=", 1)[1]
        axes = "\n".join(
            " ".join(f"{axis:.1f}" for axis in body.semi_axes) for body in entry.ellipsoids
        )
        ratio = entry.ellipsoid_volume / entry.volume
        counts = str(entry.atoms), f"{1e-3 * entry.mass:.2f}"
        table.add_row(escape(entry.domain.name), escape(residues), *counts, axes, f"{ratio:.2f}")
    return table


def contacts_table(fitted: MoleculeFit, contacts: list[Contact]) -> Table:
    """The closest contacts of the deposited molecules."""
    from rich.markup import escape
    from rich.table import Table

    table = Table(title="Closest contacts at the deposited pose", title_justify="left")
    for column in ("ellipsoid", "copy of", "operation", "cell"):
        table.add_column(column, overflow="fold")
    for column in ("gap [Å]", "touch at scale"):
        table.add_column(column, justify="right")
    for contact in contacts[:MOST_ROWS]:
        operation = fitted.structure.group.operations[contact.operation].triplet()
        cell = " ".join(map(str, contact.shift))
        colour = "red" if contact.gap < 0.0 else "green"
        numbers = f"[{colour}]{contact.gap:.2f}[/{colour}]", f"{fitted.scale * contact.factor:.3f}"
        table.add_row(escape(contact.first), escape(contact.second), operation, cell, *numbers)
    return table
