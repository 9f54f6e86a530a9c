"""Objects and conditions whose printing fails, does not end, or is too much: for tests of what shows errors.

`DEFINITIONS` is a text of Lisp; the classes of Python here are called from Lisp by the name of this module.
"""

from __future__ import annotations

DEFINITIONS = """\
(defclass bp-empty () ((a :accessor bp-a)))
(defmethod print-object ((object bp-empty) stream) (format stream "<~a>" (slot-value object 'a)))
(defclass bp-mirror () ((other :initform nil :accessor bp-other)))
(defmethod print-object ((object bp-mirror) stream) (format stream "[~a]" (bp-other object)))
(defun bp-mirrors ()
  (let ((a (make-instance 'bp-mirror)) (b (make-instance 'bp-mirror))) (setf (bp-other a) b (bp-other b) a) a))
(defclass bp-endless () ())
(defmethod print-object ((object bp-endless) stream) (loop (list object stream)))
(defclass bp-sleeper () ())
(defmethod print-object ((object bp-sleeper) stream) (sleep 100000) (princ "slept" stream))
(defclass bp-flood () ())
(defmethod print-object ((object bp-flood) stream) (dotimes (i 100000) (write-string "flood " stream)))
(defclass bp-writer () ())
(defmethod print-object ((object bp-writer) stream)
  (princ (with-output-to-string (inner) (dotimes (i 100000) (write-string "flood " inner))) stream))
(defclass bp-deep () ())
(defmethod print-object ((object bp-deep) stream) (format stream "<~a>" (make-instance 'bp-deep)))
(defclass bp-throw () ())
(defmethod print-object ((object bp-throw) stream) (throw 'nowhere stream))
(defstruct (bp-part (:print-function (lambda (object stream depth) (error "part ~a ~a ~a" (bp-part-size object) (streamp stream) depth))))
  size)
(defstruct (bp-piece (:print-object (lambda (object stream) (car (bp-piece-size object)) stream))) (size 5))
(define-condition bp-lost (error) ((where :initarg :where :reader bp-where))
  (:report (lambda (condition stream) (format stream "Lost at ~a." (bp-where condition)))))
(define-condition bp-echo (error) ((other :initarg :other :accessor bp-other-echo))
  (:report (lambda (condition stream) (format stream "Echo of ~a." (bp-other-echo condition)))))
(defun bp-echoes ()
  (let ((a (make-condition 'bp-echo)) (b (make-condition 'bp-echo)))
    (setf (slot-value a 'other) b (slot-value b 'other) a)
    a))
(define-condition bp-silent (error) () (:report (lambda (condition stream) (loop (list condition stream)))))
(defun bp-ring () (let ((list (list 1 2 3))) (setf (cdddr list) list) list))
(defun bp-long () (make-list 100000 :initial-element 7))
(defun bp-fail (x) (error "bad: ~a" x))
"""

FAILING = {
    # what makes the object → what stands for it, in the text of an error about it
    "an unbound slot": ("(make-instance 'bp-empty)", "#<error printing a BP-EMPTY: The slot "),
    "an unbound slot in a list": ("(list 1 (make-instance 'bp-empty) 2)", "(1 #<error printing a BP-EMPTY: The slot "),
    "objects that print each other": ("(bp-mirrors)", "bad: [[[[[[#<BP-MIRROR>]]]]]]"),
    "a print-object without end": ("(make-instance 'bp-endless)", "#<error printing a BP-ENDLESS: it took too long>"),
    "a print-object that sleeps": ("(make-instance 'bp-sleeper)", "#<error printing a BP-SLEEPER: It took longer than 10 s."),
    "a print-object that writes too much": ("(make-instance 'bp-flood)", "bad: flood flood flood"),
    "a print-object that makes a string that is too long": (
        "(make-instance 'bp-writer)",
        "#<error printing a BP-WRITER: its text is longer than 20000 characters>",
    ),
    "objects in objects without end": ("(make-instance 'bp-deep)", "<<<#<BP-DEEP>>>>"),
    "a throw to nowhere": ("(make-instance 'bp-throw)", "#<error printing a BP-THROW: attempt to THROW to a tag that does not exist"),
    "a print-function": ("(make-bp-part)", "#<error printing a BP-PART: part NIL T 0"),
    "the print-object of a structure": ("(make-bp-piece)", "#<error printing a BP-PIECE: The value 5 is not of type LIST"),
    "the report of a condition": ("(make-condition 'bp-lost)", "#<error printing a BP-LOST: "),
    "conditions that print each other": ("(bp-echoes)", "Echo of Echo of Echo of Echo of Echo of Echo of #<BP-ECHO>......"),
    "a report without end": ("(make-condition 'bp-silent)", "#<error printing a BP-SILENT: it took too long>"),
    "a list that is a ring": ("(bp-ring)", "bad: #1=(1 2 3 . #1#)"),
    "a long list": ("(bp-long)", "7 7 7 7 7"),
    "a repr that raises": ('(py:call "bad_printers.Raises")', "#<error printing a RAISES: no repr (at "),
    "a repr that calls itself": ('(py:call "bad_printers.Recurses")', "#<error printing a RECURSES: Control stack exhausted"),
    "a repr that gives no text": ('(py:call "bad_printers.NoText")', "#<error printing a NOTEXT: __repr__ returned non-string (type int)>"),
    "a repr of five million characters": ('(py:call "bad_printers.Huge")', "bad: #<PYTHON xxxxxx"),
    "a repr that ends Python": ('(py:call "bad_printers.Leaves")', "#<error printing a LEAVES: 3"),
    "a repr that raises a class of its own": ('(py:call "bad_printers.OwnWay")', "#<error printing a OWNWAY: own"),
}

OF_CONDITIONS = {
    # a form that fails → what its error says
    "a report that fails": ("(error 'bp-lost)", "#<error printing a BP-LOST: "),
    "reports that print each other": ("(error (bp-echoes))", "Echo of Echo of "),
    "a report that does not end": ("(error 'bp-silent)", "#<error printing a BP-SILENT: it took too long>"),
    "a control that wants more": (
        '(apply (function error) "a ~a ~a" (list 1))',
        '#<error printing a SIMPLE-ERROR "a ~a ~a": error in FORMAT',
    ),
    "a type error about it": ("(car (make-instance 'bp-empty))", "#<error printing a BP-EMPTY: "),
    "a value": ("(make-instance 'bp-empty)", "while a value of class BP-EMPTY was printed"),
    "a value of Python": ('(py:call "bad_printers.Raises")', "while a value of class RAISES was printed"),
    "a str of an exception": ('(py:call "bad_printers.raise_it")', "#<error printing a BAD-ERROR: There is no key 'no str'."),
}

MOST = 25_000
"""Characters of a message at the most."""


class Raises:
    def __repr__(self):
        raise ValueError("no repr")


class Recurses:
    def __repr__(self):
        return f"<{self!r}>"


class NoText:
    def __repr__(self):
        return 5


class Huge:
    def __repr__(self):
        return "x" * 5_000_000


class Leaves:
    def __repr__(self):
        raise SystemExit(3)


class Own(BaseException):
    pass


class OwnWay:
    def __repr__(self):
        raise Own("own")


class BadError(Exception):
    def __str__(self):
        raise KeyError("no str")


def raise_it():
    raise BadError()


def forms():
    """(what fails, a form that fails, what is said)."""
    yield from ((f"a message about {what}", f"(bp-fail {made})", said) for what, (made, said) in FAILING.items())
    yield from ((what, form, said) for what, (form, said) in OF_CONDITIONS.items())
