"""Phasing by packing on OMPL: refinement by its RRT, and the loop over candidates."""
