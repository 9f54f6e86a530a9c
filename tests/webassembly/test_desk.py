"""What the page of a tab asks its session beside the prompt. Any Python can answer."""

from __future__ import annotations

import base64
import json
import sys
import types

import hy
import pytest

from cramhy_runtime import kernel
from cramhy_runtime.browser.desk import Desk
from cramhy_runtime.session.session import Session


@pytest.fixture
def ask(tmp_path, monkeypatch):
    """A function that asks, and returns the answer, or ("refused", why)."""
    monkeypatch.chdir(tmp_path)
    answers = {}
    session = Session(time="virtual", turtlesim=False)
    desk = Desk(session, lambda text: answers.update({(told := json.loads(text))["id"]: told}))

    def ask(what, **values):
        ask.number += 1
        desk.ask(json.dumps({"id": ask.number, "what": what, **values}))
        kernel.settle()
        told = answers[ask.number]
        return told["answer"] if "answer" in told else ("refused", told["refused"])

    ask.number, ask.desk, ask.session = 0, desk, session
    yield ask
    kernel.stop()


def names(found):
    return [name for name, _ in found["options"]]


def test_lisp_is_completed_in_the_package_of_the_file_or_of_the_prompt(ask):
    ask.session.evaluate_text("(defpackage :walks (:use :cl)) (defun walks::stride (&key long) long)")
    found = ask("complete", text="(list (strid", package="walks")
    assert found == {"length": 5, "options": [["stride", ""]]}
    assert "stride" not in names(ask("complete", text="(list (strid", package=None))
    assert "stride" not in names(ask("complete", text="(list (strid", package="nowhere"))
    ask.desk.package = ask.session.evaluate_text("(find-package :walks)")[0]
    assert names(ask("complete", text="(strid")) == ["stride"]
    assert names(ask("complete", text="(stride :l")) == [":long"]
    assert names(ask("complete", text="(walks::strid")) == ["walks::stride"]
    assert "multiple-value-bind" in names(ask("complete", text="(mvb"))  # the letters in order
    assert names(ask("complete", text="(cpl:pursu")) == ["cpl:pursue"]


def test_in_a_string_files_are_completed(ask, tmp_path):
    (tmp_path / "walk.lisp").write_text("")
    assert ask("complete", text='(load "wa') == {"length": 2, "options": [["walk.lisp", ""]]}
    assert ask("complete", text='(open "wa', language="hy") == {"length": 2, "options": [["walk.lisp", ""]]}


@pytest.mark.soak
def test_hy_is_completed_once_there_is_a_prompt_of_hy(ask):
    assert ask("complete", text="(defn wal", language="hy") == {"length": 3, "options": []}
    module = types.ModuleType("typed_here")
    sys.modules["typed_here"] = module
    try:
        hy.eval(hy.read("(do (require cramhy *) (defn walk-on [steps [slowly False]] steps))"), module=module)
        ask.desk.hy_module = lambda: module
        assert names(ask("complete", text="(wal", language="hy")) == ["walk-on"]
        assert ask("arglist", text="(print (walk-on ", language="hy") == {"name": "", "items": ["(walk-on steps slowly)"], "place": None}
        assert ask("arglist", text="(top-level ", language="hy")["items"] == ["(top-level form...)"]
    finally:
        del sys.modules["typed_here"]
    assert ask("arglist", text="(lfor ", language="hy")["items"] == ["(lfor name values value)"]


def test_the_call_at_the_cursor_is_told_with_the_argument_that_is_typed(ask):
    ask.session.evaluate_text("(defun drive (speed &key angle long) (list speed angle long))")
    told = {"name": "drive", "items": ["speed", "&key", "angle", "long"]}
    assert ask("arglist", text="(drive ") == {**told, "place": 0}
    assert ask("arglist", text="(drive 5 :angle ") == {**told, "place": 2}
    assert ask("arglist", text="(drive 5 :long 3") == {**told, "place": 3}
    assert ask("arglist", text="(drive ; (here\n ") == {**told, "place": 0}
    assert ask("arglist", text='(drive "(" :long #\\( :angle (unheard-of 1 ') == {**told, "place": 2}
    assert ask("arglist", text="(unheard-of ") is None
    assert ask("arglist", text="") is None


