"""What an exercise asks for is compared with what a run was: ways, drawings, values, and the run that is drawn again."""

from __future__ import annotations

import math

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.grading import drawings, expressions, forms, judging, paths, performing
from cramhy_runtime.grading.exercise import Exercise, own_exercises
from cramhy_runtime.grading.problems import ExerciseError
from cramhy_runtime.grading.replay import Replay, WrongReport
from cramhy_runtime.grading.told import Told
from cramhy_runtime.turtlesim.node import running_simulator


@pytest.mark.parametrize(
    ("way", "points"),
    [
        ("forward 2 left 90 forward :size", [(1, 1), (3, 1), (3, 4)]),
        ("back 1", [(1, 1), (0, 1)]),
        ("repeat 2 [ forward size right 90 ]", [(1, 1), (4, 1), (4, -2)]),
        ("to 2 2 to size*2 0", [(1, 1), (3, 3), (7, 1)]),
        ("face 90 forward 1", [(1, 1), (1, 2)]),
    ],
)
def test_a_way_is_a_line(way, points):
    ((colour, line),) = paths.lines(way, {"size": 3}, (1, 1, 0))
    assert colour is None and [pytest.approx(point) for point in line] == points


def test_a_way_lifts_its_pen_and_changes_its_colour():
    found = paths.lines("forward 1 up forward 1 down colour 255 0 0 forward 1", {}, (0, 0, math.pi / 2))
    assert [colour for colour, _ in found] == [None, (255, 0, 0)]
    assert found[1][1] == [pytest.approx((0, 2)), pytest.approx((0, 3))]


def test_an_arc_is_a_part_of_a_circle():
    ((_, line),) = paths.lines("arc 2 180", {}, (0, 0, 0))
    assert line[-1] == pytest.approx((0, 4)) and all(math.dist(point, (0, 2)) == pytest.approx(2) for point in line)
    ((_, line),) = paths.lines("arc -2 90", {}, (0, 0, 0))
    assert line[-1] == pytest.approx((2, -2))


@pytest.mark.parametrize(
    ("way", "words"),
    [
        ("fly 2", "has no word 'fly'"),
        ("forward", "needs 1 numbers"),
        ("repeat 4 forward", "repeat needs"),
        ("repeat 4 [ forward 1", "not closed"),
        ("forward 1 ]", "closes nothing"),
        ("forward side", "no value side"),
        ("repeat 1000000 [ left 1 ]", "more than 20000 steps"),
        ("forward __import__('os')", "cannot be computed"),
    ],
)
def test_a_wrong_way_is_told(way, words):
    with pytest.raises(ExerciseError, match=words.replace("(", r"\(")):
        paths.lines(way, {}, (0, 0, 0))


def test_formulas_are_arithmetic_and_nothing_else():
    assert expressions.computed("hypot(x, 4) + 2 * -y", {"x": 3, "y": 1}) == 3
    assert expressions.filled("(go {x} {x / 2} {name})", {"x": 3, "name": ":left"}) == "(go 3 1.5 :left)"
    for formula in ("().__class__", "[1]", "open('x')", "x.y", "'a' * 3", "1 / 0", "lambda: 1"):
        with pytest.raises(ExerciseError):
            expressions.computed(formula, {"x": 1})


def test_a_seed_always_gives_the_same_values():
    vary = {"size": {"from": 1, "to": 3, "step": 0.5}, "colour": ["red", "green"], "angle": {"from": -1.0, "to": 1.0}}
    found = [expressions.drawn(vary, seed) for seed in range(1, 30)]
    assert found == [expressions.drawn(vary, seed) for seed in range(1, 30)]
    assert {values["size"] for values in found} == {1, 1.5, 2, 2.5, 3} and {values["colour"] for values in found} == {"red", "green"}
    assert all(-1 <= values["angle"] <= 1 for values in found)


SQUARE = paths.lines("repeat 4 [ forward 2 left 90 ]", {}, (2, 2, 0))


def test_the_order_and_the_direction_of_lines_do_not_count():
    other = paths.lines("left 90 repeat 8 [ forward 2 right 90 ]", {}, (2, 2, 0))
    assert drawings.difference(SQUARE, other, 0.1) == (0, None, 0, None)


