"""Mistakes that are put into the files of the course, and what is told of each: (file, what is replaced, by what, what is marked, severity,
a part of the message, the text of a fix or ``None``).

What is marked is a text that stands in the changed file; a number behind it says which one of several.
"""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).parents[2] / "tutorials"
COURSE = ROOT / "cram_my_beginner_tutorial"
PLANS, CONTROL, ACTIONS, MODULES, MOTIONS, PLACES, HIGH, PACKAGE = (
    COURSE / "src" / f"{name}.hy"
    for name in (
        "simple-plans", "control-turtlesim", "action-designators", "process-modules", "motion-designators", "location-designators",
        "high-level-plans", "package",
    )
)  # fmt: skip
SYSTEM, MANIFEST = COURSE / "cram-my-beginner-tutorial.asd", COURSE / "package.xml"
HY, HY_MODULES, HY_MOTIONS = (ROOT / "turtlesim_in_hy" / f"{name}.hy" for name in ("simple_plans", "process_modules", "motion_designators"))

ERROR, WARNING, HINT = 1, 2, 4
STOP = "(send-vel-cmd 0 0)"
MOTION = "(desig:a motion (type driving) (speed ?speed)"
RULE = "(<- (desig:motion-grounding ?desig (drive ?motion))"
HY_RULE = '(<- (desig:motion-grounding ?desig ["drive" ?motion])'
CALLED = "(lisp-fun make-turtle-motion :speed ?speed :angle ?angle ?motion)"
GROUP = "(def-fact-group turtle-motion-designators (motion-grounding)"
ROTATE = "(defun rotate-to (goal &optional (threshold 0.05))"


def stop(new, at, severity, word, fix=None):
    """A mistake in place of the form that stops the turtle."""
    return PLANS, STOP, new, at, severity, word, fix


READER = [
    (PLANS, "theta))))\n", "theta)))\n", "(", ERROR, "a closing bracket ) is missing", ")"),
    (PLANS, "(send-vel-cmd 0 0))))\n\n", "(send-vel-cmd 0 0)))))\n\n", ")", ERROR, "This ) closes nothing", ""),
    (PLANS, "turn to face `goal', a 3d-vector.\"", "turn to face `goal', a 3d-vector.", ".", ERROR, "dot context error", None),
    (PLACES, 'well away from the walls.")', "well away from the walls.)", '"', ERROR, "This string is never closed", None),
    stop("#| comment", "#|", ERROR, "This comment is never closed"),
    stop("(print]", "]", ERROR, "does not close the (", ")"),
    stop("#<unreadable>", "#<unreadable>", ERROR, "illegal sharp macro character"),
    stop("(a . b c)", "c", ERROR, "More than one object follows ."),
    stop("( . b)", ".", ERROR, "Nothing appears before ."),
    stop(",x", ",x", ERROR, "Comma not inside a backquote"),
    stop("#\\nonsense", "#\\nonsense", ERROR, "unrecognized character name"),
    stop("#q1", "#q1", ERROR, "no dispatch function defined"),
]

PACKAGES = [
    (PLANS, "(in-package :tut)", "(in-package :tutt)", "(in-package :tutt)", ERROR, "does not designate any package", "tut"),
    (PLANS, "(in-package :tut)", "(in-package)", "(in-package)", ERROR, "It is written (in-package name)", None),
    (PLANS, "(make-transform", "(nowhere:make-transform", "nowhere:make-transform", ERROR, "NOWHERE does not exist", None),
    stop(
        "(cram-process-module:pm-execute 1 1)",
        "cram-process-module:pm-execute",
        ERROR,
        "Did you mean cram-process-modules?",
        "cram-process-modules",
    ),
    stop("(exe:perfom 1)", "exe:perfom", ERROR, "exports no symbol PERFOM", "exe:perform"),
    stop("(tut:move-to 1)", "tut:move-to", ERROR, "with two colons, tut::move-to", None),
    (
        PACKAGE,
        ":cram-process-modules",
        ":cram-process-modles",
        "(defpackage :cram-my-beginner-tutorial",
        ERROR,
        "does not designate any package",
        "cram-process-modules",
    ),
    (PACKAGE, ":lisp-fun", ":lisp-funn", ":lisp-funn", ERROR, "no symbol named", ":lisp-fun"),
    (PACKAGE, "(:nicknames :tut)", "(:nickname :tut)", ":nickname", ERROR, "There are :nicknames, :use", None),
    (PACKAGE, "(:nicknames :tut)", "(:nicknames :cpl)", ":cpl", ERROR, "already a nickname", None),
]

