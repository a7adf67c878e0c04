"""The page in a real browser: what is where, what can be switched, and what it may load."""

import dataclasses
import re
import subprocess
import sys
from itertools import pairwise

import numpy as np
import pytest

from ellipsoid_planning.errors import EllipsoidPlanningError
from planners.view import colours, meshcat_page
from planners.view.embedding import LINES, SOLID
from planners.view.meshcat_page import (
    open_in_browser,
    page_of_scene,
    scene_html,
    write_page,
)
from planners.view.meshcat_scene import build_scene
from tests.view.chromium import HEIGHT, WIDTH, photograph
from tests.view.pixels import at, resembles
from tests.view.scenes import (
    planar_scenario,
    small_roadmap,
    solved,
    spatial_scenario,
    unsolved,
)

SCENARIOS = [planar_scenario, spatial_scenario]


def body_places(scenario):
    """Return (pixel, colour) of the centre of each body that stands still."""
    scene = build_scene(scenario)
    groups = {
        colours.OBSTACLE: scenario.world.obstacles,
        colours.START: scenario.robot.bodies_at(scenario.start),
        colours.GOAL: scenario.robot.bodies_at(scenario.goal),
    }
    places, expected = [], []
    for colour, bodies in groups.items():
        for body in bodies:
            point = scene.embedding.points(body.centre, SOLID)
            places.append(scene.camera.pixels(point, WIDTH, HEIGHT)[0])
            expected.append(colour)
    return np.array(places), expected


@pytest.mark.parametrize("make", SCENARIOS)
def test_bodies_are_seen_where_they_project(make, tmp_path):
    scenario = make()
    picture, messages = photograph(scene_html(scenario), tmp_path)
    places, expected = body_places(scenario)
    seen = at(picture, places)
    wrong = [
        (place, pixel, colour)
        for place, pixel, colour in zip(places, seen, expected, strict=True)
        if not resembles(pixel, colour)
    ]
    assert wrong == []
    assert messages == []


@pytest.mark.parametrize("make", SCENARIOS)
def test_an_empty_scene_has_none_of_the_bodies(make, tmp_path):
    scenario = make()
    empty = dataclasses.replace(build_scene(scenario), commands=())
    picture, _ = photograph(page_of_scene(empty, "empty", []), tmp_path)
    places, expected = body_places(scenario)
    seen = at(picture, places)
    assert not any(resembles(p, colour) for p, colour in zip(seen, expected, strict=True))


