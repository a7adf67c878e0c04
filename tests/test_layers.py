"""What import-linter cannot say: kernels import a handful of modules and nothing else."""

import ast
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parent.parent / "ellipsoid_planning"
KERNELS = sorted((PACKAGE / "kernels").glob("*.py"))
COMPILER = "compile.py"  # finds the cache folder, so it may use the standard library


def imported_modules(file):
    """The full names of all modules that a file imports."""
    names = []
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names.append(f"{'ellipsoid_planning.kernels.' if node.level else ''}{node.module}")
    return names


@pytest.mark.parametrize("file", KERNELS, ids=lambda file: file.name)
def test_kernels_import_numpy_numba_math_and_each_other(file):
    allowed = {"numpy", "numba", "math", "typing", "__future__"}
    if file.name == COMPILER:
        allowed |= sys.stdlib_module_names | {"ellipsoid_planning"}
    for name in imported_modules(file):
        kernel = name.startswith("ellipsoid_planning.kernels")
        assert kernel or name.split(".")[0] in allowed, name


def test_only_the_plugin_imports_ompl_and_only_the_top_a_screen():
    planners = PACKAGE.parent / "planners"
    screens = {"matplotlib", "meshcat", "rich", "typer", "umsgpack", "webbrowser"}
    for file in planners.rglob("*.py"):
        if file.relative_to(planners).parts[0] in ("view", "cli"):
            continue
        assert not screens & {name.split(".")[0] for name in imported_modules(file)}, file
