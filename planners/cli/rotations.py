"""``rotations``: even grids of rotations, measured, written to a file and drawn."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from planners.cli.outputs import QUATERNION, check_outputs, print_json
from planners.cli.terminal import result_console, say, working

if TYPE_CHECKING:
    from rich.table import Table

    from ellipsoid_planning.groups import GridMetrics, RotationGrid

SUFFIXES = (".csv", ".npy")
IDEAL_THICKNESS = 1.4635  # of the body-centred cubic lattice, the thinnest covering of space


def rotations(
    grid: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            help="600-cell (the most even: for as many rotations, none has them farther apart, "
            "and only octahedral-bcc with 648 covers more closely), icosahedral, octahedral, "
            "tetrahedral (each also with -bcc), icosahedral-double (also -cubic, -bcc), "
            "icosahedral-wedge, hopf, super-fibonacci, euler or random.",
        ),
    ],
    count: Annotated[
        int | None, typer.Option(metavar="N", help="How many rotations there shall be.")
    ] = None,
    resolution_deg: Annotated[
        float | None,
        typer.Option(
            metavar="D",
            help="Instead, the edge in degrees of a cube that has one rotation's share of them "
            "all: the smallest grid that is at least as fine.",
        ),
    ] = None,
    seed: Annotated[
        int | None, typer.Option(metavar="N", min=0, help="Of random rotations; 0 without it.")
    ] = None,
    metrics: Annotated[
        bool, typer.Option("--metrics", help="Measure how even the grid is.")
    ] = False,
    json: Annotated[
        bool, typer.Option("--json", help="Print the measures as JSON, and nothing else.")
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.csv|.npy", help="Write the rotations, as quaternions (x, y, z, w)."
        ),
    ] = None,
    figure: Annotated[
        Path | None,
        typer.Option(metavar="FILE.png", help="Draw the grid; the suffix chooses the format."),
    ] = None,
) -> None:
    """Spread rotations evenly over all orientations.

    [dim]Examples:[/dim]

    ellipsoid-planning rotations --grid 600-cell --resolution-deg 15 --metrics

    ellipsoid-planning rotations --grid icosahedral --count 480 --figure grid.png

    ellipsoid-planning rotations --grid super-fibonacci --count 10000 --output rotations.npy
    """
    _check_options(output, figure, count, resolution_deg)
    made = _make(grid, count, resolution_deg, seed)
    from ellipsoid_planning.groups import measure

    measured = None
    if metrics or json:
        with working(f"Measuring {made.count} rotations"):
            measured = measure(made)
    _write(made, output, figure)
    if json and measured is not None:
        print_json({**measured.to_dict(), "grid": grid})
        return
    result_console().print(_table(grid, made, measured))


def _check_options(
    output: Path | None, figure: Path | None, count: int | None, resolution_deg: float | None
) -> None:
    from ellipsoid_planning.errors import GridError

    if (count is None) == (resolution_deg is None):
        got = "neither" if count is None else "both"
        raise GridError(f"expected either --count or --resolution-deg, got {got}")
    check_outputs(output=output, figure=figure)
    if output is not None and output.suffix.lower() not in SUFFIXES:
        raise GridError(
            f"--output {output}: unknown format {output.suffix!r}; expected "
            + " or ".join(SUFFIXES)
        )
    if figure is not None:
        from planners.view.figures import check_format

        check_format(figure)


def _make(
    name: str, count: int | None, resolution_deg: float | None, seed: int | None
) -> RotationGrid:
    import difflib

    from ellipsoid_planning.errors import GridError
    from ellipsoid_planning.groups import grid_by_name, grid_names

    known = grid_names()
    if name not in known:
        close = difflib.get_close_matches(name.lower(), known, n=2)
        hint = f"did you mean {' or '.join(close)}?" if close else f"there are {', '.join(known)}"
        raise GridError(f"--grid {name}: unknown grid; {hint}")
    if seed is not None and name != "random":
        raise GridError(f"--seed {seed}: the grid {name} is not random; remove it")
    return grid_by_name(name, count=count, resolution_deg=resolution_deg, seed=seed or 0)


def _write(grid: RotationGrid, output: Path | None, figure: Path | None) -> None:
    """Write both files; neither is begun before both are ready."""
    from planners.view.writing import write_whole

    ready: list[tuple[Path, bytes]] = []
    if output is not None:
        with working(f"Writing {grid.count} rotations"):
            ready.append((output, _content(grid, output.suffix.lower())))
    if figure is not None:
        from planners.view import figures_rotations

        with working("Drawing the figure"):
            picture = figures_rotations.picture(grid, figure.suffix[1:].lower())
        ready.append((figure, picture))
    for file, content in ready:
        write_whole(file, content)
        say(f"Wrote {file}")


def _content(grid: RotationGrid, suffix: str) -> bytes:
    """The quaternions (n, 4) as a file's bytes; the digits of a CSV give them back exactly."""
    import io

    import numpy as np

    quaternions = grid.quaternions()
    if suffix == ".npy":
        binary = io.BytesIO()
        np.save(binary, quaternions, allow_pickle=False)
        return binary.getvalue()
    lines = [",".join(QUATERNION), *(",".join(map(repr, row)) for row in quaternions.tolist()), ""]
    return "\n".join(lines).encode()


def _table(name: str, grid: RotationGrid, measured: GridMetrics | None) -> Table:
    import math

    from rich.table import Table

    table = Table(title=f"Grid {name}", title_justify="left", show_header=False)
    table.add_column("what")
    table.add_column("value", justify="right")
    table.add_column("remark", style="dim")
    table.add_row("rotations", str(grid.count), "")
    spacing = f"{math.degrees(grid.spacing):.4g}°"
    table.add_row("resolution", spacing, "edge of a cube with a rotation's share")
    if measured is None:
        return table
    table.add_row("separation", f"{math.degrees(measured.separation):.4g}°", "smallest distance")
    at_least = "" if measured.covering_is_exact else "at least; probed"
    covering = f"{math.degrees(measured.covering):.4g}°"
    table.add_row("covering radius", covering, at_least or "farthest rotation from the grid")
    ideal = f"the best lattice's is {IDEAL_THICKNESS}"
    table.add_row("covering thickness", f"{measured.thickness:.4g}", ideal)
    ratio = "smallest to largest distance of nearest neighbours"
    table.add_row("neighbour ratio", f"{measured.neighbour_ratio:.4g}", ratio)
    if measured.max_distortion is not None:
        distortion = f"{100.0 * measured.max_distortion:.4g} %"
        table.add_row("largest distortion", distortion, "of the coordinates, thesis (4.11)")
    return table
