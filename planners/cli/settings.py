"""Settings on the command line: ``--set planner.key=value``."""

from __future__ import annotations

from typing import Any

from ellipsoid_planning.errors import PlannerError

PREFIX = "planner."


def planner_parameters(settings: list[str]) -> dict[str, Any]:
    """The planner's parameters from ``planner.key=value`` texts; a later one wins.

    Values are read as in a scenario file: numbers, true, false, null, text, lists.

    Raises:
        PlannerError: a text of another form.
    """
    parameters = {}
    for setting in settings:
        key, equals, text = setting.partition("=")
        name = key.strip().removeprefix(PREFIX)
        if not equals or not key.strip().startswith(PREFIX) or not name:
            raise PlannerError(
                f"--set {setting}: expected planner.key=value, such as planner.range=2.5"
            )
        parameters[name] = _value(setting, text)
    return parameters


def _value(setting: str, text: str) -> Any:
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    try:
        return YAML(typ="safe", pure=True).load(text)
    except (YAMLError, ValueError):
        raise PlannerError(f"--set {setting}: the value {text!r} cannot be read") from None