def test_what_is_missing_and_what_is_too_much_is_measured():
    other = paths.lines("repeat 3 [ forward 2 left 90 ]", {}, (2, 2, 0))
    found = drawings.difference(SQUARE, other, 0.1)
    assert found.missing == pytest.approx(1.8, abs=0.15) and found.missing_at[0] == pytest.approx(2) and found.much == 0
    found = drawings.difference(other, SQUARE, 0.1)
    assert found.much == pytest.approx(1.8, abs=0.15) and found.missing == 0
    assert drawings.difference(SQUARE, [], 0.1).missing == pytest.approx(8, abs=0.1)


def test_a_line_beside_its_target_is_right_within_the_tolerance():
    moved = paths.lines("repeat 4 [ forward 2 left 90 ]", {}, (2.1, 2, 0))
    assert drawings.difference(SQUARE, moved, 0.15).missing == 0
    assert drawings.difference(SQUARE, moved, 0.05).missing > 3


def test_a_circle_is_no_square():
    """With the tolerance of the exercise. At 0.25 m a circle was one."""
    circle = [(None, [(3 + 1.207 * math.cos(part / 20), 3 + 1.207 * math.sin(part / 20)) for part in range(127)])]
    exercise = Exercise.read(own_exercises()["square"])
    tolerance = exercise.checks[0].table["paper"]["tolerance"]
    assert drawings.difference(SQUARE, circle, 0.25) == (0, None, 0, None)
    found = drawings.difference(SQUARE, circle, tolerance)
    assert min(found.missing, found.much) > judging.SLACK


def test_colours_count_if_the_target_names_them():
    red = [((255, 0, 0), SQUARE[0][1])]
    blue = [((0, 0, 255), SQUARE[0][1])]
    assert drawings.difference(SQUARE, blue, 0.1).missing == 0
    assert drawings.difference(red, blue, 0.1).missing == pytest.approx(8, abs=0.1)


@pytest.mark.parametrize(
    ("one", "other", "equal"),
    [
        ("5", "5.0d0", True),
        ("(1 2)", "(1.0  2.0)", True),
        ("1/2", "0.5", True),
        (":LEFT", ":left", True),
        ("(CIRCLE 2)", "(CIRCLE 3)", False),
        ("room2", "room3", False),
        ("5", "five", False),
        ("(1 2)", "(1 2 3)", False),
        ("1e3", "1000", True),
        ("1/0", "1", False),
    ],
)
def test_printed_values_are_compared_as_values(one, other, equal):
    assert judging.same(one, other, 1e-6) == equal


# ---------------------------------------------------------------------------------------------------- the run, drawn again

PLAN = """(progn
  (roslisp:call-service "turtle1/set_pen" "turtlesim/SetPen" :r 255 :g 0 :b 0 :width 5 :off 0)
  (let ((commands (roslisp:advertise "turtle1/cmd_vel" "geometry_msgs/Twist"))
        (others (roslisp:advertise "turtle2/cmd_vel" "geometry_msgs/Twist")))
    (flet ((drive (to speed turn)
             (roslisp:publish to (roslisp:make-message "geometry_msgs/Twist" (:x :linear) speed (:z :angular) turn))))
      (drive commands 2 1.5) (sleep 0.7)
      (roslisp:call-service "spawn" "turtlesim/Spawn" :x 4 :y 5 :theta 2 :name "turtle2")
      (drive others 3 -1) (drive commands 1 0) (sleep 1.3)
      (roslisp:call-service "turtle1/teleport_relative" "turtlesim/TeleportRelative" :linear 1 :angular 2)
      (dotimes (i 20) (drive commands 3 0.1) (sleep 0.25))
      (roslisp:call-service "kill" "turtlesim/Kill" :name "turtle2")
      (drive commands 1 1) (sleep 0.5) :drawn)))"""
