"""A type-error's expected type is a type, and its datum is not of that type: for every function of Common Lisp and wrong arguments.

A program that handles the error asks ``typep`` with these two (ANSI, TYPE-ERROR).
"""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session

ASKING = """
(defvar *nowhere* (make-broadcast-stream))
(defvar *objects*
  (list 1 -7/2 #c(1 2) 'a :k nil #\\a "text" (list 1 2) '(a . b) (vector 1 2) (make-array '(2 2)) #*101 #'car (make-hash-table)
        (find-package :cl) *readtable* #p"x.y" (make-string-input-stream "") *terminal-io* *nowhere* (find-class 'integer)
        (make-condition 'error) (make-random-state) (make-array 3 :fill-pointer 0) (code-char 300)))
(defvar *left-out*
  '(break invoke-debugger read read-line read-char read-char-no-hang read-byte read-preserving-whitespace peek-char listen y-or-n-p yes-or-no-p sleep
    load compile-file delete-file rename-file ensure-directories-exist dribble ed abort exit quit delete-package unuse-package use-package
    in-package rename-package make-package import export unexport unintern shadow shadowing-import fmakunbound makunbound
    close clear-input set proclaim require provide invoke-restart invoke-restart-interactively throw inspect describe room
    signal error cerror warn disassemble make-list make-string make-array make-sequence untrace trace read-delimited-list open probe-file
    directory apropos apropos-list compile eval funcall apply sxhash gentemp intern print prin1 princ pprint write muffle-warning
    continue store-value use-value make-instances-obsolete add-method remove-method update-instance-for-redefined-class
    change-class reinitialize-instance shared-initialize initialize-instance copy-readtable set-macro-character ash expt
    set-dispatch-macro-character make-dispatch-macro-character set-syntax-from-char set-pprint-dispatch documentation copy-structure))
(defun wrong-expectation (function arguments)
  "What is wrong with the type-error that FUNCTION signals for ARGUMENTS; NIL if nothing is."
  (handler-case (let ((*standard-output* *nowhere*) (*error-output* *nowhere*)) (apply function arguments) nil)
    (type-error (c)
      (handler-case (let ((type (type-error-expected-type c)) (datum (type-error-datum c)))
                      (if (typep datum type) (list :is-of-it datum type) nil))
        (error (problem) (list :no-type (princ-to-string problem)))))
    (error () nil)))
(defun asked-functions ()
  (let ((found nil))
    (do-external-symbols (s :cl (sort found #'string<))
      (when (and (fboundp s) (not (macro-function s)) (not (special-operator-p s)) (not (member s *left-out*)))
        (push s found)))))
(defun wrong-expectations (name count)
  (let ((found nil))
    (flet ((ask (&rest arguments)
             (let ((wrong (wrong-expectation name (mapcar (lambda (x) (if (stringp x) (copy-seq x) (if (consp x) (copy-tree x) x))) arguments))))
               (when wrong (push (list arguments wrong) found)))))
      (dolist (a *objects* (reverse found))
        (if (= count 1) (ask a) (progn (ask a 1) (ask 'car a) (ask "text" a) (ask a '(1 2))))))))
"""


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    made.package = "COMMON-LISP-USER"
    made.evaluate_text(ASKING)
    yield made
    kernel.stop()


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("letters", ["ABCDEF", "GHIJKLMNO", "PQR", "STUVWXYZ*+-/1<=>"])
def test_the_datum_of_a_type_error_is_not_of_the_expected_type(session, letters):
    (names,) = session.evaluate_text("(asked-functions)")
    for name in names:
        if name.name[0] in letters:
            for count in (1, 2):
                (wrong,) = session.evaluate_text(f"(wrong-expectations '{name.name} {count})")
                assert (name.name, prin1_to_string(wrong)) == (name.name, "NIL")
