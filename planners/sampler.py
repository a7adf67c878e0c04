"""Valid states without collision checks: drawing inside the free intervals of sweep lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from ompl import base as ob

from ellipsoid_planning.cspace.articulated_sampling import ArticulatedSampling
from ellipsoid_planning.cspace.sampling import FreeIntervalSampling

from .bindings import clear_sampler, draw_seed, install_sampler
from .spaces import check_space, is_articulated, state_access

if TYPE_CHECKING:
    from ellipsoid_planning.cspace.space import CSpace


class FreeIntervalSampler(ob.ValidStateSampler):
    """Draws an orientation and a line, computes the line's free intervals, and draws in them.

    Every state it yields is valid by construction; no state is ever checked, except that joints are
    drawn until an articulated robot keeps clear of itself, and that one on a fixed base, which has
    no lines to draw from, is drawn until it is valid. With ``uniform`` the
    states are exactly uniform on free space; without, places that are narrow along a line are
    favoured, which suits roadmap planners. OMPL's PRM, PRMstar and BKPIECE1 use it once installed;
    the other bound planners draw from the whole space, whatever is installed.
    """

    def __init__(
        self,
        si: ob.SpaceInformation,
        cspace: CSpace,
        uniform: bool = False,
        seed: int | None = None,
    ) -> None:
        """Create a sampler.

        Args:
            si: the space information; it is not kept.
            cspace: the C-space to draw from.
            uniform: exactly uniform on free space, instead of favouring narrow places.
            seed: of this sampler alone; drawn from OMPL's random numbers if None.

        Raises:
            PlannerError: the space of ``si`` does not fit ``cspace``.
        """
        super().__init__(si)
        check_space(si.getStateSpace(), cspace)
        self.setName("FreeIntervalSampler")
        access = state_access(cspace)
        self.uniform = uniform
        self._write = access.write
        self._read = access.read
        self._out = np.empty(access.size)
        seed = draw_seed() if seed is None else seed
        self._drawing: ArticulatedSampling | FreeIntervalSampling
        if is_articulated(cspace):
            self._drawing = ArticulatedSampling(cspace, seed, uniform)
        else:
            self._drawing = FreeIntervalSampling(cspace, seed, uniform)

    def sample(self, state: ob.State) -> bool:
        """Set ``state`` to a free one; False when several lines in a row are blocked."""
        if not self._drawing.sample(self._out):
            return False
        self._write(state, self._out.tolist())
        return True

    def sampleNear(self, state: ob.State, near: ob.State, distance: float) -> bool:  # noqa: N802
        """Set ``state`` to a free one within ``distance`` of ``near``; False when none was met."""
        if not self._drawing.sample_near(np.array(self._read(near)), distance, self._out):
            return False
        self._write(state, self._out.tolist())
        return True


def install_free_interval_sampler(
    si: ob.SpaceInformation, cspace: CSpace, uniform: bool = False
) -> None:
    """Let ``si`` draw its valid states with a `FreeIntervalSampler`."""

    def allocate(information: ob.SpaceInformation) -> ob.ValidStateSampler:
        return FreeIntervalSampler(information, cspace, uniform)

    install_sampler(si, allocate)


__all__ = ["FreeIntervalSampler", "clear_sampler", "install_free_interval_sampler"]
