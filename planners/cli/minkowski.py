"""``minkowski``: the sum or difference of two ellipses or ellipsoids, measured and drawn."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from planners.cli.outputs import check_outputs, print_json
from planners.cli.terminal import result_console, say, working

if TYPE_CHECKING:
    from ellipsoid_planning.geometry import Ellipsoid


def minkowski(
    semi_axes: Annotated[
        list[str],
        typer.Option(
            "--semi-axes",
            metavar="A,B[,C]",
            help="Of a body; twice. Two numbers make an ellipse, three an ellipsoid.",
        ),
    ],
    euler_zxz_deg: Annotated[
        list[str] | None,
        typer.Option(
            "--euler-zxz-deg",
            metavar="A,B,C",
            help="How the second ellipsoid is turned: Rz(A) Rx(B) Rz(C). Given twice: the first, "
            "then the second.",
        ),
    ] = None,
    yaw_deg: Annotated[
        list[str] | None,
        typer.Option("--yaw-deg", metavar="ANGLE", help="The same for ellipses."),
    ] = None,
    difference: Annotated[
        bool,
        typer.Option(
            "--difference", help="Where the second body can be inside the first, not the sum."
        ),
    ] = False,
    figure: Annotated[
        Path | None,
        typer.Option(metavar="FILE.png", help="Draw it; the suffix chooses the format."),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print the numbers as JSON, and nothing else.")
    ] = False,
) -> None:
    """Minkowski sum or difference of two ellipsoids: exact volume, bounds, a picture.

    [dim]Examples:[/dim]

    ellipsoid-planning minkowski --semi-axes 5,1 --semi-axes 3,6 --yaw-deg 45

    ellipsoid-planning minkowski --semi-axes 7,3,3 --semi-axes 2,3,4 --euler-zxz-deg -45,-22.5,45
    --euler-zxz-deg 60,45,-30 --figure sum.png

    ellipsoid-planning minkowski --semi-axes 30,40,50 --semi-axes 1,2,3 --difference --json
    """
    check_outputs(figure=figure)
    first, second = _bodies(semi_axes, euler_zxz_deg or [], yaw_deg or [])
    from ellipsoid_planning.geometry.minkowski_summary import minkowski_summary

    summary = minkowski_summary(first, second, difference=difference)
    if figure is not None:
        from planners.view import figures_minkowski

        with working("Drawing the figure"):
            figures_minkowski.figure(summary, figure)
        say(f"Wrote {figure}")
    if json:
        print_json(summary.to_dict())
        return
    from planners.cli.minkowski_tables import summary_tables

    for table in summary_tables(summary):
        result_console().print(table)


def _bodies(axes: list[str], zxz: list[str], yaw: list[str]) -> tuple[Ellipsoid, Ellipsoid]:
    from ellipsoid_planning.errors import GeometryError
    from ellipsoid_planning.geometry import Ellipsoid
    from ellipsoid_planning.sizes import check_semi_axes

    if len(axes) != 2:
        raise GeometryError(f"--semi-axes: expected two bodies, got {len(axes)}")
    sizes = [_numbers("--semi-axes", text, (2, 3)) for text in axes]
    for text, values in zip(axes, sizes, strict=True):
        if not all(value > 0.0 for value in values):
            raise GeometryError(f"--semi-axes {text}: expected positive numbers")
        check_semi_axes(values, f"--semi-axes {text}")
    if len(sizes[0]) != len(sizes[1]):
        raise GeometryError(
            f"--semi-axes: expected two bodies of one dimension, got {len(sizes[0])} axes "
            f"({axes[0]}) and {len(sizes[1])} ({axes[1]})"
        )
    n = len(sizes[0])
    rotations = _rotations(n, zxz, yaw)
    one, two = (
        Ellipsoid.from_semi_axes(size, None, rotation, name)
        for size, rotation, name in zip(sizes, rotations, ("E1", "E2"), strict=True)
    )
    return one, two


def _rotations(dimension: int, zxz: list[str], yaw: list[str]) -> list[Any]:
    """The rotations of both bodies."""
    import numpy as np

    from ellipsoid_planning.errors import GeometryError
    from ellipsoid_planning.orientation_forms import rotation_from_form

    option, other = ("--yaw-deg", "--euler-zxz-deg")[:: 1 if dimension == 2 else -1]
    texts, unused = (yaw, zxz) if dimension == 2 else (zxz, yaw)
    if unused:
        kind = "ellipses" if dimension == 2 else "ellipsoids"
        raise GeometryError(f"{other} {unused[0]}: {kind} are turned by {option}")
    if len(texts) > 2:
        raise GeometryError(f"{option}: expected it at most twice, got it {len(texts)} times")
    rotations = [np.eye(dimension), np.eye(dimension)]
    for index, text in enumerate(texts, 2 - len(texts)):
        angles = _numbers(option, text, (1,) if dimension == 2 else (3,))
        value = angles[0] if dimension == 2 else angles
        form = "yaw_deg" if dimension == 2 else "euler_zxz_deg"
        rotations[index] = rotation_from_form(form, value)
    return rotations


def _numbers(option: str, text: str, counts: tuple[int, ...]) -> list[float]:
    from ellipsoid_planning.errors import GeometryError

    wanted = " or ".join(str(count) for count in counts)
    pieces = text.split(",")
    plural = "" if counts == (1,) else "s separated by commas"
    try:
        values = [float(piece) for piece in pieces]
    except ValueError:
        raise GeometryError(f"{option} {text}: expected {wanted} number{plural}") from None
    if len(values) not in counts:
        raise GeometryError(f"{option} {text}: expected {wanted} number{plural}, got {len(values)}")
    if not all(math.isfinite(value) for value in values):
        raise GeometryError(f"{option} {text}: expected finite numbers")
    return values