CALLS = [
    stop("(send-vel-cmd 0)", "(send-vel-cmd 0)", WARNING, "called with one argument, but wants exactly two"),
    stop("(calculate-angular-cmd)", "(calculate-angular-cmd)", WARNING, "but wants at least one"),
    stop("(calculate-angular-cmd 1 2 3)", "(calculate-angular-cmd 1 2 3)", WARNING, "but wants at most two"),
    stop("(car 1 2)", "(car 1 2)", WARNING, "CAR is called with two arguments"),
    stop("(wait-for)", "(wait-for)", WARNING, "WAIT-FOR is called with zero arguments"),
    stop("(flet ((f (x) x)) (f))", "(f)", WARNING, "F is called with zero arguments"),
    stop("(make-fluent :name)", "(make-fluent :name)", WARNING, "odd number of keyword arguments"),
    stop("(make-fluent :nam 1)", ":nam", WARNING, "takes no argument :nam", ":name"),
    (
        HIGH,
        "(exe:perform (desig:a motion (type setting-pen) (off 1)))",
        "(exe:perform)",
        "(exe:perform)",
        WARNING,
        "wants exactly one",
        None,
    ),
]

NAMES = [
    (PLANS, "(value *turtle-pose*)", "(value *turtle-posse*)", "*turtle-posse*", WARNING, "undefined variable", "*turtle-pose*"),
    (PLANS, "(calculate-angular-cmd goal 8)", "(calculate-angular-cmd gaol 8)", "gaol", WARNING, "Did you mean goal?", "goal"),
    (PLANS, "(transform-point ", "(transform-pointt ", "transform-pointt", WARNING, "undefined function", "transform-point"),
    (PLANS, "(unwind-protect", "(unwind-protct", "unwind-protct", WARNING, "undefined function", "unwind-protect"),
    (PLANS, "(pursue\n", "(persue\n", "persue", WARNING, "Did you mean pursue?", "pursue"),
    (PLANS, "#'v-dist", "#'v-distt", "v-distt", WARNING, "Did you mean v-dist?", "v-dist"),
    (PLANS, "(defun rotate-to (goal", "(defunn rotate-to (goal", "defunn", WARNING, "Did you mean defun?", "defun"),
    (CONTROL, "#'color-cb", "#'color-cbb", "color-cbb", WARNING, "Did you mean color-cb?", "color-cb"),
    stop("(setf *nothing-here* 5)", "*nothing-here*", WARNING, "undefined variable"),
    stop("(setf (nofun 1) 5)", "nofun", WARNING, "undefined function: (COMMON-LISP:SETF"),
    stop("(return-from nobody 1)", "nobody", ERROR, "unknown block"),
    stop("(go nowhere)", "nowhere", ERROR, "nonexistent tag"),
    (
        HIGH,
        "(out-of-bounds-error (failure)",
        "(out-of-bound-error (failure)",
        "out-of-bound-error",
        WARNING,
        "undefined type",
        "out-of-bounds-error",
    ),
    (HIGH, "(fail 'out-of-bounds-error)", "(fail 'out-of-bound-error)", "out-of-bound-error", WARNING, "condition", "out-of-bounds-error"),
    stop("(make-instance 'no-such-class)", "no-such-class", WARNING, "Nothing defines the class"),
    (PLACES, "(typep solution '3d-vector)", "(typep solution '3d-vectr)", "3d-vectr", WARNING, "undefined type", "3d-vector"),
]

