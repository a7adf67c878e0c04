"""What pydantic found wrong with a scenario, in the words of the scenario format."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ellipsoid_planning.errors import ScenarioError
from ellipsoid_planning.numbers_shown import shown as short
from ellipsoid_planning.orientation_forms import PLANAR_FORMS, SPATIAL_FORMS
from ellipsoid_planning.scenario_format_robot import TAGS
from ellipsoid_planning.scenario_origin import Origin, Path
from ellipsoid_planning.sizes import LEAST_LENGTH, MOST_LENGTH, REMEDY

if TYPE_CHECKING:
    from pydantic import ValidationError

FORMS = PLANAR_FORMS + SPATIAL_FORMS
VECTORS = ("semi_axes", "position", "low", "high", "axis")
BODILESS = {"parts": "part", "links": "link"}
WRONG_KEYS = ("unknown_key", "misplaced_key")
# Steps of pydantic's that no file has: branches of unions, and "[key]" at keys of a wrong type.
NOT_IN_FILES = TAGS | {"[key]"}
JOINT_VALUE = (
    "a number, or an orientation for a ball joint",
    "write NAME_deg: 30 (angle), NAME: 0.2 (shift) or NAME: {quaternion: [x, y, z, w]} (ball)",
)

# What was expected, and the remedy, by pydantic's error type.
EXPECTATIONS: Mapping[str, tuple[str, str]] = {
    "float_type": ("a number", "write it without quotes"),
    "finite_number": ("a finite number", "write an ordinary number"),
    "greater_than": ("a positive number", "give a length above zero"),
    "greater_than_equal": ("a number that is not negative", "give zero or more"),
    "string_too_short": ("text that is not empty", "give it a name"),
    "string_type": ("text", "put it in quotes"),
    "group": ("a group's symbol or number", "write group: P212121, say"),
    "bool_type": ("true or false", "write one of them without quotes"),
    "list_type": ("a list", "write it in brackets, [..., ...], or as lines that start with '-'"),
    "model_type": ("a mapping", "write it as key: value pairs"),
    "model_attributes_type": ("a mapping", "write it as key: value pairs"),
    "dict_type": ("a mapping", "write it as key: value pairs"),
    "invalid_key": ("keys that are text", "put the key in quotes"),
}
LITERALS: Mapping[str, tuple[str, str]] = {
    "format": ("1", "this version reads format 1"),
    "dimension": ("2 or 3", "give the dimension of the world"),
    "type": (
        "revolute, continuous, prismatic, ball or fixed",
        "write one of these types of joints",
    ),
    "base": ("free, translating or fixed", "write what the robot's base can do"),
}


def scenario_error(error: ValidationError, origin: Origin) -> ScenarioError:
    """Return the error for the first problem that pydantic reports, wrong keys before others."""
    details = error.errors(include_url=False)
    first = min(details, key=lambda item: item["type"] not in WRONG_KEYS)
    path: Path = tuple(step for step in first["loc"] if step not in NOT_IN_FILES)
    context: Mapping[str, Any] = first.get("ctx") or {}
    kind = first["type"]
    if kind == "unknown_key":
        return origin.error((*path, context["key"]), _unknown_key(context), at_key=True)
    if kind == "misplaced_key":
        return origin.error((*path, context["key"]), context["remedy"], at_key=True)
    if kind in ("missing_key", "missing"):
        key = context.get("key")
        path = (*path, key) if key else path
        more = ", or links of an articulated robot" if path == ("robot", "parts") else ""
        return origin.error(path, f"this key is missing; add it{more}")
    if kind == "empty_key":
        problem = "expected a value, got none; give one or leave the key out"
        return origin.error((*path, context["key"]), problem, at_key=True)
    return origin.error(path, _problem(kind, path, context, first["input"], first["msg"]))


def _unknown_key(context: Mapping[str, Any]) -> str:
    known = ", ".join(context["known"])
    if context["close"]:
        return f"unknown key; did you mean {context['close'][0]!r}? (known here: {known})"
    return f"unknown key; expected one of {known}; remove it or correct its name"


def _problem(kind: str, path: Path, context: Mapping[str, Any], value: Any, message: str) -> str:
    if kind == "forms":
        return _forms_problem(context["forms"])
    if kind in ("too_short", "too_long"):
        return _length_problem(path, context, len(value))
    expectation = EXPECTATIONS.get(kind)
    if kind in ("less_than_equal", "greater_than_equal"):
        expectation = _range_expectation(path, value)
    if kind == "float_type" and path[-2:-1] == ("joints",):
        expectation = JOINT_VALUE
    if kind == "literal_error" and path:
        expectation = LITERALS.get(str(path[-1]))
    if expectation is None:
        return f"{message}, got {shown(value)}"
    expected, remedy = expectation
    return f"expected {expected}, got {shown(value)}; {remedy}"


def _range_expectation(path: Path, value: float) -> tuple[str, str]:
    """What was expected instead of a number that is beyond the sizes of scenes."""
    if "semi_axes" in path:
        if value <= 0.0:
            return EXPECTATIONS["greater_than"]
        return f"a length from {LEAST_LENGTH:g} to {MOST_LENGTH:g}", REMEDY
    if path[-1:] == ("clearance",):
        if value < 0.0:
            return EXPECTATIONS["greater_than_equal"]
        return f"a length of at most {MOST_LENGTH:g}", REMEDY
    return f"a coordinate from {-MOST_LENGTH:g} to {MOST_LENGTH:g}", REMEDY


def _forms_problem(forms: list[str]) -> str:
    got = "none" if not forms else " and ".join(forms)
    return f"expected exactly one of {', '.join(FORMS)}, got {got}; keep one of them"


def _length_problem(path: Path, context: Mapping[str, Any], length: int) -> str:
    if path[-1] in VECTORS:
        return f"expected as many numbers as the dimension, 2 or 3, got {length}"
    if path[-1] in BODILESS:
        return f"expected at least one {BODILESS[path[-1]]}, got none; give the robot a body"
    if "ignore_self_collision" in path:
        return f"expected pairs of two links, got {length}; write [[one, other], ...]"
    if "max_length" in context:
        return f"expected at most {context['max_length']} numbers, got {length}"
    return f"expected {context.get('min_length')} numbers, got {length}"


def shown(value: Any) -> str:
    """Return a value as a message shows it: short, and with YAML's words."""
    words = {True: "true", False: "false", None: "nothing"}
    if isinstance(value, Mapping):
        return "a mapping"
    return words[value] if value is None or isinstance(value, bool) else short(value)
