"""The names of bullet-world.md 2 that test_bullet_reasoning.py does not try: bodies, timelines, meshes, reaching, places; and cl-urdf."""

import pytest

from cramhy_runtime.prolog.engine import database
from cramhy_runtime.robot_world import remarks

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

NAMES = """*current-bullet-world* object objects find-objects add-object remove-object pose name item-type rigid-bodies rigid-body
rigid-body-names ensure-pose ensure-vector aabb calculate-bb-dims item-dimensions simulate contact-p find-all-contacts
find-objects-in-contact link-contacts above-p below-p find-objects-above find-objects-below stable-p copy-world with-current-bullet-world
joint-names joint-state joint-states link-names links link-pose set-robot-state-from-joints set-robot-state-from-tf attach-object
detach-object detach-all-objects attached-objects object-attached get-robot-object get-robot-name get-environment-object
robot-colliding-objects-without-attached calculate-pan-tilt add-objects-to-mesh-list add-vis-axis-object add-debug-window *debug-window*
add-costmap-function-object add-costmap-sample-object clear-costmap-vis-object object-visible-p calculate-object-visibility
occluding-objects *visibility-threshold* prolog-?w with-stored-world with-world with-copied-world timeline timeline-init timeline-advance
timeline-lookup timeline-current-world-state make-event *current-timeline* with-timeline bullet-world clear-bullet-world assert retract
%object item-type object-type object-pose object-bottom-pose object-pose-on step simulate-realtime contact object-not-in-collision stable
stable-items above below supported-by supporting visible visible-from occluding-object link head-pointing-at attached execute
random-poses-on n-poses-on desig-poses debug-window debug-costmap reachable point-reachable pose-reachable blocking valid-grasp
object-grasp urdf robot-object item bounding-box-center bounding-box-dimensions item-types *mesh-files*"""


