"""Each task of the course: its solution passes; nothing, the code to begin with, and wrong solutions do not. All is typed into the prompt."""

from __future__ import annotations


import pytest

from cramhy_runtime.course import contents, reading

from .walking import Walk

IN_BOTH = [
    # task, what stands in the solution, what stands there instead
    ("seconds-of-a-day", "24", "23"),
    ("rectangle", "(+ width height)", "(+ width 3)"),
    ("turn-left", "1.57", "-1.57"),
    ("first-square", "(ahead 2)", "(ahead 1)"),
    ("any-polygon", "(/ 360 corners)", "(/ 180 corners)"),
    ("the-way-home", "5.5 5.5", "5.5 4.5"),
    ("so-many-seconds", "(sleep seconds)", "(sleep 9)"),
    ("thick-line", "255 255 0", "255 0 0"),
    ("upper-part", "8", "2"),
    ("figure-eight", "-1.047", "1.047"),
    ("there-in-time", "pursue", "par"),
    ("turn-until-up", "1.57", "0.5"),
    ("too-large", "?size 5", "?size 50"),
    ("braking", "braking)", "driving)"),
    ("backwards", ":speed ?back", ":speed ?speed"),
    ("red-arc", "(angle 1)", "(angle 2)"),
    ("shaking-module", "(wait-duration 1)", "(wait-duration 0.1)"),
    ("two-colours", "(g 255)", "(g 0)"),
    ("dancing", "dancing)", "flying)"),
    ("blue-dash", "(b 255)", "(b 0)"),
    ("planning-module", "planned", "done"),
    ("two-places", ":top", ":bottom"),
    ("middle-of-the-field", "0.5", "0"),
    ("square-action", "(height ?side)", "(height 1)"),
    ("stairs", "(+ y step 1)", "(+ y step)"),
    ("try-again", "again 3", "again 1"),
    ("move-surely", "(rotate-to goal)", "goal"),
    ("checking-the-left", "(/ pi 2)", "0"),
    ("put-brick", "0.05 0.03", "0.05 0"),
    ("take-surely", "looks 3", "looks 0"),
]
IN_LISP = [
    ("around-a-square", "(* 4 *side*)", "(* 3 *side*)"),
    ("turn-left", "(sleep 1)", "nil"),
    ("stop-at-a-line", "    (send-vel-cmd 0 0)", "    nil"),
    ("there-or-too-late", ":too-late", ":late"),
    ("visit-points", "(first point) (second point)", "(second point) (first point)"),
    ("no-ink", "(fail 'no-ink)", '(error "no ink")'),
    ("checking-no-pose", '(angle-to 1 7 "here")', '(error "here")'),
    ("take-surely", "(setf place (brick-place))", "nil"),
    ("put-brick", "0.05 0)", "0.05 0.03)"),
]
IN_HY = [
    ("around-a-square", "(* 4 side)", "(* 3 side)"),
    ("turn-left", "(sleep 1)", "None"),
    ("stop-at-a-line", "    (tut.send-vel-cmd 0 0)", "    None"),
    ("there-or-too-late", '"too late"', '"late"'),
    ("visit-points", "[[x y] points]", "[[y x] points]"),
    ("no-ink", "(fail (NoInk))", "(raise (ValueError))"),
    ("checking-no-pose", "(assert False)", "None"),
    ("take-surely", "(.append places (brick-place))", "None"),
    ("put-brick", "0.05 0)", "0.05 0.03)"),
]
WRONG = [
    *((task, language, *texts) for task, *texts in IN_BOTH for language in ("lisp", "hy")),
    *((task, "lisp", *texts) for task, *texts in IN_LISP),
    *((task, "hy", *texts) for task, *texts in IN_HY),
]
"""Solutions that no check may pass: (task, language, what stands in the right solution, what stands there instead)."""


def test_each_task_has_a_wrong_solution_in_both_languages():
    tasks = {task.name for page in reading.pages() for task in page.tasks}
    assert {(task, language) for task, language, *_ in WRONG} == {(task, language) for task in tasks for language in ("lisp", "hy")}


@pytest.mark.parametrize("language", ["lisp", "hy"])
@pytest.mark.parametrize("name", contents.NAMES)
def test_a_student_who_types_everything_comes_through_the_page(name, language, tmp_path):
    if name in contents.WITH_ROBOT:
        pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")
    walk = Walk(name, language, tmp_path, WRONG)
    assert walk.status == 0
    wrong = {key: passed for key, passed in walk.verdicts.items() if passed != (key[1] == "solution")}
    assert not wrong, walk.text
    assert {key[0] for key in walk.verdicts} == {task.name for task in reading.page(name).tasks}
    assert "This is the end of the " in walk.text
