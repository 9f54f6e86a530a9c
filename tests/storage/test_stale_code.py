"""Code that is kept is never stale: it is compiled again when anything has changed that the compiler asked for, wherever that was made.

Each case is a file of definitions as it was and as it is, and a file that uses them. The second file was loaded after the first version;
then it is loaded after the second one, in an image that knows nothing of before. It must do what it does when no code is kept.
"""

from __future__ import annotations

import shutil
import sys

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.systems import loader
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image

USE = "(in-package :cl-user)\n(defun other () 1)\n(defparameter *found* (use))\n"
CASES = {
    "macro": ("(defmacro m () 1)", "(defmacro m () 2)", "(defun use () (m))"),
    "macro in a symbol's place": (
        "(defmacro m (x) `(list ,x 1))",
        "(defmacro m (x) `(list ,x 2))",
        "(defun use () (mapcar (lambda (x) (m x)) '(0)))",
    ),
    "helper of a macro": (
        "(defun helper (x) (list '+ x 1)) (defmacro m (x) (helper x))",
        "(defun helper (x) (list '+ x 2)) (defmacro m (x) (helper x))",
        "(defun use () (m 5))",
    ),
    "helper of a helper, in a closure": (
        "(defun deep (x) (list '+ x 1)) (defun helper (x) (mapcar (lambda (y) (deep y)) (list x))) (defmacro m (x) (first (helper x)))",
        "(defun deep (x) (list '+ x 2)) (defun helper (x) (mapcar (lambda (y) (deep y)) (list x))) (defmacro m (x) (first (helper x)))",
        "(defun use () (m 5))",
    ),
    "macro in the expansion of a macro": (
        "(defmacro inner () 1) (defmacro m () '(inner))",
        "(defmacro inner () 2) (defmacro m () '(inner))",
        "(defun use () (m))",
    ),
    "method that a macro calls": (
        "(defgeneric helper (x)) (defmethod helper ((x integer)) 1) (defmacro m () (helper 3))",
        "(defgeneric helper (x)) (defmethod helper ((x integer)) 2) (defmacro m () (helper 3))",
        "(defun use () (m))",
    ),
    "what a macro closes over": ("(let ((kept 1)) (defmacro m () kept))", "(let ((kept 2)) (defmacro m () kept))", "(defun use () (m))"),
    "macro that was a function": ("(defun m () 1)", "(defmacro m () 2)", "(defun use () (m))"),
    "function that was a macro": ("(defmacro m () 1)", "(defun m () 2)", "(defun use () (m))"),
    "macro that was nothing": ("", "(defmacro m () 2)", "(defun use () (ignore-errors (m)))"),
    "symbol macro": ("(define-symbol-macro s 1)", "(define-symbol-macro s 2)", "(defun use () s)"),
    "constant": ("(defconstant +k+ 1)", "(defconstant +k+ 2)", "(defun use () (+ 0 +k+))"),
    "special variable": (
        "(defun f () (if (boundp 'v) (symbol-value 'v) :unbound))",
        "(defvar v 1) (defun f () v)",
        "(defun use () (let ((v 2)) v (f)))",
    ),
    "type": ("(deftype small () '(integer 0 1))", "(deftype small () '(integer 0 9))", "(defun use () (typep 5 'small))"),
    "declared type": (
        "(deftype small () '(integer 0 1))",
        "(deftype small () '(integer 0 9))",
        "(defun use () (handler-case (let ((x 5)) (declare (type small x)) x) (type-error () :refused)))",
    ),
    "setf function by defsetf": (
        "(defvar *p* (list 1 2)) (defsetf place (x) (v) `(progn ,x (setf (first *p*) ,v)))",
        "(defvar *p* (list 1 2)) (defsetf place (x) (v) `(progn ,x (setf (second *p*) ,v)))",
        "(defun use () (setf (place 0) 7) (copy-list *p*))",
    ),
    "setf expander": (
        "(defvar *p* (list 1 2)) (define-setf-expander place () (values () () '(v) '(setf (first *p*) v) '(first *p*)))",
        "(defvar *p* (list 1 2)) (define-setf-expander place () (values () () '(v) '(setf (second *p*) v) '(second *p*)))",
        "(defun use () (setf (place) 7) (copy-list *p*))",
    ),
    "compiler macro": (
        "(defun f (x) x) (define-compiler-macro f (x) (declare (ignore x)) 1)",
        "(defun f (x) x) (define-compiler-macro f (x) (declare (ignore x)) 2)",
        "(defun use () (f 0))",
    ),
    "structure": (
        "(defstruct point (x 1) (y 2))",
        "(defstruct point (y 2) (x 3))",
        "(defun use () (let ((p (make-point))) (list (point-x p) (point-y p))))",
    ),
    "accessor that became a function": (
        "(defstruct point (x 1)) ",
        "(defstruct (point (:conc-name p-)) (x 1)) (defun point-x (p) (list :x (p-x p)))",
        "(defun use () (let ((p (make-point))) (declare (type point p)) (point-x p)))",
    ),
    "modify macro": ("(define-modify-macro more () 1+)", "(define-modify-macro more () 1-)", "(defun use () (let ((x 5)) (more x) x))"),
    "package": (
        "(defpackage :lib (:use :cl) (:export #:g)) (defun lib:g () 1) (defpackage :user (:use :cl :lib))",
        "(defpackage :lib (:use :cl) (:export #:g)) (defun lib:g () 1) (defpackage :user (:use :cl)) (defun user::g () 2)",
        "(defun cl-user::use () (user::use))\n(in-package :user)\n(defun use () (g))\n",
    ),
    "feature": ("(push :one *features*)", "(push :two *features*)", "(defun use () #+one 1 #+two 2)"),
    **{
        f"feature in {expression}": (
            "(push :one *features*)",
            "(push :two *features*)",
            f"(defun use () (list #+{expression} 1 #-{expression} 2))",
        )
        for expression in (":one", "(or :no (and one (not three)))", "(:and\n:one)", "(or ;; more\n one)", "#.'(or one)")
    },
    "feature that a computed expression asks for": (
        "(push :one *features*)",
        "(push :two *features*)",
        '(defun use () (list #+#.(cl:intern (cl:string-upcase "one") :keyword) 1 2))',
    ),
    "feature that a reading function of a macro asks for": (
        "(push :one *features*)",
        "(push :two *features*)",
        '(defmacro m () (read-from-string "(list #+one 1 2)")) (defun use () (m))',
    ),
    "feature that a macro asks for": (
        "(push :one *features*)",
        "(push :two *features*)",
        "(defmacro m () (if (member :one *features*) 1 2)) (defun use () (m))",
    ),
    "feature in a readtable where a name may have a comma": (
        '(push (intern "A,B" :keyword) *features*)',
        "(push :two *features*)",
        "(eval-when (:compile-toplevel :load-toplevel :execute) (set-syntax-from-char #\\, #\\a)) (defun use () (list #+a,b 1 2))",
    ),
    "reader macro": (
        "(set-macro-character #\\! (lambda (s c) (declare (ignore c)) (list '+ 1 (read s t nil t))))",
        "(set-macro-character #\\! (lambda (s c) (declare (ignore c)) (list '+ 2 (read s t nil t))))",
        "(defun use () !5)",
    ),
    "variable in a designator": (
        "(defvar start-pose 1)",
        "",
        "(defun use () (desig:desig-prop-value (desig:a motion (from start-pose)) :from))",
    ),
    "variable in a designator that a macro makes": (
        "(defvar word 1) (defmacro made () '(desig:description (desig:a motion (x word))))",
        "(defmacro made () '(desig:description (desig:a motion (x word))))",
        "(defun use () (list (made) (desig:description (desig:a motion (y word)))))",
    ),
    "keyword in a designator that became a variable": (
        "",
        "(defconstant start-pose 1)",
        "(defun use () (desig:desig-prop-value (desig:a motion (from start-pose)) :from))",
    ),
    "number base": ("(setf *read-base* 10)", "(setf *read-base* 8)", "(defun use () 11)"),
}


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    yield tmp_path / "definitions.lisp", tmp_path / "use.lisp"
    kernel.stop()


