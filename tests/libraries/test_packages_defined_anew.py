"""A file of the user's that defines a package of a library of ours: a warning with both places, and the user's counts."""

from __future__ import annotations

import pytest
from lisp_text import LispText

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.systems.systems import LIBRARIES
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image

THEIRS = """(defpackage :cram-math (:use :cl) (:nicknames :cma) (:export #:determinant #:own))
(in-package :cram-math)
(defun determinant (m) (list :mine m))
(defun own () 1)
"""


@pytest.fixture
def lisp():
    with Image():
        yield LispText(Session(time="virtual", turtlesim=False), "(in-package :cl-user)")
        kernel.stop()


@pytest.fixture
def theirs(tmp_path):
    path = tmp_path / "theirs.lisp"
    path.write_text(THEIRS)
    return path


def test_a_file_that_is_loaded_after_the_library(lisp, theirs):
    lisp("(asdf:load-system :cram-math)")
    said = " ".join(lisp.warnings(f'(load "{theirs}")').split())
    assert (
        f"WARNING: The package CRAM-MATH of {LIBRARIES}/cram-math/cram-math.lisp is defined anew by {theirs}, whose definitions count from now on."
    ) in said
    assert lisp("(list (cram-math:determinant 3) (cma:own))") == "((:MINE 3) 1)"
    assert "is defined anew" not in lisp.warnings(f'(load "{theirs}")')


@pytest.mark.parametrize("package", ["cram-language", "roslisp", "cram-utilities"])
def test_a_file_that_defines_a_package_of_cramhy_itself(lisp, tmp_path, package):
    path = tmp_path / "own.lisp"
    path.write_text(f"(defpackage :{package} (:use :cl) (:export #:own)) (in-package :{package}) (defun own () 1)")
    said = " ".join(lisp.warnings(f'(load "{path}")').split())
    assert said == (
        f"WARNING: The package {package.upper()} of cramhy itself is defined anew by {path}, whose definitions count from now on."
    )
    assert lisp(f"({package}:own)") == "1" and lisp.warnings(f'(load "{path}")').count("anew") == 0


def test_a_file_that_is_loaded_before_the_library(lisp, theirs):
    assert lisp.warnings(f'(load "{theirs}")') == ""
    said = " ".join(lisp.warnings("(asdf:load-system :cram-math)").split())
    assert said == (
        f"WARNING: The library cram-math of {LIBRARIES}/cram-math is not loaded, because {theirs} has defined its package CRAM-MATH: that counts."
    )
    assert lisp("(list (cram-math:determinant 3) (cma:own))") == "((:MINE 3) 1)"
    assert lisp.warnings("(asdf:load-system :cram-math)") == ""


def test_a_package_of_a_library_that_nobody_defines_anew_is_not_warned_of(lisp):
    assert (
        lisp.warnings('(asdf:load-system :cram-math) (load (asdf:system-relative-pathname :cram-math "cram-math.lisp"))').count("anew") == 0
    )