def test_all_names_are_exported(ask):
    quoted = " ".join(f'"{name.upper()}"' for name in NAMES.split())
    assert ask(f"(remove-if (lambda (n) (eq :external (nth-value 1 (find-symbol n :btr)))) '({quoted}))") == "NIL"


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    ("form", "answer"),
    [
        # objects
        ("(btr:rigid-body-names (mug))", "(MUG-1)"),
        ('(and (btr:rigid-body (named :kitchen) (intern "KITCHEN.sink_area" :keyword)) t)', "T"),
        ('(and (gethash "sink_area" (btr:links (named :kitchen))) t)', "T"),
        ("(length (btr:rigid-bodies (robot)))", '(hash-table-count (btr:links (robot)))'),
        ("(near (cl-transforms:z (btr:bounding-box-dimensions (btr:aabb (first (btr:rigid-bodies (mug)))))) 0.096)", "T"),
        ("(mapcar #'btr:name (btr:find-objects-below *world* (mug)))", "(remove 'mug-1 (all `(btr:below ?w ?x mug-1) '?x))"),
        ("(btr:below-p (robot) (mug))", "(btr:above-p (mug) (robot))"),
        ("(slot-value (mug) 'btr::types)", "(:MUG)"),
        ("(eq (slot-value (robot) 'btr:urdf) (btr:urdf (robot)))", "T"),
        ("(typep (btr:urdf (robot)) 'cl-urdf:robot)", "T"),
        # shapes
        ("(progn (btr:add-object *world* :cone 'c '((1 3 1) (0 0 0 1)) :radius 0.1 :height 0.2) (btr:simulate *world* 10) (z-of 'c))", "0.1d0"),
        ("(progn (btr:add-object *world* :cylinder 'c '((1 3 1) (0 0 0 1)) :size '(0.1 0.1 0.3)) (btr:simulate *world* 10) (z-of 'c))", "0.15d0"),
        ("(progn (btr:add-object *world* :sugar-box 'c '((1 3 1) (0 0 0 1)) :size '(0.1 0.1 0.1)) (btr:simulate *world* 10) (z-of 'c))", "0.1d0"),
        ("(progn (btr:add-object *world* :mesh 'c '((1 3 1) (0 0 0 1)) :mesh :mug :scale 2.0) (near (* 2 (cl-transforms:z (btr:item-dimensions :mug))) (cl-transforms:z (btr:item-dimensions (named 'c)))))", "T"),
        ("(progn (btr:add-object *world* :cutlery 'c '((1 3 1) (0 0 0 1)) :cutlery-type :fork) (btr:item-types (named 'c)))", "(:CUTLERY :FORK)"),
        ("(progn (btr:add-object *world* :point-cloud 'c '((1 3 1) (0 0 0 1)) :points '((0 0 0) (1 0 0) (0 1 0) (0 0 1))) (btr:simulate *world* 10) (z-of 'c))", "1.0d0"),
        # Prolog
        ("(all '(btr:supported-by ?w mug-1 ?x) '?x)", "(:KITCHEN)"),
        ("(all '(btr:supporting ?w :kitchen ?x) '?x)", "(MUG-1)"),
        ("(all '(btr:contact ?w ?x :floor) '?x)", "NIL"),
        ("(progn (setf (btr:pose (mug)) (btr:ensure-pose '((0 3 0.5) (0 0 0 1)))) (btr:simulate *world* 10) (all '(btr:supported-by ?w mug-1 ?x) '?x))", "(:FLOOR)"),
        ("(proves '(btr:object-not-in-collision ?w mug-1))", "NIL"),
        ("(progn (btr:attach-object (named :kitchen) (mug) \"table_area_main\") (proves '(btr:object-not-in-collision ?w mug-1)))", "T"),
        ("(progn (prolog:prolog `(assert (btr:attached ?w :kitchen \"table_area_main\" mug-1))) (all '(btr:attached ?w :kitchen ?l mug-1) '?l))", '("table_area_main")'),
        ("(proves '(btr:above ?w mug-1 :kitchen \"table_area_main\"))", "T"),
        ("(proves '(btr:below ?w mug-1 :kitchen \"table_area_main\"))", "NIL"),
        ("(progn (prolog:prolog '(assert (btr:object-pose-on ?w mug-1 ((0 3 0) (0 0 0 1))))) (near 0 (cl-transforms:z (cl-transforms:origin (cdr (assoc '?p (cut:lazy-car (prolog:prolog '(btr:object-bottom-pose ?w mug-1 ?p)))))))))", "T"),
        ("(progn (setf (btr:pose (mug)) (btr:ensure-pose '((0 3 0.5) (0 0 0 1)))) (prolog:prolog '(btr:step ?w 0.1)) (< 0.3 (z-of 'mug-1) 0.5))", "T"),
        ("(progn (prolog:prolog '(btr:with-copied-world ?w (btr:retract ?w (btr:object mug-1)))) (and (mug) t))", "T"),
        ("(progn (prolog:prolog '(and (btr:bullet-world ?w) (btr:with-stored-world ?w (btr:assert ?w (btr:object-pose mug-1 ((0 3 9) (0 0 0 1))))))) (z-of 'mug-1))", "(z-of 'mug-1)"),
        ("(all `(btr:with-world ,(robot-world:make-world) (btr:object ?w ?x)) '?x)", "NIL"),
        ("(length (cdr (assoc '?p (cut:lazy-car (prolog:prolog '(btr:n-poses-on ?w 4 mug-1 :kitchen ?p))))))", "4"),
        ("(length (cdr (assoc '?p (cut:lazy-car (prolog:prolog '(btr:random-poses-on ?w 3 mug-1 :kitchen ?p))))))", "3"),
        ("(progn (prolog:prolog '(btr:execute ?w (btr:open :kitchen \"sink_area_left_upper_drawer_main\"))) (> (btr:joint-state (named :kitchen) \"sink_area_left_upper_drawer_main_joint\") 0.3))", "T"),
        ("(progn (prolog:prolog '(btr:execute ?w (btr:close :kitchen \"sink_area_left_upper_drawer_main\"))) (btr:joint-state (named :kitchen) \"sink_area_left_upper_drawer_main_joint\"))", "0.0d0"),
        # the head and the arms
        ("(progn (prolog:prolog `(btr:head-pointing-at ?w ,*pr2* ((2 2 1) (0 0 0 1)))) (near (btr:joint-state (robot) \"head_pan_joint\") 0.769))", "T"),
        ("(near (first (btr:calculate-pan-tilt (robot) \"head_pan_link\" \"head_tilt_link\" (btr:ensure-pose '((0 2 1) (0 0 0 1))))) 1.537)", "T"),
        ("(progn (setf (btr:pose (robot)) (btr:ensure-pose '((-1.4 -0.15 0) (0 0 -0.70710678 0.70710678)))) (prolog:prolog `(btr:head-pointing-at ?w ,*pr2* ((-2 -0.9 0.8) (0 0 0 1)))) (proves `(btr:visible ?w ,*pr2* mug-1)))", "T"),
        ("(proves `(btr:visible ?w ,*pr2* mug-1))", "NIL"),
        ("(proves `(btr:point-reachable ?w ,*pr2* (0.6 0.3 0.8)))", "T"),
        ("(proves `(btr:reachable ?w ,*pr2* mug-1))", "NIL"),
        ("(proves `(btr:pose-reachable ?w ,*pr2* ((0.6 -0.3 0.8) (0 0 0 1)) :right))", "T"),
        ("(proves `(btr:pose-reachable ?w ,*pr2* ((3 -0.3 0.8) (0 0 0 1)) :right))", "NIL"),
        ("(progn (setf (btr:pose (mug)) (btr:ensure-pose '((0.6 0.3 0.8) (0 0 0 1)))) (all `(btr:blocking ?w ,*pr2* mug-1 :left ?x) '?x))", "(NIL)"),
        ("(progn (setf (btr:link-pose (robot) \"torso_lift_link\") (btr:ensure-pose '((-0.05 0 0.99) (0 0 0 1)))) (near 0.2 (btr:joint-state (robot) \"torso_lift_joint\")))", "T"),
        ("(setf (btr:link-pose (robot) \"tail\") (btr:ensure-pose '((0 0 0) (0 0 0 1))))", 'Link tail unknown'),
        # time
        ("(let* ((line (btr:timeline-init *world*)) (copy (btr:copy-world *world*))) (setf (btr:pose (btr:object copy 'mug-1)) (btr:ensure-pose '((0 0 5) (0 0 0 1))))"
         " (btr:timeline-advance line (btr:make-event copy '(fell mug-1) 2.0)) (btr:timeline-advance line (btr:make-event *world* '(stood) 1.0))"
         " (btr:with-timeline line (list (mapcar #'second (btr::patterns-and-stamps line)) (all '(coe:occurs (fell ?x) (coe:at ?t)) '?t)"
         "  (all '(coe:occurs ?e (coe:during 0.5 1.5)) '?e) (proves '(coe:holds (btr:object-pose ?w mug-1 ((0 0 5) (0 0 0 1))) (coe:at 2.5)))"
         "  (proves '(coe:holds (btr:object-pose ?w mug-1 ((0 0 5) (0 0 0 1))) (coe:at 1.5))) (proves '(coe:holds (btr:object ?w mug-1) (coe:throughout 0.0 3.0)))"
         "  (proves '(coe:holds (btr:object-pose ?w mug-1 ((0 0 5) (0 0 0 1))) (coe:during 0.0 3.0))) (proves '(coe:holds (btr:object-pose ?w mug-1 ((0 0 5) (0 0 0 1))) (coe:throughout 0.0 3.0))))))",
         "((0.0 1.0 2.0) (2.0) ((STOOD)) T NIL T T NIL)"),
        # meshes
        ("(physics-utils:parse-uri \"package://no_such_package/x.stl\")", "NIL"),
        ("(btr:add-objects-to-mesh-list \"cram_pick_place_tutorial\" :extension \"stl\")", "(:BLUE-METAL-PLATE :CUBE :RED-METAL-PLATE)"),
        ("(list btr:*debug-window* (btr:add-debug-window *world*) (btr:add-vis-axis-object 'mug-1))", "(NIL NIL NIL)"),
        # objects by their names: btr-utils:object-pose is btr's symbol, a function here and a predicate there
        ("(list (eq 'btr-utils:object-pose 'btr:object-pose) (typep (btr-utils:object-pose 'mug-1) 'cl-transforms:pose))", "(T T)"),
        ("(flet ((x () (cl-transforms:x (cl-transforms:origin (btr-utils:object-pose 'mug-1))))) (let ((before (x))) (btr-utils::translate-object 'mug-1 0.1) (near (- (x) before) 0.1)))", "T"),
        # drawings: nothing touches them, and they hide nothing
        ("(list (btr-utils::spawn-object-aabb-box 'mug-1) (near 0 (cl-transforms:v-dist (btr:bounding-box-dimensions (btr:aabb (named 'mug-1-aabb-box))) (btr:bounding-box-dimensions (btr:aabb (mug))))) (btr:find-objects-in-contact *world* (named 'mug-1-aabb-box)))", "(MUG-1-AABB-BOX T NIL)"),
        ("(let ((eye (btr:ensure-pose '((-2 -0.6 0.8) (0.7071 0 0 0.7071))))) (flet ((part () (btr:object-visibility-percentage (btr:calculate-object-visibility *world* eye (mug))))) (let ((before (part))) (btr-utils::spawn-object-aabb-box 'mug-1) (= before (part)))))", "T"),
        ("(progn (setf (btr:pose (mug)) (btr:ensure-pose '((0 3 0.5) (0 0 0 1)))) (btr-utils::spawn-object-aabb-box 'mug-1 :box-name 'b) (let ((before (z-of 'b))) (btr:simulate *world* 10) (list (< (z-of 'mug-1) 0.1) (= before (z-of 'b)) (> before 0.4))))", "(T T T)"),
        ("(btr-utils::spawn-object-aabb-box 'ghost)", 'There is no object GHOST in the world.'),
        # poses by names
        ("(progn (prolog:prolog '(btr-utils:assert-object-pose mug-1 ((0 3 0.7) (0 0 0 1)))) (z-of 'mug-1))", "0.7d0"),
        ("(proves '(btr-utils:assert-object-pose ghost ((0 3 0.7) (0 0 0 1))))", "NIL"),
        ("(let ((?there (cl-transforms-stamped:pose->pose-stamped \"map\" 0.0 (btr:ensure-pose '((0 3 0.7) (0 0 0 1)))))) (prolog:prolog `(btr-utils:assert-object-pose-on mug-1 ,(desig:a location (pose ?there)))) (near 0.7 (- (cl-transforms:z (btr:bounding-box-center (btr:aabb (mug)))) (/ (cl-transforms:z (btr:bounding-box-dimensions (btr:aabb (mug)))) 2))))", "T"),
        # kinds of objects that a program adds
        ("(progn (prolog:def-fact-group of-mine (btr-utils:scenario-object-shape btr-utils:scenario-object-extra-attributes) (prolog:<- (btr-utils:scenario-object-shape :brick :box)) (prolog:<- (btr-utils:scenario-object-extra-attributes ?_ :brick (:size (0.1 0.2 0.3))))) (near 0.3 (cl-transforms:z (btr:calculate-bb-dims (btr-utils:spawn-object 'brick-1 :brick :pose '((0 3 1) (0 0 0 1)))))))", "T"),
        # cl-urdf
        ("(princ-to-string (btr:urdf (named :kitchen)))", '"#<ROBOT iai_kitchen>"'),
        ("(cl-urdf:name (btr:urdf (robot)))", '"pr2"'),
        ("(let ((joint (gethash \"torso_lift_joint\" (cl-urdf:joints (btr:urdf (robot)))))) (list (cl-urdf:joint-type joint) (cl-urdf:upper (cl-urdf:limits joint)) (cl-urdf:name (cl-urdf:parent joint)) (cl-urdf:name (cl-urdf:from-joint (cl-urdf:child joint)))))", '(:PRISMATIC 0.33d0 "base_link" "torso_lift_joint")'),
        ("(type-of (cl-urdf:geometry (cl-urdf:collision (gethash \"base_link\" (cl-urdf:links (btr:urdf (robot)))))))", "CL-URDF:BOX"),
    ],
)  # fmt: skip
def test_what_is_asked_is_answered(ask, form, answer):
    """An answer may also be written as a form with the same value."""
    found = ask(form)
    assert found == answer or found == ask(answer)


