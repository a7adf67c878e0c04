"""``crystal phase``: the arrangement whose diffraction fits, from a grid search to refinement."""

from __future__ import annotations

import time
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from planners.cli.crystal_candidates import (
    Choice,
    Chosen,
    Method,
    Spread,
    Starts,
    StepDeg,
    by_potential,
)
from planners.cli.crystal_runs import Cluster, Jobs, Json, Model, Run, Session, Workplace, session
from planners.cli.outputs import check_outputs, print_json
from planners.cli.progress import progress
from planners.cli.terminal import say, wide_console

if TYPE_CHECKING:
    from ellipsoid_planning.crystal.diffraction.ranking import Ranking
    from ellipsoid_planning.crystal.packing.potential_candidates import CellSearch
    from planners.cli.crystal_data import Data
    from planners.crystal.parameters import Refinement
    from planners.crystal.phasing import PhasingOutcome

FOUND, NOT_FOUND = 0, 1
MOST_CANDIDATES = 1_000_000


class Ways(str, Enum):
    """How candidates are refined."""

    both = "both"
    polish = "polish"
    rrt = "rrt"


CANDIDATES = {Ways.both: 50, Ways.polish: 50, Ways.rrt: 10}


@dataclass(frozen=True, eq=False)
class Phased:
    """All that a run has found.

    Attributes:
        looked_at: how many arrangements, or cells, were looked at.
        ranking: the candidates, with how many arrangements are free.
        outcome: of their refinement, None if nothing is free.
        search_seconds: time of search and ranking [s].
    """

    looked_at: int
    ranking: Ranking
    outcome: PhasingOutcome | None
    search_seconds: float


def phase(
    model: Model,
    target: Annotated[
        str,
        typer.Option(
            metavar="TARGET.yaml|NAME|DATA.mtz|DATA.cif",
            help="What to find: an arrangement whose magnitudes are simulated, by file or bundled "
            "name, or measured magnitudes.",
        ),
    ],
    method: Chosen = Method.grid,
    best: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            min=1,
            max=MOST_CANDIDATES,
            help="How many candidates are refined, if need be: 50 without it, 10 with "
            "[bold]--refine rrt[/bold]; trees are grown for the best 10 of them only.",
        ),
    ] = None,
    threshold: Annotated[
        float | None,
        typer.Option(
            metavar="C",
            help="Cost that counts as found, over that of an empty cell. By default 1e-6, which "
            "fits simulated magnitudes; 0.02 with --refine rrt. Measured ones need more.",
        ),
    ] = None,
    refine: Annotated[
        Ways,
        typer.Option(
            help="polish: least squares. rrt: OMPL's RRT, as in the thesis. both: least squares, "
            "and the RRT where that does not suffice."
        ),
    ] = Ways.both,
    seed: Annotated[int, typer.Option(metavar="N", min=0, help="Of the RRT.")] = 1,
    column: Annotated[
        str | None, typer.Option(metavar="NAME", help="Of the magnitudes in DATA.")
    ] = None,
    block: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Of the data block in DATA.cif; the first without it."),
    ] = None,
    skip_missing: Annotated[
        bool,
        typer.Option("--skip-missing", help="Leave reflections of DATA without a value out."),
    ] = False,
    compare: Annotated[
        str | None,
        typer.Option(
            metavar="TARGET.yaml|NAME",
            help="With DATA, the true arrangement if it is known, to measure errors against.",
        ),
    ] = None,
    spread: Spread = None,
    step_deg: StepDeg = None,
    starts: Starts = None,
    run: Run = None,
    jobs: Jobs = None,
    cluster: Cluster = None,
    json: Json = False,
    output: Annotated[
        Path | None, typer.Option(metavar="FILE.json", help="Write the result.")
    ] = None,
    figure: Annotated[
        Path | None,
        typer.Option(metavar="FILE.png", help="Draw the candidates, with a table of them."),
    ] = None,
    trends: Annotated[
        Path | None,
        typer.Option(metavar="FILE.png", help="Draw how cost and errors fall in the refinement."),
    ] = None,
    html: Annotated[
        Path | None,
        typer.Option(metavar="FILE.html", help="Write a page with the arrangement found, in 3-D."),
    ] = None,
) -> None:
    """Find the arrangement of a molecule whose diffraction magnitudes fit.

    The free arrangements of the model's grid are ranked by their cost, the distance of their
    magnitudes from the target's; the best are refined one after the other until one has a cost
    below the threshold. If the target's arrangement is known, errors say how far away it is, modulo
    what diffraction cannot tell apart.

    The JSON result has [bold]found[/bold], configurations and free (how many were looked at, and
    are free), arrangement (the one found: configuration by key, angles in degrees, cost, cost_share
    of an empty cell's, free, candidate counted from 1, errors), candidates (best first: number in
    the grid, configuration, cost, errors), refined (what became of them), threshold (a cost),
    target, refine, model, group, keys, fingerprint, seed, time (search, refinement and total, in
    seconds, of this session) and version. Errors: E_h (of the motion), MAE_deg and E_max_deg (of
    angles), MAE_shifts, RMSD_centres (root mean square distance of the bodies' centres from the
    target's), lengths in the model's unit.

    [dim]Exit codes: 0 found, 1 not found, 2 bad input, 130 interrupted.[/dim]

    [dim]Examples:[/dim]

    ellipsoid-planning crystal phase rabbit-p1 --target rabbit-p1-target

    ellipsoid-planning crystal phase rabbit-p212121 --target rabbit-p212121-target --run phased
    --output result.json --figure candidates.png --html cell.html

    ellipsoid-planning crystal phase MODEL.yaml --target DATA.mtz --threshold 0.3
    """
    from ellipsoid_planning.crystal.packing.model import load_model
    from planners.cli import crystal_phase_report as report
    from planners.cli.crystal_data import load_data
    from planners.cli.crystal_output import save_json
    from planners.crystal.parameters import Refinement

    check_outputs(output=output, figure=figure, trends=trends, html=html)
    _check_pictures(figure, trends)
    began = time.perf_counter()
    choice = Choice(method, spread, step_deg, starts)
    loaded = load_model(model)
    refinement = Refinement(method=refine.value, threshold=threshold, seed=seed)
    data = load_data(
        target, loaded, column, skip_missing=skip_missing, compare=compare, block=block
    )
    for remark in data.remarks:
        say(remark)
    phased = _phased(
        data, best or CANDIDATES[refine], choice, refinement, Workplace(run, cluster, jobs)
    )
    result = report.result(data, phased, refinement, time.perf_counter() - began)
    if output is not None:
        save_json(result, output)
    report.draw(data, phased, figure, trends, html)
    if json:
        print_json(result)
    else:
        wide_console().print(*report.tables(data, phased, result), sep="\n")
    raise typer.Exit(FOUND if result["found"] else NOT_FOUND)


