"""Names of CFFI that need no C: what ``.asd`` files and readers of C's names ask."""

from __future__ import annotations

import pytest


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
