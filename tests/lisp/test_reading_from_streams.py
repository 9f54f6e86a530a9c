"""A text reads the same from a string, a user's stream, and streams made of these: every reader macro, comments, and the end of the text.

A user's stream (SB-GRAY) gives one character at a time, so the reader may have seen the beginning of a comment or token only.
"""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.printer.print_controls import PRINT_CIRCLE, PRINT_PRETTY, bound
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session, condition_of

TEXTS = [
    "; a b\n1 2",
    "1 ; a b",
    "(1 ; a b\n 2 ;x\n)",
    ";;; x\n;;; y\n\nz",
    "a;b",
    "(a;b\nc)",
    "'; x\na",
    ";",
    "#|a ; b|# 1 #|c #|d|# e|# 2 #||#",
    '"a\\"b;c" "d" ";" "\\\\"',
    "#\\; #\\Space #\\a #\\( #\\\\ #\\x41",
    "'a '(b . c) #'e `d",
    "`(b ,c ,@d . ,e) `#(,a ;x\n)",
    "#(1 2 ;x\n3) #3(1) #2a((1 2) (3 4)) #*101 #b101 #o17 #xff #36rz #c(1 2)",
    '#p"a.b" #.(+ 1 2) #.\'(a ;b\n c)',
    "#+nil (a ; b)\nc) d #-nil e #+(or) ; x\n f g",
    "(#1=(a ;b\n) . #1#)",
    "|a ; b| c\\;d \\a|b| :k cl:car cl-user::x ::y",
    "(a . b) (a .b) () nil (a . ;x\n b)",
    "1.5 .5 -3 1/2 1. + 1+ ... -",
    ",a",
    "(a",
    "(a ; b",
    '"a',
    "#|a",
    "#",
    "|a",
    "a\\",
    "#\\",
    "a)",
    "#(",
    "'",
    "#+x",
    "#<a",
    "cl:nope",
]

READ = """(let ((*gensym-counter* 1)) (loop for x = (read s nil :end) until (eq x :end) collect x))"""
STREAMS = {
    "a user's stream": "(make-instance 'typed :typed text)",
    "a two-way stream": "(make-two-way-stream (make-instance 'typed :typed text) (make-broadcast-stream))",
    "an echo stream": "(make-echo-stream (make-instance 'typed :typed text) (make-broadcast-stream))",
    "a concatenated stream": '(make-concatenated-stream (make-string-input-stream text) (make-instance \'typed :typed ""))',
    "a user's stream behind others": '(make-concatenated-stream (make-string-input-stream "") (make-instance \'typed :typed text))',
    "a synonym stream": "(progn (setq *typed* (make-instance 'typed :typed text)) (make-synonym-stream '*typed*))",
}
DEFINITIONS = """
(defvar *typed*)
(defclass typed (sb-gray:fundamental-character-input-stream) ((typed :initarg :typed) (next :initform 0)))
(defmethod sb-gray:stream-read-char ((s typed))
  (with-slots (typed next) s
    (if (< next (length typed)) (prog1 (char typed next) (incf next)) :eof)))
(defmethod sb-gray:stream-unread-char ((s typed) character)
  (declare (ignore character))
  (decf (slot-value s 'next)) nil)
"""


@pytest.fixture(scope="module")
def session():
    made = Session(time="virtual", turtlesim=False)
    made.package = "COMMON-LISP-USER"
    made.evaluate_text(DEFINITIONS)
    yield made
    kernel.stop()