def _check_pictures(*files: Path | None) -> None:
    from planners.view.figures import check_format

    for file in files:
        if file is not None:
            check_format(file)


def _phased(
    data: Data, best: int, choice: Choice, refinement: Refinement, workplace: Workplace
) -> Phased:
    """Search, rank and refine, with what an earlier session of the run has done."""
    from ellipsoid_planning.crystal.phasing.ranking_runs import target_digest
    from ellipsoid_planning.crystal.phasing.run_store import run_settings

    model = data.cost.model
    search = choice.search(model)

    def settings() -> dict[str, Any]:
        wanted = {"target": target_digest(data.cost), "refinement": vars(refinement)}
        return run_settings(model, "phase", best=best, **wanted, **choice.settings(model))

    with session(workplace, settings) as working:
        began = time.perf_counter()
        looked_at, ranking = _ranked(data, best, search, working)
        seconds = time.perf_counter() - began
        outcome = _refined(data, ranking, refinement, working) if len(ranking) else None
    return Phased(looked_at, ranking, outcome, seconds)


def _ranked(
    data: Data, best: int, search: CellSearch | None, working: Session
) -> tuple[int, Ranking]:
    """How many arrangements were looked at, and the best that are free."""
    from ellipsoid_planning.crystal.diffraction.ranking import rank_listed
    from ellipsoid_planning.crystal.phasing.ranking_runs import RankedArrangements, ranking_of
    from ellipsoid_planning.crystal.phasing.runs import search_pieces

    model = data.cost.model
    if search is not None:
        found = by_potential(search, working)
        every = slice(0, len(found))
        return found.looked_at, rank_listed(data.cost, found.configurations(every), best)
    title = f"Searching and ranking {model.grid.count:,} arrangements"
    pieces = search_pieces(model.grid, stage="ranked")
    results = working.results(title, RankedArrangements(data.cost, best), pieces)
    return model.grid.count, ranking_of(model, results, best)


def _refined(
    data: Data, ranking: Ranking, refinement: Refinement, working: Session
) -> PhasingOutcome:
    from ellipsoid_planning.crystal.phasing.run_store import Nowhere
    from planners.crystal.kept import KeptRefinements
    from planners.crystal.phasing import phase_candidates

    refiner = KeptRefinements(working.store or Nowhere())
    count = len(ranking)
    trees = min(count, refinement.trees) if refinement.method == "both" else 0
    with progress(f"Refining {count} candidates", count + trees) as update:

        def on_progress(_: int, __: int, cost: float) -> None:
            update(f"lowest cost {cost / data.cost.norm:.3g} of an empty cell's", 1)
            working.check()

        return phase_candidates(data.cost, ranking.configurations, refinement, on_progress, refiner)
