"""What a packing model's results depend on, as data: to send to others and to compare."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

from ellipsoid_planning import __version__
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.errors import CrystalError

IRRELEVANT = {"description"}
MOST_DIFFERENCES = 4


def normal_form(model: PackingModel) -> dict[str, Any]:
    """A model's document with all defaults written out, as data for JSON, less its description.

    Models with one normal form have the same arrangements, whatever their files look like.

    Raises:
        CrystalError: if the model was not made from a document.
    """
    from ellipsoid_planning.crystal.packing.model_format import PackingModelBlock

    if not model.document:
        raise CrystalError(
            f"the model {model.name!r} has no document to keep or to send; make it by model_of "
            "or load_model"
        )
    block = PackingModelBlock.model_validate(dict(model.document))
    return block.model_dump(mode="json", by_alias=True, exclude=IRRELEVANT, exclude_none=True)


def model_text(model: PackingModel) -> str:
    """The normal form as text, keys in order."""
    return json.dumps(normal_form(model), sort_keys=True)


def sent_model(model: PackingModel) -> tuple[str, str]:
    """What another process makes the model of: our version, and the normal form as text."""
    return __version__, model_text(model)


@lru_cache(maxsize=4)
def received_model(sent: tuple[str, str]) -> PackingModel:
    """The model that `sent_model` describes; a process makes it once.

    Raises:
        CrystalError: another version sent it; its results might not be ours.
    """
    from ellipsoid_planning.crystal.packing.model_build import model_of

    version, text = sent
    if version != __version__:
        raise CrystalError(f"expected work of version {__version__}, which is here, got {version}")
    return model_of(json.loads(text))


def fingerprint(model: PackingModel) -> str:
    """A hash of the normal form, format's version included."""
    return hashlib.sha256(model_text(model).encode()).hexdigest()


def differences(asked: Mapping[str, Any], earlier: Mapping[str, Any]) -> list[str]:
    """What two settings differ in, such as ``model.search.joints.roll_deg.step: 10 there, 5 now``.

    Args:
        asked: nested mappings and lists of JSON, what is wanted now.
        earlier: the same of an earlier run.
    """
    now, there = _leaves(asked), _leaves(earlier)
    names = dict.fromkeys([*now, *there])
    absent = "nothing"
    found = [
        f"{name}: {there.get(name, absent)} there, {now.get(name, absent)} now"
        for name in names
        if now.get(name, absent) != there.get(name, absent)
    ]
    more = len(found) - MOST_DIFFERENCES
    return found if more <= 0 else [*found[:MOST_DIFFERENCES], f"and {more} more"]


def _leaves(value: Any, name: str = "") -> dict[str, str]:
    """Every number, text or the like in nested data, as JSON, by its dotted place."""
    inner: dict[str, str] = {}
    if isinstance(value, Mapping):
        for key, entry in value.items():
            inner |= _leaves(entry, f"{name}.{key}" if name else str(key))
    elif isinstance(value, (list, tuple)):
        for index, entry in enumerate(value):
            inner |= _leaves(entry, f"{name}[{index}]")
    else:
        inner[name] = json.dumps(value)
    return inner