@pytest.mark.parametrize(
    ("form", "text"),
    [
        ("(btr:add-object *world* :mesh 'x '((0 0 1) (0 0 0 1)) :mesh :bottel)", "there is no model of the object bottel"),
        ("(btr:add-object *world* :spaceship 'x '((0 0 1) (0 0 0 1)))", "There is no object of type :SPACESHIP"),
        ("(btr:add-object *world* :box 'x '((0 0 1) (0 0 0 1)) :size '(0 1 1))", "lengths are above 0"),
        ("(btr:add-object *world* :mesh 'x '((0 0 1) (0 0 0 1)) :mesh \"/no/such.stl\")", "/no/such.stl: it cannot be read"),
        (
            '(handler-case (btr:add-objects-to-mesh-list "no_such_package") (warning (told) (princ-to-string told)))',
            "There is no ROS package no_such_package",
        ),
        ('(cl-urdf:parse-urdf "<robot>")', "this is no XML"),
    ],
)
def test_what_is_wrong_is_told(ask, form, text):
    assert text in ask(form)


def test_meshes_of_a_package_are_known_by_their_files(ask, tmp_path, monkeypatch):
    from test_meshes import obj, stl_text

    package = tmp_path / "my_things"
    (package / "resource").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>my_things</name></package>")
    (package / "resource" / "tall_box.stl").write_bytes(stl_text())
    (package / "resource" / "other.obj").write_bytes(obj())
    (package / "resource" / "readme.txt").write_text("no mesh")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    assert ask('(btr:add-objects-to-mesh-list "my_things")') == "(:OTHER NIL :TALL-BOX)"
    assert ask("(first btr:*mesh-files*)") == '(:TALL-BOX "package://my_things/resource/tall_box.stl" NIL)'
    assert ask("(near 0.3 (cl-transforms:z (btr:item-dimensions :tall-box)))") == "T"
    assert ask("(btr:item-types (btr-utils:spawn-object 'b :tall-box :pose '((1 3 0.5) (0 0 0 1))))") == "(:TALL-BOX)"
    assert ask("(progn (btr:simulate *world* 10) (abs (z-of 'b)))") == "0.0d0"


