"""``plan``: a scenario goes in, a proved path comes out."""

from __future__ import annotations

import sys
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from planners.cli.command_group import NO_PATH, SOLVED
from planners.cli.outputs import check_outputs, write_csv
from planners.cli.safety_tables import make_tables
from planners.cli.settings import planner_parameters
from planners.cli.sources import say_notices
from planners.cli.terminal import result_console, say, working, working_with_kernels

if TYPE_CHECKING:
    from ellipsoid_planning.result import PlanResult
    from ellipsoid_planning.scenario import Scenario
    from planners.registry import PlannerEntry


DEFAULT_PLANNER = "HighwayRoadmap"


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
    seed: Annotated[int | None, typer.Option(help="Make the run repeatable.")] = None,
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
    _check_limits(time_limit, seed)
    parameters = planner_parameters(settings or [])
    problem = _checked_scenario(scenario, planner, checker.value, parameters, roadmap)
    from planners import solve

    if checker is CheckerName.tabulated:
        make_tables(problem)
    with working(f"Planning {problem.name}, for {time_limit:g} s at most"):
        result = solve.plan(
            problem,
            planner=planner,
            checker=checker.value,
            time_limit=time_limit,
            seed=seed,
            simplify=simplify,
            anytime=anytime,
            parameters=parameters,
            roadmap=roadmap,
        )
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


def _checked_scenario(
    name: str,
    planner: str | None,
    checker: str,
    parameters: dict[str, Any],
    roadmap: Path | None,
) -> Scenario:
    """Load the scenario and check all that can be wrong, what is quick to check first."""
    from ellipsoid_planning.scenario import load_scenario
    from ellipsoid_planning.scenario_checks import check_endpoints

    scenario = load_scenario(name)
    say_notices(scenario)
    _check_planner(scenario, planner, checker, parameters, roadmap)
    with working_with_kernels(f"Checking start and goal of {scenario.name}"):
        check_endpoints(scenario)
    return scenario


def _check_planner(
    scenario: Scenario,
    planner: str | None,
    checker: str,
    parameters: dict[str, Any],
    roadmap: Path | None,
) -> None:
    """Refuse what `solve.plan` would refuse, before the kernels are compiled."""
    from ellipsoid_planning.errors import PlannerError
    from planners.registry import checked_parameters, find_planner

    own = dict(scenario.planner)
    own_name = own.pop("name", DEFAULT_PLANNER)
    try:
        entry = find_planner(own_name if planner is None else planner)
    except PlannerError as error:
        if planner is not None:
            raise
        raise scenario.origin.error(("planner", "name"), str(error)) from None
    if entry.needs_plugin and checker == CheckerName.fcl.value:
        raise PlannerError(
            f"{entry.name} works with the plug-in checker only; leave out --checker {checker}, "
            "or choose an OMPL planner with --planner"
        )
    if roadmap is not None:
        from planners.request import check_roadmap_file

        check_roadmap_file(entry, roadmap)
    for name, value in own.items() if entry.name == own_name else ():
        _check_own(scenario, entry, name, value)
    try:
        checked_parameters(entry, parameters)
    except PlannerError as error:
        raise PlannerError(f"--set: {error}") from None


def _check_own(scenario: Scenario, entry: PlannerEntry, name: str, value: object) -> None:
    """Refuse a parameter of the scenario's planner block, with its place in the file."""
    from ellipsoid_planning.errors import PlannerError
    from planners.registry import checked_parameters

    try:
        checked_parameters(entry, {name: value})
    except PlannerError as error:
        raise scenario.origin.error(("planner", name), str(error)) from None


def _check_limits(time_limit: float, seed: int | None) -> None:
    from ellipsoid_planning.errors import PlannerError
    from ellipsoid_planning.sizes import MOST_SECONDS

    if not 0.0 < time_limit <= MOST_SECONDS:
        raise PlannerError(
            f"--time-limit: expected a positive number of seconds, at most {MOST_SECONDS:g}, "
            f"got {time_limit:g}"
        )
    if seed is not None and not 0 <= seed < 2**32:
        raise PlannerError(f"--seed: expected an integer in [0, 2**32), got {seed}")


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
