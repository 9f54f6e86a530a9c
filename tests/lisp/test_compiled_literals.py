"""A compiled file makes the literal objects of its text again: pathnames, packages, arrays, and objects that ``make-load-form`` is defined for.

Source: ANSI 3.2.4.
"""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.files.files import lisp_path
from cramhy_runtime.languages.commonlisp.pathnames.pathnames import DEFAULTS
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    made.package = "COMMON-LISP-USER"
    yield made
    kernel.stop()


@pytest.fixture
def answer(session, tmp_path):
    """Evaluates a text in an empty folder; the printed values."""

    def evaluate(text):
        with binding(DEFAULTS, lisp_path(tmp_path)):
            return " ; ".join(prin1_to_string(value) for value in session.evaluate_text(text)).replace(str(tmp_path), "/here")

    return evaluate


LITERALS = {
    "pathnames": """(list '#p"a/b.c" '(eql #p"") '#.(make-pathname :directory '(:absolute "x" :wild) :name "y*" :type :wild)
                        '#.(make-pathname :type "t") (pathname-name '#p"*.[ab]"))""",
    "packages": """(list '#.(find-package "CL-USER") '(in #.(find-package "KEYWORD")))""",
    "arrays": """(list '#.(make-array '(2 2) :element-type 'bit :initial-element 1) '#2a((1 a) ("x" (b)))
                     '#.(make-array 3 :fill-pointer 2 :initial-contents '(1 2 3)) '#.(make-array '(1 2) :adjustable t :initial-element 'q)
                     '#.(make-array 2 :element-type '(unsigned-byte 8) :initial-element 7) '#*101 '#0a5)""",
    "strings": """(list '#.(coerce "abc" 'base-string) (type-of '#.(coerce "abc" 'base-string))
                      '#.(make-array 3 :element-type 'character :fill-pointer 2 :initial-element #\\x))""",
    "numbers": "(list '1/2 '#c(1 2) '123456789012345678901234567890 '#\\a ':k '#:g)",
    "structures": "(list (literal-thing-name '#s(literal-thing :name (1 2))) (literal-thing-p '#.(make-literal-thing :name 1)))",
    "instances": "(let ((o '#.(make-instance 'literal-object :o 5))) (list (slot-value o 'o) (eq (slot-value o 'self) o)))",
}
DEFINITIONS = """
(eval-when (:compile-toplevel :load-toplevel :execute)
  (defstruct literal-thing name)
  (defmethod make-load-form ((x literal-thing) &optional environment) (make-load-form-saving-slots x :environment environment))
  (defclass literal-object () ((o :initarg :o) (self :initform nil)))
  (defmethod make-load-form ((x literal-object) &optional environment)
    (declare (ignore environment))
    (values `(make-instance 'literal-object :o ,(slot-value x 'o)) `(setf (slot-value ',x 'self) ',x))))
"""


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("kind", LITERALS)
def test_a_compiled_file_makes_its_literals_again(answer, tmp_path, kind):
    form = LITERALS[kind].replace("\\\\", "\\")
    (tmp_path / "literals.lisp").write_text(f"{DEFINITIONS}\n(defparameter *literals* {form})")
    answer('(let ((*error-output* (make-broadcast-stream))) (load (compile-file "literals" :verbose nil)))')
    wanted = "(5 T)" if kind == "instances" else answer(f"{DEFINITIONS} {form}").rpartition(" ; ")[2]
    assert answer("*literals*") == wanted


def test_a_literal_that_no_form_makes_is_named(answer, tmp_path, capsys):
    (tmp_path / "a.lisp").write_text("(print '#.(make-instance 'standard-object))")
    assert answer('(let ((*error-output* (make-broadcast-stream))) (compile-file "a.lisp" :verbose nil))') == '#P"/here/a.fasl" ; T ; T'
