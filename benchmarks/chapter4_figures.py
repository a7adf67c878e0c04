"""The pictures of the thesis' chapter 4, with our numbers."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.chapter4_solids import curved_faces, draw_prism, draw_solid, new_space, wedge_faces
from ellipsoid_planning.groups import (
    DoubleCosets,
    FiniteGroup,
    GridMetrics,
    VoronoiCell,
    icosahedral,
    octahedral,
    plane_group,
    tetrahedral,
)
from ellipsoid_planning.groups.cosets import BEST_CONJUGATION, Wedge
from ellipsoid_planning.groups.distortion import distortion, euler_distortion
from ellipsoid_planning.groups.lattices import lattice_nodes
from ellipsoid_planning.groups.published_cells import published_cell
from ellipsoid_planning.groups.quaternions import logarithm, random_rotations
from planners.view import colours

BLUE, ORANGE, GREEN, PINK = colours.ROBOT, colours.GOAL, colours.START, colours.ROADMAP
YELLOW = colours.C_OBSTACLE
PLATONIC = (tetrahedral, octahedral, icosahedral)
HUES = (BLUE, GREEN, ORANGE)
CONJUGATIONS = 60


def figure_4_3() -> Figure:
    """Centre cells: exact with curved faces, the published polyhedra around, and their nodes."""
    drawn = Figure(figsize=(12.0, 8.0), layout="constrained")
    for column, (make, hue) in enumerate(zip(PLATONIC, HUES, strict=True)):
        group, published = make(), published_cell(make().name)
        cell = VoronoiCell.of_group(group)
        reach = 1.02 * float(np.abs(published.vertices).max())
        for row in range(2):
            axes = new_space(drawn, (2, 3, 3 * row + column + 1), reach)
            if row == 0:
                draw_solid(axes, curved_faces(cell), hue, 0.55)
                axes.set_title(f"{group.name}: {len(cell.normals)} curved faces", fontsize=10)
            else:
                nodes = logarithm(lattice_nodes(cell, "cubic", math.pi / 15.0))
                axes.scatter(*nodes.T, s=7.0, color=hue, linewidths=0)
                axes.set_title(f"{len(nodes)} nodes; published polyhedron", fontsize=10)
            _outline(axes, published.vertices, published.normals, published.offsets)
    return drawn


def _outline(axes: Axes, vertices: np.ndarray, normals: np.ndarray, offsets: np.ndarray) -> None:
    on = np.abs(vertices @ normals.T - offsets) < 1e-6
    for i in range(len(vertices)):
        for j in range(i):
            if np.count_nonzero(on[i] & on[j]) >= 2:
                axes.plot(*vertices[[i, j]].T, color=colours.PATH, linewidth=0.8)


def figure_4_4() -> Figure:
    """Distortion of exponential coordinates in each cell, and of ZXZ Euler angles."""
    drawn = Figure(figsize=(10.0, 4.0), layout="constrained")
    left, right = drawn.subplots(1, 2)
    for make, hue in zip(PLATONIC, HUES, strict=True):
        end = VoronoiCell.of_group(make()).circumradius
        angles = np.linspace(0.0, end, 200)
        percent = [100.0 * distortion(float(angle)) for angle in angles]
        left.plot(angles, percent, color=hue, linewidth=1.8)
        left.plot(end, percent[-1], "o", color=hue)
        label = f"{make().name}: {percent[-1]:.2f} %"
        left.annotate(label, (end, percent[-1]), (-8, 4), textcoords="offset points", ha="right")
    _finish(left, "Lattices in the cells of groups", "angle ‖x‖ [rad]")
    beta = np.linspace(0.0, np.pi, 300)
    right.plot(beta, 100.0 * euler_distortion(beta), color=PINK, linewidth=1.8)
    _finish(right, "ZXZ Euler angles: at most 81.65 %", "middle angle β [rad]")
    return drawn


def _finish(axes: Axes, title: str, label: str) -> None:
    axes.set_title(title, loc="left", fontsize=11)
    axes.set_xlabel(label)
    axes.set_ylabel("distortion [%]")
    axes.set_ylim(bottom=0.0)
    axes.spines[["top", "right"]].set_visible(False)


@cache
def double_cell(make) -> VoronoiCell:
    """The smallest cell found of conjugates of a group and the icosahedral group."""
    if make is icosahedral:
        return DoubleCosets(icosahedral().conjugate(BEST_CONJUGATION), icosahedral()).cell
    cells = [_cell_of(make(), g) for g in random_rotations(CONJUGATIONS, 4)]
    return min(cells, key=lambda cell: cell.circumradius)


def _cell_of(group: FiniteGroup, conjugation: np.ndarray) -> VoronoiCell:
    return DoubleCosets(group.conjugate(conjugation), icosahedral()).cell


def figure_4_7() -> Figure:
    """Cells of double cosets in the icosahedral group's."""
    drawn = Figure(figsize=(12.0, 4.9), layout="constrained")
    whole = VoronoiCell.of_group(icosahedral())
    for place, make in enumerate(PLATONIC):
        cell = double_cell(make)
        axes = new_space(drawn, (1, 3, place + 1), 0.72)
        draw_solid(axes, curved_faces(whole), YELLOW, 0.10)
        draw_solid(axes, curved_faces(cell), ORANGE, 0.9)
        title = f"{make().name} (conjugated) and icosahedral\n{len(make()) * 60} cells, "
        axes.set_title(f"{title}‖x‖ ≤ {cell.circumradius:.4f}", y=0.98, fontsize=10)
    return drawn


