"""Files, as streams and as programs: what goes wrong is a condition of Lisp, and nothing is lost.

What SBCL answers to each symbol of these chapters is in ``symbols/``; here is what SBCL was not asked or does worse.
"""

from __future__ import annotations

import os
import threading
import time

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.evaluation import universal_time
from cramhy_runtime.languages.commonlisp.files.files import lisp_path
from cramhy_runtime.languages.commonlisp.pathnames.pathnames import DEFAULTS
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session


@pytest.fixture(scope="module")
def session():
    yield Session(time="virtual", turtlesim=False)
    kernel.stop()


@pytest.fixture
def answer(session, tmp_path):
    """Evaluates a text in an empty folder; the printed values."""

    def evaluate(text):
        with binding(DEFAULTS, lisp_path(tmp_path)):
            return " ; ".join(prin1_to_string(value) for value in session.evaluate_text(text)).replace(str(tmp_path), "/here")

    return evaluate


@pytest.fixture
def complaint(answer, tmp_path):
    """The class and the text of the error that a text ends in."""

    def evaluate(text):
        with pytest.raises(conditions.Condition) as caught:
            answer(text)
        return f"{caught.value.lisp_name.rpartition(':')[2]} {caught.value.report()}".replace(str(tmp_path), "/here")

    return evaluate


# ----------------------------------------------------------------------------------------------------------------- writing


def test_a_file_that_was_replaced_is_back_when_writing_fails(answer, complaint, tmp_path):
    (tmp_path / "x").write_text("old")
    for how in ("supersede", "rename", "rename-and-delete"):
        assert (
            complaint(f'(with-open-file (s "x" :direction :output :if-exists :{how}) (write-line "new" s) (error "left"))')
            == "SIMPLE-ERROR left"
        )
        assert (tmp_path / "x").read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["x"]


def test_a_new_file_is_gone_when_writing_fails(answer, tmp_path):
    answer('(ignore-errors (with-open-file (s "x" :direction :output) (write-line "new" s) (error "left")))')
    assert not (tmp_path / "x").exists()


def test_a_file_that_is_deleted_while_it_is_written_does_no_harm(answer, complaint):
    assert answer('(with-open-file (s "x" :direction :output) (delete-file "x"))') == "T"
    assert complaint('(with-open-file (s "x" :direction :output) (delete-file "x") (error "left"))') == "SIMPLE-ERROR left"


def test_a_replaced_file_keeps_its_mode(answer, tmp_path):
    (tmp_path / "x").write_text("old")
    (tmp_path / "x").chmod(0o640)
    answer('(with-open-file (s "x" :direction :output :if-exists :supersede) (write-line "new" s))')
    assert (tmp_path / "x").stat().st_mode & 0o777 == 0o640


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a device that is always full")
def test_a_full_disk_is_a_stream_error(complaint):
    text = complaint('(with-open-file (s "/dev/full" :direction :output :if-exists :append) (write-line "x" s) (finish-output s))')
    assert text.startswith("SIMPLE-STREAM-ERROR couldn't write to #<")
    assert text.endswith(":\n  No space left on device. Make room on that disk, or choose another place.")


def test_a_folder_is_no_file(complaint, tmp_path):
    (tmp_path / "folder").mkdir()
    assert complaint('(open "folder")') == 'SIMPLE-FILE-ERROR Error opening #P"/here/folder": Is a directory'
    assert complaint('(load "folder")') == 'SIMPLE-FILE-ERROR Can\'t LOAD a directory: #P"folder".'


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read everything")
def test_a_file_that_may_not_be_read(complaint, tmp_path):
    (tmp_path / "secret").write_text("x")
    (tmp_path / "secret").chmod(0)
    assert complaint('(open "secret")') == 'SIMPLE-FILE-ERROR Error opening #P"/here/secret": Permission denied'


# ----------------------------------------------------------------------------------------------------------------- reading


