"""What ``crystal phase`` looks for: a target's arrangement, or magnitudes that were measured."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
    from ellipsoid_planning.crystal.packing.model import PackingModel

FEW = 0.5  # of the model's reflections; fewer are said to be few


@dataclass(frozen=True, eq=False)
class Data:
    """What is looked for.

    Attributes:
        name: as the user gave it.
        cost: FCF against it.
        target: (K,), the arrangement, None if only magnitudes are known.
    """

    name: str
    cost: FourierCost
    target: NDArray[np.float64] | None

    @property
    def remarks(self) -> list[str]:
        """What to say before the search: how the data were read, and what they cannot tell."""
        notes = [f"{self.name}: {note}." for note in self.cost.magnitudes.notes]
        return notes if self.warning is None else [*notes, self.warning]

    @property
    def warning(self) -> str | None:
        """Why an arrangement that fits need not be the true one; None without a reason."""
        magnitudes, model = self.cost.magnitudes, self.cost.model
        unknowns = len(model.keys) + self.cost.scaled
        share = f"{100.0 * magnitudes.completeness:.0f} % of those to resolution"
        share += f" {model.resolution:g}"
        if len(magnitudes) < unknowns:
            return (
                f"Warning: {self.name} has {len(magnitudes)} reflections, {share}, for {unknowns} "
                "unknowns: an arrangement that fits them need not be the true one"
            )
        if magnitudes.completeness < FEW:
            return f"Warning: {self.name} has only {share}: {len(magnitudes)} reflections"
        return None

    def to_dict(self) -> dict[str, Any]:
        """Data for JSON."""
        magnitudes = self.cost.magnitudes
        model = self.cost.model
        return {
            "name": self.name,
            "source": magnitudes.source,
            "reflections": len(magnitudes),
            "completeness": magnitudes.completeness,
            "notes": list(magnitudes.notes),
            "scaled": self.cost.scaled,
            "configuration": None if self.target is None else model.values_of(self.target),
        }


def load_data(
    name: str,
    model: PackingModel,
    column: str | None = None,
    *,
    skip_missing: bool = False,
    compare: str | None = None,
    block: str | None = None,
) -> Data:
    """The magnitudes of a file, or those of a target's arrangement.

    Args:
        name: a file with magnitudes (MTZ, CIF), a target's YAML file, or a bundled target's name.
        model: the packing model.
        column: of the file's magnitudes.
        skip_missing: leave reflections of the file without a usable value out.
        compare: with a file, the target that errors are measured against, if it is known.
        block: of a CIF file, its data block.

    Raises:
        EllipsoidPlanningError: something is wrong with them.
    """
    from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
    from ellipsoid_planning.crystal.diffraction.magnitude_files import read_magnitudes
    from ellipsoid_planning.crystal.diffraction.magnitudes import simulate
    from ellipsoid_planning.crystal.diffraction.reflection_table import is_reflection_file
    from ellipsoid_planning.crystal.packing.model import load_target
    from ellipsoid_planning.crystal.packing.model_files import locate_data
    from ellipsoid_planning.errors import CrystalError

    file = locate_data(name)
    if is_reflection_file(file):
        magnitudes = read_magnitudes(file, model, column, skip_missing=skip_missing, block=block)
        known = None if compare is None else load_target(compare, model)
        return Data(name, FourierCost(model, magnitudes, scaled=magnitudes.relative), known)
    given = {"--column": column, "--block": block, "--compare": compare}
    for option, value in (given | {"--skip-missing": skip_missing or None}).items():
        if value is not None:
            raise CrystalError(
                f"{option}: it belongs to a file of magnitudes, and the target {name} is an "
                "arrangement; remove it"
            )
    target = load_target(name, model)
    return Data(name, FourierCost(model, simulate(model, target)), target)
