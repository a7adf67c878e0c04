"""What samples and proofs say of obstacles, arenas and the robot itself."""

from __future__ import annotations

from collections.abc import Iterator

from planners.verify.report import Check
from planners.verify.resolution import Place
from planners.verify.sampling import SampledPath
from planners.verify.whole_motions import WholeMotions


def body_checks(
    sampled: SampledPath, itself: SampledPath | None, whole: WholeMotions
) -> Iterator[Check]:
    """Whether there is a contact that is certain, with obstacles, arenas, and of parts."""
    free = {"obstacle": "none is hit", "arena": "the robot stays inside"}
    for kind in ("obstacle", "arena"):
        yield _check(f"{kind}s", _contact(sampled, whole, kind), free[kind])
    if itself is not None:
        least = f"at least {2.0 * itself.smallest:.6g} {_where(*itself.place)}"
        contact = _contact(itself, whole, "self")
        yield _check("self-collision", contact, f"no part meets another, {least}")


def open_checks(whole: WholeMotions) -> Iterator[Check]:
    """Whether anything was left open between the samples, where there is no contact."""
    name, detail = "between samples", ""
    if whole.contacts:
        return
    if whole.unproved is not None:
        detail = f"not resolved: {_told(whole.unproved)}"
    elif whole.undecided:
        detail = f"not resolved: motion {whole.undecided[0]} makes half-turns that have two ways"
    if detail:
        yield Check(name, passed=False, detail=detail, open=True)
    else:
        yield Check(name, passed=True, detail="nothing is met, by separating directions")


def stated_check(proof: WholeMotions, stated: float, detail: str, doubt: float) -> Check:
    """Whether the clearance that a result states is kept between the samples, too."""
    name, nearest = "stated clearance", proof.nearest
    if nearest is not None and nearest.distance < stated - doubt:
        found = f"found {nearest.distance:.9g} {_where(nearest.motion, nearest.s)}"
        return Check(name, passed=False, detail=f"stated at least {stated:.9g}, {found}")
    if proof.unproved is None:
        return Check(name, passed=True, detail=detail)
    told = f"not resolved: {_told(proof.unproved)}"
    return Check(name, passed=False, detail=f"{detail}, {told}", open=True)


def smallest_clearance(sampled: SampledPath, whole: WholeMotions) -> tuple[float, str]:
    """The smallest clearance that was seen anywhere, and where."""
    nearest = whole.nearest
    contacts = [place for place in whole.contacts if place.kind != "self"]
    if contacts and (place := min(contacts, key=lambda one: one.gap)).gap < sampled.smallest:
        return place.gap, _where(place.motion, place.s)
    if nearest is not None and nearest.distance < sampled.smallest:
        return nearest.distance, _where(nearest.motion, nearest.s)
    return sampled.smallest, _where(*sampled.place)


def _contact(sampled: SampledPath, whole: WholeMotions, kind: str) -> str | None:
    """The contact of a kind in words, if there is one."""
    worst, place = sampled.worst, whole.contact(kind)
    if worst is not None and worst.kind == kind:
        named = worst.part, worst.body
        depth, where = worst.depth, _where(*sampled.place)
    elif place is not None:
        named = place.part, place.body
        depth, where = -place.gap, _where(place.motion, place.s)
    else:
        return None
    return f"{_meeting(kind, *named)}, about {depth:.3g} deep, {where}"


def _check(name: str, contact: str | None, free: str) -> Check:
    return Check(name, contact is None, free if contact is None else contact)


def _meeting(kind: str, part: str, body: str) -> str:
    verbs = {"obstacle": "hits obstacle", "arena": "leaves arena", "self": "meets"}
    return f"part {part!r} {verbs[kind]} {body!r}"


def _told(place: Place) -> str:
    """What could not be decided."""
    body = f"{'part' if place.kind == 'self' else place.kind} {place.body!r}"
    gap = f"a gap of {place.gap:.3g} at least, of {place.distance:.3g} at most"
    return f"part {place.part!r} and {body} leave {gap}, {_where(place.motion, place.s)}"


def _where(motion: int, s: float) -> str:
    return f"in motion {motion} at {s:.6g}"
