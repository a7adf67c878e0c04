"""How contenders look in every figure of a benchmark, and what all these figures share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from planners.benchmark.contenders import Contender
from planners.benchmark.tables import duration

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INK = "#1a1a1a"
QUIET = "#6b6b6b"
GRID = "#e4e4e4"

_OURS = "HighwayRoadmap"
_OUR_COLOUR = "#0072b2"
_COLOURS = ("#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6bb1", "#7f7f7f")
"""Okabe and Ito's hues, and two more that stay apart from them for every reader."""
_MARKERS = ("s", "D", "^", "v", "P", "X", "h")


@dataclass(frozen=True)
class Style:
    """How one contender is drawn: the planner has the colour, the checker the line."""

    colour: str
    marker: str
    dashes: Any
    width: float
    is_ours: bool = False


def styles(contenders: Sequence[Contender]) -> dict[str, Style]:
    """The style of every contender, by label."""
    names = [name for name in dict.fromkeys(c.planner for c in contenders) if name != _OURS]
    number = {name: index % len(_COLOURS) for index, name in enumerate(names)}
    return {contender.label: _style(contender, number) for contender in contenders}


def _style(contender: Contender, number: dict[str, int]) -> Style:
    if contender.planner == _OURS:
        return Style(_OUR_COLOUR, "o", "-", 2.6, is_ours=True)
    index = number[contender.planner]
    dashes: Any = "-" if contender.checker == "plugin" else (0, (4.0, 1.6))
    return Style(_COLOURS[index], _MARKERS[index], dashes, 1.6)


def plain_axes(axes: Axes) -> None:
    """Take away what says nothing."""
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.spines["bottom"].set_color(QUIET)
    axes.tick_params(labelsize=9, colors=QUIET, length=3)
    axes.tick_params(axis="y", which="both", length=0)
    axes.tick_params(axis="x", which="minor", length=0)
    axes.set_axisbelow(True)


def time_axis(axis: Any) -> None:
    """Let the ticks of a logarithmic axis of seconds read 1 ms, 10 ms, 1 s."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(10.0, numticks=20))
    axis.set_major_formatter(FuncFormatter(lambda value, _: duration(value)))
    axis.set_minor_formatter(NullFormatter())


def spread(heights: Sequence[float], least: float, low: float, high: float) -> list[float]:
    """``heights`` moved apart, in their order, so that neighbours differ by ``least``.

    They stay within [low, high] if there is room for them.
    """
    order = sorted(range(len(heights)), key=lambda index: heights[index])
    placed = [min(max(heights[index], low), high) for index in order]
    for _ in range(200):
        moved = False
        for k in range(len(placed) - 1):
            lack = least - (placed[k + 1] - placed[k])
            if lack > 1e-9:
                placed[k] = max(placed[k] - 0.5 * lack, low + k * least)
                placed[k + 1] = placed[k] + least
                moved = True
        over = placed[-1] - high if placed else 0.0
        if over > 1e-9:
            placed = [place - over for place in placed]
        if not moved:
            break
    result = [0.0] * len(heights)
    for index, place in zip(order, placed, strict=True):
        result[index] = place
    return result
