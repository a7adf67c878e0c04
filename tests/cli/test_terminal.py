"""Messages and progress go to stderr."""

import threading

from ellipsoid_planning.compilation import report
from planners.cli import compiling
from planners.cli.compiling import telling_of_compilation
from planners.cli.terminal import working


def test_progress_is_a_line_on_stderr_when_nobody_watches(capsys):
    with working("Thinking"):
        pass
    assert capsys.readouterr() == ("", "Thinking ...\n")


def test_compilation_is_announced_once_with_its_progress(capsys, monkeypatch):
    said, inner = threading.Event(), compiling.say

    def say(message):
        inner(message)
        if "functions compiled" in message:
            said.set()

    monkeypatch.setattr(compiling, "EVERY", 0.01)
    monkeypatch.setattr(compiling, "say", say)
    with telling_of_compilation():
        report(True, 0, 9)
        report(True, 3, 9)
        assert said.wait(60)
    report(True, 4, 9)  # nobody listens any more
    out, errors = capsys.readouterr()
    assert out == ""
    assert errors.count("Compiling the kernels") == 1
    assert "of at most 9 functions compiled" in errors


def test_nothing_is_said_where_nothing_is_compiled(capsys):
    with telling_of_compilation():
        pass
    assert capsys.readouterr() == ("", "")
