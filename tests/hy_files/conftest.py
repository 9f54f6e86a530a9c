"""Programs in ``.hy`` files, run as a user runs them: by ``hy FILE``, by ``cramhy run FILE``, by an import."""

from __future__ import annotations

import importlib
import itertools
import os
import subprocess
import sys
from pathlib import Path

import pytest
from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from systems import RUNS_HY_FILES, WHY_NO_HY_FILES

ROOT = Path(__file__).parents[2]
PROGRAMS = {"hy": ["hy"], "run": ["cramhy_runtime.cli", "run"]}

WITHOUT_HY = pytest.mark.skipif(not RUNS_HY_FILES, reason=WHY_NO_HY_FILES)


def pytest_collection_modifyitems(items):
    for item in items:
        if item.path.parent == Path(__file__).parent:
            item.add_marker(WITHOUT_HY)


_numbers = itertools.count(1)


@pytest.fixture
def load(tmp_path, monkeypatch):
    """``load(text)``: a module made of a Hy file with that text behind ``(require cramhy *)``."""
    boot()
    kernel.start()
    monkeypatch.syspath_prepend(str(tmp_path))
    made = []

    def load(text):
        name = f"names_of_ours_{next(_numbers)}"
        (tmp_path / f"{name}.hy").write_text(f"(require cramhy *)\n{text}\n")
        importlib.invalidate_caches()
        made.append(name)
        return importlib.import_module(name)

    yield load
    for name in made:
        sys.modules.pop(name, None)
    kernel.stop()


def environment(**variables):
    left_out = ("ROS_PACKAGE_PATH", "PYTHONDONTWRITEBYTECODE", "CRAMHY_TIME", "CRAMHY_BACKTRACE")
    kept = {key: value for key, value in os.environ.items() if key not in left_out}
    return {**kept, "PYTHONPATH": f"{ROOT / 'src'}{os.pathsep}{ROOT / 'hy_src'}", **variables}


@pytest.fixture
def python(tmp_path):
    """``python("-m", "hy", "x.hy", CRAMHY_TIME="wall")``: the finished process of Python with these words, in a folder of its own."""

    def python(*words, cwd=tmp_path, input="", **variables):
        return subprocess.run(
            [sys.executable, *words], cwd=cwd, input=input, text=True, capture_output=True, timeout=120, env=environment(**variables)
        )

    return python


@pytest.fixture
def program(python):
    """``program("hy", "x.hy")``, ``program("run", "x.hy")``: the finished process of ``hy x.hy``, of ``cramhy run x.hy``."""

    def program(way, *words, **variables):
        return python("-m", *PROGRAMS[way], *words, **variables)

    return program


@pytest.fixture
def write(tmp_path):
    """``write("x.hy", text)``: the path of that file."""

    def write(name, text):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write