def test_what_is_in_a_wall_is_warned_about(ask):
    ask("(btr:add-object *world* :box 'wall '((4 4 0) (0 0 0 1)) :size '(1 1 9) :mass 0)")
    ask("(btr:add-object *world* :box 'stone '((4 4 1) (0 0 0 1)) :size '(0.1 0.1 0.1))")
    text = ask("(handler-case (btr:simulate *world* 10) (warning (problem) (princ-to-string problem)))")
    assert "STONE is inside of WALL and cannot get out" in text


OF_UTILITIES = """spawn-object kill-object kill-all-objects move-object object-instance object-pose object-exists item-exists respawn-object
translate-object spawn-object-aabb-box robot-name move-robot move-robot-away park-robot visualize-designator-costmaps
visualize-gripper"""
OF_FACTS = """scenario-objects-init-pose scenario-objects-default-color scenario-object-color scenario-object-shape
scenario-object-extra-attributes assert-object-pose assert-object-pose-on"""
OF_BELIEF = """setup-world-database set-tf-from-bullet update-bullet-transforms get-designator-object-name get-designator-object
object-pose-in-frame publish-environment-joint-state"""
OF_BELIEF_VARIABLES = "*robot-urdf* *kitchen-urdf* *robot-parameter* *kitchen-parameter* *spawn-debug-window*"


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("package", "names", "there"),
    [
        ("btr-utils", OF_UTILITIES, "(fboundp symbol)"),
        ("btr-belief", OF_BELIEF, "(fboundp symbol)"),
        ("btr-belief", OF_BELIEF_VARIABLES, "(boundp symbol)"),
    ],
)
def test_each_name_of_the_page_is_defined(ask, package, names, there):
    ask("(asdf:load-system :cram-bullet-reasoning-belief-state)")
    quoted = " ".join(f'"{name.upper()}"' for name in names.split())
    assert ask(f"(remove-if (lambda (name) (let ((symbol (find-symbol name :{package}))) (and symbol {there}))) '({quoted}))") == "NIL"


