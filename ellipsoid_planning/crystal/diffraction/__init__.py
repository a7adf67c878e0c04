"""Diffraction: reflections, structure factors, data, the Fourier cost and ranking by it."""
