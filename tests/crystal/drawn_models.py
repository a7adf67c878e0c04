"""Bundled packing models, in their crystals and in others, for the tests of what is drawn."""

import numpy as np

from ellipsoid_planning.crystal.packing.model import load_model, load_target
from ellipsoid_planning.crystal.packing.model_build import model_of
from ellipsoid_planning.scenario_origin import Origin

NAMES = ("rabbit-plane", "rabbit-p1", "rabbit-p212121")


def target_of(name):
    model = load_model(name)
    return model, load_target(f"{name}-target", model)


def colliding(model, seed=0):
    rng = np.random.default_rng(seed)
    numbers = rng.integers(model.grid.count, size=50)
    found = model.grid.configurations(numbers)
    return found[np.flatnonzero(~model.are_free(found))[0]]


def in_group(name, group, lengths, angles=None):
    """A bundled model in another crystal."""
    document = {**load_model(name).document, "group": group, "cell": {"lengths": lengths}}
    if angles is not None:
        document["cell"]["angles_deg"] = angles
    return model_of(document, Origin())
