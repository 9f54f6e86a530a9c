"""What a report says: nothing that acts in a terminal, nothing that cannot be written, and no more of a check than it wants to show."""

from __future__ import annotations

import json
from xml.etree import ElementTree

import pytest

from cramhy_runtime.grading import CheckResult, Grader, Report, formats, judging
from cramhy_runtime.grading.exercise import Exercise
from cramhy_runtime.grading.harmless import harmless
from cramhy_runtime.grading.problems import ExerciseError


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("plain äöü 漢字 🐢\n\tnext", "plain äöü 漢字 🐢\n\tnext"),
        ("\x1b[31mred\x1b[0m", "\\x1b[31mred\\x1b[0m"),
        ("title\x1b]0;owned\x07", "title\\x1b]0;owned\\x07"),
        ("\x9b31m", "\\x9b31m"),
        ("passed\rFAILED\b\b\x7f", "passed\\x0dFAILED\\x08\\x08\\x7f"),
        ("one\r\ntwo", "one\ntwo"),
        ("a\u202eb\u2066c\u200f", "a\\u202eb\\u2066c\\u200f"),
        ("zero\u200bwidth\ufeff", "zero\\u200bwidth\\ufeff"),
        ("line\u2028paragraph\u2029", "line\\u2028paragraph\\u2029"),
        ("half \ud800 \udfff", "half \\ud800 \\udfff"),
        ("none \ufffe \uffff \ufdd0", "none \\ufffe \\uffff \\ufdd0"),
        ("\U000e0041", "\\U000e0041"),
        ("\x00", "\\x00"),
        ("::error::x\n   ::set-output name=a::b ##[error]", ": :error::x\n   : :set-output name=a::b # #[error]"),
        ("(tut::drive 1)", "(tut::drive 1)"),
        (5, "5"),
    ],
)
def test_what_acts_is_shown_and_the_rest_stays(text, shown):
    assert harmless(text) == shown
    assert harmless(shown) == shown
    shown.encode()


NASTY = "a\x1b[2J\u202e\ud800\x00\ufffe\r<b>&--|>"


@pytest.mark.parametrize("write", [*formats.FORMATS.values(), Report.junit], ids=[*formats.FORMATS, "junit"])
def test_each_kind_of_report_is_harmless_and_can_be_written(write):
    report = Report(NASTY, [CheckResult(NASTY, 0, 1, [NASTY], NASTY)], NASTY, [NASTY])
    found = write(report)
    text = found.decode() if isinstance(found, bytes) else found
    text.encode()
    assert not set("\x1b\u202e\ud800\x00\ufffe\r") & set(text) and "x1b[2J" in text
    if write is Report.junit:
        ElementTree.fromstring(found)
    elif text.startswith("{"):
        shown = json.dumps(json.loads(text), ensure_ascii=False)
        assert not set("\x1b\u202e\ud800\x00\ufffe\r") & set(shown)


# ------------------------------------------------------------------------------------------- how much is shown of a check

TOML = """
title = "Sums"
submission = ["a.lisp"]
before = []
{exercise}
[[check]]
title = "Adding"
{check}
ask = [["(sum 20 22)", "42"], ["(sum 1 2 :wrong)", "fails program-error"]]
"""
DRIVE = """
title = "Driving"
submission = ["a.lisp"]
before = ['(roslisp:start-ros-node "grader")', '(sleep 0.1)']
{exercise}
[limits]
turtle_time = 10
[[check]]
title = "Far"
{check}
do = "(drive 7.25)"
value = "31415"
at = {{ x = 9.875, y = 1.125, heading = 77 }}
visits = [[3.625, 1.375]]
seconds = [6.5, 8.5]
distance = [9.75, 10.25]
commands = [5, 6]
paper = {{ way = "forward 4.375" }}
"""
WRONG = "(defun sum (one other) (+ one one))"
STAYS = "(defun drive (metres) (sleep 1) 27)"


@pytest.fixture(scope="module")
def grader():
    with Grader(apart=False) as made:
        yield made


def report(grader, folder, toml, text, exercise="", check=""):
    (folder / "exercise.toml").write_text(toml.format(exercise=exercise, check=check))
    return grader.grade_texts(Exercise.read(folder), {"a.lisp": text}).text()


def test_an_expected_answer_is_shown_only_if_the_exercise_or_the_check_wants_it(grader, tmp_path):
    said = report(grader, tmp_path, TOML, WRONG)
    assert "(sum 20 22) gave 40, which is not right." in said and "42" not in said
    for entries in ({"exercise": "show_answers = true"}, {"check": "show_answers = true"}):
        assert "(sum 20 22) should give 42, and gave 40." in report(grader, tmp_path, TOML, WRONG, **entries)
    said = report(grader, tmp_path, TOML, WRONG, "show_answers = true", "show_answers = false")
    assert "42" not in said


EXPECTED = ["31415", "9.9", "9.875", "1.1", "1.125", "77", "3.6", "6.5", "8.5", "9.75", "10.2", "4.375", "5 to 6"]
"""Numbers of the check that a student could use, as they would be shown."""


