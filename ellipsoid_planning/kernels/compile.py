"""The one way kernels are compiled: lazily, cached on disk, and without fast-math.

Numba's cache does not notice an edit in a *called* kernel of another file, so the cache folder is
keyed by a hash of all kernel sources and of the numba and numpy versions.
"""

import hashlib
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
import numpy as np

_SOURCES = Path(__file__).resolve().parent
_CACHE_VARIABLE = "ELLIPSOID_PLANNING_CACHE"


def _cache_root() -> Path:
    if chosen := os.environ.get(_CACHE_VARIABLE):
        return Path(chosen)
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "ellipsoid-planning"


def _source_key() -> str:
    digest = hashlib.sha256(f"numba {numba.__version__} numpy {np.__version__}".encode())
    for source in sorted(_SOURCES.glob("*.py")):
        digest.update(source.name.encode())
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


def _usable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(folder, os.W_OK)


def _cache_folder() -> Path:
    name = f"kernels-{_source_key()}"
    folder = _cache_root() / name
    return folder if _usable(folder) else Path(tempfile.gettempdir()) / "ellipsoid-planning" / name


CACHE_FOLDER = _cache_folder()


def is_compiled() -> bool:
    """Whether an earlier run on this machine has left compiled kernels in the cache."""
    return any(CACHE_FOLDER.rglob("*.nbc"))


def _without_literals(dispatcher: Any) -> Any:
    """Make ``dispatcher`` compile one version for an argument, whether constant or not.

    Numba compiles a kernel anew for every constant integer or bool that another kernel passes,
    which more than doubles the time of the first run; the versions would not be any faster.
    """
    template = dispatcher.get_call_template

    def get_call_template(args: Any, kws: Any) -> Any:
        plain = tuple(numba.types.unliteral(kind) for kind in args)
        return template(plain, {name: numba.types.unliteral(kind) for name, kind in kws.items()})

    dispatcher.get_call_template = get_call_template
    return dispatcher


def _compiled(function: Callable[..., Any], inline: str, nogil: bool = False) -> Any:
    # The folder is read when the function is decorated; restoring it leaves other users of numba
    # in this process alone.
    previous = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(CACHE_FOLDER)
    try:
        options = {"error_model": "numpy", "fastmath": False, "inline": inline}
        return _without_literals(numba.njit(cache=True, nogil=nogil, **options)(function))
    finally:
        numba.config.CACHE_DIR = previous


def kernel(function: Callable[..., Any]) -> Any:
    """Compile ``function`` lazily with numba, cached in :data:`CACHE_FOLDER`.

    ``fastmath`` stays off because certificates rest on IEEE rounding; the numpy error model makes
    divisions by zero give infinities instead of exceptions.
    """
    return _compiled(function, "never")


def inlined(function: Callable[..., Any]) -> Any:
    """As :func:`kernel`, for a function that is one step of the kernel that calls it.

    It becomes a part of its caller. Numba optimises everything that a function calls anew for
    each function above it, so that a chain of calls costs its length in compiling time; this
    keeps chains short.
    """
    return _compiled(function, "always")


def released(function: Callable[..., Any]) -> Any:
    """As :func:`kernel`, for long work that several threads share: it lets go of Python's lock.

    Its caller must not touch the arguments meanwhile.
    """
    return _compiled(function, "never", nogil=True)
