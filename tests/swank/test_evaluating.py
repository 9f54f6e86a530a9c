"""Forms in the REPL buffer, the echo area and other buffers."""

from __future__ import annotations

import pytest

from cramhy_runtime.course import package
from cramhy_runtime.swank.wire import write


def test_the_first_words(emacs):
    import os

    info = emacs.call("(swank:connection-info)")
    told = dict(zip(info[::2], info[1::2], strict=True))
    assert told[":pid"] == os.getpid() and told[":style"] == ":spawn"
    assert told[":package"] == [":name", "COMMON-LISP-USER", ":prompt", "CL-USER"]
    assert told[":lisp-implementation"][:4] == [":type", "cramhy", ":name", "cramhy"]
    assert ":cramhy" in told[":features"] and "SWANK-REPL" in told[":modules"]
    assert "SWANK-FUZZY" in emacs.call("(swank:swank-require '(swank-fuzzy swank-arglists))")
    assert emacs.call('(swank-repl:create-repl nil :coding-system "utf-8-unix")') == ["COMMON-LISP-USER", "CL-USER"]
    assert emacs.call("(swank:ping)") == "pong"


def test_values_go_to_the_repl_buffer(emacs):
    assert emacs.repl("(+ 1 2)") == "3\n"
    assert emacs.repl('(values 1 "a" :b)') == '1\n"a"\n:B\n'
    assert emacs.repl("(values)") == "; No value\n"
    assert emacs.repl("") == "; No value\n"


def test_output_goes_before_the_values_on_a_line_of_its_own(emacs):
    assert emacs.repl('(progn (format t "hello") 5)') == "hello\n5\n"
    assert emacs.repl('(progn (format *error-output* "oops~%") 5)') == "oops\n5\n"


def test_output_of_a_plan_goes_to_whoever_started_it(emacs, session):
    from .client import Emacs

    other = Emacs(session, emacs.server)
    assert emacs.repl('(cpl:top-level (cpl:par (format t "a") (format t "b")))') == "ab\nNIL\n"
    assert not [event for event in other.events if event[0] == ":write-string"]


def test_the_history_is_that_of_the_prompt(emacs):
    emacs.repl("(+ 1 2)")
    emacs.repl("(values 4 5)")
    assert emacs.repl("(list * ** / +)") == "(4 3 (4 5) (VALUES 4 5))\n"
    emacs.call("(swank-repl:clear-repl-variables)")
    assert emacs.repl("*") == "NIL\n"


def test_the_prompt_follows_the_package(emacs):
    emacs.repl("(in-package :cpl)")
    assert [":new-package", "CRAM-LANGUAGE", "CPL"] in emacs.events
    assert emacs.repl("(package-name *package*)") == '"CRAM-LANGUAGE"\n'
    assert emacs.call('(swank:set-package "CL-USER")') == ["COMMON-LISP-USER", "CL-USER"]
    assert emacs.repl("(package-name *package*)") == '"COMMON-LISP-USER"\n'
    assert emacs.refused('(swank:set-package "NO-SUCH")') == "There is no package NO-SUCH."


def test_each_emacs_has_a_package_of_its_own(emacs, session):
    from .client import Emacs

    other = Emacs(session, emacs.server)
    emacs.repl("(in-package :cpl)")
    assert other.repl("(package-name *package*)") == '"COMMON-LISP-USER"\n'


def test_a_buffer_has_a_package_of_its_own(emacs):
    assert emacs.call('(swank:interactive-eval "(package-name *package*)")', "CPL") == '=> "CRAM-LANGUAGE"'
    assert emacs.call('(swank:interactive-eval "(package-name *package*)")', ":cpl") == '=> "CRAM-LANGUAGE"'
    assert emacs.call('(swank:interactive-eval "(package-name *package*)")', '"CPL"') == '=> "CRAM-LANGUAGE"'
    assert emacs.call('(swank:interactive-eval "(package-name *package*)")') == '=> "COMMON-LISP-USER"'


def test_the_echo_area_and_other_buffers(emacs):
    assert emacs.call('(swank:interactive-eval "10")') == "=> 10 (4 bits, #xA, #o12, #b1010)"
    assert emacs.call('(swank:interactive-eval "(values 1 2)")') == "=> 1, 2"
    assert emacs.call('(swank:interactive-eval "(values)")') == "; No value"
    assert emacs.call('(swank:interactive-eval-region "(setf x 1) (list x)")') == "=> (1)"
    assert emacs.call('(swank:pprint-eval "(list 1 2)")') == "(1 2)\n"
    assert emacs.call('(swank:eval-and-grab-output "(progn (princ 1) 2)")') == ["1", "2"]
    assert emacs.call('(swank:value-for-editing "(list 1 2)")') == "(1 2)"
    assert emacs.call('(swank:commit-edited-value "(get \'x \'y)" "7")') == "=> 7 (3 bits, #x7, #o7, #b111)"
    emacs.repl("(defvar *again* 1)")
    assert emacs.call('(swank:re-evaluate-defvar "(defvar *again* 2)")') == "=> *AGAIN*"
    assert emacs.repl("*again*") == "2\n"


def test_presentations_can_be_part_of_later_forms(emacs):
    emacs.call("(swank:init-presentations)")
    assert emacs.repl("(list 1 (gensym))").startswith("(1 #:G")
    start = next(event for event in emacs.events if event[0] == ":presentation-start")
    assert [":presentation-end", start[1], ":repl-result"] in emacs.events
    assert emacs.repl(f"(eq * (quote #.(swank:lookup-presented-object-or-lose {start[1]}.)))") == "T\n"
    again = emacs.call(f"(swank:lookup-and-save-presented-object-or-lose {start[1]})")
    assert again > start[1]
    assert emacs.call("(swank:clear-repl-results)") is True
    assert emacs.refused(f"(swank:lookup-and-save-presented-object-or-lose {again})").endswith("is not kept any more.")


