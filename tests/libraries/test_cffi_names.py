"""Names of CFFI that need no C: what ``.asd`` files and readers of C's names ask."""

from __future__ import annotations

import pytest


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("form", "printed"),
    [
        ("(list (cffi-features:cffi-feature-p :unix) (cffi-features:cffi-feature-p :windows))", "(T NIL)"),
        ("(cffi-features:cffi-feature-p '(:and :unix (:not :windows)))", "T"),
        ("(cffi-features:cffi-feature-p '(:or :windows (:and :unix :no-such-feature)))", "NIL"),
        ('(mapcar #\'cffi:canonicalize-symbol-name-case \'("grab-image" "x1" ""))', '("GRAB-IMAGE" "X1" "")'),
        ('(list (cffi-sys:native-namestring #p"/tmp/a b") (cffi-sys:native-namestring "/tmp/a/"))', '("/tmp/a b" "/tmp/a/")'),
        ('(not (find-symbol "NATIVE-NAMESTRING" "CFFI"))', "T"),
        ("(list (eq 'cffi-sys:null-pointer 'cffi:null-pointer) (eq 'cffi-sys:foreign-pointer 'cffi:foreign-pointer))", "(T T)"),
        ("(progn (cffi:defcenum colours :red (:green 5) :blue) (list (cffi:foreign-enum-keyword-list 'colours)))", "((:RED :GREEN :BLUE))"),
        ("(progn (cffi:defbitfield marks (:a 1) :b) (list (cffi:foreign-bitfield-symbol-list 'marks)))", "((:A :B))"),
        (r'(cffi-sys:native-namestring (make-pathname :directory "tmp" :name "a*b"))', '"/tmp/a*b"'),
    ],
)
def test_a_name_that_asks_about_this_machine_or_about_cases(values, form, printed):
    values('(asdf:load-system "cffi")')
    assert values(form) == printed


def test_a_package_that_uses_cffi_has_a_function_of_the_name_of_one_of_cffi_sys(values):
    values('(asdf:load-system "cffi")')
    values("(defpackage :files-of-c (:use :cl :cffi)) (in-package :files-of-c)")
    assert values('(defun native-namestring (file) (list :own (cffi-sys:native-namestring file))) (native-namestring "/tmp/x")') == (
        '(:OWN "/tmp/x")'
    )
    values("(in-package :libraries-tests)")


def test_a_structure_of_c_has_a_class_that_methods_may_name(values):
    """That of ``:class``, else one named for the structure."""
    values('(asdf:load-system "cffi")')
    values("(defpackage :structures-of-c (:use :cl :cffi)) (in-package :structures-of-c)")
    values("(defcstruct (pair-of-floats :class pair-type) (dat :float :count 2)) (defcstruct plain (x :int))")
    values("(defcunion either (x :int)) (defcunion (one-of :class one-of-type) (x :int))")
    assert values("(defmethod translate-from-foreign (p (type pair-type)) (list p :pair))").startswith("#<STANDARD-METHOD")
    assert values("(translate-from-foreign 5 (make-instance 'pair-type))") == "(5 :PAIR)"
    assert values("(mapcar (lambda (name) (class-name (find-class name))) '(plain-tclass either-tclass one-of-type))") == (
        "(PLAIN-TCLASS EITHER-TCLASS ONE-OF-TYPE)"
    )
    values("(in-package :libraries-tests)")


def test_files_that_ask_the_compiler_of_c_are_passed_over(values, tmp_path, monkeypatch):
    """By a symbol of CFFI-GROVEL, by a keyword, and by a class made of CFFI-GROVEL's; files of Lisp beside them load."""
    (tmp_path / "asks-c.asd").write_text(
        """(asdf:load-system "cffi-grovel")
        (defclass asks-c-file (cffi-grovel:grovel-file) ())
        (setf cffi-grovel::*cc* "g++")
        (defsystem "asks-c" :defsystem-depends-on ("cffi-grovel") :serial t
          :components ((cffi-grovel:grovel-file "one") (:cffi-grovel-file "two") (cffi-grovel:wrapper-file "three") (:cffi-wrapper-file "four")
                       (asks-c-file "five") (:file "six")))"""
    )
    for name in ("one", "two", "three", "four", "five"):
        (tmp_path / f"{name}.lisp").write_text('(include "math.h") (constant (+pi+ "M_PI"))')
    (tmp_path / "six.lisp").write_text("(defvar cl-user::*six* 6)")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    assert values('(progn (asdf:load-system "asks-c") cl-user::*six*)') == "6"


@pytest.mark.parametrize("call", ['(cffi-toolchain:cc-compile "a.o" \'("a.c"))', '(cffi-toolchain:link-shared-library "a.so" \'("a.o"))'])
def test_the_compiler_of_c_is_not_called(values, call):
    values('(asdf:load-system "cffi-toolchain")')
    assert values("(list (stringp cffi-toolchain:*cc*) (listp cffi-toolchain:*cc-flags*))") == "(T T)"
    refusal = f"(handler-case {call} (cffi:foreign-not-implemented (e) (subseq (princ-to-string e) 0 11)))"
    assert values(refusal) in ('"CC-COMPILE "', '"LINK-SHARED"')


def test_libffi_brings_grovel_for_the_system_whose_file_asks_for_it_alone(session, tmp_path, monkeypatch):
    """CFFI's own cffi-libffi loads cffi-grovel, and GSLL's .asd file counts on it."""
    (tmp_path / "by-value.asd").write_text(
        """(eval-when (:compile-toplevel :load-toplevel :execute) (asdf:oos 'asdf:load-op :cffi-libffi))
        (defsystem "by-value" :components ((cffi-grovel:grovel-file "one") (:file "six" :depends-on ("one"))))"""
    )
    (tmp_path / "one.lisp").write_text('(include "math.h")')
    (tmp_path / "six.lisp").write_text("(defvar cl-user::*by-value* 7)")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    assert session.evaluate_text('(progn (asdf:load-system "by-value") cl-user::*by-value*)') == [7]
