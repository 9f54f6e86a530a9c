"""CRAM's applications run past loading: what their readers type, and what must come.

The forms and their answers are in ``typed`` (`typed_lists`). ``(lies 'name)`` is where an object lies, in centimetres as metres; ``(stands-in 'name "link")`` is
true if its middle is over a link of the furniture, and its lowest point within the heights of that link, or on top of it.

``cram_cup_demo`` is a package of our own with the habits of CRAM's, in ``workspace``. The others are CRAM's, which are not ours to ship:
CRAMHY_APPLICATIONS names a folder with checkouts of cram2/cram (``cram-master``, ``cram-devel``), of the EASE Fall School (``cram_teaching``) and of ``roslisp_tutorials``.
"""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

import numpy as np
import pytest

from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image
from typed_lists import run

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

from cramhy_runtime.robot_world import models  # noqa: E402

HERE = Path(__file__).parent
LIES = """
(defun common-lisp-user::lies (name)
  (let ((place (cl-transforms:origin (btr:pose (btr:object btr:*current-bullet-world* name)))))
    (mapcar (lambda (number) (/ (round number 0.01) 100.0)) (list (cl-transforms:x place) (cl-transforms:y place) (cl-transforms:z place)))))

(defun common-lisp-user::stands-in (name link)
  (flet ((ends (box axis)
           (let ((middle (funcall axis (btr:bounding-box-center box))) (half (/ (funcall axis (btr:bounding-box-dimensions box)) 2)))
             (list (- middle half) (+ middle half)))))
    (let* ((body (or (gethash link (btr:links (btr:get-environment-object))) (error "There is no link ~a with shapes." link)))
           (thing (btr:aabb (btr:object btr:*current-bullet-world* name))) (around (btr:aabb body)))
      (and (loop for axis in '(cl-transforms:x cl-transforms:y)
                 for (low high) = (ends around axis)
                 always (< low (funcall axis (btr:bounding-box-center thing)) high))
           (destructuring-bind (low high) (ends around 'cl-transforms:z)
             (< (- low 0.01) (first (ends thing 'cl-transforms:z)) (+ high 0.01)))))))
"""
CHECKOUTS = os.environ.get("CRAMHY_APPLICATIONS")
foreign = pytest.mark.skipif(not CHECKOUTS, reason="CRAMHY_APPLICATIONS names no folder with checkouts of CRAM's applications")


@pytest.fixture
def begin(monkeypatch):
    """A function: a session in an image of its own, in which the packages below a folder are found. Two applications exclude each other."""

    def session(folder):
        monkeypatch.setenv("ROS_PACKAGE_PATH", str(folder))
        made = Session(time="virtual", seed=1, turtlesim=False)
        made.evaluate_text(LIES)
        return made

    with Image():
        yield session


def test_a_package_with_the_habits_of_crams_demos_runs(begin, capsys):
    assert run(begin(HERE / "workspace" / "src"), "cram_cup_demo") == []
    printed = capsys.readouterr().out
    assert printed.count("This is said once.") == 2  # json-prolog and ccl
    assert printed.count("undefined functor") == 0 and "A keyword is no string" not in printed
    assert "performing POSITIONING-ARM" in printed and "performing MOVING-TORSO" in printed


@foreign
@pytest.mark.parametrize("application", ["cram_bullet_world_tutorial", "cram_pick_place_tutorial", "cram_pr2_pick_place_demo"])
def test_crams_own_applications_run(begin, application, capsys):
    assert run(begin(Path(CHECKOUTS) / "cram-master"), application) == []
    printed = capsys.readouterr()
    assert (printed.out + printed.err).count("undefined functor") == 0


CARRIED = list(range(1, 21))
"""Seeds of random places from which the demo carries all five objects; one of them is looked at where time is short."""


@foreign
@pytest.mark.parametrize("seed", CARRIED if os.environ.get("CRAMHY_SOAK") else CARRIED[:1])
def test_the_demo_with_random_places_carries_all_five(monkeypatch, seed):
    """Where they lie afterwards is what counts: on the island, 0.84 m high, and in no hand."""
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(Path(CHECKOUTS) / "cram-master"))
    with Image():
        session = Session(time="virtual", seed=seed, turtlesim=False)
        session.evaluate_text(LIES)
        session.evaluate_text("(asdf:load-system :cram-pr2-pick-place-demo) (in-package :demo) (roslisp-utilities:startup-ros)")
        session.evaluate_text("(urdf-proj:with-simulated-robot (demo-random))")
        names = "'(:cereal-1 :cup-1 :bowl-1 :spoon-1 :milk-1)"
        places = prin1_to_string(session.evaluate_text(f"(mapcar #'cl-user::lies {names})")[0])
        held = session.evaluate_text("(btr:attached-objects (btr:get-robot-object))")[0]
    found = [[float(number) for number in place.split()] for place in re.findall(r"\(([-\d. ]+)\)", re.sub(r"d0", "", places))]
    assert held is None and len(found) == 5
    assert all(x < -0.4 and 0 < y < 3 and z > 0.84 for x, y, z in found), places


