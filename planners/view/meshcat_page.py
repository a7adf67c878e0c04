"""One self-contained HTML page with a scene in it, viewed by meshcat.

The page loads nothing: meshcat's program and the scene are in the file, and its content
security policy forbids every outside address.
"""

from __future__ import annotations

import base64
import functools
import html
import json
import math
import tempfile
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING

from planners.view import colours
from planners.view.meshcat_scene import Scene, build_scene
from planners.view.meshcat_surroundings import ROOT
from planners.view.writing import write_whole

if TYPE_CHECKING:
    from ellipsoid_planning.result import PlanResult
    from ellipsoid_planning.roadmap.graph import RoadmapGraph
    from ellipsoid_planning.scenario import Scenario

POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; connect-src data: blob:; worker-src blob:"
)

MOST_LINKS = 12  # that the legend tells apart

STYLE = """
body { margin: 0; font: 14px/1.4 system-ui, sans-serif; color: #1a1a1a; }
#meshcat-pane { width: 100vw; height: 100vh; overflow: hidden; }
#caption { position: absolute; left: 16px; top: 12px; max-width: 44em; pointer-events: none;
           padding: 4px 8px; border-radius: 6px; background: rgba(255, 255, 255, 0.75); }
#caption h1 { font-size: 18px; margin: 0; }
#caption p { margin: 2px 0; color: #505050; }
#legend { pointer-events: auto; display: inline-flex; flex-wrap: wrap; gap: 4px 14px; }
#legend button { border: 0; background: none; padding: 0; font: inherit; cursor: pointer; }
#legend i { display: inline-block; width: 12px; height: 12px; border-radius: 6px;
            margin-right: 5px; }
#legend button[aria-pressed="false"] { opacity: 0.4; text-decoration: line-through; }
"""

SCRIPT = """
const viewer = new MeshCat.Viewer(document.getElementById("meshcat-pane"));
for (const command of __COMMANDS__)
    viewer.handle_command_bytearray(Uint8Array.from(atob(command), c => c.charCodeAt(0)));
for (const button of document.querySelectorAll("#legend button"))
    button.onclick = () => {
        const path = ["__ROOT__", button.dataset.folder];
        const visible = !viewer.scene_tree.find(path).object.visible;
        viewer.set_property(path, "visible", visible);
        viewer.set_dirty();
        button.setAttribute("aria-pressed", visible);
    };
"""

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<title>{title}</title>
<style>{style}</style>
</head>
<body>
<div id="meshcat-pane"></div>
<div id="caption"><h1>{title}</h1>{lines}<div id="legend">{legend}</div></div>
<script>{meshcat}</script>
<script>{script}</script>
</body>
</html>
"""


def scene_html(
    scenario: Scenario,
    result: PlanResult | None = None,
    roadmap: RoadmapGraph | None = None,
    show_roadmap: bool = False,
) -> str:
    """Return a page that shows a scenario, ready to be written to one file.

    Args:
        scenario: what is drawn: arena, obstacles, the robot at start and goal.
        result: its path is drawn and the robot moves along it, if it has one.
        roadmap: drawn in a folder of its own, which the page can show and hide.
        show_roadmap: whether the roadmap is visible at first.
    """
    scene = build_scene(scenario, result, roadmap, show_roadmap)
    return page_of_scene(scene, scenario.name, _caption(scenario, result))


def page_of_scene(scene: Scene, title: str, lines: list[str]) -> str:
    """Return the page of a scene under a title and lines of plain text."""
    commands = [base64.b64encode(command).decode("ascii") for command in scene.commands]
    script = SCRIPT.replace("__COMMANDS__", json.dumps(commands)).replace("__ROOT__", ROOT)
    return PAGE.format(
        policy=POLICY,
        title=html.escape(title or "scenario"),
        style=STYLE,
        lines="".join(f"<p>{html.escape(line)}</p>" for line in lines),
        legend="".join(_legend_entry(scene, *folder) for folder in scene.folders),
        meshcat=_meshcat_program(),
        script=script,
    )


def write_page(page: str, output: str | Path) -> Path:
    """Write a page to a file, whole or not at all.

    Raises:
        EllipsoidPlanningError: if it cannot be written.
    """
    return write_whole(output, page.encode("utf-8"))


def open_in_browser(page: str, output: str | Path | None = None) -> Path:
    """Write a page to `output`, or to a temporary file that stays, and open it in a browser.

    Returns the file, so that a user without a browser can be told where it is.
    """
    if output is None:
        output = Path(tempfile.mkdtemp(prefix="ellipsoid-planning-")) / "scene.html"
    path = write_page(page, output).resolve()
    webbrowser.open(path.as_uri())
    return path


def _caption(scenario: Scenario, result: PlanResult | None) -> list[str]:
    lines = [scenario.description] if scenario.description else []
    if result is None:
        return lines
    if result.path is None:
        return [*lines, f"{result.planner}: {result.status}, no path"]
    path = result.path
    proof = "certified" if path.certified else "not certified"
    summary = f"{result.planner}: path of length {path.length:.4g}, {proof}"
    if 0.0 < path.min_clearance < math.inf:
        summary += f", clearance at least {path.min_clearance:.3g}"
    return [*lines, summary]


def _legend_entry(scene: Scene, folder: str, colour: str) -> str:
    pressed = "false" if folder in scene.hidden else "true"
    shown = colours.tint(colour, 0.5) if folder == "arena" else colour
    links = scene.links if folder == "robot" and len(scene.links) <= MOST_LINKS else ()
    swatches = [_swatch(shown) + html.escape(folder)]
    if links:
        swatches = [f"{html.escape(folder)}:"]
        swatches += [_swatch(colour) + html.escape(name) for name, colour in links]
    return (
        f'<button data-folder="{html.escape(folder)}" aria-pressed="{pressed}">'
        f"{' '.join(swatches)}</button>"
    )


def _swatch(colour: str) -> str:
    return f'<i style="background:{colour}"></i>'


@functools.cache
def _meshcat_program() -> str:
    from importlib.resources import files

    return files("meshcat").joinpath("viewer/dist/main.min.js").read_text(encoding="utf-8")
