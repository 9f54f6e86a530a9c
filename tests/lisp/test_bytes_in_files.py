"""Bytes of files, one by one and many at once, and bytes of integers: the answers are those of SBCL 2.2.9."""

from __future__ import annotations

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.files.files import lisp_path
from cramhy_runtime.languages.commonlisp.pathnames.pathnames import DEFAULTS
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.repl.session import Session

DEFINITIONS = """
(defmacro writing (type &body body)
  `(with-open-file (s "f" :direction :output :if-exists :supersede :element-type ',type) ,@body))
(defmacro reading (type &body body)
  `(with-open-file (s "f" :element-type ',type) ,@body))
(defun all-bytes () (reading (unsigned-byte 8) (loop for byte = (read-byte s nil) while byte collect byte)))
(defmacro told (&body body)
  `(handler-case (progn ,@body) (end-of-file () :end) (type-error () :type-error) (error () :error)))
"""
OCTETS = "(make-array 4 :element-type '(unsigned-byte 8) :initial-contents '(9 8 7 6))"
WRITTEN = [
    ("(unsigned-byte 8)", "(write-sequence #(1 2 3 255) s)", "(1 2 3 255)"),
    ("(unsigned-byte 8)", "(write-sequence '(1 2 3) s :start 1)", "(2 3)"),
    ("(unsigned-byte 8)", f"(write-sequence {OCTETS} s :end 2)", "(9 8)"),
    ("(unsigned-byte 8)", f"(write-sequence {OCTETS} s)", "(9 8 7 6)"),
    ("(unsigned-byte 8)", "(write-byte 7 s) (write-sequence #*101 s) (write-byte 8 s)", "(7 1 0 1 8)"),
    ("(signed-byte 8)", "(write-sequence #(-1 2) s)", "(255 2)"),
    ("(unsigned-byte 16)", "(write-sequence #(1 258) s)", "(1 0 2 1)"),
]
REFUSED = ["#(1 256)", "#(1 :a)", "#(1 -1)", "#(1 1.0)", "#(1 t)"]
READ = [
    (
        "(unsigned-byte 8)",
        "(let ((v (make-array 4 :initial-element :x))) "
        "(list (read-sequence v s) (copy-seq v) (read-byte s) (read-sequence v s :start 1 :end 3) v (file-position s)))",
        "(4 #(0 1 2 3) 4 3 #(0 5 6 3) 7)",
    ),
    (
        "(unsigned-byte 8)",
        "(let ((v (make-array 14 :element-type '(unsigned-byte 8)))) (list (read-sequence v s) v (read-sequence v s) (read-byte s nil :eof)))",
        "(10 #(0 1 2 3 4 5 6 7 8 9 0 0 0 0) 0 :EOF)",
    ),
    ("(unsigned-byte 8)", "(let ((l (list 1 2 3))) (list (read-sequence l s) l))", "(3 (0 1 2))"),
    ("(unsigned-byte 8)", "(let ((v (make-array 6 :fill-pointer 3 :initial-element 7))) (list (read-sequence v s) v))", "(3 #(0 1 2))"),
    ("(signed-byte 8)", "(let ((v (make-array 3))) (list (read-sequence v s) v))", "(3 #(0 1 2))"),
    ("(unsigned-byte 16)", "(let ((v (make-array 3))) (list (read-sequence v s) v (read-byte s)))", "(3 #(256 770 1284) 1798)"),
    ("(unsigned-byte 8)", "(list (read-byte s) (file-position s) (file-position s 5) (read-byte s) (read-byte s))", "(0 1 T 5 6)"),
    ("(unsigned-byte 8)", "(dotimes (i 10) (read-byte s)) (read-byte s)", ":END"),
    ("(unsigned-byte 8)", "(close s) (read-byte s)", ":ERROR"),
    ("(unsigned-byte 8)", "(close s) (read-sequence (make-array 2) s)", ":ERROR"),
    ("character", "(let ((v (make-array 3))) (list (read-sequence v s) (map 'list #'char-code v)))", "(3 (0 1 2))"),
]
INTEGERS = [
    ("(list (ash 1 70) (ash -5 -1) (ash 5 -100))", "(1180591620717411303424 -3 0)"),
    ("(list (ldb (byte 8 8) #xABCD) (ldb (byte 0 3) 99) (ldb (byte 4 0) -1) (ldb (byte 3 70) (ash 5 70)))", "(171 0 15 5)"),
    ("(list (logand) (logand 12 10 8) (logxor 1 3 1) (logior))", "(-1 8 3 0)"),
    *(
        (form, ":TYPE-ERROR")
        for form in """(ash 1.0 2);(ash 1 2.0);(ash t 1);(ldb (byte -1 2) 4);(ldb (byte 2 2) 4.0);(ldb '(2 . t) 4);(ldb 3 4);(logior 1 t)
(logand 1.0);(ldb '(8 . 0) t)""".replace("\n", ";").split(";")
    ),
    (
        "(mapcar #'upgraded-array-element-type "
        "'((unsigned-byte 3) (unsigned-byte 8) (unsigned-byte 3) (signed-byte 5) (signed-byte 65) (mod 8) (eql 3) (unsigned-byte *)))",
        "((UNSIGNED-BYTE 4) (UNSIGNED-BYTE 8) (UNSIGNED-BYTE 4) (SIGNED-BYTE 8) T (UNSIGNED-BYTE 4) (UNSIGNED-BYTE 2) T)",
    ),
]


