"""What is not in a tab is told by who asks for it. Any Python can tell."""

from __future__ import annotations

import ast
import contextlib
import importlib.util
from pathlib import Path

import importlib
import importlib.util
import sys

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.browser import left_out
from cramhy_runtime.languages.commonlisp.tools.advice import explanation
from cramhy_runtime.languages.commonlisp.tools.error_reports import condition_of
from cramhy_runtime.session.session import Session

ADVICE = 'Install cramhy on a computer for that; the page "Install" of its documentation says how.'


@pytest.fixture(autouse=True)
def in_a_tab(monkeypatch):
    monkeypatch.setattr(sys, "meta_path", list(sys.meta_path))
    left_out.install()


@pytest.mark.parametrize("way", [lambda: __import__("numppy"), lambda: importlib.import_module("numppy")])
def test_a_module_of_somebody_elses_is_not_part_of_the_page(way):
    with pytest.raises(ModuleNotFoundError) as refused:
        way()
    assert (str(refused.value), refused.value.name) == ("No module named 'numppy': it is not part of this page.", "numppy")
    assert refused.value.__notes__ == [ADVICE]


def test_lisp_tells_it_too_and_does_not_speak_of_pip():
    session = Session(time="virtual", turtlesim=False)
    with pytest.raises(Exception) as refused:
        session.evaluate_text('(py:call "numppy.array" 1)')
    told = explanation(condition_of(refused.value))
    kernel.stop()
    assert "No module named 'numppy': it is not part of this page." in told and ADVICE in told and "pip" not in told


def test_who_asks_whether_there_is_a_module_is_told_no():
    assert importlib.util.find_spec("numppy") is None


def test_a_part_of_a_package_that_there_is_has_pythons_own_words():
    with pytest.raises(ModuleNotFoundError, match=r"^No module named 'json\.numppy'$"):
        importlib.import_module("json.numppy")


def test_a_room_that_is_left_out_says_why(monkeypatch):
    monkeypatch.delitem(sys.modules, "cramhy_runtime.swank", raising=False)
    with pytest.raises(ImportError) as refused:
        importlib.import_module("cramhy_runtime.swank")
    assert str(refused.value) == (
        f"cramhy_runtime.swank is not there in a browser's tab: it talks with other programs, and there are none in a tab. {ADVICE}"
    )


def imported_by(name):
    """The modules of ours that a module imports as soon as it is imported itself."""
    spec = importlib.util.find_spec(name)
    if spec is None or spec.origin is None or not spec.origin.endswith(".py"):
        return
    home = name if spec.submodule_search_locations is not None else name.rpartition(".")[0]
    for node in ast.parse(Path(spec.origin).read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = importlib.util.resolve_name("." * node.level + (node.module or ""), home) if node.level else node.module
            yield base
            yield from (f"{base}.{alias.name}" for alias in node.names)


@pytest.mark.soak
def test_the_prompt_of_a_tab_imports_nothing_that_is_left_out():
    known, waiting = set(), ["cramhy_runtime.browser.tab"]
    while waiting:
        name = waiting.pop()
        if name in known or not name.startswith("cramhy_runtime"):
            continue
        known.add(name)
        with contextlib.suppress(ModuleNotFoundError):  # a name in a module, or what is left out
            waiting += imported_by(name)
    assert len(known) > 300
    assert sorted(name for name in known if left_out.is_left_out(name.removeprefix("cramhy_runtime.").replace(".", "/") + ".py")) == []
