"""Declared ranges of integers and kinds of vectors: compiled declarations, ``typep`` and SBCL agree at every bound."""

from __future__ import annotations

from itertools import count

import pytest

from lisp_text import LispText

from cramhy_runtime.repl.session import Session

_numbers = count(1)
RANGES = {
    "fixnum": (-(2**62), 2**62 - 1),
    "bit": (0, 1),
    "unsigned-byte": (0, None),
    "(unsigned-byte 1)": (0, 1),
    "(unsigned-byte 8)": (0, 255),
    "(unsigned-byte 64)": (0, 2**64 - 1),
    "(unsigned-byte *)": (0, None),
    "(signed-byte 1)": (-1, 0),
    "(signed-byte 8)": (-128, 127),
    "(signed-byte 64)": (-(2**63), 2**63 - 1),
    "(mod 1)": (0, 0),
    "(mod 10)": (0, 9),
    "(integer 3 7)": (3, 7),
    "(integer -7)": (-7, None),
    "(integer -7 *)": (-7, None),
    "(integer * 5)": (None, 5),
    "(integer (3) (7))": (4, 6),
    "(or (integer 3 7) null)": (3, 7),
    "(and (integer 3 9) (integer 1 7))": (3, 7),
    "octet": (0, 255),
    "octet-again": (0, 255),
    "(bits 3)": (0, 7),
    "index": (0, 2**62 - 4),
    "small-or-nil": (3, 7),
}
TYPES = """
(deftype octet () '(unsigned-byte 8)) (deftype octet-again () 'octet) (deftype bits (n) `(unsigned-byte ,n))
(deftype index () `(integer 0 ,(1- array-dimension-limit))) (deftype small-or-nil () '(or null (integer 3 7)))
"""
OTHERS = ["4.0", "4.0d0", "9/2", "t", ":a", '"a"', "#\\a", "(list 4)"]
"""Forms whose values are in none of the ranges."""


@pytest.fixture(scope="module")
def lisp():
    return LispText(
        Session(time="virtual", turtlesim=False), f"(defpackage :dr-{(n := next(_numbers))} (:use :cl)) (in-package :dr-{n}) {TYPES}"
    )


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("specifier", RANGES)
@pytest.mark.parametrize("shape", ["parameter", "binding", "assignment", "the", "slot", "constructor"])
def test_a_declared_range_ends_at_its_bounds(lisp, specifier, shape):
    low, high = RANGES[specifier]
    inside = [bound for bound in (low, high) if bound is not None]
    outside = [bound + step for bound, step in ((low, -1), (high, 1)) if bound is not None]
    definition = {
        "parameter": f"(defun ranged (x) (declare (type {specifier} x)) x)",
        "binding": f"(defun ranged (y) (let ((x y)) (declare (type {specifier} x)) x))",
        "assignment": f"(defun ranged (y) (let ((x {inside[0]})) (declare (type {specifier} x)) (setq x y) x))",
        "the": f"(defun ranged (y) (let ((z (the {specifier} y))) z))",
        "slot": f"(progn (defstruct ranged-slot (x {inside[0]} :type {specifier})) (defun ranged (y) (ranged-slot-x (make-ranged-slot :x y))))",
        "constructor": f"(progn (defstruct (ranged-place (:constructor place-at (x))) (x {inside[0]} :type {specifier}))"
        " (defun ranged (y) (ranged-place-x (place-at y))))",
    }[shape]
    lisp(definition)
    for value in inside:
        assert lisp(f"(ranged {value})") == str(value)
        assert lisp(f"(typep {value} '{specifier})") == "T"
    for form in [*map(str, outside), *OTHERS]:
        assert (
            lisp(f"(handler-case (ranged {form}) (type-error (e) (list :refused (equal (type-error-datum e) {form}))))") == "(:REFUSED T)"
        )
        assert lisp(f"(typep {form} '{specifier})") == "NIL"


