"""What the commands ``group ...`` answer, as JSON and as rows of spreadsheets.

Elements are numbered from 1, as in the thesis.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup

Report = dict[str, Any]
Rows = list[list[Any]]


def show(group: SpaceGroup) -> Report:
    """A group's operations and kind."""
    from ellipsoid_planning.crystal.symmetry.names import setting_name, type_name, type_number

    number = group.number or type_number(group.operations)
    return {
        "name": group.name,
        "number": number,
        "type": type_name(group.operations),
        "setting": setting_name(group.operations),
        "dimension": group.dimension,
        "order": group.order,
        "symmorphic": group.symmorphic,
        "bieberbach": group.bieberbach,
        "sohncke": group.sohncke,
        "enantiomorphic": group.enantiomorphic,
        "elements": [operation.triplet() for operation in group.operations],
    }


def show_rows(group: SpaceGroup) -> Rows:
    """One row an operation."""
    header = ["number", "triplet", "order", "inverse", "determinant"]
    orders = _orders(group)
    inverses = (group.inverses + 1).tolist()
    return [
        header,
        *(
            [i + 1, operation.triplet(), orders[i], inverses[i], int(operation.determinant)]
            for i, operation in enumerate(group.operations)
        ),
    ]


def table(group: SpaceGroup) -> Report:
    """The multiplication table."""
    return {
        "name": group.name,
        "order": group.order,
        "elements": [operation.triplet() for operation in group.operations],
        "table": (group.table + 1).tolist(),
    }


def subgroups(group: SpaceGroup) -> Report:
    """All subgroups with their classes and types."""
    from ellipsoid_planning.crystal.symmetry.names import setting_name, type_name
    from ellipsoid_planning.crystal.symmetry.subgroups import all_subgroups, class_count

    found = all_subgroups(group)
    # Conjugate subgroups are of one type.
    types: dict[int, str | None] = {}
    entries = []
    for subgroup in found:
        operations = [group.operations[index] for index in subgroup.elements]
        if subgroup.conjugacy_class not in types:
            types[subgroup.conjugacy_class] = type_name(operations)
        entries.append(
            {
                "elements": [operation.triplet() for operation in operations],
                "order": subgroup.order,
                "normal": subgroup.normal,
                "class": subgroup.conjugacy_class,
                "name": types[subgroup.conjugacy_class],
                "setting": setting_name(operations),
                "numbers": _from_one(subgroup.elements),
                "generators": _from_one(subgroup.generators),
            }
        )
    return {"order": group.order, "classes": class_count(found), "subgroups": entries}


def subgroup_rows(report: Report) -> Rows:
    """One row a subgroup, the numbers of its elements in the last columns."""
    header = ["class", "order", "normal", "name", "setting", "generators", "elements"]
    return [
        header,
        *(
            [
                entry["class"],
                entry["order"],
                int(entry["normal"]),
                entry["name"] or "",
                entry["setting"] or "",
                " ".join(map(str, entry["generators"])),
                *entry["numbers"],
            ]
            for entry in report["subgroups"]
        ),
    ]


def is_subgroup(group: SpaceGroup, numbers: list[int]) -> Report:
    """Whether the elements with these numbers are a subgroup."""
    from ellipsoid_planning.crystal.symmetry import elements

    verdict = elements.is_subgroup(group, [number - 1 for number in numbers])
    report = {**_asked(group, numbers), "subgroup": verdict.holds}
    return {**report, **_reason(group, verdict)}


def is_normal(group: SpaceGroup, numbers: list[int]) -> Report:
    """Whether the elements with these numbers are a normal subgroup."""
    from ellipsoid_planning.crystal.symmetry import elements

    verdict = elements.is_normal(group, [number - 1 for number in numbers])
    report = {**_asked(group, numbers), "subgroup": verdict.product is None}
    return {**report, "normal": verdict.holds, **_reason(group, verdict)}


def answer_rows(report: Report) -> Rows:
    """The answer as a single row."""
    asked = [key for key in ("subgroup", "normal") if key in report]
    header = ["name", "elements", *asked, "message"]
    numbers = " ".join(map(str, report["numbers"]))
    return [header, [report["name"], numbers, *(int(report[k]) for k in asked), report["message"]]]


def cosets(group: SpaceGroup, numbers: list[int]) -> Report:
    """Both coset spaces of the subgroup with these elements."""
    from ellipsoid_planning.crystal.symmetry.cosets import coset_spaces

    spaces = coset_spaces(group, [number - 1 for number in numbers])
    return {
        **_asked(group, numbers),
        "index": len(spaces.left),
        "agree": spaces.agree,
        "left": [_coset(group, coset) for coset in spaces.left],
        "right": [_coset(group, coset) for coset in spaces.right],
        "matches": [None if match is None else match + 1 for match in spaces.matches],
    }


def coset_rows(report: Report) -> Rows:
    """One row a coset, the numbers of its elements in the last columns."""
    rows: Rows = [["side", "coset", "elements"]]
    for side in ("left", "right"):
        cosets = enumerate(report[side], start=1)
        rows += [[side, place, *coset["numbers"]] for place, coset in cosets]
    return rows


def _asked(group: SpaceGroup, numbers: list[int]) -> Report:
    from ellipsoid_planning.crystal.symmetry.elements import checked_elements

    chosen = checked_elements(group, [number - 1 for number in numbers])
    return {"name": group.name, "order": group.order, **_coset(group, chosen)}


def _coset(group: SpaceGroup, indices: Iterable[int]) -> Report:
    chosen = list(indices)
    texts = [group.operations[index].triplet() for index in chosen]
    return {"elements": texts, "numbers": _from_one(chosen)}


def _reason(group: SpaceGroup, verdict: Any) -> Report:
    """The counter-example in numbers and as a triplet, and the answer in words."""
    example: Report | None = None
    if verdict.product is not None:
        i, j, k = verdict.product
        example = {"kind": "product", "first": i + 1, "second": j + 1, "result": k + 1}
    elif verdict.conjugate is not None:
        g, h, k = verdict.conjugate
        example = {"kind": "conjugate", "g": g + 1, "h": h + 1, "result": k + 1}
    if example is not None:
        example["triplet"] = group.operations[example["result"] - 1].triplet()
    return {"counter_example": example, "message": verdict.message}


def _from_one(indices: Iterable[int]) -> list[int]:
    return [index + 1 for index in indices]


def _orders(group: SpaceGroup) -> list[int]:
    """The order of each element in the factor group."""
    orders = []
    for index in range(group.order):
        power, order = index, 1
        while power:
            power, order = int(group.table[index, power]), order + 1
        orders.append(order)
    return orders
