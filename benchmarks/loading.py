"""How long scenarios take to load: bundled ones, and scenes of many bodies, by the way of reading.

Beside the whole of `load_scenario` stands ruamel.yaml's reading with lines and columns alone, which
every file went through before and those with an error still do. Own CPU time, the best of a few
runs.

    python -m benchmarks.loading [--bodies 20000]
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ellipsoid_planning.scenario import Scenario, bundled_scenarios, load_scenario
from ellipsoid_planning.scenario_places import read_yaml
from ellipsoid_planning.scenario_yaml import document_text

RUNS = 5
SLOW_RUNS = 1


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bodies", type=int, default=20_000)
    bodies = parser.parse_args().bodies
    load_scenario("rabbit-2d-open")
    print("bundled scenario        load [ms]  ruamel alone [ms]")
    for name, file in bundled_scenarios().items():
        loaded = best(lambda file=file: load_scenario(file), RUNS)
        text = file.read_text(encoding="utf-8")
        general = best(lambda text=text: read_yaml(text), RUNS)
        print(f"{name:22s} {1e3 * loaded:10.2f} {1e3 * general:18.2f}")
    print(f"\n{bodies} bodies                 load [us a body]")
    with tempfile.TemporaryDirectory() as folder:
        for name, text in scenes(bodies).items():
            file = Path(folder) / "scene.yaml"
            file.write_text(text, encoding="utf-8")
            loaded = best(lambda file=file: load_scenario(file), RUNS)
            print(f"{name:28s} {1e6 * loaded / bodies:14.1f}")
    document = json.loads(scenes(bodies)["3-D, JSON"])
    built = best(lambda: Scenario.from_dict(document), RUNS)
    few = max(1, bodies // 20)
    general = best(lambda: read_yaml(scenes(few)["3-D, a line each"]), SLOW_RUNS)
    print(f"{'(building alone)':28s} {1e6 * built / bodies:14.1f}")
    print(f"{'(ruamel alone, a line each)':28s} {1e6 * general / few:14.1f}")


def best(run: Callable[[], Any], runs: int) -> float:
    """The least CPU time of a few runs [s]."""
    times = []
    for _ in range(runs):
        began = time.process_time()
        run()
        times.append(time.process_time() - began)
    return min(times)


def scenes(bodies: int) -> dict[str, str]:
    """Texts of scenes by the way in which they are written."""
    flat, spatial = scene(2, bodies), scene(3, bodies)
    return {
        "2-D, a line each": lines(flat),
        "3-D, a line each": lines(spatial),
        "3-D, as we write": document_text(spatial),
        "3-D, JSON": json.dumps(spatial),
    }


def scene(dimension: int, bodies: int) -> dict[str, Any]:
    """A scene of small obstacles, all digits written out."""
    rng = np.random.default_rng(1)
    angles = rng.uniform(-180.0, 180.0, (bodies, 3)).tolist()
    obstacles = [
        {
            "name": f"rock {k}",
            "semi_axes": rng.uniform(0.01, 0.1, dimension).tolist(),
            "position": rng.uniform(-8.0, 8.0, dimension).tolist(),
            "orientation": {"yaw_deg": turn[0]} if dimension == 2 else {"rpy_deg": turn},
        }
        for k, turn in enumerate(angles)
    ]
    return {
        "format": 1,
        "name": "rocks",
        "dimension": dimension,
        "bounds": {"low": [-10.0] * dimension, "high": [10.0] * dimension},
        "obstacles": obstacles,
        "robot": {"parts": [{"semi_axes": [0.5] * dimension}]},
        "start": {"position": [-9.0] * dimension},
        "goal": {"position": [9.0] * dimension},
    }


def lines(document: Mapping[str, Any]) -> str:
    """YAML with a line for each obstacle."""
    rest = {key: value for key, value in document.items() if key != "obstacles"}
    written = [json.dumps(body).replace('"', "") for body in document["obstacles"]]
    return document_text(rest) + "obstacles:\n" + "".join(f"  - {body}\n" for body in written)


if __name__ == "__main__":
    main()
