"""Files are compiled once and kept; a kept file is used only while nothing has changed that it was made from."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from cramhy_runtime.lisp_core.conditions import Condition, FileError
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.lisp_core.packages import find_package, make_package, sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.systems import loader
from cramhy_runtime.storage.kept_files import kept_path


@pytest.fixture
def compiled(monkeypatch):
    """The number of top-level forms compiled for files so far."""
    count = [0]
    compile_form = evaluator.Unit.compile

    def counting(unit, form):
        count[0] += unit.filename.endswith(".lisp")
        return compile_form(unit, form)

    monkeypatch.setattr(evaluator.Unit, "compile", counting)
    return count


@pytest.fixture
def folder(tmp_path, session, monkeypatch):
    monkeypatch.setattr("sys.dont_write_bytecode", False)
    session.package = "CL-USER"
    return tmp_path


def write(folder, text, name="file.lisp"):
    path = folder / name
    path.write_text(text)
    return path


def value(name):
    return " ".join(prin1_to_string(sym(f"CL-USER::{name}").value).split())


def test_an_unchanged_file_is_not_compiled_again(folder, compiled):
    path = write(folder, "(defparameter *loaded* (list 1 2))")
    loader.load_file(path)
    before = compiled[0]
    sym("CL-USER::*LOADED*").value = None
    loader.load_file(path)
    assert (compiled[0], value("*LOADED*")) == (before, "(1 2)")


def test_a_changed_file_is_compiled_again(folder, compiled):
    path = write(folder, "(defparameter *loaded* 1)")
    loader.load_file(path)
    write(folder, "(defparameter *loaded* 2)")
    loader.load_file(path)
    assert value("*LOADED*") == "2"


def test_a_kept_file_is_used_only_after_the_same_files(folder, compiled):
    macros = write(folder, "(defmacro answer () 1)", "macros.lisp")
    user = write(folder, "(defparameter *answer* (answer))", "user.lisp")
    loader.load_file(user, loader.load_file(macros))
    write(folder, "(defmacro answer () 2)", "macros.lisp")
    loader.load_file(user, loader.load_file(macros))
    assert value("*ANSWER*") == "2"


@pytest.mark.parametrize("rubbish", [b"", b"rubbish", b"\xe3\x01\x02", os.urandom(50)], ids=["nothing", "text", "a beginning", "noise"])
def test_a_damaged_kept_file_is_made_anew(folder, rubbish):
    path = write(folder, "(defparameter *loaded* 3)")
    loader.load_file(path)
    kept_path(path).write_bytes(rubbish)
    sym("CL-USER::*LOADED*").value = None
    loader.load_file(path)
    assert value("*LOADED*") == "3"
    assert kept_path(path).read_bytes() != rubbish


def test_a_truncated_kept_file_is_made_anew(folder):
    path = write(folder, "(defparameter *loaded* '(3 4 5))")
    loader.load_file(path)
    kept = kept_path(path)
    whole = kept.read_bytes()
    for length in range(0, len(whole), 40):
        kept.write_bytes(whole[:length])
        loader.load_file(path)
    assert value("*LOADED*") == "(3 4 5)"


def test_where_the_folder_cannot_be_written_the_user_cache_is_used(folder, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(folder / "cache"))
    monkeypatch.setattr(loader.os, "access", lambda path, mode: False)
    path = write(folder, "(defparameter *loaded* 4)")
    loader.load_file(path)
    assert not (folder / "__pycache__").exists()
    assert list((folder / "cache" / "cramhy").iterdir()) == [kept_path(path)]


def test_where_nothing_can_be_written_the_file_is_loaded_all_the_same(folder, monkeypatch):
    (folder / "cache").write_text("a file where the folder should be")
    monkeypatch.setenv("XDG_CACHE_HOME", str(folder / "cache"))
    monkeypatch.setattr(loader.os, "access", lambda path, mode: False)
    loader.load_file(write(folder, "(defparameter *loaded* 5)"))
    assert value("*LOADED*") == "5"


LITERALS = r"""
'symbol :keyword 'other-package::sym "text" "a \"quoted\" line" #\a #\Space #\Newline 1 -7 123456789012345678901234567890 1/3 1.5 -0.0
1.0d0 1e20 1.5d300 nil t '(a . b) '(1 (2 . 3) "x" #\y) #(1 2 #(3)) '#(a (b)) '(quote a) '`(a ,b ,@c) "ünïcödé" #\λ '|mixed Case| #(1.0d0)
"""


def test_every_kind_of_literal_comes_back_from_a_kept_file(folder, compiled):
    from cramhy_runtime.languages.commonlisp.reader.reader import Reader

    find_package("OTHER-PACKAGE") or make_package("OTHER-PACKAGE", [])
    reader, end, forms = Reader(LITERALS, filename="literals"), object(), []
    while (form := reader.read(eof_error=False, eof_value=end)) is not end:
        forms.append(form)
    path = write(folder, f"(defparameter *literals* (list {LITERALS}))")
    loader.load_file(path)
    first, before = value("*LITERALS*"), compiled[0]
    sym("CL-USER::*LITERALS*").value = None
    loader.load_file(path)
    assert compiled[0] == before
    assert value("*LITERALS*") == first
    types = [type(item) for item in sym("CL-USER::*LITERALS*").value]
    assert len(types) == len(forms)


def test_an_uninterned_symbol_is_the_same_wherever_a_file_mentions_it(folder):
    path = write(
        folder,
        """(defmacro both () (let ((g (make-symbol "G"))) `(list ',g '(a ,g) (eq ',g (second '(a ,g))))))
                            (defparameter *both* (both))""",
    )
    for _ in range(2):
        loader.load_file(path)
        assert value("*BOTH*") == "(#:G (A #:G) T)"


def test_a_quoted_list_is_one_object(folder):
    path = write(folder, "(defun constant () '(1 2)) (defparameter *same* (eq (constant) (constant)))")
    for _ in range(2):
        loader.load_file(path)
        assert value("*SAME*") == "T"


def test_a_literal_that_no_code_can_make_keeps_the_file_from_being_kept(folder):
    path = write(folder, "(defparameter *table* '#.(make-hash-table)) (defparameter *after* (list 'a '(b)))")
    for _ in range(2):
        loader.load_file(path)
        assert value("*AFTER*") == "(A (B))"
        assert value("*TABLE*").startswith("#<HASH-TABLE")
    assert not kept_path(path).exists()


def test_definitions_of_all_kinds_work_from_a_kept_file(folder, compiled):
    path = write(
        folder,
        """
(defpackage kept-test (:use :cl) (:export #:f))
(in-package :kept-test)
(defvar *v* 10 "a variable")
(defconstant +c+ 5)
(defmacro twice (x) `(* 2 ,x))
(define-symbol-macro vv (car *list*))
(defvar *list* (list 1 2))
(defun f (x &key (y +c+) (z (twice x) z-p)) "documented" (list x y z z-p *v* vv))
(defstruct point x y)
(defclass thing () ((a :initarg :a :accessor a)))
(defmethod describe-it ((thing thing) &key more) (list :thing (a thing) more))
(define-condition bad (error) ((n :initarg :n :reader n)) (:report (lambda (c s) (format s "bad ~a" (n c)))))
(defsetf my-car (l) (v) `(progn (rplaca ,l ,v) ,v))
(deftype small () '(integer 0 9))
(defun result ()
  (let ((p (make-point :x 1)) (l (list 1 2)))
    (setf (point-y p) 2 (my-car l) 'new)
    (list (f 1) (f 2 :z 3) p l (typep 5 'small) (typep 50 'small) (describe-it (make-instance 'thing :a 1) :more 2)
          (handler-case (error 'bad :n 3) (bad (c) (princ-to-string c))) (documentation 'f 'function)
          (block nil (mapc (lambda (x) (when (= x 2) (return x))) '(1 2 3))))))
(defparameter *result* (result))
""",
    )
    wanted = '((1 5 2 NIL 10 1) (2 5 3 T 10 1) #S(KEPT-TEST::POINT :X 1 :Y 2) (KEPT-TEST::NEW 2) T NIL (:THING 1 2) "bad 3" "documented" 2)'
    loader.load_file(path)
    assert " ".join(prin1_to_string(sym("KEPT-TEST::*RESULT*").value).split()) == wanted
    before = compiled[0]
    loader.load_file(path)
    assert compiled[0] == before
    assert " ".join(prin1_to_string(sym("KEPT-TEST::*RESULT*").value).split()) == wanted


def test_the_package_is_the_same_after_loading(folder, session):
    loader.load_file(write(folder, "(defpackage elsewhere (:use :cl)) (in-package :elsewhere) (defun here () 1)"))
    assert session.package.name == "COMMON-LISP-USER"


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("(defun f ()\n  (let ((x 1 2))\n    x))", (2, 3)),
        ("(defun f ()\n  (return-from g 1))", (2, 3)),
        ("\n\n(defun g ()\n  (list 1\n        (if)))", (5, 9)),
        ("(defun h (a a) a)", (1, 1)),
        ("(setq 5 1)", (1, 1)),
        ("(list 1 2)\n(car 5)", (2, 1)),
        ("(defun f ()\n  (car 5))\n\n(f)", (2, 3)),
        ("(list 1 2)\n ; why\n  nowhere\n(list 2)", (3, 3)),
    ],
)
def test_an_error_says_where_in_the_file_it_arose(folder, text, place, session):
    from cramhy_runtime.lisp_core.source_places import exception_position

    path = write(folder, text)
    with pytest.raises(Condition) as caught:
        loader.load_file(path)
    at = exception_position(caught.value)
    at = caught.value.position if caught.value.position and at is None or not at else at
    assert (at[0], at[1], at[2]) == (str(path), *place) or tuple(caught.value.position) == (str(path), *place)


def test_a_file_that_ends_inside_a_form_says_where_the_form_begins(folder):
    path = write(folder, "(defparameter *before* 1)\n\n(defun f (x)\n  (list x\n")
    with pytest.raises(Condition) as caught:
        loader.load_file(path)
    assert caught.value.position[0] == str(path)
    assert "end of file" in caught.value.report().lower()
    assert value("*BEFORE*") == "1"


def test_a_file_with_an_error_is_not_kept(folder):
    path = write(folder, "(defparameter *one* 1) (car 5)")
    for _ in range(2):
        with pytest.raises(Condition):
            loader.load_file(path)
    assert not kept_path(path).exists()


def test_a_missing_file_is_a_file_error(folder):
    with pytest.raises(FileError) as caught:
        loader.load_file(folder / "absent.lisp")
    assert caught.value.report() == f"Cannot load {folder / 'absent.lisp'}: No such file or directory."


def test_a_file_that_is_no_text_is_a_file_error(folder):
    path = folder / "binary.lisp"
    path.write_bytes(b"(list 1)\xff\xfe")
    with pytest.raises(FileError) as caught:
        loader.load_file(path)
    assert caught.value.report() == f"Cannot load {path}: it is no UTF-8 text (line 1, byte 8 of the file). Save it as UTF-8."


def test_load_finds_files_beside_the_one_being_loaded(folder, session):
    write(folder, "(defparameter *inner* 7)", "inner.lisp")
    loader.load_file(write(folder, '(load "inner") (load "nowhere" :if-does-not-exist nil) (defparameter *outer* (1+ *inner*))'))
    assert value("*OUTER*") == "8"
    with pytest.raises(FileError):
        loader.load_file(write(folder, '(load "nowhere")'))


def test_eval_when_in_a_file(folder):
    path = write(
        folder,
        """(eval-when (:compile-toplevel :load-toplevel :execute) (defun helper () '(list 1 2)))
                            (defmacro use-helper () (helper))
                            (defparameter *used* (use-helper))
                            (let () (eval-when (:compile-toplevel) (defparameter *used* nil)))""",
    )
    for _ in range(2):
        loader.load_file(path)
        assert value("*USED*") == "(1 2)"


def test_load_time_value_is_computed_once_for_each_load(folder):
    path = write(folder, "(defun box () (load-time-value (list 1))) (defparameter *one-box* (eq (box) (box)))")
    for _ in range(2):
        loader.load_file(path)
        assert value("*ONE-BOX*") == "T"


def test_each_load_time_value_of_a_text_has_a_place_of_its_own(folder):
    """All of them were one variable: a scanner of cl-ppcre matched what a later function of the file looked for."""
    path = write(
        folder,
        """(defun first-box () (load-time-value (list 1)))
                            (defun other-boxes () (flet ((inner () (load-time-value (list 3)))) (list (load-time-value (list 2)) (inner))))
                            (defun last-box () (load-time-value (list 4)))
                            (defparameter *boxes* (list (first-box) (other-boxes) (last-box)))""",
    )
    for _ in range(2):
        loader.load_file(path)
        assert value("*BOXES*") == "((1) ((2) (3)) (4))"


def test_load_time_values_of_the_repl_are_apart(session):
    session.evaluate_text("(defun loaded-box () (load-time-value (list 1)))")
    session.evaluate_text("(defun other-loaded-box () (load-time-value (list 2)))")
    assert session.evaluate_text("(equal (list (loaded-box) (other-loaded-box)) '((1) (2)))") == [True]


@pytest.mark.soak
def test_a_kept_file_runs_in_a_process_that_compiles_nothing(tmp_path):
    """What expansions call is there without the macros: LOOP's collecting was not."""
    path = write(
        tmp_path,
        """(defparameter *got*
      (list (loop for x in '(1 2) collect x append (list x) nconc (list x)) (loop for x across "ab" collect x)
            (let ((h (make-hash-table)))
              (setf (gethash 1 h) 2)
              (loop for k being the hash-keys of h using (hash-value v) collect (list k v)))
            (loop for s being the external-symbols of :sb-mop count (symbolp s))
            (with-output-to-string (s) (format s "~a" 1)) (handler-case (error "x") (error () :handled))))
      (print (subseq *got* 0 3))""",
    )
    program = f"""from cramhy_runtime.repl.session import Session
import sys
Session(time="virtual", turtlesim=False).load({str(path)!r})
print("hy" in sys.modules)"""
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": ""}
    runs = [subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=environment) for _ in range(2)]
    assert [run.stdout.split("\n") for run in runs] == [
        ["", "((1 1 1 2 2 2) (#\\a #\\b) ((1 2))) True", ""],
        ["", "((1 1 1 2 2 2) (#\\a #\\b) ((1 2))) False", ""],
    ], runs[1].stderr


@pytest.mark.parametrize(
    "literal",
    [
        '#2A((1 a) ("x" #\\y))',
        "#0A(1)",
        "#3A(((1 2)) ((3 4)))",
        "#*10110",
        "#*",
        "#(1 #2A((1)) #*1)",
        "(1 . #2A((b)))",
        "#2A((#1=(1) #1#))",
    ],
)
def test_a_literal_array_is_kept(folder, compiled, literal):
    path = write(folder, f"(defun make () '{literal}) (defparameter *array* (list (make) (type-of (make)) (eq (make) (make))))")
    loader.load_file(path)
    before, array = compiled[0], value("*ARRAY*")
    assert array.endswith(" T)")
    sym("CL-USER::*ARRAY*").value = None
    loader.load_file(path)
    assert (compiled[0], value("*ARRAY*")) == (before, array)


def test_a_circular_array_is_loaded_but_not_kept(folder, compiled):
    path = write(folder, "(defparameter *ring* '#1=#2A((1 #1#))) (defparameter *inner* (aref (aref *ring* 0 1) 0 0))")
    for _ in range(2):
        loader.load_file(path)
        assert value("*INNER*") == "1"
    assert compiled[0] >= 4


def test_a_circular_literal_is_loaded_but_not_kept(folder, compiled):
    path = write(folder, "(defparameter *ring* '#1=(1 #2=#(#2# 2) . #1#)) (defparameter *third* (third *ring*))")
    for _ in range(2):
        loader.load_file(path)
        assert value("*THIRD*") == "1"
    assert compiled[0] >= 4
