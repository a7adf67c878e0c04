"""Checking that links and joints make a tree, and walking it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from ellipsoid_planning.errors import GeometryError
from ellipsoid_planning.robots.joint import Joint


def check_tree(
    links: Sequence[str], joints: Sequence[Joint], ignored: Collection[frozenset[str]]
) -> None:
    """Check names, and that the joints hang every link but one on another.

    Raises:
        GeometryError: saying which joint or link is wrong.
    """
    _check_unique(links, "link")
    _check_unique([joint.name for joint in joints], "joint")
    known = set(links)
    parents: dict[str, Joint] = {}
    for joint in joints:
        for role, name in (("parent", joint.parent), ("child", joint.child)):
            if name not in known:
                raise GeometryError(
                    f"joint {joint.name!r}: {role} {name!r} is no link; "
                    f"the links are {', '.join(links)}"
                )
        if joint.child in parents:
            raise GeometryError(
                f"link {joint.child!r} is the child of two joints, "
                f"{parents[joint.child].name!r} and {joint.name!r}; links must form a tree"
            )
        parents[joint.child] = joint
    _check_connected(links, parents)
    for pair in ignored:
        for name in pair - known:
            raise GeometryError(f"ignored pair: {name!r} is no link")
        if len(pair) != 2:
            raise GeometryError(f"ignored pair: expected two links, got {sorted(pair)}")


def _check_unique(names: Sequence[str], kind: str) -> None:
    for index, name in enumerate(names):
        if name in names[:index]:
            raise GeometryError(f"two {kind}s are called {name!r}; give each a name of its own")


def _check_connected(links: Sequence[str], parents: dict[str, Joint]) -> None:
    for link in links:
        seen, at = [link], link
        while at in parents:
            at = parents[at].parent
            if at in seen:
                cycle = " -> ".join(reversed([*seen[seen.index(at) :], at]))
                raise GeometryError(f"the joints form a cycle, {cycle}; links must form a tree")
            seen.append(at)
    roots = [link for link in links if link not in parents]
    if len(roots) != 1:
        raise GeometryError(
            f"links {', '.join(repr(root) for root in roots)} are not connected by joints; "
            "each link but one must be the child of a joint"
        )


def joints_in_order(joints: Sequence[Joint], root: str) -> Iterator[Joint]:
    """The joints, every parent's before its children's."""
    children: dict[str, list[Joint]] = {}
    for joint in joints:
        children.setdefault(joint.parent, []).append(joint)
    waiting = [root]
    while waiting:
        for joint in children.get(waiting.pop(0), []):
            yield joint
            waiting.append(joint.child)
