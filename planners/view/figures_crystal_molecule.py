"""A molecule and its degrees of freedom (thesis fig. 3.15)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from planners.view import colours
from planners.view import crystal_colours as palette
from planners.view.camera import frame
from planners.view.crystal_plane import halo
from planners.view.crystal_space import AZIMUTH, FINE
from planners.view.embedding import outline
from planners.view.figures_crystal import saved
from planners.view.figures_plane import ellipse, finish
from planners.view.plain_text import as_written
from planners.view.ray_image import RayImage

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    from ellipsoid_planning.crystal.packing.model import PackingModel

    Array = NDArray[np.float64]

SIZES = {2: (8.0, 5.4), 3: (8.0, 7.0)}  # by dimension [inches]
# Of arrows, in the molecule's radius; those of the base beyond the molecule.
LENGTHS = {"base": 0.25, "shift": 0.4, "joint": 0.8}
LABEL = np.array([0.85, 0.35])  # how far a label's middle is from a head, in room
THICKNESS = 0.004  # of arrows, as a part of the window
HUES = {"base": "#1a1a1a", "shift": colours.START, "joint": colours.GOAL}
ROOM = 0.2  # around the arrows, as a part of the window


class Motion(NamedTuple):
    """A coordinate's axis in the world.

    Attributes:
        label: the coordinate's name and range, angles in degrees.
        kind: base (a turn of the whole molecule), shift or joint.
        point: (3,), on the axis.
        direction: (3,), a unit vector.
    """

    label: str
    kind: str
    point: Array
    direction: Array


def picture_of_molecule(
    model: PackingModel, suffix: str, configuration: ArrayLike | None = None
) -> bytes:
    """Draw a molecule with an arrow for each degree of freedom, as a picture's bytes.

    Args:
        model: the molecule and its ranges.
        suffix: the picture's format, such as png.
        configuration: (K,), the middle of all ranges by default.
    """
    return saved(draw_molecule(model, configuration), suffix)


def draw_molecule(model: PackingModel, configuration: ArrayLike | None = None) -> Figure:
    """Return the matplotlib figure."""
    from matplotlib.figure import Figure

    values = np.array([0.5 * (r.lower + r.upper) for r in model.grid.ranges])
    if configuration is not None:
        values = np.array(configuration, dtype=float)
    drawn = Figure(figsize=SIZES[model.dimension], layout="constrained")
    count = len(model.keys)
    drawn.suptitle(
        f"{as_written(model.name)}: {count} degrees of freedom", fontsize=13, fontweight="bold"
    )
    axes = drawn.add_subplot()
    draw = _draw_plane if model.dimension == 2 else _draw_space
    draw(axes, model, values)
    return drawn


def motions(model: PackingModel, configuration: Array) -> list[Motion]:
    """The axes of all coordinates where a configuration puts them."""
    molecule = model.molecule
    frames = molecule.frames(configuration)
    found = []
    for k, (coordinate, span) in enumerate(
        zip(molecule.coordinates, model.grid.ranges, strict=True)
    ):
        low, high = span.lower, span.upper
        low, high = np.degrees([low, high]) if coordinate.turns else (low, high)
        unit = "°" if coordinate.turns else ""
        label = f"{coordinate.name.replace('_', ' ')}: {low:.4g}{unit} to {high:.4g}{unit}"
        kind = "joint" if k >= molecule.base_count else "base" if coordinate.turns else "shift"
        # A turn leaves its own axis where it is.
        direction = frames[k, :9].reshape(3, 3) @ molecule.axes[k]
        found.append(Motion(label, kind, frames[k, 9:].copy(), direction))
    return found


def _draw_plane(axes: Axes, model: PackingModel, values: Array) -> None:
    """Axes of turns are points here; all labels stand to the right, from top to bottom."""
    bodies = model.molecule.bodies(values)
    for body, shade in zip(bodies, palette.part_shades(model, palette.HUES[0]), strict=True):
        axes.add_patch(ellipse(body, facecolor=shade, edgecolor="black", linewidth=1.0, zorder=2))
    points = np.concatenate([outline(body) for body in bodies])
    radius = 0.5 * float(np.max(np.ptp(points, axis=0)))
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    ordered = sorted(motions(model, values), key=lambda motion: -motion.point[1])
    heights = np.linspace(0.8, -0.8, len(ordered)) if len(ordered) > 1 else np.zeros(1)
    for motion, height in zip(ordered, heights, strict=True):
        hue, turns = HUES[motion.kind], motion.kind != "shift"
        end = motion.point + (0.0 if turns else 0.5 * radius) * motion.direction
        if turns:
            ring: dict[str, Any] = {"markeredgecolor": hue, "markeredgewidth": 2.0, "zorder": 5}
            axes.plot(end[0], end[1], "o", markersize=9, color="white", **ring)
        else:
            _draw_arrow(axes, motion.point[:2], end[:2], hue)
        axes.annotate(
            motion.label,
            (end[0], end[1]),
            xytext=(middle[0] + 1.3 * radius, middle[1] + height * radius),
            ha="left",
            va="center",
            fontsize=10,
            color=hue,
            arrowprops={"arrowstyle": "-", "color": hue, "shrinkB": 6.0},
            zorder=6,
        )
    axes.set_xlim(middle[0] - 1.2 * radius, middle[0] + 2.6 * radius)
    axes.set_ylim(middle[1] - 1.2 * radius, middle[1] + 1.2 * radius)
    finish(axes)


def _draw_space(axes: Axes, model: PackingModel, values: Array) -> None:
    bodies = model.molecule.bodies(values)
    points = np.concatenate([body.surface_points(200) for body in bodies])
    camera = frame(points, AZIMUTH)
    radius = 0.5 * float(np.max(np.ptp(points, axis=0)))
    # Shifts have no place of their own; their arrows stand beside the molecule.
    aside = camera.centre - 1.3 * radius * camera.right - 1.0 * radius * camera.up
    arrows = []
    for motion in motions(model, values):
        start = aside if motion.kind == "shift" else motion.point
        length = LENGTHS[motion.kind] * radius
        if motion.kind == "base":
            length += max(float(b.support(motion.direction)) for b in bodies)
            length -= float(motion.direction @ start)
        arrows.append((motion, start + np.outer([0.0, length], motion.direction)))
    seen = camera.axes(np.concatenate([points, *(ends for _, ends in arrows)]))[:, :2]
    low, high = seen.min(axis=0), seen.max(axis=0)
    room = ROOM * float(np.max(high - low))
    margin = room * np.array([1.0, 0.5])
    low, high = low - margin, high + margin
    image = RayImage(camera, low, high, FINE)
    for body, shade in zip(bodies, palette.part_shades(model, palette.HUES[0]), strict=True):
        image.add(body, shade, 0)
    for motion, ends in arrows:
        image.add_line(ends, THICKNESS * float(np.max(high - low)), HUES[motion.kind])
    image.outline(2)
    axes.imshow(
        image.colours,
        origin="lower",
        extent=(low[0], high[0], low[1], high[1]),
        interpolation="antialiased",
    )
    _label(axes, [(motion, camera.axes(ends)[:, :2]) for motion, ends in arrows], room)
    axes.set_axis_off()


def _label(axes: Axes, arrows: list[tuple[Motion, Array]], room: float) -> None:
    """Heads of arrows, and their labels, which keep apart."""
    places: list[Array] = []
    for motion, (first, last) in arrows:
        hue = HUES[motion.kind]
        way = (last - first) / max(float(np.linalg.norm(last - first)), 1e-9)
        _draw_arrow(axes, last - 0.05 * room * way, last + 0.15 * room * way, hue)
        place = last + room * LABEL * way
        while any(np.all(np.abs(place - p) < [1.6 * room, 0.2 * room]) for p in places):
            place = place + np.array([0.0, 0.05 * room])
        places.append(place)
        axes.text(
            place[0],
            place[1],
            motion.label,
            ha="center",
            va="center",
            fontsize=9,
            color=hue,
            zorder=6,
            path_effects=halo(),
        )


def _draw_arrow(axes: Axes, first: Array, last: Array, hue: str) -> None:
    look = {"arrowstyle": "-|>", "color": hue, "mutation_scale": 18, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (last[0], last[1]), xytext=(first[0], first[1]), arrowprops=look, zorder=5)
