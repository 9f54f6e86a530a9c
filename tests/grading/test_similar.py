"""Submissions that are alike after renaming and reordering are found, and others are not."""

from __future__ import annotations

import json

import pytest

from cramhy_runtime.cli import main
from cramhy_runtime.grading.exercise import own_exercises
from cramhy_runtime.grading.forms import source_faults
from cramhy_runtime.grading.problems import ExerciseError
from cramhy_runtime.grading.similar import pairs
from cramhy_runtime.grading.similar.pairs import similar_pairs
from cramhy_runtime.grading.similar.shapes import shapes_of

from .submissions import SOLUTIONS

ANN = """
(in-package :tut)

(defun corner (x y right up)
  "A corner."
  (make-3d-vector (+ x right) (+ y up) 0))

(defun draw-square (size)
  (top-level
    (with-fields (x y) (value *turtle-pose*)
      (dolist (step (list (list size 0) (list size size) (list 0 size) (list 0 0)))
        (move-to (corner x y (first step) (second step)))))))
"""
BOB = """
(in-package :tut)
; my own work!
(defun draw-square (laenge)
  (top-level
    (with-fields (x y) (value *turtle-pose*)
      (dolist (stueck (list (list laenge 0) (list laenge laenge) (list 0 laenge) (list 0 0)))
        (move-to (ecke x y (first stueck) (second stueck)))))))

(defun ecke (a b rechts hoch) (make-3d-vector (+ rechts a) (+ hoch b) 0))
"""
CARL = """
(in-package :tut)
(defun draw-square (size)
  (top-level
    (dotimes (side 4)
      (send-vel-cmd size 0)
      (wait-duration 1.1)
      (send-vel-cmd 0 (/ pi 2))
      (wait-duration 1.1))))
"""
DORA = (SOLUTIONS / "square" / "square.lisp").read_text()


def folder(path, **texts):
    for name, text in texts.items():
        (path / name).mkdir(parents=True)
        (path / name / "square.lisp").write_text(text)
    return path


def test_a_renamed_and_reordered_copy_is_found_and_the_others_are_not(tmp_path):
    found = similar_pairs(folder(tmp_path, ann=ANN, bob=BOB, carl=CARL, dora=DORA))
    assert [(pair.one, pair.other) for pair in found] == [("ann", "bob")]
    assert found[0].share > 0.9
    assert [(part.one, part.other, part.head) for part in found[0].parts][0] == (
        "square.lisp:8",
        "square.lisp:4",
        "(defun draw-square ...)",
    )


def test_what_all_were_given_does_not_count(tmp_path):
    start = own_exercises()["square"] / "start"
    given = (start / "square.lisp").read_text()
    folder(tmp_path, ann=given + ANN, carl=given + CARL)
    assert similar_pairs(tmp_path, least=0.1)
    assert not similar_pairs(tmp_path, start, least=0.1)


def test_what_most_of_them_have_does_not_count(tmp_path):
    helper = "(defun twice (x y) (list (+ x x) (+ y y) (* x y) (- x y)))\n"
    texts = {
        f"student{number}": helper
        + f'(defun own ({" ".join("abcdefghijkl"[:number])}) (format t "a" {" ".join("abcdefghijkl"[:number])} {number} 1 2 3 4))'
        for number in range(1, 13)
    }
    assert not similar_pairs(folder(tmp_path, **texts))


def test_the_order_of_arguments_counts_where_it_means_something():
    def shapes(text):
        return set(shapes_of(f"(defun f (a b c d e) {text})", "a.lisp"))

    assert shapes("(+ (sin a) (cos b) (tan c) d e)") == shapes("(+ e d (tan c) (cos b) (sin a))")
    assert shapes("(list (sin a) (cos b) (tan c))") != shapes("(list (tan c) (cos b) (sin a))")
    assert shapes("(- a b c d e)") != shapes("(- a b c d d)")


RACE = (SOLUTIONS / "race" / "race.lisp").read_text()
RACE_OF_EVE = """
(in-package :tut)
(defun permutations (items)
  (if (null items) (list nil)
    (loop for item in items
          append (loop for tail in (permutations (remove item items)) collect (cons item tail)))))
(defun hypot (x y) (sqrt (+ (* x x) (* y y))))
(defun length-of (way)
  (loop for (a b) on way while b sum (hypot (- (first b) (first a)) (- (second b) (second a)))))
(defun go-straight (x y)
  (send-vel-cmd 0 (relative-angle-to (make-3d-vector x y 0) (value *turtle-pose*)))
  (wait-duration 1.2)
  (with-fields ((x0 x) (y0 y)) (value *turtle-pose*)
    (send-vel-cmd (hypot (- x x0) (- y y0)) 0)
    (wait-duration 1.2)))
(defun race (points)
  (top-level
    (let* ((begin (with-fields (x y) (value *turtle-pose*) (list x y)))
           (ways (mapcar (lambda (way) (cons begin way)) (permutations points)))
           (best (first (sort ways (lambda (a b) (< (length-of a) (length-of b)))))))
      (loop for (x y) in (rest best) do (go-straight x y)))))
"""
"""Another author's solution of the same exercise, with the same idea."""
COPIES = {
    "other words": [
        ("(first ", "(car "),
        ("(second ", "(cadr "),
        ("(null points)", "(not points)"),
        ("(expt (- x x0) 2)", "(* (- x x0) (- x x0))"),
    ],
    "numbers": [("1.008", "1.01"), ("1.1", "1.05")],
    "printing": [("(turn-to goal)", '(progn (format t "turning") (turn-to goal))'), ("(top-level", "(top-level (print points)")],
    "a helper": [
        ("(sqrt (+ (expt (- x x0) 2) (expt (- y y0) 2)))", "(dist x y x0 y0)"),
        ("(defun orders", "(defun dist (a b c d) (sqrt (+ (expt (- a c) 2) (expt (- b d) 2))))\n(defun orders"),
    ],
    "dead code": [
        (
            "(defun orders",
            '(defun unused (a b) (let ((c (* a b))) (format t "~a" c) (if (> c 3) (list a b c) (list c b a))))\n(defun orders',
        )
    ],
}


