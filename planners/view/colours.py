"""The colours of bodies, shared by the meshcat pages and the matplotlib figures.

The hues are Okabe and Ito's ("Color Universal Design", 2008), which stay apart for readers
with any of the common colour-vision deficiencies.
"""

from __future__ import annotations

OBSTACLE = "#686868"
ARENA = "#56b4e9"
START = "#009e73"
GOAL = "#d55e00"
ROBOT = "#0072b2"
JOINT = "#262626"
PATH = "#1a1a1a"
ROADMAP = "#cc79a7"
C_OBSTACLE = "#e69f00"
FREE_INTERVAL = "#56b4e9"
SWEEP_LINE = "#c8c8c8"
FRAME = "#b0b0b0"
OUTSIDE = "#ececec"

# The links of a moving robot, over again where there are more; neither green nor orange, as its
# start and goal are. The first is the robot's own; the others are of Paul Tol's schemes ("Colour
# Schemes", 2021), which keep apart for the same readers.
LINKS = (ROBOT, "#ddaa33", "#882255", "#33bbee", "#999933", "#aa4499", "#332288", "#cc6677")


def rgb(colour: str) -> tuple[float, float, float]:
    """Return red, green and blue in [0, 1] of a colour written "#rrggbb"."""
    number = as_integer(colour)
    return ((number >> 16) / 255.0, (number >> 8 & 255) / 255.0, (number & 255) / 255.0)


def as_integer(colour: str) -> int:
    """Return the number 0xrrggbb of a colour written "#rrggbb", as three.js wants it."""
    return int(colour.removeprefix("#"), 16)


def tint(colour: str, whiteness: float) -> str:
    """Return the colour mixed with white; 0 keeps it and 1 is white."""
    channels = (round(255.0 * (c + (1.0 - c) * whiteness)) for c in rgb(colour))
    return "#" + "".join(f"{channel:02x}" for channel in channels)
