"""`plan --checker tabulated`: tables are made once, with a word about it."""

import json

from tests.cli.command import run


def test_tables_are_made_once_and_kept(scenario_file):
    arguments = ("plan", scenario_file(), "--checker", "tabulated", "--seed", 1, "--json")
    first, second = run(*arguments), run(*arguments)
    assert first.returncode == 0, first.stderr
    assert " 1 safety table(s)" in first.stderr
    assert "Loaded 1 safety table(s)" in second.stderr
    paths = [json.loads(done.stdout)["path"] for done in (first, second)]
    assert paths[0] == paths[1] and paths[0]["certified"]
