"""Lenses above plans and tests: what they run, what the editor is told, and that a plan without end can be interrupted."""

from __future__ import annotations

import asyncio
import signal
import threading

import pytest
from lsprotocol import types as lsp

from .editor import Editor
from .mistakes import COURSE, HIGH, HY_MODULES, PLANS, ROOT

TESTS = COURSE / "tests" / "simple-plans-tests.hy"


def lenses(editor, file):
    editor.open(file.as_uri(), file.read_text(encoding="utf-8"))
    found = editor.ask("code_lens", lsp.CodeLensParams(lsp.TextDocumentIdentifier(file.as_uri())))
    return [(each.range.start.line + 1, each.command.title, each.command.arguments[1]) for each in found]


def execute(editor, command, file, name):
    return editor.run(editor.client.workspace_execute_command_async(lsp.ExecuteCommandParams(command, [file.as_uri(), name])))


def test_which_forms_have_lenses(editor):
    assert lenses(editor, HIGH) == [(66, "Run", "perform-draw-house")]
    assert lenses(editor, PLANS) == []
    assert [(title, name) for _, title, name in lenses(editor, TESTS)] == [
        ("Test", "relative-angle-to-dont-turn"),
        ("Test", "relative-angle-to-look-back"),
        ("Test", "relative-angle-to-type-error"),
    ]
    assert (54, "Run", "move-parallel") in lenses(editor, HY_MODULES)
    hy_tests = ROOT / "turtlesim_in_hy" / "tests" / "test_simple_plans.hy"
    assert lenses(editor, hy_tests) and {title for _, title, _ in lenses(editor, hy_tests)} == {"Test"}


@pytest.mark.soak
def test_one_test_runs_and_is_told(editor):
    lenses(editor, TESTS)
    answer = execute(editor, "cramhy.test", TESTS, "relative-angle-to-look-back")
    assert answer["status"] == 0 and "3 assertions passed" in answer["output"] and "TYPE-ERROR" not in answer["output"]
    assert editor.shown[-1].type == lsp.MessageType.Info and "1 passed" in editor.shown[-1].message


@pytest.mark.soak
def test_a_plan_runs_behind_init(editor):
    lenses(editor, HIGH)
    answer = execute(editor, "cramhy.run", HIGH, "perform-draw-house")
    assert answer["status"] == 0 and answer["what"] == "(tut::init) (tut::perform-draw-house)"
    assert "TurtleSim navigation invoked" in answer["output"]


@pytest.mark.soak
def test_a_plan_of_hy_runs(editor):
    lenses(editor, HY_MODULES)
    answer = execute(editor, "cramhy.run", HY_MODULES, "move-parallel")
    assert answer["status"] == 0 and "navigation invoked" in answer["output"], answer["output"]


ENDLESS = """(cl:defun endless ()
  (cpl:top-level
    (cl:unwind-protect (cl:progn (cl:format t "it runs~%") (cl:loop (cpl:sleep 1)))
      (cl:format t "cleanup has run~%"))))
(cl:defun fails ()
  (cpl:top-level (cpl:fail "no ~a" 'way)))
"""


@pytest.mark.soak
def test_a_plan_without_end_is_interrupted_and_the_server_answers_meanwhile(editor, tmp_path):
    file = tmp_path / "endless.lisp"
    file.write_text(ENDLESS, encoding="utf-8")
    assert [name for *_, name in lenses(editor, file)] == ["endless", "fails"]
    begun = len(editor.logged)
    answers = []
    thread = threading.Thread(target=lambda: answers.append(execute(editor, "cramhy.run", file, "endless")))
    thread.start()
    editor.wait_for(lambda: any("it runs" in each for each in editor.logged[begun:]))
    assert editor.ask("folding_range", lsp.FoldingRangeParams(lsp.TextDocumentIdentifier(file.as_uri())))
    params = lsp.ExecuteCommandParams("cramhy.interrupt", [])
    assert editor.run(editor.client.workspace_execute_command_async(params)) == 1
    thread.join()
    assert answers[0]["status"] != 0 and "cleanup has run" in answers[0]["output"]
    failed = execute(editor, "cramhy.run", file, "fails")
    assert failed["status"] == 1 and "no way" in failed["output"].lower()
    assert editor.shown[-1].type == lsp.MessageType.Error


WRITES = """(defun endless ()
  (cpl:top-level
    (unwind-protect (progn (print "it runs") (loop (cpl:sleep 0.01)))
      (with-open-file (file "{}" :direction :output) (print :cleaned file)))))
"""


@pytest.mark.soak
@pytest.mark.parametrize("how", ["SIGTERM", "SIGHUP", "closed", "shutdown"])
def test_a_plan_is_cleaned_up_when_the_server_ends(tmp_path, how):
    """It may drive a robot."""
    file, cleaned = tmp_path / "endless.lisp", tmp_path / "cleaned"
    file.write_text(WRITES.format(cleaned), encoding="utf-8")
    editor = Editor()
    lenses(editor, file)
    params = lsp.ExecuteCommandParams("cramhy.run", [file.as_uri(), "endless"])
    running = asyncio.run_coroutine_threadsafe(editor.client.workspace_execute_command_async(params), editor.loop)
    editor.wait_for(lambda: any("it runs" in each for each in editor.logged))
    server = editor.client._server
    if how == "closed":
        editor.loop.call_soon_threadsafe(server.stdin.close)
    elif how == "shutdown":
        editor.run(editor.client.shutdown_async(None))
    else:
        server.send_signal(getattr(signal, how))
    looks = iter(range(600))
    while not (cleaned.exists() and "CLEANED" in cleaned.read_text()):
        assert next(looks, None) is not None, "the plan was not cleaned up"
        threading.Event().wait(0.1)
    if how != "shutdown":
        editor.run(server.wait())
    running.cancel()


@pytest.mark.parametrize("arguments", [[], [None], ["file:///nowhere.lisp", "x"], [1, 2, 3], ["", {}]])
def test_arguments_that_are_none_are_refused(editor, arguments):
    answer = editor.run(editor.client.workspace_execute_command_async(lsp.ExecuteCommandParams("cramhy.run", arguments)))
    assert answer["status"] is None and "Open the file" in editor.shown[-1].message


def test_a_text_that_is_not_saved_does_not_run(editor):
    lenses(editor, HIGH)
    editor.change(HIGH.as_uri(), HIGH.read_text(encoding="utf-8") + "\n")
    answer = execute(editor, "cramhy.run", HIGH, "perform-draw-house")
    assert answer["status"] is None and "Save the file" in answer["output"]
    assert "no Run above nothing" in execute(editor, "cramhy.run", PLANS, "nothing")["output"]
