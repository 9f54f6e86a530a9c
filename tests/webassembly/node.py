"""Node with Pyodide in it, as a machine for tests: `run_pytest` runs files of tests there, on this checkout.

``npm ci`` in the folder ``webassembly`` fetches both, with checksums (`make pyodide`). What is made of them is kept below its ignored
``node_modules``: Pyodide as mended, pytest and Hy as copies, and Python's compiled files.
"""

from __future__ import annotations

import functools
import importlib.util
import json
import shutil
import subprocess
from pathlib import Path

import pytest
from systems import SOAK

from cramhy_runtime.browser import pyodide_files, site

ROOT = Path(__file__).parents[2]
KEPT = pyodide_files.FETCHED / ".cramhy"
PACKAGES = ("pytest", "_pytest", "pluggy", "iniconfig", "packaging", "pygments", "py", "hy", "hyrule", "funcparserlib", "yaml")
LIMIT = 3600 if SOAK else 360  # s


@functools.cache
def node():
    """The path of a Node whose WebAssembly can suspend stacks. The test is skipped where there is none."""
    try:
        return site.find_node()
    except site.SiteError:
        pytest.skip("needs node from 25 on: make pyodide, in this checkout, fetches it from npm")


@functools.cache
def pyodide():
    """The folder of Pyodide, mended. The test is skipped where npm has not fetched it."""
    try:
        return pyodide_files.copied(pyodide_files.FETCHED / "pyodide", KEPT / "pyodide")
    except pyodide_files.UnfitPyodide:
        pytest.skip("needs the package pyodide of npm: make pyodide, in this checkout, fetches it")


def _packages():
    """A folder with the packages of Python that tests need and that are Python alone."""
    folder = KEPT / "packages"
    folder.mkdir(parents=True, exist_ok=True)
    for name in PACKAGES:
        origin = Path(importlib.util.find_spec(name).origin)
        if origin.name == "__init__.py":
            shutil.copytree(origin.parent, folder / name, ignore=shutil.ignore_patterns("__pycache__", "*.so"), dirs_exist_ok=True)
        else:
            shutil.copy2(origin, folder)
    return folder


def run_pytest(*arguments, **environment):
    """The process of a run of pytest with ``arguments``, paths among them relative to the checkout. What it prints is its ``stdout``."""
    program, python = node(), pyodide()
    compiled = KEPT / "compiled"
    compiled.mkdir(parents=True, exist_ok=True)
    job = {
        "pyodide": str(python),
        "folders": {"/cramhy": str(ROOT), "/packages": str(_packages()), "/compiled": str(compiled)},
        "environment": {
            "PYTHONPYCACHEPREFIX": "/compiled",
            "PYTHONHASHSEED": "0",
            "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",
            **({"CRAMHY_SOAK": "1"} if SOAK else {}),
            **environment,
        },
        "path": ["/cramhy/src", "/cramhy/hy_src", "/packages", "/cramhy/tests"],
        "arguments": ["-p", "cramhy_runtime.pytest_plugin", "-p", "no:cacheprovider", "--capture=sys", *arguments],
    }
    return subprocess.run(
        [program, str(Path(__file__).with_name("run_pytest.mjs")), json.dumps(job)],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=LIMIT,
    )
