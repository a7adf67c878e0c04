"""``plan``: a scenario goes in, a proved path comes out."""

from __future__ import annotations

import sys
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from planners.cli.command_group import NO_PATH, SOLVED
from planners.cli.outputs import check_outputs, write_csv
from planners.cli.safety_tables import make_tables
from planners.cli.settings import planner_parameters
from planners.cli.sources import say_notices
from planners.cli.terminal import result_console, say, working

if TYPE_CHECKING:
    from ellipsoid_planning.result import PlanResult


class CheckerName(str, Enum):
    """The collision checkers, as the command line offers them."""

    plugin = "plugin"
    tabulated = "tabulated"
    fcl = "fcl"


def plan(
    scenario: Annotated[
        str,
        typer.Argument(metavar="SCENARIO", help="A YAML file, or the name of a bundled scenario."),
    ],
    planner: Annotated[
        str | None,
        typer.Option(
            help="HighwayRoadmap or an OMPL planner: RRTConnect, PRM, BITstar, ... "
            "[dim]By default the scenario's own, or else HighwayRoadmap.[/dim]"
        ),
    ] = None,
    checker: Annotated[
        CheckerName,
        typer.Option(
            help="Exact, certified checks, the same with states looked up in tables, or "
            "python-fcl at a resolution."
        ),
    ] = CheckerName.plugin,
    time_limit: Annotated[float, typer.Option(help="For the planner alone, in seconds.")] = 10.0,
    anytime: Annotated[
        bool, typer.Option("--anytime", help="Improve the path until the time limit.")
    ] = False,
    seed: Annotated[
        int | None,
        typer.Option(
            help="Make the run repeatable. [dim]PRM and PRMstar search in two threads, and can "
            "differ all the same.[/dim]"
        ),
    ] = None,
    simplify: Annotated[bool, typer.Option(help="Shorten the path afterwards.")] = True,
    output: Annotated[
        Path | None, typer.Option(metavar="FILE.json", help="Write the result.")
    ] = None,
    csv: Annotated[
        Path | None, typer.Option(metavar="FILE.csv", help="Write the interpolated path.")
    ] = None,
    html: Annotated[
        Path | None, typer.Option(metavar="FILE.html", help="Write a page with the moving robot.")
    ] = None,
    roadmap: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Keep the planner's roadmap in FILE: loaded if it exists, written afterwards, "
            "path or not. [dim]HighwayRoadmap only; for other starts and goals in the same "
            "world, with the same robot, clearance and seed.[/dim]",
        ),
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="planner.KEY=VALUE", help="A parameter of the planner; repeatable."
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print the result as JSON, and nothing else.")
    ] = False,
) -> None:
    """Plan a path and certify it.

    [dim]Examples:[/dim]

    ellipsoid-planning plan rabbit-2d-open

    ellipsoid-planning plan rabbit-3d-open --seed 1 --output path.json --html path.html

    ellipsoid-planning plan my.yaml --roadmap my.roadmap

    ellipsoid-planning plan my.yaml --planner RRTConnect --set planner.range=5 --time-limit 30
    """
    check_outputs(output=output, csv=csv, html=html, roadmap=roadmap)
    from ellipsoid_planning.scenario_checks import check_endpoints
    from planners.cli.requests import checked_plan_request
    from planners.solve import answer

    request = checked_plan_request(
        scenario,
        planner=planner,
        checker=checker.value,
        time_limit=time_limit,
        seed=seed,
        simplify=simplify,
        anytime=anytime,
        parameters=planner_parameters(settings or []),
        roadmap=roadmap,
    )
    problem = request.scenario
    say_notices(problem)
    with working(f"Checking start and goal of {problem.name}"):
        check_endpoints(problem, request.cspace)
    if checker is CheckerName.tabulated:
        make_tables(problem)
    with working(f"Planning {problem.name}, for {time_limit:g} s at most"):
        result = answer(request, ends_checked=True)
    if result.status in ("invalid_start", "invalid_goal"):
        which = result.status.removeprefix("invalid_")
        raise problem.origin.error((which,), f"the {which} cannot be proved free; move it a little")
    if result.path is not None and not result.path.certified:
        say("Note: the path is not certified; verify it before you rely on it.")
    _print(result, json)
    _write(result, output, csv, html)
    if roadmap is not None:
        say(f"Wrote {roadmap}")
    raise typer.Exit(SOLVED if result.solved else NO_PATH)


def _print(result: PlanResult, as_json: bool) -> None:
    if as_json:
        sys.stdout.write(result.to_json())
        sys.stdout.flush()
        return
    from planners.cli.tables import result_table

    result_console().print(result_table(result))


def _write(result: PlanResult, output: Path | None, csv: Path | None, html: Path | None) -> None:
    if output is not None:
        result.save(output)
        say(f"Wrote {output}")
    if csv is not None and result.solved:
        write_csv(result, csv)
        say(f"Wrote {csv}")
    elif csv is not None:
        say(f"No path, so {csv} was not written.")
    if html is not None:
        from planners.cli.pages import scene_page
        from planners.view.meshcat_page import write_page

        with working("Drawing the page"):
            write_page(scene_page(result.scenario, result), html)
        say(f"Wrote {html}")
