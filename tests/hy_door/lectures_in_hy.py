"""Every form of both lectures, as the slides have it, and beside it the same in plain Hy.

A step has both; ``None`` where one side has no such thing. What stands in the files of the slides is read from there, form by form.
Where a form of the slides has a parenthesis too many, so has that in Hy.
"""

from __future__ import annotations

import re
from typing import NamedTuple


class Step(NamedTuple):
    """lisp, hy: what is typed. ends: how the answer to the Hy ends, where it is another one than that to the Lisp."""

    lisp: str | None
    hy: str | None
    ends: str | None = None


LOAD = '(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)'
IN_PACKAGE = "(in-package :tut)"

NOT_IN_HY = "NOT-IN-HY"
"""Beside forms that Hy has no counterpart of: a system is a Python package, and a package is chosen by ``lisp-package``."""


def forms(slides, name):
    """The texts of the forms of a file of the slides; each begins a line."""
    return [part.rstrip() for part in re.split(r"^(?=\()", (slides / name).read_text(), flags=re.M) if part.strip()]


def beside(slides, name, *in_hy):
    """The steps of a file of the slides, with what its forms are in Hy."""
    in_lisp = forms(slides, name)
    assert len(in_lisp) == len(in_hy), f"{name} has {len(in_lisp)} forms"
    return [Step(lisp, None if hy is NOT_IN_HY else hy + surplus(lisp)) for lisp, hy in zip(in_lisp, in_hy)]


def surplus(text):
    """The closing parentheses at the end of ``text`` that nothing opens."""
    code = re.sub(r'"[^"]*"|;.*', "", text)
    return ")" * (code.count(")") - code.count("("))


# ----------------------------------------------------------------------------------------------------------------- lecture 34

INIT = """\
(defn init-ros-turtle [name]
  "Subscribes to topics for a turtle and binds callbacks.
  'name' specifies the name of the turtle."
  (global color-sub pose-sub cmd-vel-pub pen-srv)
  (setv color-sub (subscribe f"{name}/color_sensor"
                             "turtlesim/Color"
                             color-cb))
  (setv pose-sub (subscribe f"{name}/pose"
                            "turtlesim/Pose"
                            pose-cb))
  (setv cmd-vel-pub (advertise f"{name}/cmd_vel"
                               "geometry_msgs/Twist"))
  (setx pen-srv (+ "/" name "/set_pen")))"""

SEND_VEL_CMD = """\
(defn send-vel-cmd [lin ang]
  "Function to send velocity commands."
  (publish cmd-vel-pub
    ;; short syntax:
    ;; (make-message "geometry_msgs/Twist" (:x :linear) lin (:z :angular) ang)
    ;; more understandable syntax:
    (make-message "geometry_msgs/Twist"
      :linear (make-msg "geometry_msgs/Vector3" :x lin)
      :angular (make-msg "geometry_msgs/Vector3" :z ang))))"""

CALL_SET_PEN = """\
(defn call-set-pen [r g b width off]
  "Function to call the SetPen service."
  (call-service pen-srv 'turtlesim-srv:SetPen
    :r r
    :g g
    :b b
    :width width
    :off off))"""

VARIABLES = (
    "(lisp-package :tut)",
    "(setv color-value (make-fluent :name :color-value))",
    "(setv turtle-pose (make-fluent :name :turtle-pose))",
    "(setv color-sub None)",
    "(setv pose-sub None)",
    "(setv cmd-vel-pub None)",
    "(setv pen-srv None)",
)

CIRCLE = Step("(dotimes (i 10) (send-vel-cmd 1 1) (sleep 1))", "(for [i (range 10)] (send-vel-cmd 1 1) (sleep 1))")
ARROW_KEYS = "(turtlesim:press :left) (sleep 1.1) (turtlesim:press :left) (sleep 1.1) (turtlesim:press :up) (sleep 1.1)"


