"""Standard streams that are closed, full, left, or cannot show every sign; unusual outputs."""

import os
import subprocess
import sys
import unicodedata
from pathlib import Path

import pytest

from planners.cli.streams import prepare_streams
from tests.cli.command import COMMAND, refused, run

SIGNS = "⊕ 90° ±1 c₁² ü ∞ → \ud800 漢"


def shell(command, **environment):
    """A finished shell that has run the command line with redirections."""
    program = f"{sys.executable} -m planners.cli"
    return subprocess.run(
        ["/bin/sh", "-c", command.replace("PROGRAM", program)],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("closed", ["2>&-", "<&- >&- 2>&-"])
def test_closed_streams_lead_to_nothing(tmp_path, closed):
    page = tmp_path / "page.html"
    done = shell(f"PROGRAM show rabbit-2d-open --html {page} {closed}")
    assert done.returncode == 0
    text = page.read_text(encoding="utf-8")
    assert text.startswith("<!DOCTYPE html>")
    assert "Drawing the page" not in text  # a message that went to the number of the closed stream


@pytest.mark.parametrize(
    ("encoding", "shown"),
    [
        ("ascii", "(+) 90 deg +-1 c12 u inf -> \\ud800 \\u6f22"),
        ("latin-1", "(+) 90° ±1 c1² ü inf -> \\ud800 \\u6f22"),
        ("cp1252", "(+) 90° ±1 c1² ü inf -> \\ud800 \\u6f22"),
        ("utf-8", SIGNS.replace("\ud800", "\\ud800")),
    ],
)
def test_signs_that_cannot_be_shown_are_spelled(tmp_path, monkeypatch, encoding, shown):
    for name in ("stdout", "stderr"):
        stream = (tmp_path / name).open("w", encoding=encoding)
        monkeypatch.setattr(sys, name, stream)
    prepare_streams()
    for stream in (sys.stdout, sys.stderr):
        stream.write(SIGNS)
        stream.close()
        assert (tmp_path / stream.name).read_text(encoding=encoding) == shown


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
def test_tables_are_shown_on_every_terminal(encoding):
    done = shell("PROGRAM scenarios && PROGRAM rotations --help", PYTHONIOENCODING=encoding)
    assert done.returncode == 0, done.stderr
    assert "rabbit-2d-open" in done.stdout
    assert not any(unicodedata.category(sign) == "Cs" for sign in done.stdout)


def test_a_reader_that_leaves_is_told_from_no_path():
    with subprocess.Popen(
        [*COMMAND, "schema"], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        process.stdout.close()
        assert process.stderr.read() == b""
    assert process.returncode == 141


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
def test_messages_that_cannot_be_written_are_no_reason_to_end():
    done = shell("PROGRAM show nothing --html x.html 2>/dev/full")
    assert done.returncode == 2


def test_an_output_that_is_a_loop_of_links_is_refused_at_once(tmp_path):
    (tmp_path / "a.json").symlink_to(tmp_path / "a.json")
    done = run("plan", "rabbit-2d-open", "--output", tmp_path / "a.json")
    assert refused(done, "--output", "a.json", "links")
    assert "Planning" not in done.stderr


@pytest.mark.parametrize("value", ['"\\ud800"', '"\\udfff x"', '"\\U0000d912"'])
def test_halves_of_characters_are_refused(scenario_file, value):
    file = scenario_file(("name: left", f"name: {value}"))
    assert refused(run("plan", file), "two-pillars.yaml:8:", "obstacles[0].name", "surrogate")


def test_file_names_need_not_be_text(scenario_file, tmp_path):
    odd = tmp_path / os.fsdecode(b"caf\xe9.html")
    done = subprocess.run(
        [*COMMAND, "show", scenario_file(), "--html", odd], capture_output=True, check=False
    )
    assert done.returncode == 0
    assert b"Wrote" in done.stderr
    assert odd.exists()