def found(*paths, before=""):
    """What the files find when they are loaded one after the other in an image that knows nothing of before."""
    with Image():
        session = Session(time="virtual", turtlesim=False)
        session.evaluate_text(before)
        for path in paths:
            session.evaluate_text(f'(load "{path}")')
        return str(session.evaluate_text("cl-user::*found*")[0])


def without_kept_code(*paths, before=""):
    shutil.rmtree(paths[0].parent / "__pycache__", ignore_errors=True)
    return found(*paths, before=before)


@pytest.mark.soak
@pytest.mark.parametrize("name", ["nav_msgs-msg:data", "geometry_msgs-msg:x", "alexandria:flatten", "turtlesim-srv:teleportabsolute"])
def test_a_package_that_is_made_when_it_is_named_makes_no_difference(files, name):
    """A reader makes it, or loads it; kept code is not read, and is used all the same."""
    _, use = files
    use.write_text(f"(in-package :cl-user)\n(defun use () '{name})\n(defparameter *found* (use))\n")
    assert found(use) == found(use) and loader.why_not_kept(use) is None


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("case", CASES)
def test_what_has_changed_in_another_file_is_seen(files, case):
    definitions, use = files
    old, new, text = CASES[case]
    use.write_text(text + "\n" + USE)
    definitions.write_text(new)
    wanted = without_kept_code(*files)
    definitions.write_text(old)
    before = without_kept_code(*files)
    assert before != wanted  # else the case shows nothing
    assert found(*files) == before and loader.why_not_kept(use) is None  # and nothing is compiled again without need
    definitions.write_text(new)
    assert found(*files) == wanted
    assert found(*files) == wanted and loader.why_not_kept(use) is None


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("case", CASES)
def test_what_has_changed_at_the_prompt_is_seen(files, case):
    use = files[1]
    old, new, text = CASES[case]
    use.write_text(text + "\n" + USE)
    wanted, before = without_kept_code(use, before=new), without_kept_code(use, before=old)
    assert found(use, before=old) == before and loader.why_not_kept(use) is None
    assert found(use, before=new) == wanted
    assert found(use, before=new) == wanted and loader.why_not_kept(use) is None


