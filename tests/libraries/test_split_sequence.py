"""split-sequence and cl-utilities: the values that the libraries (Debian's 2.0.1 and 1.2.4) give on SBCL."""

import pytest

from cramhy_runtime.lisp_core.conditions import Condition


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize(
    "arguments, parts",
    [
        ('#\\; "a;b;;c"', '("a" "b" "" "c") 6'),
        ('#\\; "a;b;;c" :remove-empty-subseqs t', '("a" "b" "c") 6'),
        ('#\\; "a;b;;c" :from-end t', '("a" "b" "" "c") 0'),
        ('#\\; "a;b;;c" :count 1', '("a") 2'),
        ('#\\; "a;b;;c" :count 0', "NIL 0"),
        ('#\\; "a;b;;c" :count 2 :from-end t :remove-empty-subseqs t', '("b" "c") 1'),
        ('#\\; "a;b;;c" :count 2 :remove-empty-subseqs t', '("a" "b") 5'),
        ('#\\; ";a;" :count 1 :from-end t', '("") 2'),
        ('#\\; "" :remove-empty-subseqs t', "NIL 0"),
        ('#\\; ""', '("") 0'),
        ('#\\; "a;b;;c" :start 1', '("" "b" "" "c") 6'),
        ("1 '(0 1 2 1 3)", "((0) (2) (3)) 5"),
        ("1 #(0 1 2) :from-end t", "(#(0) #(2)) 0"),
        ("1 '((1) (2) (1)) :key #'car", "(NIL ((2)) NIL) 3"),
        ("2 '(1 2 3) :test-not #'=", "(NIL (2) NIL) 3"),
        ('#\\Space "go to  table" :remove-empty-subseqs t', '("go" "to" "table") 12'),
    ],
)
def test_the_parts(values, arguments, parts):
    assert values(f"(split-sequence:split-sequence {arguments})") == parts


@pytest.mark.soak
@pytest.mark.parametrize(
    "form, value",
    [
        ('(split-sequence:split-sequence-if #\'digit-char-p "a1b22c" :remove-empty-subseqs t)', '("a" "b" "c") 6'),
        ('(cl-utilities:split-sequence-if-not #\'alpha-char-p "a1b22c")', '("a" "b" "" "c") 6'),
        ("(cl-utilities:extremum '(3 1 2) #'<)", "1"),
        ("(cl-utilities:extrema '(3 1 2 1) #'<)", "(1 1)"),
        ("(cl-utilities:n-most-extreme 2 '(3 1 2) #'>)", "(3 2)"),
        ("(cl-utilities:collecting (dotimes (i 3) (cl-utilities:collect (* i i))))", "(0 1 4)"),
        ("(cl-utilities:with-collectors (a b) (a 1) (b 2) (a 3))", "(1 3) (2)"),
        ("(list (cl-utilities:expt-mod 3 200 13) (cl-utilities:rotate-byte 3 (byte 32 0) (expt 2 30)))", "(9 2)"),
        ('(let ((s (make-string 5))) (with-input-from-string (in "ab-c") (cl-utilities:read-delimited s in :delimiter #\\-)))', "2 T"),
    ],
)
def test_other_functions(values, form, value):
    assert values(form) == value


@pytest.mark.parametrize(
    "form, text",
    [
        ("(split-sequence:split-sequence 1 '(1) :start 1 :end 0)", "bounding indices 1 and 0"),
        ("(cl-utilities:extremum nil #'<)", "Cannot find extremum of empty sequence"),
    ],
)
def test_what_is_wrong(values, form, text):
    with pytest.raises(Condition) as caught:
        values(form)
    assert text in caught.value.report()
