"""What we change in Hy: these tests fail when Hy changes there, and then somebody looks whether the patch can go."""

from __future__ import annotations

import ast
import importlib.metadata
import inspect
import types

import hy
import hy.macros
import hy.repl
import pytest

from cramhy_runtime.languages.hy import patches
from cramhy_runtime.repl import hy_repl


def test_the_patches_were_looked_at_with_this_hy():
    """Another version that passes the tests of this file needs the new number in `SEEN_WITH`, and no more."""
    assert importlib.metadata.version("hy") == patches.SEEN_WITH


@pytest.mark.parametrize("function", [hy.macros.require, hy.macros.require_reader, hy.macros.enable_readers])
def test_hy_asks_for_the_whole_stack_to_find_one_frame(function):
    assert inspect.getsource(function).count("inspect.stack()[1][0]") == 1


def test_hy_looks_at_no_other_entry_of_the_stack():
    tree = ast.parse(inspect.getsource(hy.macros))
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and ast.unparse(node.func) == "inspect.stack"]
    assert len(calls) == 3 and all(not call.args for call in calls)


def test_hy_compiles_a_keyword_to_a_call_of_its_class_whose_hash_is_that_of_the_name():
    from hy.compiler import hy_compile

    assert ast.unparse(hy_compile(hy.read("[:driving]"), types.ModuleType("a"), import_stdlib=False)) == "[hy.models.Keyword('driving')]"
    assert "def __hash__(self):\n        return hash(self.name)" in inspect.getsource(hy.models.Keyword)


def test_hy_makes_its_repl_of_one_class_that_nobody_can_choose():
    from hy import cmdline

    assert "REPL(\n            spy = options" in inspect.getsource(cmdline.cmdline_handler)
    variables = {node.args[0].value for node in ast.walk(ast.parse(inspect.getsource(hy.repl))) if _is_of_the_startup_file(node)}
    assert variables == {"__all__", "repl_spy", "repl_output_fn", "repl_ps1", "repl_ps2"}


def _is_of_the_startup_file(node):
    return isinstance(node, ast.Call) and ast.unparse(node.func) in ("imports.get", "mod.__dict__.get")


def test_a_repl_that_runs_may_become_one_of_another_class():
    repl = hy.REPL(locals={"__name__": "a_repl_that_changes"})
    before = vars(repl).copy()
    patches.change_class(repl, hy_repl.attended(type(repl)))
    assert isinstance(repl, hy.REPL) and type(repl).__name__ == "REPL" and vars(repl) == before
    assert repl.runsource("(setv x 1)") is False and repl.locals["x"] == 1  # without a prompt of ours all is as Hy has it
