"""``family``: scenarios whose passage is as narrow as one wants."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from planners.cli.outputs import check_outputs
from planners.cli.terminal import say


def family(
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME",
            help="gap, turned-gap, window-3d, slot-3d, bend, chain-of-gaps or tight-arena.",
        ),
    ],
    clearance: Annotated[
        float,
        typer.Option(
            metavar="FRACTION",
            help="Free play in the passage, at the best orientation, divided by the robot's width "
            "there: above 0, at most 1.",
        ),
    ],
    output: Annotated[Path, typer.Option(metavar="FILE.yaml", help="The scenario file to write.")],
    dimension: Annotated[
        int | None, typer.Option(metavar="2|3", help="2-D or 3-D; 2-D where a family has both.")
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            help="Draw sizes, clutter and a rigid motion of everything, the same at every "
            "clearance; the canonical scene without it.",
        ),
    ] = None,
    blocked: Annotated[
        bool,
        typer.Option("--blocked", help="Make the passage too narrow by this fraction instead."),
    ] = False,
    without_passage: Annotated[
        bool,
        typer.Option("--without-passage", help="Leave the bodies that form the passage out."),
    ] = False,
) -> None:
    """Write a scenario with a narrow passage of exactly known clearance.

    [dim]Examples:[/dim]

    ellipsoid-planning family turned-gap --clearance 1e-3 --output gap.yaml

    ellipsoid-planning family window-3d --clearance 1e-6 --seed 7 --output window.yaml

    ellipsoid-planning family gap --dimension 3 --clearance 0.01 --blocked --output closed.yaml
    """
    check_outputs(output=output)
    from ellipsoid_planning import atomic
    from ellipsoid_planning.errors import EllipsoidPlanningError
    from ellipsoid_planning.families import make_family
    from ellipsoid_planning.scenario_yaml import scenario_text

    scenario = make_family(
        name, clearance, dimension, seed, blocked=blocked, without_passage=without_passage
    )
    try:
        atomic.write_text(output, scenario_text(scenario))
    except OSError as error:
        raise EllipsoidPlanningError(f"{output}: cannot write the file: {error.strerror}") from None
    say(f"Wrote {output}")
