"""What a CIF file says about the use of each reflection (``_refln.status`` and its kin)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.errors import ScenarioError

# The dictionaries' codes (mmCIF _refln.status, core CIF _refln_include_status). Weak reflections
# (<), those beyond the limits of a refinement (h, l) and those of the free set (f) are measured
# like any other, and a search refines nothing against them: they count.
USED = ("o", "f", "<", "h", "l", "?", ".")
LEFT_OUT = {"x": "unreliable", "-": "systematically absent"}
TAGS = ("status", "include_status", "observed_status")


def keep_usable(
    statuses: Mapping[str, Sequence[str]], indices: NDArray[np.int64], file: str, prefix: str
) -> tuple[NDArray[np.bool_], tuple[str, ...]]:
    """Which reflections (N,) a file wants used, and what to tell about the others.

    Args:
        statuses: codes (N,) by the name of their column; other columns are not looked at.
        indices: (N, 3), for messages.
        file: the file's path, for messages.
        prefix: of the columns' names, for messages.

    Raises:
        ScenarioError: a code is not in the dictionary; names the reflection.
    """
    usable, notes = np.ones(len(indices), bool), []
    for tag in TAGS:
        codes = np.array(statuses.get(tag, ()), dtype=np.str_)
        odd = np.flatnonzero(~np.isin(codes, (*USED, *LEFT_OUT)))
        if len(odd):
            raise ScenarioError(
                f"reflection {tuple(indices[odd[0]].tolist())}: expected one of the codes "
                f"{' '.join((*USED, *LEFT_OUT))}, got {codes[odd[0]]}",
                file=file,
                field=prefix + tag,
            )
        for code, meaning in LEFT_OUT.items():
            marked = np.flatnonzero(codes == code)
            usable[marked] = False
            if len(marked):
                notes.append(
                    f"{len(marked)} reflections are marked as {meaning} ({prefix}{tag} {code}) and "
                    "left out"
                )
    return usable, tuple(notes)