def lecture_34(slides):
    control = "lecture-34/2-control/src/control-turtlesim"
    return [
        Step(LOAD, LOAD),
        *beside(slides, "lecture-34/1-create/src/package.lisp", *forms(slides, "lecture-34/1-create/src/package.lisp")),
        Step("(in-package :asdf-user)", None),
        *beside(slides, "lecture-34/1-create/cram-my-beginner-tutorial.asd", NOT_IN_HY),
        *beside(slides, "lecture-34/1-create/src/control-turtlesim.lisp", "(lisp-package :tut)"),
        Step("(in-package :asdf-user)", None),
        *beside(slides, "lecture-34/2-control/cram-my-beginner-tutorial.asd", NOT_IN_HY),
        *beside(slides, "lecture-34/2-control/src/package.lisp", *forms(slides, "lecture-34/2-control/src/package.lisp")),
        *beside(slides, f"{control}-one-paren-too-many.lisp", *VARIABLES, INIT),
        *beside(
            slides,
            f"{control}.lisp",
            *VARIABLES,
            INIT,
            '(defn color-cb [msg]\n  "Callback for color values. Called by the color topic subscriber."\n  (setv color-value.value msg))',
            '(defn pose-cb [msg]\n  "Callback for pose values. Called by the pose topic subscriber."\n  (setv turtle-pose.value msg))',
            SEND_VEL_CMD,
            CALL_SET_PEN,
        ),
        Step('(start-ros-node "cram_tutorial_client")', '(start-ros-node "cram_tutorial_client")'),
        Step('(init-ros-turtle "turtle1")', '(init-ros-turtle "turtle1")'),
        Step("(value *turtle-pose*)", "(value turtle-pose)"),
        Step("(value *color-value*)", "(value color-value)"),
        Step(
            "(value turtle-pose)",
            "(value *turtle-pose*)",
            "NameError: name '*turtle-pose*' is not defined\n  Did you mean turtle-pose?\n=> ",
        ),
        Step(f"(progn {ARROW_KEYS})", f"(do {ARROW_KEYS})"),
        Step("(value *turtle-pose*)", "(value turtle-pose)"),
        Step(
            "(wait-for (< (fl-funcall #'turtlesim-msg:x *turtle-pose*) 5.0))",
            "(wait-for (< (fl-funcall (fn [pose] pose.x) turtle-pose) 5.0))",
        ),
        CIRCLE,
        Step("(call-set-pen 255 0 0 10 0)", "(call-set-pen 255 0 0 10 0)"),
        CIRCLE,
        Step("(value *turtle-pose*)", "(value turtle-pose)"),
        Step("(value *color-value*)", "(value color-value)"),
    ]


# ----------------------------------------------------------------------------------------------------------------- lecture 38

NAVIGATION = """\
(def-process-module turtlesim-navigation [motion-designator]
  (roslisp:ros-info (turtle-process-modules)
    "TurtleSim navigation invoked with motion designator {quote}~a'."
    motion-designator)
  (let [[command motion] (reference motion-designator)]
    (ecase command
      (lisp drive)
        (send-vel-cmd
          motion.speed
          motion.angle){move})))"""
NAVIGATION_1 = NAVIGATION.format(quote="`", move="")
NAVIGATION_2 = NAVIGATION.format(quote="'", move="")
NAVIGATION_3 = NAVIGATION.format(quote="`", move="\n      (lisp move)\n        (move-to motion)")

PEN_CONTROL = """\
(def-process-module turtlesim-pen-control [motion-designator]
  (roslisp:ros-info (turtle-process-modules)
    "TurtleSim pen control invoked with motion designator `~a'."
    motion-designator)
  (let [[command motion] (reference motion-designator)]
    (ecase command
      (lisp set-pen)
        (call-set-pen
          motion.r
          motion.g
          motion.b
          motion.width
          motion.off))))"""

DRIVE = """\
(defn drive [?speed ?angle]
  (top-level
    (with-process-modules-running [turtlesim-navigation]
      (let [trajectory (desig:a motion (type driving) (speed ?speed) (angle ?angle))]
        (pm-execute 'turtlesim-navigation trajectory)))))"""

SLIP = DRIVE.replace("desig:", "design:")
"""A slip on a slide. Lisp does not read it; to Hy it is the name of a function, which is looked for when it is called."""

FACTS = """\
(def-fact-group turtle-motion-designators [motion-grounding]
  ;; for each kind of motion, check for and extract the necessary info

  ;; drive and turn
  (<- (desig:motion-grounding ?desig [drive ?motion])
    (desig-prop ?desig [:type :driving])
    (desig-prop ?desig [:speed ?speed])
    (desig-prop ?desig [:angle ?angle])
    (lisp-fun make-turtle-motion :speed ?speed :angle ?angle ?motion))

  ;; drive
  (<- (desig:motion-grounding ?desig [drive ?motion])
    (desig-prop ?desig [:type :driving])
    (desig-prop ?desig [:speed ?speed])
    (lisp-fun make-turtle-motion :speed ?speed ?motion))

  ;; turn
  (<- (desig:motion-grounding ?desig [drive ?motion])
    (desig-prop ?desig [:type :driving])
    (desig-prop ?desig [:angle ?angle])
    (lisp-fun make-turtle-motion :angle ?angle ?motion))

  ;; move
  (<- (desig:motion-grounding ?desig [move ?motion])
    (desig-prop ?desig [:type :moving])
    (desig-prop ?desig [:goal ?goal])
    (lisp-fun apply make-3d-vector ?goal ?motion)))"""

PAR_SAME_MODULE = """\
(top-level
      (with-process-modules-running [turtlesim-navigation turtlesim-pen-control]
        (let [goal (desig:a motion (type moving) (goal (9 1 0)))
              trajectory (desig:a motion (type driving) (speed 3) (angle 8))]
          (cpl:par
            (pm-execute 'turtlesim-navigation goal)
            (pm-execute 'turtlesim-navigation trajectory)))))"""