def test_a_keyword_in_a_designator_of_kept_code_is_remembered_until_a_variable_of_its_name_is_defined(files, capsys):
    _, use = files
    use.write_text("(in-package :cl-user)\n(defun use () (desig:description (desig:a motion (x later))))\n(defparameter *found* (use))\n")
    for reason in (f"{use.parent}/__pycache__/use.lisp.", "None", "None"):
        with Image():
            session = Session(time="virtual", turtlesim=False)
            session.evaluate_text(f'(load "{use}")')
            assert str(loader.why_not_kept(use)).startswith(reason)
            session.evaluate_text("(defparameter later 1)")
            said = capsys.readouterr().err
            assert "LATER becomes a variable, but in a designator that was expanded before it is the keyword :LATER." in said
            assert f"at {use}:2:34" in said


def test_what_has_changed_in_a_file_that_the_file_itself_loads_is_seen(files):
    definitions, use = files
    use.write_text(f'(defun before () 0)\n(load "{definitions}")\n(defun use () (m))\n{USE}')
    definitions.write_text("(defmacro m () 1)")
    assert found(use) == "1" and found(use) == "1" and loader.why_not_kept(use) is None
    definitions.write_text("(defmacro m () 2)")
    assert found(use) == "2" and str(loader.why_not_kept(use)).endswith("has changed since it was compiled")
    assert found(use) == "2" and loader.why_not_kept(use) is None


@pytest.mark.soak
def test_forms_before_the_change_are_not_run_twice(files):
    definitions, use = files
    use.write_text(f"(defvar *runs* 0)\n(incf *runs*)\n(defun use () (list *runs* (m)))\n(defun again () (m))\n{USE}")
    for number in (1, 2, 2, 3, 1):
        definitions.write_text(f"(defmacro m () {number})")
        assert found(*files) == f"(1 {number})"