@pytest.mark.parametrize("make", SCENARIOS)
def test_the_arena_is_seen_through(make, tmp_path):
    picture, _ = photograph(scene_html(make()), tmp_path)
    # Right below the centre of the window there is the arena only, in every one of the scenes.
    inside, outside = picture[HEIGHT // 2, WIDTH // 2 + 150], picture[HEIGHT - 5, WIDTH - 5]
    assert inside[2] - inside[0] > 0.05  # bluish
    assert inside.min() > 0.5  # yet light
    assert abs(outside[2] - outside[0]) < 0.05


@pytest.mark.parametrize("make", SCENARIOS)
def test_the_robot_moves_on_its_path(make, tmp_path):
    result = solved(make())
    picture, messages = photograph(scene_html(result.scenario, result), tmp_path)
    assert messages == []
    assert np.count_nonzero(resembles(picture, colours.ROBOT)) > 300
    scene = build_scene(result.scenario, result)
    n = result.scenario.dimension
    corners = result.path.configurations[:, :n]
    shares = np.linspace(0.1, 0.9, 33)[:, None]
    points = np.concatenate([a + shares * (b - a) for a, b in pairwise(corners)])
    places = scene.camera.pixels(scene.embedding.points(points, LINES), WIDTH, HEIGHT)
    dark = at(picture, places).max(axis=1) < 0.35
    assert np.mean(dark) > 0.6  # the robot hides a part in 3-D


def test_the_roadmap_can_be_switched_on(tmp_path):
    scenario = spatial_scenario()
    page = scene_html(scenario, roadmap=small_roadmap(scenario))
    click = "<script>document.querySelector('[data-folder=roadmap]').click()</script></body>"
    hidden, shown = tmp_path / "hidden", tmp_path / "shown"
    hidden.mkdir()
    shown.mkdir()
    without, _ = photograph(page, hidden)
    with_roadmap, messages = photograph(page.replace("</body>", click), shown)
    legend = np.s_[:140, : WIDTH // 2]
    without[legend], with_roadmap[legend] = 1.0, 1.0
    assert np.count_nonzero(resembles(without, colours.ROADMAP, 0.06)) == 0
    assert np.count_nonzero(resembles(with_roadmap, colours.ROADMAP, 0.06)) > 200
    assert messages == []


def test_page_has_no_outside_addresses():
    page = scene_html(spatial_scenario(), solved(spatial_scenario()))
    addresses = set(re.findall(r"(?:https?|wss?|ftp)://[^\s\"'`<>)]+", page))
    namespaces = {"http://www.w3.org/1999/xhtml", "http://www.w3.org/2000/svg"}
    assert {a for a in addresses if not a.startswith("ws://${")} <= namespaces
    assert not re.search(r"<(?:link|iframe|img|script)[^>]*(?:src|href)=", page)
    assert "default-src 'none'" in page


def test_title_and_caption_are_escaped():
    scenario = planar_scenario()
    page = scene_html(scenario, solved(scenario))
    assert "<title>planar &lt;test&gt;</title>" in page
    assert "Tests &amp; pictures." in page
    assert "HighwayRoadmap: path of length" in page


def test_a_result_without_a_path_says_so():
    scenario = planar_scenario()
    page = scene_html(scenario, unsolved(scenario))
    assert "RRT: timeout, no path" in page
    assert 'data-folder="path"' not in page


def test_a_page_starts_no_process_and_prints_nothing():
    program = (
        "import os, threading\n"
        "from planners.view.meshcat_page import scene_html\n"
        "from tests.view.scenes import planar_scenario\n"
        "scene_html(planar_scenario())\n"
        "children = open(f'/proc/self/task/{os.getpid()}/children').read().split()\n"
        "assert children == [], children\n"
        "assert threading.active_count() == 1, threading.enumerate()\n"
    )
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, capture_output=True, text=True, timeout=900, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_meshcat_and_matplotlib_are_imported_lazily():
    program = (
        "import sys, planners.view.meshcat_page, planners.view.figures\n"
        "heavy = {'meshcat', 'matplotlib', 'zmq', 'IPython', 'scipy', 'numba'} & set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True, timeout=900)


def test_write_page_replaces_the_file_whole(tmp_path):
    target = tmp_path / "page.html"
    target.write_text("old")
    assert write_page("ä", target) == target
    assert target.read_text(encoding="utf-8") == "ä"
    assert list(tmp_path.iterdir()) == [target]


def test_a_missing_folder_is_a_clean_error(tmp_path):
    with pytest.raises(EllipsoidPlanningError, match="does not exist"):
        write_page("page", tmp_path / "missing" / "page.html")


def test_an_unwritable_place_is_a_clean_error_and_leaves_nothing(tmp_path):
    (tmp_path / "page.html").mkdir()
    with pytest.raises(EllipsoidPlanningError, match=r"page\.html: cannot write"):
        write_page("page", tmp_path / "page.html")
    assert [path.name for path in tmp_path.iterdir()] == ["page.html"]


def test_open_in_browser_hands_over_a_file_address(tmp_path, monkeypatch):
    opened = []
    monkeypatch.setattr(meshcat_page.webbrowser, "open", opened.append)
    path = open_in_browser("page", tmp_path / "page.html")
    assert opened == [path.as_uri()]
    assert path.read_text() == "page"
    monkeypatch.setattr(meshcat_page.tempfile, "mkdtemp", lambda **_: str(tmp_path))
    assert open_in_browser("other").read_text() == "other"
