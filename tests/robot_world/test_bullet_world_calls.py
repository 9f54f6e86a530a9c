"""Each name of bullet-world.md: it is there, it is called as the page says, and some test calls it.

``names/bullet_world.txt`` has the names of the page, a line each. The table below calls those that no other test calls.
"""

import re
from pathlib import Path

import pytest

from cramhy_runtime.lisp_core.packages import find_package
from cramhy_runtime.prolog.engine import database
from cramhy_runtime.session.arglists import arglist

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

TESTS = Path(__file__).parents[1]
NAMES = [
    line.split(None, 3)
    for line in (Path(__file__).parent / "names" / "bullet_world.txt").read_text().splitlines()
    if line and not line.startswith("#")
]
SYSTEMS = """cl-bullet cram-physics-utils cram-bullet-reasoning-utilities cram-bullet-reasoning-belief-state cram-pr2-projection
cram-pr2-projection-reasoning cram-pr2-fetch-deliver-plans cram-knowrob-pick-place cram-btr-spatial-relations-costmap"""


OF_PLACES = """
(cram-tf::set-frames)
(defun there (x y z) (cl-transforms-stamped:pose->pose-stamped "map" 0.0 (btr:ensure-pose `((,x ,y ,z) (0 0 0 1)))))
(defun place (x y z &aux (?pose (there x y z))) (desig:a location (pose ?pose)))
(defun of-mug () (let ((pose (btr:pose (mug)))) (place (cl-transforms:x (cl-transforms:origin pose)) (cl-transforms:y (cl-transforms:origin pose)) (cl-transforms:z (cl-transforms:origin pose)))))
(defun counter () (desig:an object (type counter-top) (urdf-name sink-area-surface) (part-of kitchen)))
(prolog:def-fact-group costmap-metadata (costmap:costmap-size costmap:costmap-origin costmap:costmap-resolution)
  (prolog:<- (costmap:costmap-size 12 12)) (prolog:<- (costmap:costmap-origin -6 -6)) (prolog:<- (costmap:costmap-resolution 0.05)))
(defun opening () (desig:an action (type opening) (arm left) (distance 0.3) (object (desig:an object (type drawer) (urdf-name sink-area-left-upper-drawer-main) (part-of kitchen)))))
(defparameter *mug* (let ((?name 'mug-1)) (desig:an object (type mug) (name ?name))))
"""


@pytest.fixture(scope="module")
def loaded(session_with_kitchen):
    for system in SYSTEMS.split():
        session_with_kitchen.evaluate_text(f"(asdf:load-system :{system})")
    session_with_kitchen.evaluate_text(OF_PLACES)
    return session_with_kitchen


def counted(items):
    """How many required and optional arguments there are, whether there is a rest, and the names of the keywords."""
    counts, mode, rest, keywords = {"required": 0, "&OPTIONAL": 0}, "required", False, None
    for item in items:
        name = item.strip("()").split()[0].upper()
        if name in ("&REST", "&BODY"):
            mode, rest = name, True
        elif name == "&KEY":
            mode, keywords = name, []
        elif name.startswith("&"):
            mode = name
        elif mode == "&KEY":
            keywords.append(name)
        elif mode in counts:
            counts[mode] += 1
    return counts, rest, keywords


def what_is_wrong(session, package, name, kind, shape=""):
    internal, name = name.startswith("::"), name.lstrip(":")
    symbol, status = find_package(package.upper()).lookup(name.upper())
    if not status or not internal and "external" not in str(status).lower():
        return "not exported"
    quoted = f"'{package}::{name}"
    if kind in ("function", "generic", "macro", "accessor"):
        items = arglist(symbol)
        if items is None:
            return "cannot be called"
        if shape and counted(items) != counted(shape[1:-1].split()):
            return f"is called with {' '.join(items)}"
        if kind in ("generic", "accessor") and not session.evaluate_text(f"(typep (fdefinition {quoted}) 'generic-function)")[0]:
            return "takes no methods"
        if kind == "accessor" and not session.evaluate_text(f"(fboundp '(setf {package}::{name}))")[0]:
            return "cannot be set"
    elif kind == "class" and not session.evaluate_text(f"(find-class {quoted} nil)")[0]:
        return "no class"
    elif kind == "variable" and not session.evaluate_text(f"(boundp {quoted})")[0]:
        return "unbound"
    elif kind == "predicate" and (symbol not in database.functors or not database.functors[symbol].clauses):
        return "no clauses"
    return None