@pytest.mark.parametrize("way", COPIES)
def test_a_copy_that_was_worked_over_is_found_and_the_other_authors_solution_is_not(tmp_path, way):
    copy = RACE
    for old, new in COPIES[way]:
        assert old in copy
        copy = copy.replace(old, new)
    for name in ("orders", "points", "point", "begin", "goal", "turn-to", "way-length", "shortest"):
        copy = copy.replace(name, f"my-{name[::-1]}")
    found = similar_pairs(folder(tmp_path, ann=RACE, bob=copy, eve=RACE_OF_EVE))
    assert [(pair.one, pair.other) for pair in found] == [("ann", "bob")]
    assert similar_pairs(tmp_path, least=0.25)[1:] == []


def test_programs_in_hy_and_python_are_compared_too(tmp_path):
    one = "def draw(size):\n    for side in range(4):\n        drive(size)\n        turn(90 + side * 0)\n    return size\n"
    for name, text in (("a", one), ("b", one.replace("size", "laenge").replace("side", "i")), ("c", "print('hello', 1, 2, 3, 4, 5, 6)\n")):
        (tmp_path / f"{name}.py").write_text(text)
    assert [(pair.one, pair.other) for pair in similar_pairs(tmp_path)] == [("a.py", "b.py")]


def test_the_command_lists_the_pairs(tmp_path, capsys):
    place = folder(tmp_path / "all", ann=ANN, bob=BOB, carl=CARL)
    assert main(["similar", str(place), "--json", str(tmp_path / "pairs.json")]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].endswith("ann  bob") and "(defun draw-square ...)" in lines[1]
    assert json.loads((tmp_path / "pairs.json").read_text())[0]["one"] == "ann"
    assert main(["similar", str(folder(tmp_path / "few", ann=ANN, carl=CARL))]) == 0
    assert capsys.readouterr().out == "No two submissions are alike.\n"
    assert main(["similar", str(tmp_path / "nothing")]) == 2
    assert "There is no folder" in capsys.readouterr().err


def test_one_submission_alone_is_told(tmp_path):
    with pytest.raises(ExerciseError, match="there are no two submissions"):
        similar_pairs(folder(tmp_path, ann=ANN))


HARD = {
    "parentheses.py": "(" * 5000 + ")" * 5000,
    "a sum.py": "x = " + "+".join("1" * 20_000),
    "signs.py": "x = " + "-" * 3000 + "1",
    "attributes.py": "x" + ".a" * 50_000,
    "branches.py": "if 1: pass\n" + "elif 1: pass\n" * 20_000,
    "a null byte.py": "x = 1\0",
    "half a surrogate.py": "x = '\ud800'",
    "digits.py": "x = " + "9" * 5000,
    "hexadecimal digits.py": "x = 0x" + "f" * 20_000,
    "a wrong escape.py": "x = '\\d'",
    "sums in sums.lisp": "(defun f (a b) " + "(+ a (and b " * 24 + "1" + "))" * 24,
    "groups in groups.lisp": "(a b c d e f " * 400 + ")" * 400,
    "open groups.lisp": "(" * 100_000,
    "quotes.lisp": "'" * 100_000,
    "open comments.lisp": "#|" * 100_000,
    "open names.lisp": "|" * 100_001,
}
"""Texts that stop a parser, take all of its stack, or double its work with each level."""


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("name", HARD)
@pytest.mark.filterwarnings("error")
def test_a_text_that_no_parser_likes_is_compared_and_looked_through(name):
    shapes_of(HARD[name], name)
    assert source_faults({"uses": ["nothing-like-that"], "avoids": []}, {name: HARD[name]}) == [
        "The program does not use nothing-like-that."
    ]


def test_names_of_files_and_forms_are_harmless(tmp_path):
    copy = ANN.replace("corner", "corner\x1b[31m\u202e")
    for name in ("a\x1b[2J", "b\udcff"):
        try:
            (tmp_path / f"{name}.lisp").write_text(copy)
        except OSError:  # a file system of UTF-8 alone
            (tmp_path / "b.lisp").write_text(copy)
    found = similar_pairs(tmp_path)
    for text in (pairs.as_text(found), pairs.as_json(found)):
        text.encode()
        assert "\x1b" not in text and "\u202e" not in text and "\\x1b[2J.lisp" in text.replace("\\\\", "\\")


def test_a_file_that_cannot_be_read_is_passed_over(tmp_path):
    folder(tmp_path, ann=ANN, bob=BOB)
    (tmp_path / "ann" / "gone.lisp").symlink_to(tmp_path / "nowhere")
    (tmp_path / "bob" / "folder.lisp").mkdir()
    assert [(pair.one, pair.other) for pair in similar_pairs(tmp_path)] == [("ann", "bob")]


def test_broken_texts_are_compared_as_far_as_they_go(tmp_path):
    folder(tmp_path, ann=ANN.rstrip()[:-5], bob=BOB + "(((", carl="\x00\x01 ) ) (", dora='"' * 99)
    assert [(pair.one, pair.other) for pair in similar_pairs(tmp_path)] == [("ann", "bob")]