@pytest.mark.parametrize("toward, tool", [(1, 0.55), (-1, 0.61)], ids=["from before it", "from behind it"])
def test_the_first_placing_of_demo_hard_coded_is_beyond_the_arm_of_the_pr2(toward, tool):
    """CRAM's demo-hard-coded puts the cereal down with the right arm 0.6 m to the left of the base; so it fails there in the original, too.

    The hand, 0.18 m long, points along x. However high the torso is, the wrist would be further away from the axis of the shoulder than the
    links between them are long.
    """
    joints = models.described("pr2").joints
    arm = sum(joints[f"r_{name}_joint"].frame.position[0] for name in ("shoulder_lift", "elbow_flex", "wrist_flex"))
    x, y, _ = np.add(joints["torso_lift_joint"].frame.position, joints["r_shoulder_pan_joint"].frame.position)
    assert arm == pytest.approx(0.821)
    assert np.hypot(tool - 0.18 * toward - x, 0.6 - y) > arm + 0.07


@foreign
@pytest.mark.parametrize("application", ["cram_bullet_world_tutorial", "cram_pick_place_tutorial", "cram_pick_place_tutorial_right_arm"])
def test_applications_of_crams_branch_devel_run(begin, application, capsys):
    """Their robot and kitchen are known by other names, and CRAM's own interfaces and plans come from the checkout."""
    assert run(begin(Path(CHECKOUTS) / "cram-devel"), f"devel/{application}") == []
    printed = capsys.readouterr()
    assert (printed.out + printed.err).count("undefined functor") == 0


@foreign
def test_the_household_demo_of_devel_sets_the_table_and_clears_it(begin):
    """With the milk: from the fridge to the table, and from there into the trash drawer; afterwards all doors are shut."""
    assert run(begin(Path(CHECKOUTS) / "cram-devel"), "devel/cram_projection_demos") == []


@foreign
def test_the_tutorials_of_roslisp_run(begin, capsys):
    """Its programs are typed at one prompt, the talker in a thread, since each waits for another terminal."""
    assert run(begin(Path(CHECKOUTS) / "roslisp_tutorials"), "roslisp_tutorials") == []
    assert "Param ~foo value is now 43" in capsys.readouterr().out


LESSONS = {
    "01-Lesson_01_Lisp_Introduction": {"UnboundVariable": 2, "UndefinedFunction": 1},
    "02-Lesson_02_CRAM_Basics": {"DesignatorError": 1},
    "03-Lesson_03_Pick_n_Place": {},
}
"""The lessons of the EASE Fall School, and the errors in them that their texts announce."""


def cells(notebook):
    """The code of the cells of a notebook."""
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    return [text for cell in cells if cell["cell_type"] == "code" and (text := "".join(cell["source"])).strip()]


@foreign
@pytest.mark.parametrize("lesson", LESSONS)
def test_the_lessons_of_the_ease_fall_school_run(begin, lesson, tmp_path):
    session, errors = begin(tmp_path), {}
    for text in cells(Path(CHECKOUTS) / "cram_teaching" / "lectures" / "tutorials" / f"{lesson}.ipynb"):
        try:
            session.evaluate_text(text)
        except Condition as problem:
            errors[type(problem).__name__] = errors.get(type(problem).__name__, 0) + 1
    assert errors == LESSONS[lesson]


@pytest.mark.soak
def test_the_lessons_world_is_set_and_made_anew(begin, tmp_path):
    """The system that the lessons load comes with cramhy, for those who have no checkout."""
    session = begin(tmp_path)
    session.evaluate_text("(asdf:load-system :cram-pr2-pick-place-demo) (in-package :demo) (roslisp-utilities:startup-ros)")
    session.evaluate_text("(urdf-proj:with-simulated-robot (setting-demo '(:bowl)))")
    assert prin1_to_string(session.evaluate_text("(cl-user::lies :bowl-1)")[0]) == "(-0.8 1.2 0.89)"
    session.evaluate_text("(initialize)")
    names = session.evaluate_text("(mapcar #'btr:name (btr:objects btr:*current-bullet-world*))")
    assert prin1_to_string(names[0]) == "(:FLOOR :KITCHEN CRAM-PR2-DESCRIPTION:PR2)"


def test_a_checkout_of_the_demo_comes_before_ours(begin, tmp_path):
    (tmp_path / "cram_pr2_pick_place_demo").mkdir()
    (tmp_path / "cram_pr2_pick_place_demo" / "cram-pr2-pick-place-demo.asd").write_text(
        '(defsystem cram-pr2-pick-place-demo :description "theirs")'
    )
    session = begin(tmp_path)
    description = '(asdf:system-description (asdf:find-system "cram-pr2-pick-place-demo"))'
    assert prin1_to_string(session.evaluate_text(description)[0]) == '"theirs"'


@pytest.mark.parametrize("sign, description", [("cram-manipulation-interfaces", '"theirs"'), ("cram-object-interfaces", '"ours"')])
def test_the_interfaces_of_a_checkout_of_devel_come_before_ours(begin, tmp_path, capsys, sign, description):
    """Those of master do not: cramhy contains them, rewritten."""
    for name in (sign, "cram-common-failures"):
        (tmp_path / name).mkdir()
        (tmp_path / name / f"{name}.asd").write_text(f'(defsystem {name} :description "theirs")')
    session = begin(tmp_path)
    session.evaluate_text('(asdf:load-system "cram-common-failures")')
    found = '(if (equal (asdf:system-description (asdf:find-system "cram-common-failures")) "theirs") "theirs" "ours")'
    assert prin1_to_string(session.evaluate_text(found)[0]) == description
    assert ("The system cram-common-failures is that of" in capsys.readouterr().err) is (description == '"theirs"')