@pytest.mark.parametrize(
    ("restart", "wanted"),
    [("'sb-int:attempt-resync", '"ab"'), ("'sb-int:force-end-of-file", '"a"'), ("'sb-impl::input-replacement #\\?", '"a?b"')],
)
def test_what_is_no_character_may_be_left_out_or_replaced(answer, tmp_path, restart, wanted):
    (tmp_path / "x").write_bytes(b"a\xffb\n")
    assert (
        answer(f"""(handler-bind ((error (lambda (c) (declare (ignore c)) (invoke-restart {restart}))))
        (with-open-file (s "x") (values (read-line s))))""")
        == wanted
    )


def test_positions_stand_behind_what_read_took(answer, tmp_path):
    (tmp_path / "x").write_text("(a ö) c\nd\n")
    assert (
        answer('(with-open-file (s "x") (list (read s) (file-position s) (read s) (file-position s) (read-line s)))') == '((A Ö) 7 C 9 "d")'
    )


def test_a_pipe_is_waited_for_while_other_tasks_run(answer, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    writer = threading.Thread(target=lambda: (tmp_path / "pipe").write_text("from outside\n"))
    writer.start()
    assert answer('(with-open-file (s "pipe") (values (read-line s)))') == '"from outside"'
    writer.join()


def test_an_unbound_synonym_is_named(complaint):
    assert complaint("(read-line (make-synonym-stream '*nowhere*))") == "UNBOUND-VARIABLE The variable *NOWHERE* is unbound."


# ---------------------------------------------------------------------------------------------------------------- pathnames


def test_logical_pathnames_lead_to_files(answer, tmp_path):
    answer("""(setf (logical-pathname-translations "PLANS")
                    (list (list "**;*.*.*" (concatenate 'string (namestring *default-pathname-defaults*) "plans/**/*.*"))))""")
    answer('(ensure-directories-exist "PLANS:KITCHEN;POUR.LISP")')
    answer('(with-open-file (s "PLANS:KITCHEN;POUR.LISP" :direction :output) (print (quote (defvar *poured* 7)) s))')
    assert (tmp_path / "plans" / "kitchen" / "pour.lisp").exists()
    assert answer('(load "PLANS:KITCHEN;POUR") *poured*') == "7"
    assert answer('(directory "PLANS:KITCHEN;*.LISP")') == '(#P"/here/plans/kitchen/pour.lisp")'


def on_one_line(text):
    return " ".join(text.split())


def test_a_stream_on_a_logical_pathname_keeps_it(answer):
    answer("""(setf (logical-pathname-translations "KEPT")
                    (list (list "**;*.*.*" (concatenate 'string (namestring *default-pathname-defaults*) "**/*.*"))))""")
    named = """(list (pathname s) (equal (logical-pathname s) (logical-pathname "KEPT:OLD.TXT.NEWEST")) (file-namestring s)
                     (translate-logical-pathname s))"""
    wanted = '(#P"KEPT:OLD.TXT.NEWEST" T "OLD.TXT.NEWEST" #P"/here/old.txt")'
    assert on_one_line(answer(f'(with-open-file (s "KEPT:OLD.TXT" :direction :output) {named})')) == wanted
    assert on_one_line(answer(f'(with-open-file (s "KEPT:OLD.TXT") {named})')) == wanted
    assert on_one_line(answer(f'(let (s) (with-open-file (file "KEPT:OLD.TXT") (setq s file)) {named})')) == wanted


def test_a_file_with_a_logical_name_is_renamed_to_one(answer):
    answer("""(setf (logical-pathname-translations "MOVED")
                    (list (list "**;*.*.*" (concatenate 'string (namestring *default-pathname-defaults*) "**/*.*"))))""")
    answer('(with-open-file (s "MOVED:A.TXT" :direction :output) (write-line "text" s))')
    moves = [
        ('"MOVED:A.TXT" "MOVED:B"', '(#P"MOVED:B.TXT.NEWEST" #P"/here/a.txt" #P"/here/b.txt")'),
        ('"MOVED:B.TXT" "c.txt"', '(#P"MOVED:C.TXT.NEWEST" #P"/here/b.txt" #P"/here/c.txt")'),
        ('"MOVED:C.TXT" (merge-pathnames "d.txt")', '(#P"/here/d.txt" #P"/here/c.txt" #P"/here/d.txt")'),
        ('"d.txt" "MOVED:E.TXT"', '(#P"MOVED:E.TXT.NEWEST" #P"/here/d.txt" #P"/here/e.txt")'),
    ]
    for names, wanted in moves:
        assert on_one_line(answer(f"(multiple-value-list (rename-file {names}))")) == wanted


def test_translations_in_a_circle_are_an_error(answer, complaint):
    answer("""(setf (logical-pathname-translations "RING") '(("**;*.*.*" "RING:**;*.*.*")))""")
    assert complaint('(open "RING:A.B")') == 'SIMPLE-FILE-ERROR The translations of #P"RING:A.B" lead in a circle.'


def test_python_opens_a_pathname(answer, session, tmp_path):
    (tmp_path / "a*b").write_text("star")
    with binding(DEFAULTS, lisp_path(tmp_path)):
        (path,) = session.evaluate_text('(truename "a\\\\*b")')
    with open(path) as file:
        assert file.read() == "star"


# ----------------------------------------------------------------------------------------------------------------- programs


PROGRAM = """
(defmacro twice (x) `(* 2 ,x))
(defconstant +wheels+ 4)
(defvar *speed* (twice 21))
(defstruct wheel radius)
(defun radius () (wheel-radius (make-wheel :radius +wheels+)))
(macrolet ((both (a b) `(progn ,a ,b))) (both (defun one () 1) (defmacro two () 2)))
(eval-when (:compile-toplevel) (defparameter *when* :compiling))
"""


def test_a_compiled_file_runs_without_its_source(answer, tmp_path):
    (tmp_path / "robot.lisp").write_text(PROGRAM)
    answer("(makunbound '*speed*)")
    assert answer('(compile-file "robot" :verbose nil)') == '#P"/here/robot.fasl" ; NIL ; NIL'
    assert answer("(list (boundp '*speed*) (fboundp 'radius) *when*)") == "(NIL NIL :COMPILING)"
    (tmp_path / "robot.lisp").unlink()
    assert answer('(load "robot") (list *speed* (radius) (one) (two))') == "(42 4 1 2)"


def test_compile_file_says_what_is_wrong(answer, tmp_path, capsys):
    (tmp_path / "a.lisp").write_text("(defun f (x) 1)")
    assert answer('(let ((*error-output* (make-broadcast-stream))) (compile-file "a.lisp" :verbose nil))') == '#P"/here/a.fasl" ; T ; NIL'
    (tmp_path / "b.lisp").write_text("(defun g () (let ((x)) (go nowhere)))\n(defvar *after* 1)")
    assert answer('(let ((*error-output* (make-broadcast-stream))) (compile-file "b.lisp" :verbose nil))') == '#P"/here/b.fasl" ; T ; T'
    (tmp_path / "c.lisp").write_text('(print "never closed)')
    assert answer('(let ((*error-output* (make-broadcast-stream))) (compile-file "c.lisp" :verbose nil))') == "NIL ; T ; T"
    assert not (tmp_path / "c.fasl").exists()


def test_a_form_that_could_not_be_compiled_is_an_error_when_it_runs(answer, complaint, tmp_path):
    (tmp_path / "b.lisp").write_text("(defun g () (go nowhere))")
    answer('(let ((*error-output* (make-broadcast-stream))) (compile-file "b.lisp" :verbose nil))')
    assert complaint('(load "b.fasl")').startswith("SIMPLE-ERROR Execution of a form compiled with errors.")


def test_compiled_files_of_others_and_damaged_ones_are_refused(answer, complaint, tmp_path):
    (tmp_path / "x.fasl").write_bytes(b"# FASL\n  compiled from ...")
    assert (
        complaint('(load "x.fasl")')
        == "SIMPLE-FILE-ERROR /here/x.fasl was compiled by SBCL. Load its source, or compile it here with COMPILE-FILE."
    )
    (tmp_path / "a.lisp").write_text("(defvar *a* 1)")
    answer('(compile-file "a.lisp" :verbose nil)')
    (tmp_path / "x.fasl").write_bytes((tmp_path / "a.fasl").read_bytes()[:-30])
    assert (
        complaint('(load "x.fasl")')
        == "SIMPLE-FILE-ERROR /here/x.fasl is damaged: it is not a complete compiled file. Compile its source again."
    )


def test_a_source_in_another_encoding_is_loaded_when_it_is_named(answer, complaint, tmp_path):
    (tmp_path / "x.lisp").write_bytes('(defvar *name* "Jürgen")'.encode("latin-1"))
    assert complaint('(load "x.lisp")').startswith("FILE-ERROR Cannot load /here/x.lisp: it is no UTF-8 text (line 1, byte 17 of the file)")
    assert answer('(load "x.lisp" :external-format :latin-1) *name*') == '"Jürgen"'


def test_load_shows_what_it_does(answer, tmp_path):
    (tmp_path / "x.lisp").write_text("(defvar *x* 1) (values 1 2) (values)")
    assert (
        answer('(with-output-to-string (*standard-output*) (load "x.lisp" :verbose t :print t))')
        == '";; loading #P\\"/here/x.lisp\\"\n;; *X*\n;; 1, 2\n;; \n"'
    )


# -------------------------------------------------------------------------------------------------------------- environment


def test_a_session_knows_its_last_forms(answer):
    answer("(+ 1 2)")
    assert answer("(list + * / -)") == "((+ 1 2) 3 (3) (LIST + * / -))"


def test_dribble_records_the_session(answer, tmp_path):
    answer('(dribble "log")')
    answer("(progn (print 'noted) nil)")
    answer("(dribble)")
    assert (tmp_path / "log").read_text() == "\nNOTED "


def test_time_zones_are_those_of_utc_in_virtual_time(session, answer):
    assert answer("(decode-universal-time 3501677469)") == "9 ; 11 ; 16 ; 18 ; 12 ; 2010 ; 5 ; NIL ; 0"
    assert answer("(let ((before (get-universal-time))) (sleep 60) (- (get-universal-time) before))") == "60"


@pytest.fixture
def in_berlin(monkeypatch):
    """A kernel in wall time, on a machine in Berlin."""
    if not hasattr(time, "tzset"):
        pytest.skip("the zone is set as Unix sets it")
    kernel.start(clock="wall")
    monkeypatch.setenv("TZ", "Europe/Berlin")
    time.tzset()
    yield
    kernel.stop()
    monkeypatch.undo()
    time.tzset()


def test_time_zones_are_the_machines_in_wall_time(in_berlin):
    assert universal_time.decode_universal_time(3501677469) == (9, 11, 17, 18, 12, 2010, 5, None, -1)
    summer = universal_time.encode_universal_time(0, 0, 12, 1, 7, 2010)
    assert universal_time.decode_universal_time(summer) == (0, 0, 12, 1, 7, 2010, 3, True, -1)


@pytest.mark.parametrize("when", [(0, 30, 9, 1, 2, 1963), (0, 30, 9, 1, 8, 1955), (59, 59, 23, 31, 12, 1969)])
def test_time_zones_where_the_system_knows_no_time_before_1970(in_berlin, monkeypatch, when):
    localtime = time.localtime

    def of_windows(seconds=None):
        if seconds is not None and seconds < 0:
            raise OSError(22, "Invalid argument")
        return localtime(seconds)

    monkeypatch.setattr(time, "localtime", of_windows)
    second, minute, hour, date, month, year = when
    moment = universal_time.encode_universal_time(second, minute, hour, date, month, year)
    assert universal_time.decode_universal_time(moment)[:6] == when