FORMS = [
    stop("(let ((unused 5)) nil)", "unused", HINT, "defined but never used"),
    stop("(let (unused 5) 1)", "(let (unused 5) 1)", ERROR, "5 cannot be bound"),
    stop("(let ((b 1 2)) b)", "(let ((b 1 2)) b)", ERROR, "A binding is a variable or (variable value)"),
    stop("(let ((b 1) (b 2)) b)", ("b", 1), ERROR, "occurs more than once"),
    stop("(let)", "(let)", ERROR, "LET takes at least 1 part"),
    stop("(cond (1 2) 3)", "(cond (1 2) 3)", ERROR, "It is written (cond (test form...)"),
    stop("(if)", "(if)", ERROR, "IF takes 2 to 3 parts"),
    stop("(case 1 (otherwise 1) (2 3))", "(case 1 (otherwise 1) (2 3))", ERROR, "only in the last clause"),
    stop("(quote)", "(quote)", ERROR, "QUOTE takes 1 part"),
    stop("(1 2 3)", "(1 2 3)", ERROR, "1 cannot be called"),
    stop("(setq 5 6)", "(setq 5 6)", ERROR, "5 cannot be assigned"),
    stop("(setf x)", "(setf x)", ERROR, "has no value"),
    stop("(dolist x (print x))", "(dolist x (print x))", ERROR, "It is written (dolist (variable list [result]) form...)"),
    stop("(dotimes (i) (print i))", "(dotimes (i) (print i))", ERROR, "It is written (dotimes (variable count [result]) form...)"),
    stop("(loop for n in '(1 2) doo (print n))", "doo", ERROR, "unknown LOOP keyword", "do"),
    stop("(loop for n of '(1 2) do (print n))", "of", ERROR, "After the variable comes IN, ON, ACROSS"),
    stop("(handler-case 1 2)", "(handler-case 1 2)", ERROR, "It is written (handler-case"),
    stop("(labels (f (x) x) 1)", "(labels (f (x) x) 1)", ERROR, "A local function is (name lambda-list . body)"),
    stop("(declare (ignore x))", "(declare (ignore x))", ERROR, "declarations belong at the beginning"),
    stop('(format nil "~q" 1)', '"~q"', WARNING, "no directive ~q"),
    stop('(format nil "~a")', '"~a"', WARNING, "takes one argument, but none follows it"),
    (PLANS, "&optional (ang-vel-factor 4)", "&optionl (ang-vel-factor 4)", "&optionl", ERROR, "a parameter must be a symbol", None),
    (PLANS, ROTATE, "(defun rotate-to", "(defun rotate-to", ERROR, "the parameters stand in a list", None),
    (PLANS, ROTATE, "(defun rotate-to (goal goal)", ("goal", 1), ERROR, "occurs more than once in the lambda list", None),
    (PLANS, ROTATE, "(defun move-to (goal &optional (threshold 0.05))", None, WARNING, "Duplicate definition for MOVE-TO", None),
    (PLANS, ROTATE, "(defun car (goal &optional (threshold 0.05))", None, ERROR, "Lock on package COMMON-LISP", None),
    (CONTROL, '(defvar *color-sub* nil "color ROS subscriber")', "(defvar)", "(defvar)", ERROR, "It is written (defvar name", None),
    (PLACES, "*world-size* 11.0 ", "*world-size* 11.0 12 ", None, ERROR, "It is written (defparameter name value", None),
    (
        PLACES,
        "(loop repeat 5\n              collect",
        "(loop repeat 5\n              colect",
        "colect",
        ERROR,
        "unknown LOOP keyword",
        "collect",
    ),
    (MOTIONS, "(defstruct turtle-motion", "(defstruct", "(defstruct", ERROR, "is not a symbol", None),
    (MOTIONS, "  (speed 0)\n", "  (speed 0) (speed 1)\n", ("speed", 1), ERROR, "duplicate slot name SPEED", None),
    (MOTIONS, "(defstruct turtle-motion", "(defstruct (turtle-motion (:includ foo))", ":includ", ERROR, "unknown DEFSTRUCT option", None),
]