@pytest.mark.parametrize("name", OF_FACTS.split())
def test_each_predicate_of_the_page_has_clauses(session_with_kitchen, ask, name):
    assert database.functors[session_with_kitchen.evaluate_text(f"'btr-utils:{name}")[0]].clauses


def test_a_hand_that_is_shown_is_heard_by_those_who_look_on(ask):
    heard = []
    remarks.listen(listener := lambda kind, value: heard.append((kind, *value)))
    try:
        ask("(setf (btr:pose (robot)) (btr:ensure-pose '((1 0 0) (0 0 0 1))))")
        ask("(asdf:load-system :cram-pr2-projection)")
        assert ask("(btr-utils:visualize-gripper '((1.6 0.3 0.8) (0 0 0 1)) :left)") == "T"
        assert ask("(btr-utils:visualize-gripper '((4 0.3 0.8) (0 0 0 1)) :left)") == "NIL"
    finally:
        remarks.unlisten(listener)
    told = [(kind, [round(float(part), 2) for part in goal.position], reached) for kind, _, goal, reached in heard[:1] + heard[-1:]]
    assert told == [("grasp", [0.6, 0.3, 0.8], True), ("grasp", [3.0, 0.3, 0.8], False)]


SETTINGS = """(prolog:def-fact-group costmap-metadata (costmap:costmap-size costmap:costmap-origin costmap:costmap-resolution)
  (prolog:<- (costmap:costmap-size 12 12)) (prolog:<- (costmap:costmap-origin -6 -6)) (prolog:<- (costmap:costmap-resolution 0.05)))"""


