"""A real protein searched in its own crystal, against magnitudes of its atoms; a Markdown table.

    python -m benchmarks.protein

The DD-peptidase of the entry 1PWC (see scenarios/crystals) as 1 to 8 ellipsoids a domain. The
magnitudes are those of its real atoms, in a vacuum or in flat solvent, to a resolution. All free
arrangements of the grid are ranked, and the best of them refined by least squares. Errors are
those of the refined arrangement with the lowest cost among the free ones, against the pose in the
entry: the mean of the shifts, of the angles (Euler angles and hinge), and the root mean square of
how far the ellipsoids' centres are off.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.diffraction.magnitude_files import read_magnitudes
from ellipsoid_planning.crystal.diffraction.ranking import rank_free
from ellipsoid_planning.crystal.packing.grid_search import GridSearch
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.crystal.packing.model_build import model_of, target_of
from ellipsoid_planning.crystal.packing.model_files import locate_model
from ellipsoid_planning.crystal.phasing.arrangement_errors import arrangement_errors
from ellipsoid_planning.crystal.structures.calculated import calculated_factors, write_mtz
from ellipsoid_planning.crystal.structures.domains import parse_domain
from ellipsoid_planning.crystal.structures.fitted_model import FittedModel, SearchSteps
from ellipsoid_planning.crystal.structures.fitting import deepest_overlap, fit_domains
from ellipsoid_planning.crystal.structures.structure import CrystalStructure, read_structure
from ellipsoid_planning.scenario_origin import Origin
from planners.crystal.parameters import Refinement
from planners.crystal.phasing import phase_candidates

DOMAINS = ("alpha_beta=A/3-79+191-347", "alpha=A/80-190")
CASES = ((1, False, 15), (2, False, 15), (4, False, 15), (8, False, 15), (4, False, 20))
WET_CASES = ((4, True, 15), (4, True, 20), (8, True, 20))
HEADER = (
    "| ellipsoids a domain | data | resolution | reflections | free | cost of the deposited pose | "
    "lowest of the grid | first near | lowest refined | off | shifts | angles | seconds |"
)
NEAR = 6.0  # [Å]


def made(
    structure: CrystalStructure, parts: int, resolution: float
) -> tuple[PackingModel, np.ndarray]:
    """The packing model, and the deposited pose."""
    fit = fit_domains(structure, [parse_domain(text) for text in DOMAINS], parts=parts)
    steps = SearchSteps(resolution=resolution)
    both = FittedModel(fit, steps, "dd-peptidase", deepest_overlap(fit))
    model = model_of(both.model())
    return model, target_of(both.target(), Origin(), model)


def cost_of(
    structure: CrystalStructure, model: PackingModel, *, solvent: bool
) -> tuple[FourierCost, int]:
    """FCF against the atoms' magnitudes, and how many there are."""
    factors = calculated_factors(structure, model.resolution, solvent=solvent)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "data.mtz"
        write_mtz(factors, file)
        magnitudes = read_magnitudes(file, model)
    return FourierCost(model, magnitudes, scaled=True), len(magnitudes)


def row(
    structure: CrystalStructure, parts: int, solvent: bool, resolution: float, best: int
) -> str:
    """One line of the table."""
    model, target = made(structure, parts, resolution)
    cost, count = cost_of(structure, model, solvent=solvent)
    began = time.perf_counter()
    ranking = rank_free(GridSearch(model), cost, best=best, workers=2)
    outcome = phase_candidates(cost, ranking.configurations, Refinement(method="polish"))
    seconds = time.perf_counter() - began
    distances = [arrangement_errors(model, q, target).distance for q in ranking.configurations]
    near = np.flatnonzero(np.array(distances) < NEAR)
    errors = arrangement_errors(model, outcome.configuration, target)
    cells = (
        str(parts),
        "solvent" if solvent else "vacuum",
        f"{resolution:g} Å",
        str(count),
        f"{ranking.looked_at:,}",
        f"{cost.value(target) / cost.norm:.3f}",
        f"{ranking.costs[0] / cost.norm:.3f}",
        str(near[0] + 1) if len(near) else f"> {best}",
        f"{outcome.best.refined.cost / cost.norm:.3f}",
        f"{errors.distance:.1f} Å",
        f"{errors.mean_shift:.1f} Å",
        f"{errors.mae_deg:.1f}°",
        f"{seconds:.0f}",
    )
    return f"| {' | '.join(cells)} |"


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.protein", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--best", type=int, default=100, help="candidates that are refined (100)")
    given = parser.parse_args()
    structure = read_structure(locate_model("dd-peptidase").with_name("dd-peptidase.pdb.gz"))
    print(HEADER)
    print("|" + "---|" * HEADER.count(" | ") + "---|")
    for case in (*CASES, *WET_CASES):
        print(row(structure, *case, given.best), flush=True)


if __name__ == "__main__":
    main()