PLAN_FORMS = [
    (MODULES, "turtlesim-navigation (motion-designator)", "turtlesim-navigation", None, ERROR, "It is written (def-process-module name (input)", None),
    (MODULES, "running (turtlesim-navigation)", "running turtlesim-navigation", None, ERROR, "It is written (with-process-modules-running", None),
    (MODULES, "'turtlesim-navigation trajectory", "'turtlesim-navigatoin trajectory", "turtlesim-navigatoin", WARNING, "process module", "turtlesim-navigation"),
    (MODULES, "running (turtlesim-navigation)", "running (turtlesim-navigatoin)", "turtlesim-navigatoin", WARNING, "process module", "turtlesim-navigation"),
    (MODULES, "((other-points 3))", "(other-points 3)", None, ERROR, "with-retry-counters ((counter 2))", None),
    (MODULES, "(do-retry other-points", "(do-retry other-point", "other-point", ERROR, "There is no retry counter", None),
    (MODULES, "((designator-error (failure)", "((designator-error failure", "(with-failure-handling", ERROR, "a clause is a list of a type", None),
    (MODULES, MOTION, MOTION.replace("motion", "motoin"), "motoin", WARNING, "There is no designator for motoin", "motion"),
    (MODULES, MOTION, MOTION.replace("(type", "(tpye"), "tpye", WARNING, "the property tpye", "type"),
    (MODULES, MOTION, MOTION.replace("driving", "drivng"), "drivng", WARNING, "the type drivng", "driving"),
    (MODULES, MOTION, MOTION.replace("(speed", "(sped"), "sped", WARNING, "the property sped", "speed"),
    (MODULES, MOTION, MOTION.replace("?speed", "?sped"), "?sped", WARNING, "must be bound around it", None),
    (MODULES, MOTION, MOTION.replace("(speed ?speed)", "speed (speed ?speed)"), "speed", ERROR, "A property is written (key value)", None),
    (MOTIONS, GROUP, "(def-fact-group turtle-motion-designators", RULE, ERROR, "The list of predicates", None),
    (MOTIONS, RULE, RULE.replace("(<- ", "(<-- "), "<--", WARNING, "Did you mean <-?", "<-"),
    (MOTIONS, RULE, RULE.replace("desig:motion-grounding", "motion-groundng"), "motion-groundng", WARNING, "does not extend", "motion-grounding"),
    (MOTIONS, "(desig-prop ?desig (:type :driving))", "(desig-porp ?desig (:type :driving))", "desig-porp", WARNING, "the predicate", None),
    (MOTIONS, "(desig-prop ?desig (:type :driving))", "(desig-prop ?desig)", "(desig-prop ?desig)", ERROR, "takes 2 or 3 arguments", None),
    (MOTIONS, CALLED, CALLED.replace("motion :speed", "motoin :speed"), "make-turtle-motoin", WARNING, "the function", "make-turtle-motion"),
    (MOTIONS, CALLED, CALLED.replace(":speed", ":sped"), ":sped", WARNING, "takes no argument :sped", ":speed"),
    (MOTIONS, CALLED, CALLED.replace("?speed", "?sped"), "?sped", HINT, "occurs only once in this clause", "?speed"),
    (PLACES, " 5 navigation-goal-generator", " 5 navigation-goal-generatr", "navigation-goal-generatr", WARNING, "the function", "navigation-goal-generator"),
    (HIGH, 'went-wrong: ~a" failure)', 'went-wrong: ~a ~a" failure)', '"Moving went-wrong: ~a ~a"', WARNING, "takes 2 arguments, but 1 follows", None),
    (CONTROL, '"turtlesim/Color"', '"turtlesim/Colr"', '"turtlesim/Colr"', WARNING, "No datatype turtlesim/Colr", "turtlesim/Color"),
    (CONTROL, ":linear (make-msg", ":liner (make-msg", ":liner", WARNING, "has no field liner", ":linear"),
    (CONTROL, ":width width", ":widht width", ":widht", WARNING, "has no field widht", ":width"),
    (CONTROL, "'turtlesim-srv:SetPen", "'turtlesim-srv:SetPn", "turtlesim-srv:SetPn", ERROR, "not found in the TURTLESIM-SRV", "turtlesim-srv:setpen"),
]  # fmt: skip