def test_costmaps_are_told_as_text(ask):
    ask("(asdf:load-system :cram-btr-spatial-relations-costmap)")
    ask(SETTINGS)
    at = "(desig:a location (on (desig:an object (type counter-top) (urdf-name sink-area-surface) (part-of kitchen))) (side left))"
    lines = ask(f"(with-output-to-string (*standard-output*) (btr-utils:visualize-designator-costmaps {at}))").strip('"').splitlines()
    told = [line for line in lines if line.startswith("[BTR-UTILS CM] ")]
    assert told[0].startswith("[BTR-UTILS CM] 2 costmaps for #<A LOCATION")
    assert {line for line in told[1:] if "costmap " in line} == {
        "[BTR-UTILS CM] costmap 1: on-bounding-box.",
        "[BTR-UTILS CM] costmap 2: side.",
    }
    assert "[BTR-UTILS CM] all of them: " in "\n".join(told)
    place = [float(part) for part in told[-1].split(": ")[1].split()]
    assert 1.2 < place[0] < 1.9 and -0.3 < place[1] < 1.4 and 0.8 < place[2] < 0.9


def test_the_joints_of_the_kitchen_are_published(ask):
    ask("(asdf:load-system :cram-bullet-reasoning-belief-state)")
    assert ask('(btr-belief::publish-environment-joint-state \'(("a" 1)))') == "NIL"  # no node
    ask("(defvar *told* nil)")
    ask("""(roslisp:with-ros-node ("belief")
             (roslisp:subscribe "kitchen/cram_joint_states" "sensor_msgs/JointState" (lambda (message) (push message *told*)))
             (btr-belief::publish-environment-joint-state '(("a" 1) ("b" . 2)))
             (cpl:sleep 0.5))""")
    assert ask("(roslisp:with-fields (name position) (first *told*) (list name position))") == '(#("a" "b") #(1.0d0 2.0d0))'
