"""``benchmark``: planners side by side, many runs each, every path checked again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from planners.cli.interrupt import noted_interrupts
from planners.cli.sources import say_notices
from planners.cli.terminal import say, working

if TYPE_CHECKING:
    from ellipsoid_planning.scenario import Scenario
    from planners.benchmark.campaign import Campaign
    from planners.benchmark.contenders import Contender
    from planners.benchmark.problems import Problem

DEFAULT_CLEARANCES = "1e-1,1e-2,1e-3,1e-4,1e-5,1e-6"


def benchmark(
    scenarios: Annotated[
        list[str] | None,
        typer.Argument(metavar="SCENARIO", help="YAML files, or names of bundled scenarios."),
    ] = None,
    planners: Annotated[
        str,
        typer.Option(
            metavar="NAME,...",
            help="HighwayRoadmap, OMPL's planners, or [bold]module:Class[/bold] for your own.",
        ),
    ] = "HighwayRoadmap,PRM,RRT,RRTConnect",
    checkers: Annotated[
        str,
        typer.Option(
            metavar="NAME,...",
            help="plugin (exact, certified), tabulated (the same, by tables), fcl (by resolution).",
        ),
    ] = "plugin,fcl",
    runs: Annotated[int, typer.Option(metavar="N", help="Of each planner on each scenario.")] = 10,
    time_limit: Annotated[
        float, typer.Option(metavar="S", help="Of a run, for the planner alone, in seconds.")
    ] = 10.0,
    memory_limit: Annotated[
        float, typer.Option(metavar="MB", help="Of a run, for the planner alone.")
    ] = 2000.0,
    seed: Annotated[
        int, typer.Option(metavar="N", help="Of the first run; each further run has the next.")
    ] = 1,
    output: Annotated[
        Path,
        typer.Option(
            metavar="DIR",
            help="A new folder, or one of an interrupted benchmark to go on with.",
        ),
    ] = Path("benchmark-results"),
    family: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Make the scenarios: a family, drawn anew in each run."),
    ] = None,
    clearances: Annotated[
        str,
        typer.Option(metavar="C,...", help="Of the family: free play over the robot's width."),
    ] = DEFAULT_CLEARANCES,
    dimension: Annotated[
        int | None, typer.Option(metavar="2|3", help="Of the family; its usual one by default.")
    ] = None,
    jobs: Annotated[
        int, typer.Option(metavar="N", help="Runs at a time; more than one disturb each other.")
    ] = 1,
    cluster: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS|local",
            help="Run on a Dask cluster, one run at a time in each worker. "
            "[dim]Needs the extra \\[cluster].[/dim]",
        ),
    ] = None,
) -> None:
    """Compare planners: success, time, path length and clearance, with figures.

    Every run has a process of its own; one that hangs, crashes or exceeds a limit is a recorded
    failure. Every path is verified independently. The folder gets OMPL's logs and its SQLite
    database (for Planner Arena), tables and figures; an interrupted benchmark goes on when the
    command is given again.

    [dim]Examples:[/dim]

    ellipsoid-planning benchmark rabbit-3d-narrow window-3d --runs 20 --output narrow

    ellipsoid-planning benchmark --family turned-gap --clearances 1e-1,1e-3,1e-6 --runs 5
    """
    from planners.benchmark.checks import check_numbers
    from planners.benchmark.contenders import line_up
    from planners.benchmark.store import Store
    from planners.cli.benchmark_report import report
    from planners.cli.benchmark_runs import executor, run_campaign

    check_numbers(runs, time_limit, memory_limit, seed, jobs)
    line = line_up(_names(planners), _names(checkers))
    problems = _problems(
        scenarios or [], line.contenders, family, clearances, dimension, runs, seed
    )
    campaign = _campaign(problems, line.contenders, runs, time_limit, memory_limit, seed)
    store = Store(output)
    store.check(campaign)
    with executor(cluster, jobs) as execute, noted_interrupts() as interrupted:
        for note in line.notes:
            say(f"Note: {note}")
        store.open(campaign)
        records = run_campaign(campaign, store, execute, interrupted)
        if records:
            report(output, campaign, records)
    if interrupted.is_set():
        message = interrupted.message
        say(f"{message} The finished runs are kept; give the same command to go on.")
        raise typer.Exit(interrupted.exit_code)


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",") if name.strip()]


def _campaign(
    problems: tuple[Problem, ...],
    contenders: tuple[Contender, ...],
    runs: int,
    time_limit: float,
    memory_limit: float,
    seed: int,
) -> Campaign:
    from planners.benchmark.campaign import Campaign

    return Campaign(problems, contenders, runs, time_limit, memory_limit, seed)


def _problems(
    names: list[str],
    contenders: tuple[Contender, ...],
    family: str | None,
    clearances: str,
    dimension: int | None,
    runs: int,
    seed: int,
) -> tuple[Problem, ...]:
    from ellipsoid_planning.errors import PlannerError
    from planners.benchmark.problems import clearances_from, family_problems

    if not names and family is None:
        raise PlannerError("nothing to plan: name a SCENARIO, or a --family")
    problems = _named_problems(names, contenders)
    if family is None:
        if dimension is not None or clearances != DEFAULT_CLEARANCES:
            raise PlannerError("--clearances and --dimension belong to a --family; name one")
        return problems
    values = clearances_from(clearances)
    with working(f"Making scenarios of the family {family}"):
        return (*problems, *family_problems(family, values, dimension, runs, seed))


def _named_problems(names: list[str], contenders: tuple[Contender, ...]) -> tuple[Problem, ...]:
    from ellipsoid_planning.scenario import load_scenario
    from planners.benchmark.checks import check_scenario
    from planners.benchmark.problems import scenario_problems

    loaded: list[Scenario] = [load_scenario(name) for name in names]
    for scenario in loaded:
        say_notices(scenario)
    if loaded:
        with working("Checking starts and goals"):
            for scenario in loaded:
                check_scenario(scenario, contenders)
    return scenario_problems(loaded)
