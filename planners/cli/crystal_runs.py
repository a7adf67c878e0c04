"""What the long commands of ``crystal`` share: who works, where it is kept, how it is stopped."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from planners.cli.interrupt import noted_interrupts
from planners.cli.progress import progress
from planners.cli.terminal import say

if TYPE_CHECKING:
    from ellipsoid_planning.crystal.phasing.run_store import RunStore
    from ellipsoid_planning.crystal.phasing.runs import Execute, Piece, Work

Model = Annotated[
    str,
    typer.Argument(
        metavar="MODEL.yaml|NAME",
        help="A packing model, or the name of a bundled one ([bold]crystal models[/bold]).",
    ),
]
Run = Annotated[
    Path | None,
    typer.Option(
        metavar="FOLDER",
        help="Keep what is finished there: a new folder, or one of an interrupted run to go on "
        "with.",
    ),
]
Jobs = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        min=1,
        help="Threads, or workers of [bold]--cluster local[/bold]; by default one a core.",
    ),
]
Cluster = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS|local",
        help="Work on a Dask cluster, with all threads of its workers; the results are the same. "
        "[dim]Needs the extra \\[cluster].[/dim]",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON, and nothing else.")]
Figure = Annotated[
    Path | None,
    typer.Option(metavar="FILE.png", help="Draw it; the suffix chooses the format."),
]
Html = Annotated[
    Path | None,
    typer.Option(metavar="FILE.html", help="Write a page with the packed cell in 3-D."),
]


@dataclass(frozen=True)
class Workplace:
    """Where a run is done, as the options say.

    Attributes:
        run: the folder that it is kept in, None to keep nothing.
        cluster: a Dask scheduler's address, ``local``, or None for threads here.
        jobs: threads or local workers; None for one a core.
    """

    run: Path | None
    cluster: str | None
    jobs: int | None


class Session:
    """One command at work on a run.

    Attributes:
        execute: who does the pieces of work.
        store: where they are kept, None if nowhere.
        interrupted: set by Ctrl-C.
    """

    def __init__(
        self, execute: Execute, store: RunStore | None, interrupted: threading.Event
    ) -> None:
        self.execute, self.store, self.interrupted = execute, store, interrupted

    def check(self) -> None:
        """Go no further after Ctrl-C.

        Raises:
            KeyboardInterrupt: there was one.
        """
        if self.interrupted.is_set():
            raise KeyboardInterrupt

    def results(self, title: str, work: Work, pieces: Sequence[Piece]) -> Iterator[Any]:
        """The pieces' results in order, with their progress on stderr.

        Raises:
            KeyboardInterrupt: after Ctrl-C; what was finished is kept.
        """
        from ellipsoid_planning.crystal.phasing.runs import done

        with progress(title, len(pieces)) as update:
            for _, result in done(
                work,
                pieces,
                self.execute,
                self.store,
                stopped=self.interrupted.is_set,
                on_piece=lambda _: update(None, 1),
            ):
                yield result


@contextmanager
def session(workplace: Workplace, settings: Callable[[], Mapping[str, Any]]) -> Iterator[Session]:
    """A session, once everything is known to be in order; Ctrl-C ends it with 130.

    Args:
        workplace: where the work is done and kept.
        settings: what the run's pieces depend on.

    Raises:
        EllipsoidPlanningError: the folder cannot be used or holds another run, or the cluster
            cannot be reached.
    """
    from ellipsoid_planning.crystal.phasing.run_store import RunStore

    store = None if workplace.run is None else RunStore(workplace.run)
    if store is not None:
        store.check(settings())
    with _executor(workplace.cluster, workplace.jobs) as execute:
        if store is not None:
            if store.is_open:
                say(f"Going on with the run in {store.folder}.")
            store.open(settings())
        with noted_interrupts(twice_ends=True) as interrupted:
            try:
                yield Session(execute, store, interrupted)
            except KeyboardInterrupt:
                kept = "What is finished is kept; give the same command to go on."
                nothing = "Nothing is kept; name a folder by --run to be able to go on."
                say(f"{interrupted.message} {nothing if store is None else kept}")
                raise typer.Exit(interrupted.exit_code) from None


@contextmanager
def _executor(cluster: str | None, jobs: int | None) -> Iterator[Execute]:
    from ellipsoid_planning.cluster import LOCAL, ClusterError
    from ellipsoid_planning.crystal.phasing.runs import in_threads, on_cluster

    if cluster is not None and cluster != LOCAL and jobs is not None:
        raise ClusterError("--jobs is for this machine; a cluster's workers have their own threads")
    count = jobs or _cores()
    with nullcontext(in_threads(count)) if cluster is None else on_cluster(cluster, count) as work:
        yield work


def _cores() -> int:
    """How many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
