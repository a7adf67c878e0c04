"""The one way kernels are compiled: lazily, cached on disk, and without fast-math.

Numba's cache does not notice an edit in a *called* kernel of another file, so the cache folder is
keyed by a hash of all kernel sources and of the numba and numpy versions.
"""

import hashlib
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numba
import numpy as np
from numba.core import caching, event

from ellipsoid_planning.compilation import report
from ellipsoid_planning.trusted_folder import is_trusted, temporary_folder

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


def _is_warm(folder: Path) -> bool:
    return any(folder.rglob("*.nbc"))


def _is_writable(folder: Path) -> bool:
    # Asking whether one may is not enough: a mount can be read-only for its owner, too.
    try:
        for level in (folder.parent, folder):
            level.mkdir(mode=0o755, parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True


def _usable(folder: Path) -> bool:
    # Numba's index of a cache is a pickle: whoever can write it runs code in this process.
    return (_is_writable(folder) or _is_warm(folder)) and is_trusted(folder)


def _cache_folder() -> Path:
    name = f"kernels-{_source_key()}"
    folder = (_cache_root() / name).resolve()
    return folder if _usable(folder) else temporary_folder() / name


CACHE_FOLDER = _cache_folder()
_READ_ONLY = not _is_writable(CACHE_FOLDER)


# Where numba looks for a folder for a function's cache.
_IMPLEMENTATION, _LOCATORS = caching.CompileResultCacheImpl, "_locator_classes"


class _ReadOnlyLocator(caching.UserProvidedCacheLocator):  # type: ignore[misc]
    """Numba's own insists on writing to the folder before it looks what is there."""

    def ensure_cache_path(self) -> None:
        """Leave the folder as it is."""


def _keep_nothing(dispatcher: Any) -> None:
    """Let versions that the cache does not have be compiled for this process alone."""
    dispatcher._cache.save_overload = lambda signature, data: None  # noqa: ARG005, SLF001


class _Compilations(event.Listener):  # type: ignore[misc]
    """Counts the kernels that numba compiles, and those that there are."""

    def __init__(self) -> None:
        self.known = 0
        self._depth = self._done = 0

    def on_start(self, happened: event.Event) -> None:
        """A function is being compiled, perhaps since another one calls it."""
        if _is_ours(happened):
            self.begin()

    def on_end(self, happened: event.Event) -> None:
        """A function is compiled."""
        if _is_ours(happened):
            self.end(1)

    def begin(self) -> None:
        """Take note of a compilation that begins."""
        self._depth += 1
        report(True, self._done, self.known)

    def end(self, count: int) -> None:
        """Take note of one that has ended, of ``count`` functions."""
        self._depth -= 1
        self._done += count
        report(self._depth > 0, self._done, self.known)


def _is_ours(happened: event.Event) -> bool:
    function = happened.data["dispatcher"].py_func
    return bool(function.__module__.partition(".")[0] == __name__.partition(".")[0])


@contextmanager
def compiling_elsewhere() -> Iterator[None]:
    """Report that a compilation goes on while the block waits for another process that compiles."""
    _COMPILATIONS.begin()
    try:
        yield
    finally:
        _COMPILATIONS.end(0)


_COMPILATIONS = _Compilations()
event.register("numba:compile", _COMPILATIONS)


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
    _COMPILATIONS.known += inline == "never"
    previous, locators = numba.config.CACHE_DIR, getattr(_IMPLEMENTATION, _LOCATORS)
    numba.config.CACHE_DIR = str(CACHE_FOLDER)
    if _READ_ONLY:
        setattr(_IMPLEMENTATION, _LOCATORS, [_ReadOnlyLocator])
    try:
        options = {"error_model": "numpy", "fastmath": False, "inline": inline}
        dispatcher = numba.njit(cache=True, nogil=nogil, **options)(function)
    finally:
        numba.config.CACHE_DIR = previous
        setattr(_IMPLEMENTATION, _LOCATORS, locators)
    if _READ_ONLY:
        _keep_nothing(dispatcher)
    return _without_literals(dispatcher)


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
