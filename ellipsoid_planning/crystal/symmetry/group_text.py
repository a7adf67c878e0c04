"""Groups as text: the thesis' files (``Coset 1``, then ``(x,y,z)``), or bare triplets."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from ellipsoid_planning.crystal.file_content import read_content
from ellipsoid_planning.crystal.symmetry.operation import Operation
from ellipsoid_planning.crystal.symmetry.space_group import SpaceGroup
from ellipsoid_planning.errors import CrystalError, ScenarioError

MOST_BYTES = 1 << 20
HEADER = re.compile(r"coset\s*\d*\s*:?\s*", re.IGNORECASE)


def space_group_from_text(source: str | Path, name: str | None = None) -> SpaceGroup:
    """The group of a list of operations, one of each coset of the conventional translations.

    Each operation has a line of its own, ``(x,y,z)`` or ``x,y,z``; lines ``Coset 1``, empty lines
    and what follows a ``#`` are skipped. The identity comes first.

    Args:
        source: the text itself, or the path of a file.
        name: of the group; by default that of the file without its suffix.

    Raises:
        ScenarioError: the file cannot be read, a line is no operation, or the operations make no
            group; names the file, and the line or the missing product.
    """
    file = str(source) if isinstance(source, Path) else None
    text = _read(source) if isinstance(source, Path) else source
    operations = [operation for coset in parse_cosets(text, file) for operation in coset]
    name = name or (source.stem if isinstance(source, Path) else "group")
    try:
        return SpaceGroup(name, None, tuple(operations))
    except CrystalError as error:
        raise ScenarioError(str(error), file=file) from None


def parse_cosets(text: str, file: str | None = None) -> list[list[Operation]]:
    """The operations under each line ``Coset k``; one coset each when there are no such lines.

    Raises:
        ScenarioError: a line is no operation, or its dimension is not that of those before.
    """
    cosets: list[list[Operation]] = []
    headed = False
    for number, line in enumerate(text.splitlines(), start=1):
        content = line.split("#", 1)[0].strip()
        if HEADER.fullmatch(content):
            headed = True
            cosets.append([])
        elif content:
            operation = _parse_line(content, file, number)
            _check_dimension(cosets, operation, file, number)
            if not headed or not cosets:
                cosets.append([])
            cosets[-1].append(operation)
    return cosets


def print_cosets(cosets: Iterable[Sequence[Operation]]) -> str:
    """The thesis' text format, with a line ``Coset k`` and one line for each operation."""
    lines: list[str] = []
    for number, coset in enumerate(cosets, start=1):
        lines.append(f"Coset {number}")
        lines += [f"({operation})" for operation in coset]
    return "\n".join(lines) + "\n"


def print_group(group: SpaceGroup) -> str:
    """The group's operations in the thesis' text format; `space_group_from_text` reads it."""
    return print_cosets([operation] for operation in group.operations)


def _read(path: Path) -> str:
    try:
        return read_content(path, MOST_BYTES).decode()
    except UnicodeDecodeError:
        raise ScenarioError("expected a text file with operations", file=str(path)) from None


def _parse_line(content: str, file: str | None, number: int) -> Operation:
    try:
        return Operation.parse(content)
    except CrystalError as error:
        raise ScenarioError(str(error), file=file, line=number) from None


def _check_dimension(
    cosets: list[list[Operation]], operation: Operation, file: str | None, number: int
) -> None:
    first = next((coset[0] for coset in cosets if coset), operation)
    if first.dimension != operation.dimension:
        raise ScenarioError(
            f"{operation}: expected {first.dimension} coordinates as in the lines before, got "
            f"{operation.dimension}",
            file=file,
            line=number,
        )
