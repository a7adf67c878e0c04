"""Before several workers start: compile the largest kernels once, not once in each of them."""

import subprocess
import sys

PLANNING = """
import numpy as np
from ellipsoid_planning.cspace.sampling import FreeIntervalSampling
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.scenario import load_scenario
for name in ("rabbit-3d-open", "chain-18dof"):
    HighwayRoadmap(load_scenario(name).cspace()).compile_kernels()
FreeIntervalSampling(load_scenario("rabbit-3d-open").cspace(), 1).sample(np.empty(7))
"""
CRYSTALS = """
from ellipsoid_planning.crystal.packing.grid_search import GridSearch
from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.packing.gaussian_mixture import GaussianMixture
from ellipsoid_planning.crystal.diffraction.magnitudes import simulate
from ellipsoid_planning.crystal.packing.model import load_model, load_target
from ellipsoid_planning.crystal.packing.potential import GaussianPotential
from ellipsoid_planning.crystal.diffraction.ranking import rank
for name in ("rabbit-plane", "rabbit-p1"):
    model = load_model(name)
    target = load_target(name + "-target", model)
    model.is_free(target)
    cost = FourierCost(model, simulate(model, target))
    cost.value(target), cost.residuals_and_jacobian(target)
    search = GridSearch(model)
    rank(search, search.free(0, 1), cost)
    GaussianPotential(model, GaussianMixture(3.2)).value_and_gradient(target)
"""


def pytest_sessionstart(session):
    several = session.config.getoption("numprocesses", None)
    if several and not hasattr(session.config, "workerinput"):
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        began = [
            subprocess.Popen([sys.executable, "-c", program], **quiet)
            for program in (PLANNING, CRYSTALS)
        ]
        for process in began:
            process.wait()  # if it fails, some test will say why