TROUBLES = [
    {"kind": "push", "at": 0.5, "x": 0.3, "y": -0.4, "turn": 1.0},
    {"kind": "slip", "forward": 0.7, "turn": 1.2, "to": 4.0},
    {"kind": "lost", "from": 3.0, "to": 5.0, "share": 0.5},
    {"kind": "pen", "at": 5.5, "r": 0, "g": 255, "b": 0, "width": 2},
]


def reports(troubles=(), **changes):
    """What a process would tell of `PLAN`, and the lines on the paper of its simulator."""
    import json

    job = {
        "seed": 3, "systems": [], "package": None, "files": {}, "load": [], "prelude": [], "before": ['(roslisp:start-ros-node "test")'],
        "do": PLAN, "after": 1.1, "asks": [], "tests": None, "start": [6.0, 5.0, 0.5], "troubles": list(troubles), "faults": [],
        "turtle_time": 100.0,
    } | changes  # fmt: skip
    lines, paper = [], []

    def tell(kind, **facts):
        if kind == "done":
            simulator = running_simulator()
            paper.extend(simulator.canvas.strokes() if simulator else [])
        lines.append(f"x {json.dumps({'kind': kind, **facts})}")

    performing.perform(job, "/nowhere", tell, apart=False)
    kernel.stop()
    return job, Told(lines, "x"), paper


@pytest.mark.parametrize("troubles", [[], TROUBLES], ids=["calm", "storm"])
def test_the_run_is_drawn_again_line_by_line(troubles):
    job, told, paper = reports(troubles)
    assert told.value["values"] == [":DRAWN"] and told.done
    replay = Replay(tuple(job["start"]), told.heard, told.run["ticks"], told.run["begin"], troubles, 3)
    mine, others = ([(colour, [(x1, y1), (x2, y2)]) for x1, y1, x2, y2, colour, _ in paper], replay.drawing())
    assert drawings.difference(mine, others, 0.02) == (0, None, 0, None)
    assert drawings.difference(others, mine, 0.02) == (0, None, 0, None)
    assert replay.commands == 24 and replay.services == {"set_pen": 1, "spawn": 1, "teleport_relative": 1, "kill": 1}
    assert replay.walls > 0 and list(replay.turtles) == ["turtle1"]
    lengths = sum(math.dist(*line) for _, line in mine)
    assert replay.distance() + replay.distance("turtle2") == pytest.approx(lengths, rel=0.2)


def test_a_fault_of_the_plan_happens_and_is_told():
    _, told, _ = reports(
        faults=[{"task": "*", "park": "sleep", "nth": 1, "action": "fail"}], do="(cpl:top-level (cpl:seq (cpl:sleep 1) 2))"
    )
    assert told.error["types"][0] == "INJECTED-FAILURE" and told.faults == {"happened": [True]}


@pytest.mark.parametrize(
    ("heard", "begin"), [([[9, "kill", "turtle1"], [5, "kill", "turtle1"]], 3), ([[101, "kill", "turtle1"]], 3), ([], 101)]
)
def test_a_report_that_no_simulator_makes_is_refused(heard, begin):
    with pytest.raises(WrongReport):
        Replay((5, 5, 0), heard, 100, begin)


# -------------------------------------------------------------------------------------------------------------- the source


def test_the_text_of_a_program_is_taken_apart_whatever_it_is():
    text = '(defun a (x) "wait-for" #\\) #| (sleep 1) |# ; (sleep 2)\n (cpl:wait-for x) \'(|odd ( name| 1.5) #.(quit)'
    assert set(forms.words_of(forms.forms_of(text, "a.lisp"))) >= {"defun", "a", "x", "wait-for", "quit"}
    submitted = {"a.lisp": text}
    assert forms.source_faults({"uses": ["wait-for"], "avoids": ["sleep"]}, submitted) == []
    assert forms.source_faults({"uses": ["pursue"], "avoids": ["wait-for"]}, submitted) == [
        "The program does not use pursue.",
        "The program uses wait-for, which it should do without.",
    ]
    forms.forms_of("(" * 5000 + ")" * 6000 + '"', "a.lisp")
    assert "wait_for" in set(forms.words_of(forms.forms_of("def f(x):\n    return cpl.wait_for(x)\n", "a.py")))
