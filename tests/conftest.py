"""Before several workers start: compile the largest kernels once, not once in each of them."""

import subprocess
import sys

PROGRAM = """
import numpy as np
from ellipsoid_planning.cspace.sampling import FreeIntervalSampling
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.scenario import load_scenario
for name in ("rabbit-3d-open", "chain-18dof"):
    HighwayRoadmap(load_scenario(name).cspace()).compile_kernels()
FreeIntervalSampling(load_scenario("rabbit-3d-open").cspace(), 1).sample(np.empty(7))
"""


def pytest_sessionstart(session):
    several = session.config.getoption("numprocesses", None)
    if several and not hasattr(session.config, "workerinput"):
        # If it fails, some test will say why.
        subprocess.run([sys.executable, "-c", PROGRAM], check=False, capture_output=True)