def test_each_name_is_what_the_page_says(loaded):
    wrong = [f"{' '.join(line)}: {problem}" for line in NAMES if (problem := what_is_wrong(loaded, *line)) is not None]
    assert wrong == []


USED = {
    "cl-bullet": "common-lisp cffi cffi-ros-utils",
    "cram-physics-utils": "common-lisp cffi cffi-ros-utils",
    "cl-bullet-vis": "common-lisp cl-bullet",
    "cram-bullet-reasoning": "common-lisp cram-prolog cl-bullet cl-bullet-vis cram-utilities cram-robot-interfaces cl-transforms-stamped cram-tf",
    "cram-bullet-reasoning-utilities": "common-lisp cram-bullet-reasoning cram-prolog cram-designators cram-utilities cram-robot-interfaces cram-tf",
    "cram-bullet-reasoning-belief-state": "common-lisp cram-prolog",
    "cram-btr-visibility-costmap": "common-lisp cram-prolog cram-bullet-reasoning",
    "cram-btr-spatial-relations-costmap": "common-lisp cram-prolog",
    "cram-pr2-projection": "common-lisp cram-prolog",
    "cram-pr2-projection-reasoning": "common-lisp cram-prolog",
    "cram-pr2-environment-manipulation": "common-lisp cram-prolog cram-designators cram-executive",
}
"""Section 1: the packages that a package uses."""


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("name", USED)
def test_a_package_uses_what_the_page_says(loaded, ask, name):
    ask(f"(asdf:load-system :{name})")
    assert sorted(package.name for package in find_package(name.upper()).use) == sorted(USED[name].upper().split())


NICKNAMES = {"btr": {"btr", "cl-bullet", "btr-utils"}, "cl-bullet": {"cl-bullet", "bullet", "btr"}}
ACTIONS = {
    "go-without-collisions": "navigating",
    "turn-towards": "turning-towards",
    "search-for-object": "searching",
    "fetch": "fetching",
    "deliver": "delivering",
    "transport": "transporting",
    "manipulate-environment": "accessing",
    "open-container": "accessing",
    "close-container": "sealing",
    "drop-at-sink": "dropped_at_the_sink",
}
"""How a test performs the action of a plan, or is called."""


