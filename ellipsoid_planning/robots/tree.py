"""Checking that links and joints make a tree, and walking it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from difflib import get_close_matches

from ellipsoid_planning.errors import RobotError
from ellipsoid_planning.robots.joint import Joint


def check_tree(
    links: Sequence[str], joints: Sequence[Joint], ignored: Collection[frozenset[str]]
) -> None:
    """Check names, and that the joints hang every link but one on another.

    Raises:
        RobotError: saying which joint or link is wrong, and where in the robot it stands.
    """
    _check_unique(links, "link")
    _check_unique([joint.name for joint in joints], "joint")
    parents: dict[str, Joint] = {}
    for index, joint in enumerate(joints):
        for role, name in (("parent", joint.parent), ("child", joint.child)):
            if name not in links:
                problem = f"joint {joint.name!r}: {role} {no_link(name, links)}"
                raise RobotError(problem, ("joints", index, role))
        if joint.child in parents:
            raise RobotError(
                f"link {joint.child!r} is the child of two joints, "
                f"{parents[joint.child].name!r} and {joint.name!r}; links must form a tree, "
                "remove one of the two or correct its child",
                ("joints", index, "child"),
            )
        parents[joint.child] = joint
    _check_connected(links, joints, parents)
    for pair in ignored:
        check_ignored_pair(sorted(pair), links)


def check_ignored_pair(pair: Sequence[str], links: Sequence[str]) -> None:
    """Check that a pair whose collisions are ignored names two links.

    Raises:
        RobotError: if a name is no link's, or the two are one.
    """
    for name in pair:
        if name not in links:
            raise RobotError(no_link(name, links), ("ignore_self_collision",))
    if len(set(pair)) != 2:
        raise RobotError(
            f"expected two different links, got {', '.join(pair) or 'none'}; "
            "name the two links that may meet",
            ("ignore_self_collision",),
        )


def no_link(name: str, links: Sequence[str]) -> str:
    """The problem of a name that should be a link's, with what it could have been."""
    close = get_close_matches(name, links, n=1)
    hint = f"did you mean {close[0]!r}?" if close else "name one of them or add this link"
    return f"{name!r} is no link; the links are {', '.join(links)}; {hint}"


def _check_unique(names: Sequence[str], kind: str) -> None:
    for index, name in enumerate(names):
        if name in names[:index]:
            raise RobotError(
                f"two {kind}s are called {name!r}; give each a name of its own",
                (f"{kind}s", index, "name"),
            )


def _check_connected(
    links: Sequence[str], joints: Sequence[Joint], parents: dict[str, Joint]
) -> None:
    for link in links:
        seen, at = [link], link
        while at in parents:
            at = parents[at].parent
            if at in seen:
                cycle = " -> ".join(reversed([*seen[seen.index(at) :], at]))
                last = max(joints.index(parents[link]) for link in seen[seen.index(at) :])
                raise RobotError(
                    f"the joints form a cycle, {cycle}; links must form a tree, remove one of "
                    "these joints or correct its parent",
                    ("joints", last),
                )
            seen.append(at)
    roots = [link for link in links if link not in parents]
    if len(roots) != 1:
        raise RobotError(
            f"links {', '.join(repr(root) for root in roots)} are not connected by joints; "
            "each link but one must be the child of a joint, add joints or remove links",
            ("links", links.index(roots[1])),
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
