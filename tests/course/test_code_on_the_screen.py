"""Code on the screen of ``cramhy learn`` is the same code when it is typed as it stands, and what was typed is known in other lines, too."""

import re

import pytest

from cramhy_runtime.course.guide import _squeezed
from cramhy_runtime.course.shown import Style, code


def without_comments(code):
    """The words of ``code``, without its comments."""
    kept = [re.match(r'((?:[^";\\]|\\.|"(?:[^"\\]|\\.)*"?)*)', line)[1] for line in code.split("\n")]
    return " ".join(kept).split()


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize("width", [44, 80])
@pytest.mark.parametrize(
    "line",
    [
        '  ;; (make-message "geometry_msgs/Twist" (:x :linear) lin (:z :angular) ang) and more than fits into a row of the terminal',
        "(setv x 1) ; the colour under the turtle, which is what this variable has at each moment of the plan",
        '(format t "a ; b" one-argument another-argument a-third-argument a-fourth-argument) ; prints, and then goes on with the rest',
        r"(list #\; first-of-them second-of-them third-of-them fourth-of-them) ; a character of Lisp that is not a comment",
    ],
)
def test_a_comment_that_is_too_long_for_the_screen_goes_on_as_one(line, width):
    assert without_comments(code(line, Style(width))) == without_comments(line)


TEXTS = [
    """(defun f ()
  "The way to the goal; its first part is told here.
The second part ; is not a comment, though a semicolon stands in it, and this line is too long for the screen.
It ends here \\"so\\"; and not before this quote, which is far to the right of the terminal."
  (list 1)) ; here is a comment, which is too long for the row as well and goes on in the next one, as a comment""",
    """(setv x #\\" y "a
b; c d e f g h i j k l m n o p q r s t u v w x y z a b c d e f g h i j k l m n o p q r s t u v w x y z \\\\" z) ; told""",
]


@pytest.mark.parametrize("width", [44, 80])
@pytest.mark.parametrize("block", TEXTS)
def test_a_semicolon_in_a_text_of_several_lines_begins_no_comment(block, width):
    text = re.compile(r'(?<!\\)"(?:[^"\\]|\\.)*"', re.S)
    assert [each.split() for each in text.findall(code(block, Style(width)))] == [each.split() for each in text.findall(block)]


def test_a_form_that_is_typed_over_two_lines_was_typed():
    assert _squeezed("(import cram-my-beginner-tutorial\n  :as tut\n)") == _squeezed("(import cram-my-beginner-tutorial :as tut)")
    assert _squeezed("(f a )") == _squeezed("(f a)") != _squeezed("(fa)")