@pytest.mark.soak
def test_each_name_is_called_by_a_test():
    files = [path for path in TESTS.rglob("*") if path.suffix in (".py", ".lisp", ".hy") and path != Path(__file__)]
    text = "\n".join(path.read_text(errors="replace") for path in files)
    called = set(re.findall(r"([a-z0-9-]+)::?([^\s()'\"`,]+)", text + Path(__file__).read_text()))

    def is_called(package, name):
        if name in ACTIONS:
            return ACTIONS[name] in text
        return any((nickname, name) in called for nickname in NICKNAMES.get(package, {package}))

    assert [f"{package}:{name}" for package, name, *_ in NAMES if not is_called(package, name.lstrip(":"))] == []


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    ("form", "answer"),
    [
        # worlds and objects
        ("(list (eq (find-class 'cl-bullet:bt-world) (class-of *world*)) (typep *world* 'btr:bt-reasoning-world))", "(T T)"),
        ("(flet ((named-p (thing) (eq (btr:name thing) 'mug-1))) (mapcar #'btr:name (btr:find-objects *world* #'named-p)))", "(MUG-1)"),
        ("(length (btr:find-objects *world*))", "(length (btr:objects *world*))"),
        ("(cl-transforms:z (btr:ensure-vector '(1 2 3)))", "3.0d0"),
        ("(typep (cl-bullet:aabb (mug)) 'cl-bullet:bounding-box)", "(typep (btr:aabb (mug)) 'btr:bounding-box)"),
        ("(eq (symbol-function 'cl-bullet:pose) (symbol-function 'btr:pose))", "T"),
        ("(eq 'cl-bullet:points 'btr::points)", "T"),
        ("(let ((pairs (btr:find-all-contacts *world*))) (and (member (list (mug) (named :kitchen)) pairs :test #'equal) (member (list (named :kitchen) (mug)) pairs :test #'equal) t))", "T"),
        ("(btr:find-objects-above *world* (mug))", "(btr:find-objects *world* (lambda (other) (and (not (eq other (mug))) (btr:above-p other (mug)))))"),
        ("(let ((copy (cl-bullet:copy-world *world*))) (btr:remove-object copy 'mug-1) (list (btr:object copy 'mug-1) (btr:name (mug))))", "(NIL MUG-1)"),
        ("(let ((other (robot-world:make-world))) (btr:copy-world *world* other) (mapcar #'btr:name (btr:objects other)))", "(mapcar #'btr:name (btr:objects *world*))"),
        ("(progn (setf (btr:pose (mug)) (btr:ensure-pose '((0 3 0.5) (0 0 0 1)))) (cl-bullet:step-simulation *world* 0.1) (< 0.3 (z-of 'mug-1) 0.5))", "T"),
        ("(mapcar (lambda (s) (eq *world* (cdr (assoc '?w s)))) (cut:force-ll (btr:prolog-?w (btr:object ?w mug-1))))", "(T)"),
        ("(let ((state (btr::get-state *world*)) (before (z-of 'mug-1))) (setf (btr:pose (mug)) (btr:ensure-pose '((0 3 9) (0 0 0 1)))) (btr::restore-world-state state *world*) (= before (z-of 'mug-1)))", "T"),
        ("(list (slot-value (mug) 'btr:name) (eq (slot-value (mug) 'btr::world) *world*))", "(MUG-1 T)"),
        # robots
        ("(string (btr::make-rigid-body-name \"KITCHEN\" \"sink_area\"))", '"KITCHEN.sink_area"'),
        ("(btr:get-robot-name)", "CRAM-PR2-DESCRIPTION:PR2"),
        ("(and (member \"l_wrist_roll_link\" (btr:link-names (robot)) :test #'equal) t)", "T"),
        ("(progn (setf (btr:pose (mug)) (btr:link-pose (robot) \"base_link\")) (list (cdr (assoc (mug) (btr:link-contacts (robot)))) (btr:robot-colliding-objects-without-attached)))",
         '("base_link" (MUG-1))'),
        ("(progn (btr:attach-object (robot) (mug) \"l_wrist_roll_link\") (btr:attach-object (robot) (mug) \"r_wrist_roll_link\" :loose t)"
         " (let ((links (btr:object-attached (robot) (mug)))) (btr:detach-object (robot) (mug) \"l_wrist_roll_link\")"
         " (let ((then (btr:object-attached (robot) (mug)))) (btr:detach-object (robot) (mug)) (list (sort (copy-list links) #'string<) then (btr:object-attached (robot) (mug)) (btr:attached-objects (robot))))))",
         '(("l_wrist_roll_link" "r_wrist_roll_link") ("r_wrist_roll_link") NIL NIL)'),
        ("(progn (btr:attach-object (robot) (mug) \"l_wrist_roll_link\") (btr:detach-all-objects (robot)) (btr:attached-objects (robot)))", "NIL"),
        *((f"(flet ((touched () (mapcar #'btr:name (btr:robot-attached-objects-in-collision)))) (setf (btr:pose (mug)) (btr:ensure-pose '{where}))"
           f" (btr-utils:spawn-object 'bowl-1 :bowl :pose '{other}) (let ((before (touched))) {attach} (list before (touched))))", found)
          for where, other, attach, found in [
              ("((0 9 2) (0 0 0 1))", "((0 8 2) (0 0 0 1))", '(btr:attach-object (robot) (mug) "l_wrist_roll_link")', "(NIL NIL)"),
              ("((0 9 2) (0 0 0 1))", "((0 9 2) (0 0 0 1))", '(btr:attach-object (robot) (mug) "l_wrist_roll_link")', "(NIL (BOWL-1))"),
              ("((0 9 2) (0 0 0 1))", "((0 9 2) (0 0 0 1))", '(dolist (name \'(mug-1 bowl-1)) (btr:attach-object (robot) (named name) "l_wrist_roll_link"))', "(NIL NIL)"),
              ("((1.5 0.5 0.84) (0 0 0 1))", "((0 8 2) (0 0 0 1))", '(btr:attach-object (robot) (mug) "l_wrist_roll_link")', "(NIL (:KITCHEN))"),
          ]),
        # seeing
        ("(let ((eye (btr:ensure-pose '((-2 -0.3 0.87) (0.7071 0 0 0.7071))))) (list (btr:object-visible-p *world* eye (mug)) (btr:object-visible-p *world* eye (mug) 2)))", "(T NIL)"),
        ("(let ((eye (btr:ensure-pose '((-2 -0.3 0.87) (0.7071 0 0 0.7071))))) (btr:add-object *world* :box 'screen '((-2 -0.6 0.9) (0 0 0 1)) :size '(0.5 0.02 0.5))"
         " (list (btr:object-visible-p *world* eye (mug)) (let ((btr:*visibility-threshold* 0)) (btr:object-visible-p *world* eye (mug)))"
         " (mapcar #'btr:name (btr:occluding-objects *world* eye (mug))) (all `(btr:occluding-objects ?w ,eye mug-1 ?x) '?x) (all `(btr:occluding-object ?w ,eye mug-1 ?x) '?x)))",
         "(NIL T (SCREEN) ((SCREEN)) (SCREEN))"),
        ("(list (btr:add-costmap-function-object nil) (btr:add-costmap-sample-object nil) (btr:clear-costmap-vis-object) (proves '(btr:debug-window ?w)) (proves '(btr:debug-costmap nil)))", "(NIL NIL NIL T T)"),
        # time
        ("(let* ((line (btr:timeline-init *world*)) (other (btr:copy-world *world*))) (btr:timeline-advance line (btr:make-event other '(later) 2.0))"
         " (let ((btr:*current-timeline* line)) (list (typep line 'btr:timeline) (mapcar (lambda (time) (length (btr:objects (btr:timeline-lookup line time)))) '(0.0 5.0))"
         " (length (btr:objects (btr:timeline-current-world-state line))) (eq line (first (all '(btr:timeline ?t) '?t))))))",
         "(list t (list (length (btr:objects *world*)) (length (btr:objects *world*))) (length (btr:objects *world*)) t)"),
        # Prolog
        ("(progn (prolog:prolog '(btr:clear-bullet-world)) (btr:objects btr:*current-bullet-world*))", "NIL"),
        ("(eq (mug) (first (all '(btr:%object ?w mug-1 ?o) '?o)))", "T"),
        ("(progn (setf (btr:pose (mug)) (btr:ensure-pose '((0 3 0.5) (0 0 0 1)))) (prolog:prolog '(btr:simulate-realtime ?w 10)) (< (z-of 'mug-1) 0.1))", "T"),
        ("(list (proves '(btr:stable-items ?w)) (proves '(btr:stable ?w mug-1)) (progn (setf (btr:pose (mug)) (btr:ensure-pose '((0 3 0.5) (0 0 0 1)))) (proves '(btr:stable-items ?w))))", "(T T NIL)"),
        ("(let ((?there (cl-transforms-stamped:pose->pose-stamped \"map\" 0.0 (btr:ensure-pose '((0 3 0.7) (0 0 0 1)))))) (mapcar #'length (all `(btr:desig-poses ,(desig:a location (pose ?there)) ?p) '?p)))", "(1)"),
        ("(progn (btr:attach-object (robot) (mug) \"l_wrist_roll_link\") (all '(btr:available-arms nil ?arms) '?arms))", "((:RIGHT))"),
        ("(sort (first (all '(btr:available-arms nil ?arms) '?arms)) #'string<)", "(:LEFT :RIGHT)"),
        ("(list (proves '(btr:valid-grasp ?a)) (proves '(btr:object-grasp ?a ?b)) (proves '(btr:semantic-map ?w ?m)) (proves '(btr:container ?w ?c)))", "(NIL NIL NIL NIL)"),
        # objects and the robot by their names
        ("(list (btr-utils:object-exists 'mug-1) (btr-utils:item-exists 'mug-1) (btr-utils:item-exists :kitchen) (btr-utils:object-exists 'ghost) (eq (btr-utils:object-instance 'mug-1) (mug)))", "(T T NIL NIL T)"),
        ("(progn (btr-utils:respawn-object (mug)) (list (btr:item-types (mug)) (near 0 (cl-transforms:v-dist (cl-transforms:origin (btr-utils:object-pose 'mug-1)) (cl-transforms:origin (btr:pose (btr:object *pristine* 'mug-1)))))))", "((:MUG) T)"),
        ("(progn (btr-utils:kill-object 'mug-1) (btr-utils:object-exists 'mug-1))", "NIL"),
        ("(progn (btr-utils:kill-all-objects) (mapcar #'btr:name (btr:objects *world*)))", "(:FLOOR :KITCHEN CRAM-PR2-DESCRIPTION:PR2)"),
        ("(progn (btr-utils:move-robot '((1 2 0) (0 0 0 1))) (list (btr-utils:robot-name) (near 2 (cl-transforms:y (cl-transforms:origin (btr:pose (robot)))))))", "(CRAM-PR2-DESCRIPTION:PR2 T)"),
        ("(progn (btr-utils:move-robot-away) (> (cl-transforms:v-norm (cl-transforms:origin (btr:pose (robot)))) 50))", "T"),
        ("(progn (btr-utils:park-robot) (near 0.16825 (btr:joint-state (robot) \"torso_lift_joint\")))", "T"),
        ("(list (all '(btr-utils:scenario-objects-init-pose ?p) '?p) (all '(btr-utils:scenario-objects-default-color ?c) '?c) (all '(btr-utils:scenario-object-color ?_ :fork ?c) '?c))", "((((2 0 0) (0 0 0 1))) ((0.5 0.5 0.5)) ((0.2 0.1 0.3)))"),
        ("(list (all '(btr-utils:scenario-object-color ?_ :brick ?c) '?c) (all '(btr-utils:scenario-object-extra-attributes ?_ :fork ?more) '?more))", "(((0.5 0.5 0.5)) ((:MESH :FORK)))"),
    ],
)  # fmt: skip
def test_what_is_called_answers(ask, form, answer):
    """An answer may also be written as a form with the same value."""
    found = ask(form)
    assert found == answer or found == ask(answer)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("form", "answer"),
    [
        # the belief state
        ("(let ((btr-belief:*spawn-debug-window* nil)) (btr-belief:setup-world-database) (list (mapcar #'btr:name (btr:objects btr:*current-bullet-world*)) (typep btr-belief:*robot-urdf* 'cl-urdf:robot) (typep btr-belief:*kitchen-urdf* 'cl-urdf:robot) (btr:joint-state (btr:get-robot-object) \"torso_lift_joint\")))",
         "((:FLOOR :KITCHEN CRAM-PR2-DESCRIPTION:PR2 MUG-1) T T 0.15000000596046448d0)"),
        ("(list btr-belief:*robot-parameter* btr-belief:*kitchen-parameter*)", '("robot_description" "kitchen_description")'),
        ("(let ((tf (make-instance 'cl-tf:transformer))) (setf (btr:pose (robot)) (btr:ensure-pose '((1 2 0) (0 0 0 1)))) (btr-belief:set-tf-from-bullet :transformer tf)"
         " (near 2 (cl-transforms:y (cl-transforms:translation (cl-transforms-stamped:lookup-transform tf \"map\" \"base_footprint\")))))", "T"),
        ("(let ((tf (make-instance 'cl-tf:transformer)) (robot (robot))) (setf (btr:pose robot) (btr:ensure-pose '((1 2 0) (0 0 0 1)))) (btr-belief:set-tf-from-bullet :transformer tf)"
         " (setf (btr:pose robot) (btr:ensure-pose '((5 5 0) (0 0 0 1)))) (btr:set-robot-state-from-tf tf robot :reference-frame \"map\") (near 2 (cl-transforms:y (cl-transforms:origin (btr:pose robot)))))", "T"),
        ("(btr-belief:update-bullet-transforms)", "NIL"),
        ("(list (btr-belief:get-designator-object-name *mug*) (eq (mug) (btr-belief:get-designator-object *mug*)))", "(MUG-1 T)"),
        ("(list (all '(btr-belief:object-designator-name mug-1 ?n) '?n) (all `(btr-belief:object-designator-name ,*mug* ?n) '?n)"
         " (all `(btr-belief:object-designator-name ,(desig:an object (type mug)) ?n) '?n) (all `(btr-belief:object-designator-name ,(desig:an object (type bowl)) ?n) '?n))",
         "((MUG-1) (MUG-1) (MUG-1) NIL)"),
        ("(let ((cram-tf:*transformer* (make-instance 'cl-tf:transformer))) (btr-belief:set-tf-from-bullet) (near 0 (cl-transforms:v-dist (cl-transforms:origin (btr-belief:object-pose-in-frame (mug) \"base_footprint\")) (cl-transforms:origin (btr:pose (mug))))))", "T"),
        # where things are
        ("(list (proves `(cpoe:loc ,*mug* ,(of-mug))) (proves `(cpoe:loc mug-1 ,(place 0 0 0))) (proves `(cpoe:loc ,*pr2* ,(place 0 0 0))) (proves `(cpoe:loc ,*pr2* ,(of-mug))))", "(T NIL T NIL)"),
        ("(typep (first (all `(cpoe:loc ,*mug* ?where) '?where)) 'desig:location-designator)", "T"),
        ("(list (proves `(cpoe:object-placed-at ,*mug* ,(of-mug))) (progn (btr:attach-object (robot) (mug) \"l_wrist_roll_link\") (proves `(cpoe:object-placed-at ,*mug* ,(of-mug)))))", "(T NIL)"),
        ("(let ((before (length (desig:get-all-designators)))) (setf desig::*designators* (tg:make-weak-hash-table :weakness :key)) (let ((new (desig:an object (type cup)))) (list (> before 0) (equal (desig:get-all-designators) (list new)) (hash-table-count desig::*designators*))))", "(T T 1)"),
        # on the counter, whether or not the place knows for what it is
        *((f"(let ((place (desig:make-designator :location (list* (list :on (counter)) {with_for})))) (btr:remove-object *world* 'mug-1) (btr-utils:spawn-object 'bottle :bottle :pose '((0 3 2) (0 0 0 1)))"
           " (prolog:prolog `(btr-utils:assert-object-pose-on bottle ,place)) (near 0.85 (- (cl-transforms:z (btr:bounding-box-center (btr:aabb (named 'bottle)))) (/ (cl-transforms:z (btr:bounding-box-dimensions (btr:aabb (named 'bottle)))) 2))))", "T")
          for with_for in ("nil", "(let ((?n 'bottle)) (list (list :for (desig:an object (type bottle) (name ?n)))))", "'((:side :left))")),
        # motions of the projection
        ("(pr2-proj:with-projected-robot (pr2-proj::move-torso 0.2) (near 0.2 (btr:joint-state (btr:get-robot-object) \"torso_lift_joint\")))", "T"),
        ("(pr2-proj:with-simulated-robot (pr2-proj::move-torso 0.5))", "Torso goal 0.5 was out of joint limits"),
        ("(pr2-proj:with-simulated-robot (pr2-proj::look-at :direction :backward))", "BACKWARD direction is unknown for PR2 projection PTU"),
        ("(pr2-proj:with-simulated-robot (pr2-proj::look-at :pose (there 1 1 1)) (< 0.7 (btr:joint-state (btr:get-robot-object) \"head_pan_joint\") 0.9))", "T"),
        ("(search \"Could not find object\" (pr2-proj:with-simulated-robot (handler-case (pr2-proj::detect (desig:an object (type bowl))) (common-fail:perception-object-not-found (failure) (princ-to-string failure)))))", "0"),
        ("(pr2-proj:with-simulated-robot (pr2-proj::gripper-action :open :left) (pr2-proj::gripper-action :grip :right))", "There was no object to grip"),
        ("(pr2-proj:with-simulated-robot (pr2-proj::gripper-action 0.05 '(:left :right)) (near 0.25 (btr:joint-state (btr:get-robot-object) \"l_gripper_l_finger_joint\")))", "T"),
        ("(pr2-proj:with-simulated-robot (pr2-proj::move-tcp (there 0.6 0.2 0.8) nil))", "Arm movement goals should be given in robot base frame"),
        ("(pr2-proj:with-simulated-robot (pr2-proj::move-joints '(0 0 0) nil))", "[PROJECTION MOVE-JOINTS] length of joints list is incorrect."),
        ("(pr2-proj:with-simulated-robot (handler-case (pr2-proj::move-with-constraints \"turn\") (warning (problem) (princ-to-string problem))))", '"Moving with constraints is not supported in projection! Ignoring."'),
        ("(pr2-proj:with-simulated-robot (pr2-proj::drive (there 3 3 0)) (near 3 (cl-transforms:x (cl-transforms:origin (btr:pose (btr:get-robot-object))))))", "T"),
        ("(pr2-proj:with-simulated-robot (eq desig:*default-role* 'pr2-proj:projection-role))", "T"),
        ("(progn (pr2-proj:with-simulated-robot 1) (typep pr2-proj:*last-timeline* 'btr:timeline))", "T"),
        ("(list pr2-proj::*projection-clock* (pr2-proj:with-simulated-robot (typep pr2-proj::*projection-clock* 'proj:partially-ordered-clock)))", "(NIL T)"),
        ("(list (pr2-proj::action-duration (desig:a motion (type going))) (pr2-proj::action-duration (desig:a motion (type going)) :default 3) (pr2-proj::projection-timestamp-function))", "(0 3 0)"),
        ("(progn (prolog:def-fact-group slow (pr2-proj::action-duration) (prolog:<- (pr2-proj::action-duration ?a 2) (desig:desig-prop ?a (:type :going))))"
         " (prog1 (pr2-proj:with-simulated-robot (list (pr2-proj::execute-as-action (desig:a motion (type going)) (lambda () :done)) (>= (pr2-proj::projection-timestamp-function) 2)))"
         " (prolog:def-fact-group slow (pr2-proj::action-duration))))", "(:DONE T)"),
        ("(list (hash-table-p pr2-proj::*ik-solution-cache*) pr2-proj::*torso-step* pr2-proj::*debug-short-sleep-duration* pr2-proj::*debug-long-sleep-duration*)", "(T 0.01 0.0 0.0)"),
        ("(remove-if #'cpm::get-running-process-module '(pr2-proj:pr2-proj-navigation pr2-proj:pr2-proj-torso pr2-proj:pr2-proj-ptu pr2-proj:pr2-proj-perception pr2-proj:pr2-proj-grippers pr2-proj:pr2-proj-arms))",
         "'(pr2-proj:pr2-proj-navigation pr2-proj:pr2-proj-torso pr2-proj:pr2-proj-ptu pr2-proj:pr2-proj-perception pr2-proj:pr2-proj-grippers pr2-proj:pr2-proj-arms)"),
        ("(proj::projection-environment-result-result (proj:with-projection-environment pr2-proj:pr2-bullet-projection-environment (cpl:top-level 1)))", "(1)"),
        ("(and (find \"l_gripper_palm_link\" (cram-pr2-description:get-hand-link-names :left) :test #'equal) t)", "T"),
        # actions that are tried
        ("(let ((action (opening))) (setf (btr:pose (robot)) (btr:ensure-pose '((0.4 0.6 0) (0 0 0 1)))) (list (eq action (desig:first-desig (pr2-proj-reasoning:check-environment-manipulation-collisions action)))"
         " (btr:joint-state (named :kitchen) \"sink_area_left_upper_drawer_main_joint\")))", "(T 0.0d0)"),
        ("(progn (setf (btr:pose (robot)) (btr:ensure-pose '((-2 0.6 0) (0 0 0 1)))) (handler-case (pr2-proj-reasoning:check-environment-manipulation-collisions (opening)) (common-fail:environment-unreachable () :unreachable)))", ":UNREACHABLE"),
        ("(let* ((?o *mug*) (?to (place -2 -1 0.8)) (action (desig:an action (type placing) (arm left) (object ?o) (target ?to)))) (handler-case (pr2-proj-reasoning:check-placing-collisions action) (common-fail:object-unreachable () :unreachable)))", ":UNREACHABLE"),
        ("(and (compute-applicable-methods #'costmap:on-visualize-costmap '(nil)) t)", "NIL"),
    ],
)  # fmt: skip
def test_belief_and_motions_answer(loaded, ask, form, answer):
    found = ask(form)
    assert found == answer or found == ask(answer)
