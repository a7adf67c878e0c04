"""Asking a picture for the colour of a body."""

import numpy as np

from planners.view.colours import rgb


def resembles(pixels, colour, tolerance=0.12):
    """Tell for pixels (..., 3) in [0, 1] whether they show a surface of the colour "#rrggbb".

    Light and shade scale a colour; another hue, or white where grey is wanted, is no match.
    """
    wanted = np.array(rgb(colour))
    pixels = np.asarray(pixels, dtype=float)[..., :3]
    brightness = pixels @ wanted / (wanted @ wanted)
    rest = np.linalg.norm(pixels - brightness[..., None] * wanted, axis=-1)
    return (rest < tolerance) & (brightness > 0.35) & (brightness < 1.45)


def at(picture, places):
    """Return the pixels (m, 3) of a picture (h, w, 3+) at places (m, 2), right and down."""
    columns, rows = np.rint(np.asarray(places)).astype(int).T
    return picture[rows, columns, :3]
