"""Joints instead of a layer: the picture for robots whose base is fixed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ellipsoid_planning.robots.joint import PRISMATIC
from planners.view import colours
from planners.view.figures_layer import add_legend
from planners.view.plain_text import as_written

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ellipsoid_planning.robots import Joint
    from planners.view.joint_slice import JointSlice


def draw_joint_slice(axes: Axes, view: JointSlice, marked: str) -> None:
    """Draw which values of two joints are free, the others held; `marked` says as where.

    With one joint there is a strip instead, and with ball joints only a remark.
    """
    names = " and ".join(as_written(joint.name) for joint in view.joints)
    axes.set_title(f"Joints {names}" if len(view.joints) > 1 else names, loc="left", fontsize=11)
    axes.tick_params(colors="#606060", labelsize=8)
    if not view.joints:
        axes.text(0.5, 0.5, "ball joints only", transform=axes.transAxes, ha="center")
        axes.set_axis_off()
        return
    _draw_free(axes, view)
    point = [_shown(joint, value) for joint, value in zip(view.joints, view.point, strict=True)]
    colour = colours.START if marked == "start" else colours.ROBOT
    dot = {"markersize": 8, "markeredgecolor": "white", "zorder": 6, "clip_on": False}
    label = marked if len(view.configuration) <= len(point) else f"{marked}, whose others are held"
    axes.plot(*[*point, 0.5][:2], "o", color=colour, label=label, **dot)  # type: ignore[arg-type]
    axes.set_xlabel(_label(view.joints[0]), fontsize=9)
    if len(view.joints) > 1:
        axes.set_ylabel(_label(view.joints[1]), fontsize=9)
    else:
        axes.set_yticks([])
    add_legend(axes)


def _draw_free(axes: Axes, view: JointSlice) -> None:
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Rectangle

    blocked = colours.tint(colours.C_OBSTACLE, 0.4)
    limits = [(_shown(j, j.lower), _shown(j, j.upper)) for j in view.joints]
    (left, right), (bottom, top) = [*limits, (0.0, 1.0)][:2]
    axes.imshow(
        np.atleast_2d(view.free()),
        origin="lower",
        extent=(left, right, bottom, top),
        aspect="auto",
        interpolation="nearest",
        cmap=ListedColormap([blocked, "white"]),
        vmin=0,
        vmax=1,
    )
    in_legend = Rectangle((left, bottom), 0.0, 0.0, facecolor=blocked, label="not proved free")
    axes.add_patch(in_legend)


def _shown(joint: Joint, value: float) -> float:
    return float(value) if joint.type == PRISMATIC else float(np.degrees(value))


def _label(joint: Joint) -> str:
    name = as_written(joint.name)
    return name if joint.type == PRISMATIC else f"{name} [°]"
