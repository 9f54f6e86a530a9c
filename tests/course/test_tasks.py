"""Each task of the course: its solution passes; nothing, the code to begin with, and wrong solutions do not. All is typed into the prompt."""

from __future__ import annotations


import pytest

from cramhy_runtime.course import contents, reading

from .walking import Walk

WRONG = [
    # task, language, what stands in the solution, what stands there instead
    ("seconds-of-a-day", "lisp", "24", "23"),
    ("seconds-of-a-day", "hy", "24", "23"),
    ("around-a-square", "lisp", "(* 4 *side*)", "(* 3 *side*)"),
    ("around-a-square", "hy", "(* 4 side)", "(* 3 side)"),
    ("rectangle", "lisp", "(+ width height)", "(+ width 3)"),
    ("rectangle", "hy", "(+ width height)", "(+ width 3)"),
    ("turn-left", "lisp", "1.57", "-1.57"),
    ("turn-left", "hy", "1.57", "-1.57"),
    ("turn-left", "lisp", "(sleep 1)", "nil"),
    ("turn-left", "hy", "(sleep 1)", "None"),
    ("first-square", "lisp", "(ahead 2)", "(ahead 1)"),
    ("first-square", "hy", "(ahead 2)", "(ahead 1)"),
]


@pytest.mark.parametrize("language", ["lisp", "hy"])
@pytest.mark.parametrize("name", contents.NAMES)
def test_a_student_who_types_everything_comes_through_the_page(name, language, tmp_path):
    walk = Walk(name, language, tmp_path, WRONG)
    assert walk.status == 0
    wrong = {key: passed for key, passed in walk.verdicts.items() if passed != (key[1] == "solution")}
    assert not wrong, walk.text
    assert {key[0] for key in walk.verdicts} == {task.name for task in reading.page(name).tasks}
    assert "This is the end of the " in walk.text