PAR_TWO_MODULES = """\
(top-level
      (with-process-modules-running [turtlesim-navigation turtlesim-pen-control]
        (let [goal (desig:a motion (type moving) (goal (9 9 0)))]
          (cpl:par
            (pm-execute 'turtlesim-navigation goal)
            (for [i (range 10)]
              (pm-execute 'turtlesim-pen-control
                (let [?r (randrange 255)
                      ?g (randrange 255)
                      ?b (randrange 255)
                      ?width (randrange 3 8)]
                  (desig:a motion (type setting-pen) (r ?r) (g ?g) (b ?b) (width ?width))))
              (sleep 0.5))))))"""

LOOK = Step(
    """\
(top-level
      (with-process-modules-running (turtlesim-navigation turtlesim-pen-control)
        (let ((goal (desig:a motion (type moving) (goal (3 9 0)))))
          (cpl:par
            (pm-execute 'turtlesim-navigation goal)
            (progn (sleep 1) (cpl:describe-task-tree))))))""",
    """\
(top-level
      (with-process-modules-running [turtlesim-navigation turtlesim-pen-control]
        (let [goal (desig:a motion (type moving) (goal (3 9 0)))]
          (cpl:par
            (pm-execute 'turtlesim-navigation goal)
            (do (sleep 1) (cpl:describe-task-tree))))))""",
)

WITH_DESIGNATORS = """\
(with-designators
  [[my-designator :location '(:close-to :fridge)]]
  (pm-execute :navigation my-designator))"""

IMPORTS = "(import cram-my-beginner-tutorial [init-ros-turtle send-vel-cmd call-set-pen move-to *turtle-pose*])"

CLEAR = '(call-service "/clear" \'std_srvs-srv:Empty)'
RESET = '(call-service "/reset" \'std_srvs-srv:Empty)'
PACKAGE = "(lisp-package :tut)"


def lecture_38(slides):
    [example] = forms(slides, "lecture-38/repl/with-designators.lisp")
    modules = "lecture-38/src/process-modules"
    return [
        Step(LOAD, LOAD),
        Step(IN_PACKAGE, PACKAGE),
        Step(None, IMPORTS),
        Step(None, "(require hyrule [ecase])"),
        Step(None, "(import random [randrange])"),
        *beside(slides, "lecture-38/repl/with-designators.lisp", WITH_DESIGNATORS),
        Step(
            "(def-process-module navigation (designator) (description designator))",
            "(def-process-module navigation [designator] (description designator))",
        ),
        Step(
            f"(top-level (with-process-modules-running ((:navigation navigation)) {example}))",
            f"(top-level (with-process-modules-running [[:navigation navigation]] {WITH_DESIGNATORS}))",
        ),
        Step("(in-package :asdf-user)", None),
        *beside(slides, "lecture-38/cram-my-beginner-tutorial.asd", NOT_IN_HY),
        *beside(slides, "lecture-38/src/package.lisp", *forms(slides, "lecture-38/src/package.lisp")),
        *beside(slides, f"{modules}-1-one-paren-too-many.lisp", PACKAGE, NAVIGATION_1),
        *beside(slides, f"{modules}-1.lisp", PACKAGE, NAVIGATION_2),
        *beside(slides, "lecture-38/src/motion-designators-fact-group.lisp", FACTS),
        *beside(slides, f"{modules}-2.lisp", PACKAGE, NAVIGATION_2, DRIVE),
        Step('(start-ros-node "turtle1")', '(start-ros-node "turtle1")'),
        Step('(init-ros-turtle "turtle1")', '(init-ros-turtle "turtle1")'),
        Step("(drive 5 2)", "(drive 5 2)"),
        Step("(sleep 1.5)", "(sleep 1.5)"),
        *beside(slides, f"{modules}-3.lisp", PACKAGE, NAVIGATION_3, PEN_CONTROL, SLIP),
        Step(None, "(drive 5 2)", "NameError: name 'design:a' is not defined\n  Did you mean desig:a or desig:an?\n=> "),
        *beside(slides, f"{modules}-3-parts.lisp", PACKAGE, NAVIGATION_3, PEN_CONTROL, DRIVE),
        Step(CLEAR, CLEAR),
        Step(RESET, RESET),
        *beside(slides, "lecture-38/repl/par-same-module.lisp", PAR_SAME_MODULE),
        Step("(sleep 1.5)", "(sleep 1.5)"),
        *beside(slides, "lecture-38/repl/par-two-modules.lisp", PAR_TWO_MODULES),
        LOOK,
        Step("(value *turtle-pose*)", "(value *turtle-pose*)"),
    ]


LECTURES = {"34": lecture_34, "38": lecture_38}
