"""A Minkowski sum or difference as tables for people."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.table import Table

if TYPE_CHECKING:
    from ellipsoid_planning.geometry.bound import Bound
    from ellipsoid_planning.geometry.minkowski_summary import MinkowskiSummary

COLOURS = {"exact": "bold green", "lower": "cyan", "upper": "magenta", "estimate": "yellow"}


def summary_tables(summary: MinkowskiSummary) -> list[Table]:
    """Volumes, and the ellipsoids inside and around."""
    return [_volumes(summary), _approximations(summary)]


def _volumes(summary: MinkowskiSummary) -> Table:
    what = "Area" if summary.first.dimension == 2 else "Volume"
    sign = "⊖" if summary.difference else "⊕"
    table = Table(title=f"{what} of E1 {sign} E2", title_justify="left")
    table.add_column("name")
    table.add_column("kind")
    table.add_column(what.lower(), justify="right")
    table.add_column("error", justify="right")
    table.add_column("source", style="dim")
    for name, bound in _sorted(summary.volumes):
        style = COLOURS[bound.kind]
        kind = f"[{style}]{bound.kind}[/{style}]"
        error = _error(float(bound), summary.exact) if name != "exact" else ""
        text = f"{float(bound):.8g}"
        table.add_row(name.replace("_", " "), kind, text, error, bound.source)
    rolling = summary.rolling
    if rolling is not None:
        table.caption_justify = "left"
        table.caption = (
            f"E2 rolls freely in E1 (Blaschke), and could grow by {100.0 * rolling.margin:.3g} %"
            if rolling.holds
            else f"E2 does not roll freely in E1 (Blaschke): it is {-100.0 * rolling.margin:.3g} % "
            "too large for that"
        )
    return table


def _sorted(volumes: dict[str, Bound]) -> list[tuple[str, Bound]]:
    """By value, the exact one in its place among them."""
    order = {"lower": 0, "exact": 1, "estimate": 1, "upper": 2}
    return sorted(volumes.items(), key=lambda one: (float(one[1]), order[one[1].kind]))


def _error(value: float, exact: float) -> str:
    if exact <= 0.0:
        return ""
    error = 100.0 * (value / exact - 1.0)
    return "0 %" if abs(error) < 1e-9 else f"{error:+.3g} %"


def _approximations(summary: MinkowskiSummary) -> Table:
    from ellipsoid_planning.geometry.minkowski_summary import volume_of

    table = Table(title="Ellipsoids inside and around", title_justify="left")
    for head in ("name", "kind"):
        table.add_column(head)
    for head in ("semi-axes", "volume", "error"):
        table.add_column(head, justify="right")
    for one in summary.approximations:
        axes = ", ".join(f"{axis:.5g}" for axis in one.ellipsoid.semi_axes)
        volume = volume_of(one.ellipsoid)
        error = _error(volume, summary.exact)
        table.add_row(one.name, one.kind, axes, f"{volume:.8g}", error)
    return table