def test_a_definition_that_the_file_does_not_use_changes_nothing(files):
    definitions, use = files
    use.write_text("(defun use () (m))\n" + USE)
    definitions.write_text("(defmacro m () 1) (defmacro n () 1) (defun f () 1)")
    found(*files)
    definitions.write_text(";; moved down\n\n(defun g () 2) (defmacro n () 2) (defun f () 2)\n(defmacro m () 1)")
    assert found(*files) == "1" and loader.why_not_kept(use) is None


@pytest.mark.parametrize(
    "text",
    [
        "(defun use () (list #+one 1 #-(and one (or :three four)) 3 '(#+x y)))",
        '(defmacro m () (intern (format nil "A~d" 1))) (defun use () \'(m)) #+one (defun two () 2)',
    ],
)
def test_a_feature_that_nothing_asks_for_changes_nothing(files, text):
    """Libraries push features when they are loaded; those that were kept before are not compiled again for that."""
    use = files[1]
    use.write_text(text + "\n" + USE)
    before = found(use, before="(push :one *features*)")
    assert found(use, before="(push :one *features*) (push :two *features*)") == before and loader.why_not_kept(use) is None
    assert found(use, before="(push :one *features*) (push 7 *features*)") == before and loader.why_not_kept(use) is None


def test_the_package_in_which_a_file_without_in_package_is_loaded_counts(files):
    use = files[1]
    use.write_text("(cl:defparameter cl-user::*found* (cl:package-name (cl:symbol-package 'here)))")
    packages = "(defpackage :one (:use :cl)) (defpackage :two (:use :cl))"
    assert without_kept_code(use, before=f"{packages} (in-package :one)") == "ONE"
    assert found(use, before=f"{packages} (in-package :two)") == "TWO"


def test_a_file_that_is_loaded_again_is_not_compiled_again(files):
    use = files[1]
    use.write_text(
        """(defvar *v* 1) (defparameter *p* (list *v*)) (defconstant +k+ 3) (declaim (special *d*)) (defmacro m () '(+ *v* +k+))
        (eval-when (:compile-toplevel :load-toplevel :execute) (defstruct point (x 1)) (defun helper () 2) (defmacro n () (helper)))
        (deftype small () '(integer 0 9)) (defsetf place (x) (v) `(list ,x ,v)) (define-symbol-macro s (m)) (define-compiler-macro hh () 2)
        (defclass c () ((a :accessor c-a))) (defgeneric g (x)) (defmethod g ((x integer)) (m)) (define-condition bad (error) ())
        (defun h () (let ((*d* 2)) (list (m) (n) s (typep 5 'small) (setf (place 1) 2) (point-x (make-point)) *d*)))
        (defparameter *found* (h))"""
    )
    assert found(use) == "(4 2 4 True (1 2) 1 2)" and loader.why_not_kept(use).kind == "missing"
    assert found(use, use, use) and loader.why_not_kept(use) is None
    assert found(use) and loader.why_not_kept(use) is None


def test_a_macro_that_calls_itself_and_data_in_a_circle_have_a_digest(files):
    definitions, use = files
    text = "(defmacro m (n) (if (plusp n) `(m ,(1- n)) (car '#1=(1 . #1#)))) (defun f () (f)) (defmacro k () (if nil (f) 3))"
    use.write_text("(defun use () (list (m 3) (k)))\n" + USE)
    definitions.write_text(text)
    assert found(*files) == found(*files) == "(1 3)" and loader.why_not_kept(use) is None


def test_a_name_that_a_macro_asks_for_and_that_means_nothing_is_as_good_as_one_that_is_not_there(files):
    """The compiler interned it after the macro had asked. When the kept code asks, nobody has read the name yet."""
    use = files[1]
    use.write_text(
        "(eval-when (:compile-toplevel :load-toplevel :execute) (defun asked (name) (fboundp name)))\n"
        "(defmacro m (name) (list 'quote (if (asked name) 1 2)))\n"
        "(defun use () (m no-such-scanner))\n" + USE
    )
    assert found(use) == "2"
    assert found(use) == "2" and loader.why_not_kept(use) is None
    assert found(use, before="(defun no-such-scanner () 3)") == "1"
