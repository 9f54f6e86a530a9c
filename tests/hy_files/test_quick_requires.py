"""`require` finds the file that asks for macros, as in a Hy that knows nothing of us, and reads no source for it."""

from __future__ import annotations

import importlib
import inspect
import subprocess
import sys
import types

import cramhy  # noqa: F401  it changes how Hy requires
import hy
import pytest

from cramhy_runtime.languages.hy import patches

LIBRARY = "(defmacro three [] 3)\n(defreader seven 7)\n(defmacro _hidden [] 1)\n(export :macros [three])\n"
PROGRAM = """\
(require a-library [three :as drei])
(require a-library :readers [seven])
(setv at-the-top [(drei) #seven])
(defn inside []
  (require a-library [three])
  (three))
(import hy)
(hy.eval '(do (require a-library) (setv evaluated (a-library.three))))
(print at-the-top (inside) evaluated (sorted (.keys _hy_macros)) (in "seven" _hy_reader_macros))
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "a_library.hy").write_text(LIBRARY)
    (tmp_path / "a_program.hy").write_text(PROGRAM)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def ran(first):
    """What the program prints when Python compiles it, and when it is imported again from its bytecode."""
    command = [sys.executable, "-c", f"{first}; import a_program"]
    return [subprocess.run(command, capture_output=True, text=True, check=True).stdout for _ in range(2)]


@pytest.mark.soak
def test_macros_come_to_the_file_that_requires_them_as_in_hy_alone(folder):
    alone = ran("import hy")
    assert ran("import hy, cramhy") == alone == ["[3, 7] 3 3 ['a_library.three', 'drei'] True\n"] * 2


@pytest.mark.soak
def test_a_module_that_is_required_for_another_one_keeps_the_macros_apart(folder, monkeypatch):
    monkeypatch.syspath_prepend(str(folder))
    wanted = types.ModuleType("wanted")
    hy.macros.require("a_library", wanted, assignments="ALL", prefix="")
    assert "three" in wanted.__dict__["_hy_macros"] and "three" not in globals().get("_hy_macros", {})
    hy.macros.require("a_library", None, assignments="ALL", prefix="")
    assert "three" in globals().pop("_hy_macros")
    del sys.modules["a_library"]


@pytest.mark.soak
def test_no_source_is_read_for_it(folder, monkeypatch):
    monkeypatch.syspath_prepend(str(folder))
    importlib.import_module("a_library")
    monkeypatch.setattr(inspect, "stack", None)
    hy.macros.require("a_library", types.ModuleType("wanted"), assignments="ALL", prefix="")
    del sys.modules["a_library"]


def test_the_rest_of_inspect_is_what_it_was():
    assert isinstance(hy.macros.inspect, patches._Inspect)
    assert hy.macros.inspect.ismodule is inspect.ismodule and hy.macros.inspect.signature is inspect.signature
    assert "frame" in inspect.stack()[0]._fields  # others are not touched
