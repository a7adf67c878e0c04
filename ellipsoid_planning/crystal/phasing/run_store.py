"""The folder of a crystal's run, which a killed run continues from, and its stand-in."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning import __version__, atomic, input_files
from ellipsoid_planning.array_members import plain_array
from ellipsoid_planning.crystal.packing.fingerprint import differences, normal_form
from ellipsoid_planning.crystal.packing.model import PackingModel
from ellipsoid_planning.errors import CrystalError
from ellipsoid_planning.run_folder import RunFolder

FORMAT = 1
DIGEST = hashlib.sha256().digest_size


class Keeper(Protocol):
    """Where finished pieces of work are kept."""

    def keep(self, name: str, content: bytes) -> None:
        """Keep a piece under a name such as ``search/000012``."""

    def kept(self, name: str) -> bytes | None:
        """A piece that was kept whole, None otherwise."""


class Nowhere:
    """Keeps nothing: for runs that are short enough."""

    def keep(self, name: str, content: bytes) -> None:
        """Nothing is kept."""

    def kept(self, name: str) -> bytes | None:  # noqa: ARG002  the protocol's
        """None."""
        return None


class RunStore(RunFolder):
    """Finished pieces of work, a file each: ``STAGE/NUMBER``, a checksum before the content.

    ``run.json`` is written first: the model, its format, and the settings of the run. A piece
    that is truncated or was changed counts as missing: it is done again.
    """

    option = "--run"
    manifest = "run.json"

    def check(self, settings: Mapping[str, Any]) -> None:
        """Check that the folder can take a run of these settings, or holds a part, writing nothing.

        Raises:
            EllipsoidPlanningError: it cannot be written to, holds something else, or a run of
                another model or other settings; the message says where they differ.
        """
        self.check_settings(settings, differences)

    def open(self, settings: Mapping[str, Any]) -> None:
        """Create the folder.

        Raises:
            EllipsoidPlanningError: it cannot be created.
        """
        self.write_settings(settings)

    def keep(self, name: str, content: bytes) -> None:
        """Write a piece, whole or not at all.

        Raises:
            CrystalError: it cannot be written.
        """
        file = self.folder / name
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            atomic.write_bytes(file, _digest(name, content) + content)
        except OSError as error:
            raise CrystalError(f"{file}: cannot write the result: {error.strerror}") from None

    def kept(self, name: str) -> bytes | None:
        """A piece that was written whole and is unchanged, None otherwise."""
        try:
            whole = input_files.read_bytes(self.folder / name)
        except OSError:
            return None
        content = whole[DIGEST:]
        return content if whole[:DIGEST] == _digest(name, content) else None


def _digest(name: str, content: bytes) -> bytes:
    return hashlib.sha256(name.encode() + b"\0" + content).digest()


def run_settings(model: PackingModel, command: str, **settings: Any) -> dict[str, Any]:
    """Everything that a run's pieces depend on, as data for JSON.

    Args:
        model: the packing model.
        command: what is done with it.
        settings: whatever else matters, such as the size of pieces.
    """
    return {
        "format": FORMAT,
        "version": __version__,
        "command": command,
        "model": normal_form(model),
        **settings,
    }


def array_bytes(array: NDArray[Any]) -> bytes:
    """An array as bytes that say what it is."""
    content = io.BytesIO()
    np.save(content, np.asarray(array, order="C"), allow_pickle=False)
    return content.getvalue()


def bytes_array(content: bytes) -> NDArray[Any]:
    """The array of `array_bytes`.

    Raises:
        ValueError: they are no plain array.
    """
    return plain_array(content)