def figure_4_9() -> Figure:
    """The largest distortion of single and double cosets."""
    drawn = Figure(figsize=(8.5, 3.6), layout="constrained")
    axes = drawn.subplots()
    bars = [(make().name, VoronoiCell.of_group(make()), YELLOW) for make in PLATONIC]
    bars += [(f"{make().name} and icosahedral", double_cell(make), ORANGE) for make in PLATONIC]
    for row, (name, cell, hue) in enumerate(bars):
        value = 100.0 * distortion(cell.circumradius)
        axes.barh(row, value, color=hue)
        axes.text(value, row, f" {value:.2f} %", va="center", fontsize=9)
        axes.text(-0.2, row, name, va="center", ha="right", fontsize=9)
    axes.set_yticks([])
    axes.invert_yaxis()
    axes.set_xlabel("largest distortion [%]")
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_title("Cells of single cosets, and of double cosets", loc="left", fontsize=11)
    return drawn


def figure_4_10() -> Figure:
    """The icosahedral group's cell and one of its 60 wedges."""
    drawn = Figure(figsize=(5.0, 5.0), layout="constrained")
    axes = new_space(drawn, (1, 1, 1), 0.72)
    wedge = Wedge.of_group(icosahedral())
    draw_solid(axes, curved_faces(wedge.cell), YELLOW, 0.12)
    draw_solid(axes, wedge_faces(wedge), ORANGE, 0.8)
    axes.set_title("One of the 60 wedges of the icosahedral group's cell", fontsize=10)
    return drawn


def figure_4_12() -> Figure:
    """The centre cells of the chiral wallpaper groups."""
    drawn = Figure(figsize=(13.0, 3.8), layout="constrained")
    oblique = (1.0, 1.2, math.radians(75.0))
    makers = {"p1": oblique, "p2": oblique, "p4": (1.0,), "p3": (1.0,), "p6": (1.0,)}
    for place, (name, lattice) in enumerate(makers.items()):
        group = plane_group(name, *lattice)
        axes = drawn.add_subplot(1, 5, place + 1, projection="3d")
        draw_prism(axes, group.cell.polygon, group.cell.half_height, BLUE)
        axes.set_title(f"{name}: |θ| ≤ 180° / {group.order}", fontsize=10)
    return drawn


def evenness(rows: list[tuple[str, GridMetrics]]) -> Figure:
    """Separation and covering radius of all grids, over the edge of a node's share of rotations."""
    drawn = Figure(figsize=(11.0, 4.6), layout="constrained")
    left, right = drawn.subplots(1, 2, sharex=True)
    names = dict.fromkeys(name for name, _ in rows)
    for place, name in enumerate(sorted(names)):
        mine = [one for other, one in rows if other == name]
        counts = np.array([one.count for one in mine])
        share = (8.0 * np.pi**2 / counts) ** (1.0 / 3.0)
        style = {
            "color": colours.LINKS[place % len(colours.LINKS)],
            "marker": "osv^D*"[place // len(colours.LINKS)],
            "linestyle": "-" if name == "600-cell" else ":",
            "linewidth": 2.5 if name == "600-cell" else 1.0,
        }
        left.plot(counts, [one.separation for one in mine] / share, label=name, **style)
        right.plot(counts, [one.covering for one in mine] / share, **style)
    for axes, title in ((left, "Separation (more is better)"), (right, "Covering radius (less)")):
        axes.set_xscale("log")
        axes.set_title(f"{title} / spacing", loc="left", fontsize=11)
        axes.set_xlabel("rotations")
        axes.spines[["top", "right"]].set_visible(False)
        axes.set_ylim(bottom=0.0)
    drawn.legend(loc="outside right center", fontsize=8, frameon=False)
    return drawn


FIGURES = {
    "4.3": figure_4_3,
    "4.4": figure_4_4,
    "4.7": figure_4_7,
    "4.9": figure_4_9,
    "4.10": figure_4_10,
    "4.12": figure_4_12,
}
