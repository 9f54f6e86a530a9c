"""Files and definitions that Emacs lets compile, with notes at the right places."""

from __future__ import annotations

from cramhy_runtime.swank.wire import write


def notes_of(result):
    """[(severity, first line of the message, location)] of a compilation."""
    assert result[0] == ":compilation-result"
    found = []
    for note in result[1] or ():
        told = dict(zip(note[::2], note[1::2], strict=True))
        found.append((told[":severity"], told[":message"].partition("\n")[0], told[":location"]))
    return found


def text_at(location):
    """What stands at a location of a file."""
    assert location[0] == ":location"
    with open(location[1][1]) as file:
        return file.read()[location[2][1] - 1 :].partition("\n")[0]


def test_a_good_file(emacs, tmp_path):
    path = tmp_path / "good.lisp"
    path.write_text("(in-package :cl-user)\n(defun compiled-one (x) (* 2 x))\n")
    result = emacs.call(f'(swank:compile-file-for-emacs "{path}" t)')
    _, notes, good, seconds, loads, file = result
    assert notes is None and good is True and loads is True and seconds >= 0
    assert emacs.call(f'(swank:load-file "{file}")') == f"=> {file} is loaded."
    assert emacs.repl("(compiled-one 4)") == "8\n"
    assert list(tmp_path.iterdir()) == [path]  # nothing is left beside the source
    emacs.connection.lost()
    import os

    assert not os.path.exists(file)


def test_errors_and_warnings_of_a_file(emacs, tmp_path):
    path = tmp_path / "wrong.lisp"
    path.write_text(
        "(in-package :cl-user)\n(defun one (x)\n  (setq 5 x))\n(defun two (x y)\n  (list x))\n(defun three (x)\n  (if x 1 2 3 4))\n"
        "(defun four ()\n  (no-such-function))\n"
    )
    result = emacs.call(f'(swank:compile-file-for-emacs "{path}" t)')
    assert result[2] is None  # not good
    found = sorted(((severity, text_at(where), message) for severity, message, where in notes_of(result)), key=str)
    assert [(severity, text) for severity, text, _ in found] == [
        (":error", "(if x 1 2 3 4))"),
        (":error", "(setq 5 x))"),
        (":style-warning", "(no-such-function))"),
        (":style-warning", "y)"),
    ]
    assert found[1][2] == "5 cannot be assigned." and "never used" in found[3][2]
    assert not [event for event in emacs.events if event[0] == ":debug"]


def test_a_text_that_cannot_be_read(emacs, tmp_path):
    path = tmp_path / "broken.lisp"
    path.write_text("(in-package :cl-user)\n(defun one (x)\n  (list x\n")
    result = emacs.call(f'(swank:compile-file-for-emacs "{path}" t)')
    assert result[2] is None and result[4:] == [None, None]
    [(severity, message, where)] = notes_of(result)
    assert severity == ":read-error" and where[0] == ":location" and "end of file" in message.lower()


def test_a_file_of_hy(emacs, tmp_path):
    path = tmp_path / "plan.hy"
    path.write_text("(require cramhy *)\n(in-package :cl-user)\n(defun of-hy (x) (* 3 x))\n")
    assert emacs.call(f'(swank:compile-file-for-emacs "{path}" t)')[2] is True
    assert emacs.repl("(of-hy 2)") == "6\n"


def test_a_missing_file(emacs):
    assert emacs.refused('(swank:compile-file-for-emacs "/no/such.lisp" t)') == "There is no file /no/such.lisp."
    assert emacs.refused('(swank:compile-file-if-needed "/no/such.lisp" t)') == "There is no file /no/such.lisp."


def compile_string(emacs, text, path, start=101, line=11):
    position = f"'((:position {start}) (:line {line} 1))"
    return emacs.call(f'(swank:compile-string-for-emacs {write(text)} "buffer" {position} {write(path)} \'nil)')


def test_a_definition_of_a_buffer(emacs):
    result = compile_string(emacs, "(defun of-buffer (x)\n  (list x))", None)
    assert result[1] is None and result[2] is True
    assert emacs.repl("(of-buffer 1)") == "(1)\n"


def test_notes_of_a_definition_count_from_its_beginning(emacs, tmp_path):
    text = "(defun of-buffer (x y)\n  (list x))"
    for path in (None, str(tmp_path / "file.lisp")):
        [(severity, _, where)] = notes_of(compile_string(emacs, text, path))
        assert severity == ":style-warning" and where == [":location", [":buffer", "buffer"], [":offset", 101, text.index("y)")], None]


def test_an_error_of_the_compiler_in_a_definition_is_a_note(emacs):
    text = "(defun of-buffer (x)\n  (setq 5 x))\n(defun after-it () 7)"
    result = compile_string(emacs, text, None)
    [(severity, message, where)] = notes_of(result)
    assert (severity, message) == (":error", "5 cannot be assigned.") and result[2] is None
    assert where[2] == [":offset", 101, text.index("(setq")]
    assert emacs.repl("(after-it)") == "7\n"


def test_a_definition_leaves_no_file_to_load(emacs):
    """SLIME tells that a compilation has failed if there should be a file to load, and there is none."""
    assert compile_string(emacs, "(defun no-file () 1)", None)[4:] == [None, None]


def test_an_error_of_a_form_opens_the_debugger(emacs):
    number = emacs.rex('(swank:compile-string-for-emacs "(car 5)" "buffer" \'((:position 1) (:line 1 1)) nil \'nil)')
    thread, *_ = emacs.debugged()
    emacs.refused("(swank:sldb-abort)", thread=thread)
    assert emacs.wait(number) == [":abort", "#<TYPE-ERROR expected-type: LIST datum: 5>"]


def test_a_definition_of_a_file_is_found_in_the_file(emacs, tmp_path):
    path = tmp_path / "file.lisp"
    path.write_text("\n" * 10 + "(defun here-it-is (x)\n  x)\n")
    compile_string(emacs, "(defun here-it-is (x)\n  x)", str(path), start=11, line=11)
    [[_, where]] = emacs.call('(swank:find-definitions-for-emacs "here-it-is")')
    assert where[1] == [":file", str(path)] and text_at(where) == "(defun here-it-is (x)"


def test_several_definitions(emacs):
    results = emacs.call(
        '(swank:compile-multiple-strings-for-emacs \'(("(defun m-1 () 1)" "b" "CL-USER" 1 nil) ("(defun m-2 () 2)" "b")) \'nil)'
    )
    assert [result[2] for result in results] == [True, True]
    assert emacs.repl("(+ (m-1) (m-2))") == "3\n"
    assert emacs.call("(swank:compiler-notes-for-emacs)") is None
