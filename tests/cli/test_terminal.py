"""Messages and progress go to stderr."""

import pytest

from ellipsoid_planning.kernels import compile as kernels_compile
from planners.cli.terminal import working, working_with_kernels


def test_progress_is_a_line_on_stderr_when_nobody_watches(capsys):
    with working("Thinking"):
        pass
    assert capsys.readouterr() == ("", "Thinking ...\n")


@pytest.mark.parametrize("compiled", [True, False])
def test_the_first_run_says_that_kernels_are_compiled(compiled, capsys, monkeypatch):
    monkeypatch.setattr(kernels_compile, "is_compiled", lambda: compiled)
    with working_with_kernels("Thinking"):
        pass
    out, errors = capsys.readouterr()
    assert out == ""
    assert ("Compiling the kernels" in errors) is not compiled
