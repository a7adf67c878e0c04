"""The colours of a packed cell: a hue for each symmetry operation, a shade for each part."""

from __future__ import annotations

import colorsys
from typing import TYPE_CHECKING

from planners.view import colours
from planners.view.links import link_shades

if TYPE_CHECKING:
    from ellipsoid_planning.crystal.packing.model import PackingModel

OVERLAP = "#f0e442"  # yellow, as in the thesis; no copy has it
OVERLAP_EDGE = "#8a7f00"
CELL = "#262626"
NEIGHBOUR_CELLS = "#9a9a9a"
FADED = 0.55  # whiteness of the copies in neighbouring cells

# Okabe and Ito's hues without the yellow and its neighbour, then Paul Tol's (see `colours`).
HUES = (
    "#0072b2",
    "#d55e00",
    "#009e73",
    "#aa4499",
    "#56b4e9",
    "#882255",
    "#999933",
    "#332288",
)
YELLOW = (0.11, 0.21)  # hues that would look like an overlap
GOLDEN = 0.618034


def operation_colours(count: int) -> tuple[str, ...]:
    """A colour for each of ``count`` operations; from nine on they are no longer told apart well.

    The first ones stay the same whatever the count.
    """
    return tuple(HUES[i] if i < len(HUES) else _made_up(i) for i in range(count))


def part_shades(model: PackingModel, colour: str) -> list[str]:
    """Shades of a colour for the parts of a molecule: the first link's is the colour itself."""
    robot = model.molecule.robot
    shades = link_shades(robot, colour)
    return [shades[link] for link in robot.part_links]


def _made_up(index: int) -> str:
    width = 1.0 - (YELLOW[1] - YELLOW[0])
    hue = (YELLOW[1] + (index * GOLDEN % 1.0) * width) % 1.0
    channels = colorsys.hsv_to_rgb(hue, (0.85, 0.5)[index % 2], (0.75, 0.6, 0.9)[index % 3])
    return "#" + "".join(f"{round(255 * channel):02x}" for channel in channels)


def faded(colour: str) -> str:
    """The colour of a copy in a neighbouring cell."""
    return colours.tint(colour, FADED)
