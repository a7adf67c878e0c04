"""Almost-uniform grids of rotations and planar motions, and the discrete groups behind them."""

from ellipsoid_planning.groups.catalogue import grid_by_name, grid_names
from ellipsoid_planning.groups.cosets import DoubleCosets, Wedge, single_coset
from ellipsoid_planning.groups.finite_groups import (
    FiniteGroup,
    cyclic,
    dihedral,
    group_by_name,
    icosahedral,
    octahedral,
    tetrahedral,
)
from ellipsoid_planning.groups.group_grid import GroupGrid
from ellipsoid_planning.groups.group_grids import double_coset_grid, group_grid, wedge_grid
from ellipsoid_planning.groups.metrics import GridMetrics, measure
from ellipsoid_planning.groups.plane_groups import PlaneGroup, plane_group
from ellipsoid_planning.groups.rotation_grid import NeighbourLists, RotationGrid
from ellipsoid_planning.groups.se2_grids import PlaneGrid, plane_grid
from ellipsoid_planning.groups.six_hundred_cell import six_hundred_cell_grid
from ellipsoid_planning.groups.standard_grids import (
    euler_grid,
    hopf_grid,
    random_grid,
    super_fibonacci_grid,
)
from ellipsoid_planning.groups.voronoi import VoronoiCell

__all__ = [
    "DoubleCosets",
    "FiniteGroup",
    "GridMetrics",
    "GroupGrid",
    "NeighbourLists",
    "PlaneGrid",
    "PlaneGroup",
    "RotationGrid",
    "VoronoiCell",
    "Wedge",
    "cyclic",
    "dihedral",
    "double_coset_grid",
    "euler_grid",
    "grid_by_name",
    "grid_names",
    "group_by_name",
    "group_grid",
    "hopf_grid",
    "icosahedral",
    "measure",
    "octahedral",
    "plane_grid",
    "plane_group",
    "random_grid",
    "single_coset",
    "six_hundred_cell_grid",
    "super_fibonacci_grid",
    "tetrahedral",
    "wedge_grid",
]
