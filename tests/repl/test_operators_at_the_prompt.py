"""What the prompt knows of the operators: DESCRIBE and the Tab key show how they are written."""

import pytest

from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.tools.advice import hint_for
from cramhy_runtime.session.completion import completions

PAR = "(par form...)  All at once until all have ended; the value of the first."


def test_describe_shows_how_an_operator_is_written_in_lisp_and_in_hy(session, capsys):
    session.evaluate_text("(describe 'cpl:par-loop)")
    assert (
        capsys.readouterr().out
        == """\
CRAM-LANGUAGE-IMPLEMENTATION:PAR-LOOP
  [symbol]

PAR-LOOP names a macro:
  Written: (par-loop (variable list) form...)
  In Hy: (par-loop [variable list] form...)
  Documentation:
    The body with all elements at once; the value for the first.
"""
    )


def test_a_word_is_completed_with_names_of_the_package_and_operators_say_how_they_are_written(session):
    assert completions("(cpl:top-level (cpl:par-") == (
        [("cpl:par-loop", "(par-loop (variable list) form...)  The body with all elements at once; the value for the first.")],
        8,
    )
    assert ("cpl:par", PAR) in completions("(cpl:pa")[0]
    session.evaluate_text("(defpackage mine (:use :cl :roslisp)) (in-package mine) (defun pursuing ())")
    assert completions("(pursui") == ([("pursuing", "")], 6)
    assert [name for name, _ in completions("(with-ros-n")[0]] == ["with-ros-node"]
    assert completions("(") == ([], 0)
    assert completions("(nowhere:x") == ([], 9)


def test_keywords_are_those_of_the_call_at_hand(session):
    def names(text):
        return [name for name, _ in completions(text)[0]]

    assert names("(make-hash-table :te") == [":test"]
    assert names("(make-fluent :") == [":allow-tracing", ":class", ":max-tracing-freq", ":name", ":value"]
    assert names("(with-task-suspended (task :re") == [":reason"]
    assert names("(with-task-suspended (task\n  :re") == [":reason"]
    assert names("(with-task-suspended (this :reason 1) (make-fluent :na") == [":name"]
    assert names("(list (make-fluent :name 'a) :") == names("(make-fluent :value (list :na") == []
    session.evaluate_text("(defun turn (speed &key ((:angle way) 0) times) (list speed way times))")
    session.evaluate_text("(defmacro twice (form &key between) (list form between))")
    assert names("(turn 1 :") == [":angle", ":times"]
    assert names("(twice 1 :") == [":between"]
    assert names(r"(turn #\( :an") == [":angle"]
    assert ":test" in names("(nobody-knows :te")


OF_HY = {
    "(setv x 1)": "setv is Hy. In Common Lisp it is written (setf name value).",
    "(defn f [x] x)": "defn is Hy. In Common Lisp it is written (defun name (parameter ...) form...).",
    "(len nil)": "len is Hy. In Common Lisp it is written (length values).",
    "(list True)": "True is Hy. In Common Lisp it is t.",
    "None": "None is Hy. In Common Lisp it is nil.",
    "[1 2]": "[ is a bracket of Hy. Common Lisp writes '(1 2), or #(1 2) for a vector.",
    "(require cramhy *)": "(require cramhy *) is Hy, and has been done: this is Common Lisp.",
}


@pytest.mark.parametrize("text", OF_HY)
def test_a_form_of_hy_in_common_lisp_is_told_how_lisp_writes_it(session, text):
    with pytest.raises(Condition) as problem:
        session.evaluate_text(text)
    assert f"{OF_HY[text]} In a .hy file and at the prompt of hy, Hy begins after (in-hy)." in hint_for(problem.value)


def test_in_hy_at_the_prompt_of_roslisp_repl_says_where_it_leads_to_hy(session):
    with pytest.raises(Condition) as problem:
        session.evaluate_text("(in-hy)")
    assert hint_for(problem.value).startswith(
        "(in-hy) leads to Hy in a .hy file and at the prompt of hy, but not in the debugger: leave that first,"
    )