SYSTEMS = [
    (SYSTEM, '(:file "high-level-plans"', '(:file "high-level-plan"', '"high-level-plan"', WARNING, "file of the component", '"high-level-plans"'),
    (SYSTEM, '(:module "src"', '(:module "scr"', '"scr"', WARNING, "folder of the module scr is missing", None),
    (SYSTEM, "cram-executive)", "cram-executve)", "cram-executve", WARNING, "no system", "cram-executive"),
    (SYSTEM, "cram-executive)", "cram-executive", "(", ERROR, "never closed", ")"),
    (SYSTEM, ":depends-on (roslisp", ":depend-on (roslisp", ":depend-on", WARNING, "no option", ":depends-on"),
    (SYSTEM, '(:file "package")', '(:fil "package")', ":fil", WARNING, "no component :fil", ":file"),
    (SYSTEM, '"conditions"\n', '"condtions"\n', '"condtions"', ERROR, "not a component beside it", None),
    (SYSTEM, '(:file "package")', '(:file "package" :depends-on ("high-level-plans"))', '"package"', ERROR, "Circular dependency", None),
    (SYSTEM, "(defsystem cram-my", "(defsytem cram-my", "defsytem", WARNING, "Did you mean defsystem?", "defsystem"),
    (MANIFEST, "</package>", "</packag>", "packag", ERROR, "does not close the <package>", "package"),
    (MANIFEST, "<license>BSD-3-Clause</license>", "<licence>BSD</licence>", "licence", WARNING, "no element <licence>", "license"),
    (MANIFEST, "<license>BSD-3-Clause</license>", "", "package", ERROR, "lacks <license>", None),
    (MANIFEST, "<version>0.1.0", "<version>0.1", "version", ERROR, "three numbers", None),
    (MANIFEST, '<package format="2">', '<package format="9">', 'format="9"', ERROR, "1, 2 or 3", None),
    (MANIFEST, "<depend>roslisp</depend>", "<depend></depend>", "depend", ERROR, "names no package", None),
    (MANIFEST, '<maintainer email="user@example.org">', "<maintainer>", "maintainer", ERROR, "has an address", None),
]  # fmt: skip

OF_HY = [
    (HY, "(wait-duration 0.1)", "(wait-duration 0.1))", ")", ERROR, "closes nothing", ""),
    (HY, "(wait-duration 0.1)", "(wait-duration 0.1]", "]", ERROR, "does not close the (", ")"),
    (HY, "calculate-angular-cmd goal 8", "calculate-angular-cdm goal 8", "calculate-angular-cdm", WARNING, "defines", "calculate-angular-cmd"),
    (HY, "(pursue\n", "(persue\n", "persue", WARNING, "Did you mean pursue?", "pursue"),
    (HY, "(finally", "(finaly", "finaly", WARNING, "Did you mean finally?", "finally"),
    (HY, "(setv distance", "(setv 5", "5", ERROR, "Can't assign", None),
    (HY, "[goal [ang-vel-factor 4]]", "(goal [ang-vel-factor 4])", "(goal [ang-vel-factor 4])", ERROR, "It is written (defn", None),
    (HY, "(require cramhy *)", "(require cramyh *)", "cramyh", WARNING, "no module", "cramhy"),
    (HY_MODULES, MOTION, MOTION.replace("motion", "motoin"), "motoin", WARNING, "no designator", "motion"),
    (HY_MODULES, "'turtlesim-navigation trajectory", "'turtlesim-navigatoin trajectory", "turtlesim-navigatoin", WARNING, "module", "turtlesim-navigation"),
    (HY_MODULES, "(for [_ (range 10)]", "(for [_]", "[_]", ERROR, "It is written (for [name values]", None),
    (HY_MOTIONS, GROUP.replace("(motion-grounding)", "[motion-grounding]"), "(def-fact-group turtle-motion-designators", HY_RULE, ERROR, "The list of predicates", None),
    (HY_MOTIONS, "TurtleMotion :speed ?speed :angle", "TurtleMotoin :speed ?speed :angle", "TurtleMotoin", WARNING, "defines", "TurtleMotion"),
]  # fmt: skip

MISTAKES = [*READER, *PACKAGES, *CALLS, *NAMES, *FORMS, *PLAN_FORMS, *SYSTEMS, *OF_HY]