@pytest.fixture(scope="module")
def session():
    session = Session(time="virtual", turtlesim=False)
    session.evaluate_text(DEFINITIONS)
    yield session
    kernel.stop()


@pytest.fixture
def answer(session, tmp_path):
    def evaluate(form):
        with binding(DEFAULTS, lisp_path(tmp_path)):
            return " ".join(prin1_to_string(session.evaluate_text(form)[0]).split())

    return evaluate


@pytest.mark.parametrize("kind, body, bytes_then", WRITTEN)
def test_what_is_written_to_a_file_of_bytes(answer, kind, body, bytes_then):
    assert answer(f"(progn (writing {kind} {body}) (all-bytes))") == bytes_then


@pytest.mark.parametrize("sequence", REFUSED)
def test_the_elements_before_one_that_is_no_byte_are_written(answer, sequence):
    form = "(let (at) (list (told (writing (unsigned-byte 8) (handler-bind ((error (lambda (c) c (setf at (file-position s)))))"
    assert answer(f"{form} (write-sequence {sequence} s)))) at))") == "(:TYPE-ERROR 1)"


@pytest.mark.parametrize("kind, body, told", READ)
def test_what_is_read_from_a_file_of_bytes(answer, kind, body, told):
    answer("(writing (unsigned-byte 8) (dotimes (i 10) (write-byte i s)))")
    assert answer(f"(told (reading {kind} {body}))") == told


@pytest.mark.parametrize("form, told", INTEGERS)
def test_bits_of_integers(answer, form, told):
    assert answer(f"(told (eval '{form}))") == told


def test_a_file_that_is_read_and_written(answer):
    answer("(writing (unsigned-byte 8) (dotimes (i 5) (write-byte i s)))")
    both = '(with-open-file (s "f" :element-type \'(unsigned-byte 8) :direction :io :if-exists :overwrite)'
    form = "(let ((v (make-array 2))) (read-sequence v s) (write-sequence #(77 78) s) (file-position s 0)"
    assert answer(f"{both} {form} (list v (loop for b = (read-byte s nil) while b collect b))))") == "(#(0 1) (0 1 77 78 4))"


def test_a_sequence_of_bytes_is_written_and_read_at_once(answer, monkeypatch):
    from cramhy_runtime.languages.commonlisp.files.file_streams import FileStream

    monkeypatch.setattr(FileStream, "write_byte", None)
    monkeypatch.setattr(FileStream, "read_byte", None)
    answer("(writing (unsigned-byte 8) (write-sequence #(1 2 3) s))")
    assert answer("(reading (unsigned-byte 8) (let ((v (make-array 3))) (list (read-sequence v s) v)))") == "(3 #(1 2 3))"