def test_a_line_is_read_from_the_repl_buffer(emacs):
    number = emacs.rex('(swank-repl:listener-eval "(list (read-line) (read))")', thread=":repl-thread")
    _, thread, tag = emacs.wait_for(":read-string")
    emacs.post(f'(:emacs-return-string {thread} {tag} "hello you\n")')
    _, thread, tag = emacs.wait_for(":read-string")
    emacs.post(f'(:emacs-return-string {thread} {tag} "(a b)\n")')
    emacs.wait(number)
    assert emacs.events[-1] == [":write-string", '("hello you" (A B))\n', ":repl-result"]


def test_a_line_that_nobody_types_any_more(emacs):
    number = emacs.rex('(swank-repl:listener-eval "(read-line)")', thread=":repl-thread")
    _, thread, tag = emacs.wait_for(":read-string")
    emacs.interrupt()
    assert emacs.wait(number) == [":abort", "interrupted"]
    assert [":read-aborted", thread, tag] in emacs.events


def test_forms_of_the_repl_buffer_run_one_after_the_other(emacs):
    first = emacs.rex('(swank-repl:listener-eval "(progn (sleep 5) (setf done 1))")', thread=":repl-thread")
    second = emacs.rex('(swank-repl:listener-eval "(setf done (list done))")', thread=":repl-thread")
    emacs.wait(second)
    assert emacs.wait(first) == [":ok", None]
    assert emacs.events[-1][1] == "(1)\n"


def test_other_buffers_are_answered_while_a_plan_runs(emacs):
    plan = emacs.rex('(swank-repl:listener-eval "(sleep 1000)")', thread=":repl-thread")
    assert emacs.call('(swank:interactive-eval "(+ 1 1)")').startswith("=> 2")
    assert emacs.call('(swank:simple-completions "mapca" "CL-USER")') == [["mapcan", "mapcar"], "mapca"]
    emacs.interrupt()
    assert emacs.wait(plan) == [":abort", "interrupted"]


def test_time_moves_while_a_form_runs(emacs, session):
    from cramhy_runtime import kernel

    before = kernel.now()
    assert emacs.repl("(progn (sleep 50) 1)") == "1\n"
    assert kernel.now() - before >= 50


def test_a_file_is_loaded(emacs, tmp_path):
    path = tmp_path / "file.lisp"
    path.write_text("(in-package :cl-user) (defun from-file () 42)")
    assert emacs.call(f'(swank:load-file "{path}")') == f"=> {path} is loaded."
    assert emacs.repl("(from-file)") == "42\n"


def test_folders(emacs, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert emacs.call(f'(swank:set-default-directory "{tmp_path}")') == f"{tmp_path}/"
    assert emacs.call("(swank:default-directory)") == f"{tmp_path}/"
    assert emacs.refused('(swank:set-default-directory "/no/such")') == "There is no folder /no/such."


def test_quit(emacs):
    emacs.call("(swank:quit-lisp)")
    assert emacs.server.quits == 1


def test_calls_that_do_nothing_here_are_answered(emacs):
    for name in """toggle-debug-on-swank-error toggle-break-on-signals init-presentation-streams
    redirect-trace-output buffer-first-change swank-compiler-notes-for-emacs""".split():
        assert emacs.call(f"(swank:{name})") is None
    for name in ("io-speed-test", "flow-control-test"):
        assert emacs.call(f"(swank:{name})") == "pong"


def test_slys_names_of_the_same_calls(emacs):
    assert "SWANK-REPL" in emacs.call("(slynk:slynk-require '(a))")
    assert emacs.call('(slynk:slynk-add-load-paths \'("/somewhere"))') is None
    assert emacs.refused("(slynk-mrepl:create-mrepl 1)") == (
        "cramhy has no REPL buffer for SLY. C-x C-e, C-c C-c and M-. work in SLY's buffers of files; for a REPL take SLIME."
    )
    assert emacs.call('(slynk:find-symbols-completions "mapca" "CL-USER")')[0][0][0] in ("mapcan", "mapcar")
    emacs.call("(swank:init-presentations)")
    emacs.repl("1")
    assert emacs.call("(slynk:inspect-object 1 t)")[1] == "1"


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("way", ["repl", "eval", "compile", "load", "compile and load"])
def test_a_check_of_the_course_knows_what_emacs_has_sent(emacs, tmp_path, way):
    file = tmp_path / "answer.lisp"
    package.define()

    def send(text):
        file.write_text(text)
        written = write(text)
        if way == "repl":
            return emacs.repl(text)
        if way == "compile and load":
            result = emacs.call(f'(swank:compile-file-for-emacs "{file}" t)')
            return emacs.call(f"(swank:load-file {write(result[5])})")
        return emacs.call(
            {
                "eval": f"(swank:interactive-eval {written})",
                "compile": f"(swank:compile-string-for-emacs {written} \"buffer\" '((:position 1) (:line 1 1)) nil 'nil)",
                "load": f'(swank:load-file "{file}")',
            }[way]
        )

    send("(defparameter *side* 4) (defparameter *around* 16)")
    assert "for another side it would be wrong" in emacs.repl('(course:check "around-a-square")')
    send("(defparameter *side* 4) (defparameter *around* (* 4 *side*))")
    assert "Well done" in emacs.repl('(course:check "around-a-square")')
