"""Robots changed a little, so that something touches by a hair."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ellipsoid_planning.geometry.ellipsoid import Ellipsoid
from ellipsoid_planning.robots.articulated import ArticulatedRobot, Link


def all_ignored(robot: ArticulatedRobot) -> ArticulatedRobot:
    """The robot without self-collision."""
    names = [link.name for link in robot.links]
    pairs = frozenset(frozenset((a, b)) for a in names for b in names if a != b)
    return replace(robot, ignored=pairs)


def with_link_scaled(robot: ArticulatedRobot, name: str, factor: float) -> ArticulatedRobot:
    """The robot with the parts of one link grown about their centres."""
    links = tuple(
        Link(
            link.name,
            tuple(Ellipsoid(p.centre, p.rotation, p.semi_axes * factor) for p in link.parts),
        )
        if link.name == name
        else link
        for link in robot.links
    )
    return replace(robot, links=links)


def from_outside(gap: Callable[[float], float], start: float) -> tuple[float, float]:
    """Where a distance has become small on the way in, and a step for the secant method."""
    value = gap(start)
    while value > 0.05:
        start -= 0.9 * value
        value = gap(start)
    return start, -0.01
