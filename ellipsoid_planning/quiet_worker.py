"""What each worker of a local Dask cluster does first: leave Ctrl-C and its aftermath to us.

A terminal sends Ctrl-C to all processes of a command; only the one that the user started
answers it.
"""

from __future__ import annotations

import logging
import signal
from typing import Any


def dask_setup(_: Any) -> None:
    """Called by Dask, as a preload, in the main thread of a worker's process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