def test_packages_leave_and_come_back(ask, tmp_path):
    (tmp_path / "walk.lisp").write_text("(walk)")
    found = ask("export", path="walk.lisp", name="walks")
    assert found["name"] == "walks.zip"
    assert ask("import", data=found["data"])["files"][-2:] == ["walks/src/walk.lisp", "walks/walks.asd"]
    assert ask("import", data=found["data"]) == {"there": "walks"}
    assert "walks/package.xml" in ask("import", data=found["data"], replace=True)["files"]
    assert ask("import", data=base64.b64encode(b"no").decode())[0] == "refused"
    assert ask("export", path="walk.lisp", name="No") == (
        "refused",
        '"No" cannot be the name of a package: it begins with a lower-case letter, and has letters, digits and _ in it.',
    )


def test_a_task_is_checked_beside_the_prompt_and_the_answer_comes_later(ask):
    answers = []
    ask.desk._say = lambda text: answers.append(json.loads(text))

    def check(task, language="lisp"):
        ask.desk.ask(json.dumps({"id": task, "what": "check", "task": task, "language": language}))
        assert answers == [] or language == "hy"
        kernel.sleep(1)
        return answers.pop()["answer"]

    ask.session.evaluate_text("(defun rectangle-around (width height) (+ width height))")
    wrong = check("rectangle")
    assert not wrong["passed"] and wrong["told"] != []
    ask.session.evaluate_text("(defun rectangle-around (width height) (* 2 (+ width height)))")
    assert check("rectangle")["passed"]
    ask.session.evaluate_text("(defun rectangle-around (width height) (car width height) (loop while t do (sleep 1)))")
    assert not check("rectangle")["passed"]
    assert check("rectangle", "hy") == {"passed": False, "told": ["Nothing was typed in Hy yet. The form (in-hy) leads there."]}
    module = types.ModuleType("typed_here")
    hy.eval(hy.read("(defn rectangle-around [width height] (* 2 (+ width height)))"), module=module)
    ask.desk.hy_module = lambda: module
    assert check("rectangle", "hy")["passed"]


def test_a_number_that_was_typed_is_not_one_that_was_computed(ask):
    answers = []
    ask.desk._say = lambda text: answers.append(json.loads(text))

    def told():
        ask.desk.ask(json.dumps({"id": 1, "what": "check", "task": "around-a-square", "language": "lisp"}))
        kernel.sleep(1)
        return " ".join(answers.pop()["answer"]["told"])

    ask.session.evaluate_text("(defvar *side* 4) (defvar *around* 16)")
    assert "for another side it would be wrong" in told()
    ask.session.evaluate_text("(setf *around* (* 4 *side*))")
    assert "Well done" in told()


def test_a_page_finds_the_files_of_pages_before_it_and_the_package_that_it_speaks_of(ask, tmp_path):
    mine = tmp_path / "cram_my_beginner_tutorial"
    assert ask("page", page="choosing-a-module") is None and not mine.exists()
    assert ask("page", page="simple-plans") is None and (mine / "src" / "control-turtlesim.lisp").is_file()

    def found():
        return ask.session.evaluate_text('(namestring (asdf:system-source-directory "cram-my-beginner-tutorial"))')[0]

    assert found().startswith(str(mine))
    ask("page", page="choosing-a-module")
    assert not found().startswith(str(mine))
    ask("page", page="motion-designators", language="hy")
    assert (tmp_path / "my_turtle" / "simple_plans.hy").is_file()
    assert ask("page", page="nowhere")[0] == "refused"


def test_a_task_that_there_is_not_is_told(ask):
    answers = []
    ask.desk._say = lambda text: answers.append(json.loads(text))
    ask.desk.ask(json.dumps({"id": 1, "what": "check", "task": "rectangel"}))
    kernel.sleep(1)
    assert answers == [{"id": 1, "refused": "There is no task rectangel. Did you mean rectangle?"}]


def test_a_question_that_goes_wrong_is_refused_and_the_next_is_answered(ask, monkeypatch):
    monkeypatch.setattr("cramhy_runtime.browser.desk.completions", lambda text, package: 1 / 0)
    assert ask("complete", text="(lis") == ("refused", "ZeroDivisionError: division by zero")
    assert ask("unheard-of")[0] == "refused"
    assert ask("arglist", text="") is None