@pytest.mark.parametrize("specifier", [specifier for specifier in RANGES if specifier != "fixnum" and RANGES[specifier][1] is not None])
def test_elements_of_a_declared_range_are_stored_up_to_the_bounds_of_the_upgraded_type(lisp, specifier):
    low, high = RANGES[specifier]
    if low is None or specifier.startswith(("(or", "(and", "small")):
        return
    lisp(f"(defun stored (x) (let ((v (make-array 2 :element-type '{specifier}))) (setf (aref v 1) x) (aref v 1)))")
    for value in (low, high):
        assert lisp(f"(stored {value})") == str(value)
    assert lisp('(handler-case (stored "a") (type-error () :refused))') == ":REFUSED"
    bounds = "(let ((e (array-element-type (make-array 2 :element-type '%s)))) (list (typep %d e) (typep %d e)))"
    fits = lisp(bounds % (specifier, low - 1, high + 1))
    answer = "(flet ((ok (x) (handler-case (progn (stored x) t) (type-error () nil)))) (list (ok %d) (ok %d)))"
    assert lisp(answer % (low - 1, high + 1)) == fits


def test_an_element_type_with_parameters_of_the_program_is_upgraded_as_what_it_stands_for(lisp):
    assert lisp("(array-element-type (make-array 2 :element-type '(bits 3)))") == "(UNSIGNED-BYTE 4)"
    assert lisp("(upgraded-array-element-type '(bits 8))") == "(UNSIGNED-BYTE 8)"
    assert lisp("(typep (make-array 2 :element-type '(unsigned-byte 8)) '(vector (bits 8)))") == "T"


VECTORS = [
    "(make-array 3 :element-type '(unsigned-byte 8))",
    "(make-array 3 :element-type '(unsigned-byte 8) :adjustable t)",
    "(make-array 3 :element-type '(unsigned-byte 8) :fill-pointer 1)",
    "(make-array '(3 1) :element-type '(unsigned-byte 8))",
    "(make-array 3 :element-type '(unsigned-byte 7))",
    "(make-array 3)",
    "(make-array 3 :element-type 'bit)",
    '"abc"',
    "4",
]
KINDS = {
    "(simple-array (unsigned-byte 8) (*))": "TNNNNNNNN",
    "(simple-array (unsigned-byte 8) 1)": "TNNNNNNNN",
    "(simple-array (unsigned-byte 8) (3))": "TNNNNNNNN",
    "(simple-array (unsigned-byte 8) (4))": "NNNNNNNNN",
    "(simple-array (unsigned-byte 8) *)": "TNNTNNNNN",
    "(array (unsigned-byte 8) (*))": "TTTNNNNNN",
    "(array (unsigned-byte 8) 2)": "NNNTNNNNN",
    "(vector (unsigned-byte 8))": "TTTNNNNNN",
    "(vector (unsigned-byte 8) 3)": "TTTNNNNNN",
    "(simple-array * (*))": "TNNNTTTTN",
    "(simple-array t (*))": "NNNNNTNNN",
}


@pytest.mark.parametrize("specifier", KINDS)
def test_a_vector_is_of_the_kinds_that_sbcl_says(lisp, specifier):
    found = ["T" if lisp(f"(typep {vector} '{specifier})") == "T" else "N" for vector in VECTORS]
    assert "".join(found) == KINDS[specifier]


@pytest.mark.soak
def test_functions_compiled_before_a_type_is_defined_or_that_misuse_it_are_defined(lisp):
    lisp("(defun early (x) (declare (type later-type x)) x) (deftype later-type () '(integer 0 3))")
    assert lisp("(list (early 3) (handler-case (early 4) (type-error () :refused)))") == "(3 :REFUSED)"
    lisp('(deftype sized (n) `(unsigned-byte ,n)) (deftype failing () (error "no"))')
    assert lisp("(progn (defun misused (x) (declare (type sized x)) x) 'misused)") == "MISUSED"


def test_a_file_is_compiled_anew_when_a_type_of_another_file_means_another_range(tmp_path, lisp):
    types, user = tmp_path / "types.lisp", tmp_path / "user.lisp"
    user.write_text("(defun ranged-by-file (x) (declare (type file-range x)) x)")
    for limit in (3, 5):
        types.write_text(f"(deftype file-range () '(integer 0 {limit}))")
        lisp(f'(progn (load "{types}") (load "{user}"))')
        assert (
            lisp(f"(list (ranged-by-file {limit}) (handler-case (ranged-by-file {limit + 1}) (type-error () :refused)))")
            == f"({limit} :REFUSED)"
        )