def lisp_string(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def answer(session, stream, text, form):
    """What FORM gives where S is the stream that the form STREAM makes of TEXT: its printed values, or the class of the error."""
    try:
        values = session.evaluate_text(f"(let* ((text {lisp_string(text)}) (s {stream})) {form})")
    except (Condition, Exception) as problem:
        return condition_of(problem).lisp_name
    with bound(PRINT_CIRCLE, True, PRINT_PRETTY, None):
        return [prin1_to_string(value) for value in values]


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("stream", STREAMS)
def test_a_text_reads_the_same_from_every_stream(session, stream):
    for text in TEXTS:
        wanted = answer(session, "(make-string-input-stream text)", text, READ)
        assert (text, answer(session, STREAMS[stream], text, READ)) == (text, wanted)


@pytest.mark.soak(all_but=16)
@pytest.mark.parametrize("stream", STREAMS)
@pytest.mark.parametrize(
    ("text", "form"),
    [
        ("a b", "(list (read s) (read-char s))"),
        ("a b", "(list (read-preserving-whitespace s) (read-char s))"),
        ("(a)b", "(list (read s) (read-char s))"),
        ('"a"b', "(list (read s) (read-char s))"),
        ("a;c\nb", "(list (read s) (read-char s))"),
        (";x\na b", "(list (read s) (read-line s))"),
        ("a;c )\nb)c", "(list (read-delimited-list #\\) s) (read-char s))"),
        ("a ;c", "(list (read s) (read s nil :end) (read-char s nil :end))"),
        (
            "!x y !z;\nw",
            "(let ((*readtable* (copy-readtable nil)))"
            " (set-macro-character #\\! (lambda (s c) (list c (read-char s) (read s t nil t)))) (list (read s) (read s)))",
        ),
        ("a ! b c\nd", "(let ((*readtable* (copy-readtable nil))) (set-syntax-from-char #\\! #\\;) (list (read s) (read s)))"),
        (
            "a ; b",
            "(let ((*readtable* (copy-readtable nil))) (set-macro-character #\\; (lambda (s c) (list c)))"
            " (list (read s) (read s) (read s)))",
        ),
    ],
)
def test_a_stream_stands_behind_what_was_read(session, stream, text, form):
    assert answer(session, STREAMS[stream], text, form) == answer(session, "(make-string-input-stream text)", text, form)


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize("slot", "source sink label given closed position text pathname read-byte write-byte symbol stream file".split())
def test_a_slot_of_a_users_stream_may_have_any_name(session, slot):
    """The runtime asks streams for such attributes of Python."""
    session.evaluate_text(
        f"(defclass own-{slot} (typed) (({slot} :initform 7)))"
        f"(defclass own-out-{slot} (sb-gray:fundamental-character-output-stream) (({slot} :initform 7) (wrote :initform nil)))"
        f"(defmethod sb-gray:stream-write-char ((s own-out-{slot}) c) (push c (slot-value s 'wrote)) c)"
    )
    form = f"(list (read s) (read-char s) (slot-value s '{slot}) (open-stream-p s) (input-stream-p s))"
    assert answer(session, f"(make-instance 'own-{slot} :typed text)", "(a)b", form) == ["((A) #\\b 7 T T)"]
    form = f"(progn (write-sequence '(#\\x) s) (format s \"y\") (list (slot-value s 'wrote) (slot-value s '{slot}) (output-stream-p s)))"
    assert answer(session, f"(make-instance 'own-out-{slot})", "", form) == ["((#\\y #\\x) 7 T)"]


WRITTEN = {
    '(write-string "hello" o :start 1 :end 4)': '((:STRING "hello" 1 4))',
    '(write-string "a" o)': '((:STRING "a" 0 1))',
    '(write-string "" o)': '((:STRING "" 0 0))',
    '(write-line "" o)': '((:STRING "" 0 0) (:CHAR #\\Newline))',
    '(write-line "hello" o)': '((:STRING "hello" 0 5) (:CHAR #\\Newline))',
    '(write-line "hello" o :start 2)': '((:STRING "hello" 2 5) (:CHAR #\\Newline))',
    '(write-sequence "abc" o :start 1)': '((:STRING "abc" 1 3))',
    "(terpri o)": "(:TERPRI)",
    "(write-char #\\a o)": "((:CHAR #\\a))",
}


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("form", WRITTEN)
def test_a_stream_of_the_users_gets_what_was_given_to_the_writing_function(session, form):
    session.package = "CL-USER"
    session.evaluate_text("(defclass noting (sb-gray:fundamental-character-output-stream) ()) (defvar *noted* nil)")
    session.evaluate_text(
        "(defmethod sb-gray:stream-write-string ((s noting) text &optional start end) (push (list :string text start end) *noted*) text)"
        "(defmethod sb-gray:stream-write-char ((s noting) c) (push (list :char c) *noted*) c)"
        "(defmethod sb-gray:stream-terpri ((s noting)) (push :terpri *noted*) nil)"
    )
    session.evaluate_text(f"(setf *noted* nil) (let ((o (make-instance 'noting))) {form})")
    assert session.evaluate_text("(prin1-to-string (reverse *noted*))") == [WRITTEN[form]]