def test_no_sentence_about_a_run_gives_an_answer_away(grader, tmp_path):
    for text in (STAYS, "(defun drive (metres) (car 7))", "(defun drive (metres) (loop (sleep 1)))"):
        said = report(grader, tmp_path, DRIVE, text)
        assert "FAILED" in said and not [each for each in EXPECTED if each in said], said
    said = report(grader, tmp_path, DRIVE, STAYS)
    for part in ("(drive 7.25) gave 27, which is not right.", "The paper is empty", "m from where it should be", "place 1 in its turn",
                 "The plan took 1.0 s of the turtle's time, which is too little.", "The plan sent 0 commands, which is too little."):  # fmt: skip
        assert part in said
    whole = report(grader, tmp_path, DRIVE, STAYS, "show_answers = true")
    assert all(each in whole for each in ("31415", "x 9.9, y 1.1", "77", "x 3.6", "6.5 to 8.5 s", "9.75 to 10.25", "5 to 6"))


def test_a_hidden_check_tells_what_failed_and_neither_its_questions_nor_its_answers(grader, tmp_path):
    said = report(grader, tmp_path, TOML, f'{WRONG} (print "20 22")', check="hidden = true")
    assert said == "Sums: 0 of 1 points\n\nFAILED  0/1  Adding\n        An answer is wrong.\n"
    assert not [each for each in ("42", "40", "sum", "20", "22", "seed") if each in said]
    assert "A question ended with an error." in report(
        grader, tmp_path, TOML, '(defun sum (a b) (error "~a ~a" a b))', check="hidden = true"
    )
    said = report(grader, tmp_path, DRIVE, STAYS, check="hidden = true")
    assert not [each for each in [*EXPECTED, "7.25", "drive", "27"] if each in said], said
    assert "The turtle ends at another place." in said and "A number is too little." in said
    said = report(grader, tmp_path, DRIVE, '(defun drive (metres) (error "~a" metres))', check="hidden = true")
    assert "The plan ended with an error." in said and "7.25" not in said


def test_a_question_that_never_ends_is_named_once_and_the_others_are_not_asked(grader, tmp_path):
    (tmp_path / "exercise.toml").write_text(TOML.format(exercise="limits = { turtle_time = 5 }", check=""))
    said = grader.grade_texts(Exercise.read(tmp_path), {"a.lisp": "(defun sum (&rest all) (loop (cpl:sleep 1)))"}).text()
    assert said.count("never ended") == 1
    assert "(sum 20 22) never ended, and was stopped. Is there a loop or a recursion in it that does not end?" in said


NEEDS = """
title = "Two"
submission = ["a.lisp"]
before = []
[[check]]
title = "One"
ask = [["(one)", "1"]]
[[check]]
title = "Other"
points = 2
needs = {needs}
ask = [["(two)", "2"]]
"""


def test_a_check_may_count_only_if_another_one_passes(grader, tmp_path):
    (tmp_path / "exercise.toml").write_text(NEEDS.format(needs=1))
    exercise = Exercise.read(tmp_path)
    assert grader.grade_texts(exercise, {"a.lisp": "(defun one () 1) (defun two () 2)"}).points == 3
    found = grader.grade_texts(exercise, {"a.lisp": "(defun one () 7) (defun two () 2)"})
    assert found.points == 0 and "This counts only if the check 'One' passes, too." in found.text()
    for needs in ("2", "[1, 3]", '"One"', "0", "true"):
        (tmp_path / "exercise.toml").write_text(NEEDS.format(needs=needs))
        with pytest.raises(ExerciseError, match="which is not the number of a check above it"):
            Exercise.read(tmp_path)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("(send 0)", "that is not a number (NaN)"),
        ("(send sb-ext:double-float-positive-infinity)", "that is endless"),
        ("(send 1d300)", "a number that is far too large: 1e+300"),
    ],
)
def test_a_number_that_is_none_is_told_so_that_a_student_finds_the_division(grader, tmp_path, text, words):
    define = """(defun send (number)
  (let ((speed (if (eql number 0) (py:call "builtins.float" "nan") number)) (commands (roslisp:advertise "turtle1/cmd_vel" "geometry_msgs/Twist")))
    (roslisp:publish commands (roslisp:make-message "geometry_msgs/Twist" (:x :linear) speed)) (sleep 1)))"""
    said = report(grader, tmp_path, DRIVE, f"{define} (defun drive (metres) {text} 31415)", 'allow = ["python"]')
    assert words in said and "Python" not in said
    if "far" not in words:
        assert "Such a number comes from a division such as 0/0 or 1/0 of floats" in said


@pytest.mark.parametrize("number, words", [(0, "sent 0 commands,"), (1, "sent 1 command,"), (2, "sent 2 commands,")])
def test_what_is_counted_agrees_with_its_number(number, words):
    judge = judging._counted("commands", lambda replay: number, "The plan sent {} command{s}", "It should send")
    [fault] = judge({"commands": [5, 5]}, {}, None, None)
    assert words in fault.plain and "It should send 5." in fault.whole
