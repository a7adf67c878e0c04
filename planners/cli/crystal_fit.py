"""``crystal fit``: packing models of real molecules, from their structures' files."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from planners.cli.crystal_fit_tables import contacts_table, domains_table, fit_report
from planners.cli.outputs import check_outputs, print_json
from planners.cli.terminal import say, working

if TYPE_CHECKING:
    from ellipsoid_planning.crystal.structures.contacts import Contact
    from ellipsoid_planning.crystal.structures.fitted_model import FittedModel
    from ellipsoid_planning.crystal.structures.fitting import MoleculeFit
    from ellipsoid_planning.crystal.structures.structure import CrystalStructure

AUTO = "auto"
LOOK = 1.25  # contacts up to this factor are reported


def fit(
    structure: Annotated[
        Path, typer.Argument(metavar="STRUCTURE", help="Coordinates: .pdb, .ent, .cif, also .gz.")
    ],
    domain: Annotated[
        list[str],
        typer.Option(
            metavar="NAME=CHAIN/FIRST-LAST+…",
            help="A domain by its residues; once for each domain.",
        ),
    ],
    shape: Annotated[
        str,
        typer.Option(
            metavar="moments|volume|enclosing",
            help="Ellipsoids of the domain's second moments; scaled to the volume of its mass; "
            "around all its atoms.",
        ),
    ] = "moments",
    parts: Annotated[
        int, typer.Option(metavar="N", min=1, max=100, help="How many ellipsoids a domain gets.")
    ] = 4,
    scale: Annotated[
        str,
        typer.Option(
            metavar="S|auto",
            help="Multiplies all semi-axes; auto: as little below 1 as keeps the deposited "
            "molecules apart.",
        ),
    ] = "1",
    overlap: Annotated[
        str,
        typer.Option(
            metavar="D|auto",
            help="How deep ellipsoids may reach into each other [Å]; auto: as deep as those of "
            "the deposited molecules do.",
        ),
    ] = AUTO,
    name: Annotated[
        str | None, typer.Option(metavar="NAME", help="Of the model; the file's without it.")
    ] = None,
    resolution: Annotated[
        float, typer.Option(metavar="D", help="Smallest spacing that is compared [Å].")
    ] = 15.0,
    shift_step: Annotated[
        float, typer.Option(metavar="D", help="Largest step of the search along the axes [Å].")
    ] = 5.0,
    turn_step_deg: Annotated[
        float, typer.Option(metavar="D", help="Largest step of its turns, in degrees.")
    ] = 15.0,
    hinge_deg: Annotated[
        float,
        typer.Option(metavar="D", help="Hinges turn by as many degrees to both sides; 0: stiff."),
    ] = 15.0,
    output: Annotated[
        Path | None, typer.Option(metavar="MODEL.yaml", help="The packing model.")
    ] = None,
    target: Annotated[
        Path | None, typer.Option(metavar="TARGET.yaml", help="The deposited pose, as a target.")
    ] = None,
    magnitudes: Annotated[
        Path | None,
        typer.Option(
            metavar="DATA.mtz",
            help="Magnitudes of the real atoms, calculated to the resolution: FC and PHIC.",
        ),
    ] = None,
    solvent: Annotated[
        bool,
        typer.Option(
            "--solvent", help="Magnitudes of a crystal with solvent between the molecules."
        ),
    ] = False,
    json: Annotated[
        bool, typer.Option("--json", help="Print everything as JSON in place of tables.")
    ] = False,
) -> None:
    """Fit ellipsoids to the domains of a real molecule, and make a packing model of it.

    The model is the molecule in its own cell and space group, with hinges where its chain crosses
    from one domain to another. Without --output it goes to stdout, the tables then to stderr.

    [dim]Example:[/dim]

    ellipsoid-planning crystal fit entry.cif --domain "n=A/1-90+251-333" --domain "c=A/91-250"
    --output model.yaml --target target.yaml --magnitudes data.mtz
    """
    check_outputs(output=output, target=target, magnitudes=magnitudes)
    _check_suffix(magnitudes)
    from ellipsoid_planning.crystal.packing.model_files import locate_data
    from ellipsoid_planning.crystal.structures.fitted_model import FittedModel, SearchSteps
    from ellipsoid_planning.crystal.structures.fitting import deepest_overlap
    from ellipsoid_planning.crystal.structures.structure import read_structure

    steps = SearchSteps(shift_step, turn_step_deg, hinge_deg, resolution=resolution)
    with working(f"Fitting {structure}"):
        found = read_structure(locate_data(structure))
        fitted, contacts = _fitted(found, domain, shape, parts, scale)
    depth = deepest_overlap(fitted) if overlap == AUTO else _number(overlap, "--overlap")
    model = FittedModel(fitted, steps, name or found.name, depth)
    _warn(model, contacts)
    if magnitudes is not None:
        _calculate(found, resolution, magnitudes, solvent=solvent)
    _write(model.model(), output)
    _write(model.target(), target)
    if json:
        report = {**fit_report(fitted, contacts), "model": model.model(), "target": model.target()}
        print_json(report)
        return
    _print(fitted, contacts, model, whole=output is None)


def _check_suffix(magnitudes: Path | None) -> None:
    from ellipsoid_planning.errors import CrystalError

    if magnitudes is not None and magnitudes.suffix.lower() != ".mtz":
        raise CrystalError(f"--magnitudes {magnitudes}: expected a file .mtz; rename it")


def _fitted(
    structure: CrystalStructure, domains: list[str], shape: str, parts: int, scale: str
) -> tuple[MoleculeFit, list[Contact]]:
    from ellipsoid_planning.crystal.structures.contacts import closest_contacts
    from ellipsoid_planning.crystal.structures.domains import parse_domain
    from ellipsoid_planning.crystal.structures.fitting import fit_domains, loosened

    parsed = [parse_domain(text) for text in domains]
    fitted = fit_domains(structure, parsed, shape, parts, _number(scale, "--scale"))
    if scale == AUTO:
        fitted = loosened(fitted)
    bodies = fitted.ellipsoids
    return fitted, closest_contacts(bodies, structure.cell, structure.group, LOOK)


def _number(text: str, option: str) -> float:
    from ellipsoid_planning.errors import CrystalError

    try:
        value = 1.0 if text == AUTO else float(text)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value >= 0.0):
        raise CrystalError(f"{option} {text}: expected a number of 0 or more, or {AUTO}")
    return value


def _warn(model: FittedModel, contacts: list[Contact]) -> None:
    """Say what is not as one might think."""
    fitted = model.fit
    for note in fitted.structure.notes:
        say(f"{fitted.structure.file}: {note}.")
    meeting = [contact for contact in contacts if contact.gap < 0.0]
    if meeting:
        deepest = max(-contact.gap for contact in meeting)
        say(
            f"As deposited, {len(meeting)} pairs of ellipsoids of different molecules meet, up to "
            f"{deepest:.2f} Å deep; the model allows {model.overlap:g} Å. From scale "
            f"{fitted.scale * meeting[0].factor:.3f} down none would."
        )
    if fitted.left_out:
        say(f"{fitted.left_out} residues are in no domain; they are left out.")
    if len(fitted.domains) > 1 and not fitted.hinges:
        say("No chain crosses from one domain to another: they move as one body.")


def _calculate(
    structure: CrystalStructure, resolution: float, file: Path, *, solvent: bool
) -> None:
    from ellipsoid_planning.crystal.structures.calculated import calculated_factors, write_mtz

    with working("Calculating structure factors"):
        factors = calculated_factors(structure, resolution, solvent=solvent)
        write_mtz(factors, file, f"calculated from {structure.name}")
    say(f"Wrote {len(factors.hkl)} reflections to {file}")


def _write(document: dict[str, Any], file: Path | None) -> None:
    from ellipsoid_planning import atomic
    from ellipsoid_planning.errors import EllipsoidPlanningError
    from ellipsoid_planning.scenario_yaml import document_text

    if file is None:
        return
    try:
        atomic.write_text(file, document_text(document))
    except OSError as error:
        raise EllipsoidPlanningError(f"{file}: cannot write the file: {error.strerror}") from None
    say(f"Wrote {file}")


def _print(
    fitted: MoleculeFit, contacts: list[Contact], model: FittedModel, *, whole: bool
) -> None:
    from rich.console import Console

    from ellipsoid_planning.scenario_yaml import document_text

    console = Console(stderr=whole)
    console.print(domains_table(fitted))
    if contacts:
        console.print(contacts_table(fitted, contacts))
    if whole:
        sys.stdout.write(document_text(model.model()))
