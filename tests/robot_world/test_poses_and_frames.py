"""CRAM-TF: poses as lists, frames, transforms, the place of locations. Source: mobile-manipulation.md, section 8, and invariants 11 to 14."""

import pytest

DEFINE = """(defun vec (x y z) (cl-transforms:make-3d-vector x y z))
            (defun turn (yaw) (cl-transforms:euler->quaternion :az yaw))
            (defun pose (x y z &optional (yaw 0)) (cl-transforms:make-pose (vec x y z) (turn yaw)))
            (defun stamped (frame x y z &optional (yaw 0) (stamp 0.0)) (cl-transforms-stamped:make-pose-stamped frame stamp (vec x y z) (turn yaw)))
            (defun from (parent child x y z &optional (yaw 0) (stamp 0.0))
              (cl-transforms-stamped:make-transform-stamped parent child stamp (vec x y z) (turn yaw)))
            (defun near (number) (let ((n (/ (round (* 1000 number)) 1000))) (if (integerp n) n (float n))))
            (defun shown (thing)
              (etypecase thing
                (cl-transforms-stamped:transform-stamped
                 (list (cl-transforms-stamped:frame-id thing) (cl-transforms-stamped:child-frame-id thing) (near (cl-transforms-stamped:stamp thing))
                       (shown (cl-transforms:translation thing)) (near (cl-transforms:get-yaw (cl-transforms:rotation thing)))))
                (cl-transforms-stamped:pose-stamped
                 (list (cl-transforms-stamped:frame-id thing) (near (cl-transforms-stamped:stamp thing))
                       (shown (cl-transforms:origin thing)) (near (cl-transforms:get-yaw (cl-transforms:orientation thing)))))
                (cl-transforms:pose (list (shown (cl-transforms:origin thing)) (near (cl-transforms:get-yaw (cl-transforms:orientation thing)))))
                (cl-transforms:3d-vector (list (near (cl-transforms:x thing)) (near (cl-transforms:y thing)) (near (cl-transforms:z thing))))
                (list (mapcar (lambda (x) (if (numberp x) (near x) (shown x))) thing))))
            (defvar *tf* (make-instance 'cl-tf:transformer))
            (cl-tf:set-transform *tf* (from "map" "base" 1 2 0.5 (/ pi 2) 5.0))
            (cl-tf:set-transform *tf* (from "base" "hand" 0.5 0 1 0 5.0))"""


@pytest.fixture
def tf(lisp):
    if lisp("(fboundp 'shown)") == "NIL":
        lisp("(asdf:load-system :cram-tf)")
        lisp(DEFINE)
    yield lambda form: lisp(
        f'(let ((cram-tf:*transformer* *tf*) (cram-tf:*fixed-frame* "map") (cram-tf:*robot-base-frame* "base")) {form})'
    )


@pytest.mark.parametrize(
    "kind, numbers", [("flat-list", "(1 2 3 0 0 1 0)"), ("list", "((1 2 3) (0 0 1 0))"), ("flat-list-w-first", "(1 2 3 0 0 0 1)")]
)
def test_poses_as_lists_and_back(tf, kind, numbers):
    assert tf(f"(shown (cram-tf:pose->{kind} (cram-tf:{kind}->pose '{numbers})))") == numbers
    assert tf(f"(shown (cram-tf:{kind}->pose '{numbers}))") == "((1 2 3) 3.142)"


@pytest.mark.parametrize(
    "form, value",
    [
        ("(cram-tf:translate-pose (pose 1 2 3 1) :x-offset 1 :z-offset -0.5)", "((2 2 2.5) 1)"),
        ('(cram-tf:translate-pose (stamped "map" 1 2 3 1 7.0) :y-offset 1)', '("map" 7 (1 3 3) 1)'),
        ('(cram-tf:rotate-pose (stamped "map" 1 2 3 0.25 7.0) :z 0.5)', '("map" 7 (1 2 3) 0.75)'),
        ("(cram-tf:rotate-pose (pose 1 2 3) :z 0.5)", "((1 2 3) 0.5)"),
        ('(cram-tf:pose->transform-stamped "a" "b" 4.0 (pose 1 2 3))', '("a" "b" 4 (1 2 3) 0)'),
        ('(cram-tf:pose-stamped->transform-stamped (stamped "a" 1 2 3 0 4.0) "b")', '("a" "b" 4 (1 2 3) 0)'),
        ('(cram-tf:strip-transform-stamped (from "a" "b" 1 2 3 1 4.0))', '("a" 4 (1 2 3) 1)'),
        ('(cram-tf:transform-stamped-inv (from "a" "b" 1 0 0 (/ pi 2) 4.0))', '("b" "a" 4 (0 1 0) -1.571)'),
        ('(cram-tf:translate-transform-stamped (from "a" "b" 1 2 3 1 4.0) :z-offset 1)', '("a" "b" 4 (1 2 4) 1)'),
        (
            '(cram-tf:copy-transform-stamped (from "a" "b" 1 2 3) :frame-id "c" :translation (vec 0 0 0) :stamp 2.0)',
            '("c" "b" 2 (0 0 0) 0)',
        ),
        ('(cram-tf:apply-transform (from "a" "b" 1 0 0 (/ pi 2) 4.0) (from "b" "c" 1 0 0 0 3.0))', '("a" "c" 3 (1 1 0) 1.571)'),
        (
            '(cram-tf:multiply-transform-stampeds "a" "c" (from "a" "b" 1 0 0 0 4.0) (from "b" "c" 1 0 0 0 9.0) :result-as-pose-or-transform :pose)',
            '("a" 4 (2 0 0) 0)',
        ),
        ('(cram-tf:ensure-pose-in-frame (stamped "hand" 0 0 0 0 5.0) "map")', '("map" 5 (1 2.5 1.5) 1.571)'),
        ('(cram-tf:ensure-pose-in-frame (stamped "hand" 0 0 0 0 99.0) "map" :use-zero-time t)', '("map" 5 (1 2.5 1.5) 1.571)'),
        ('(cram-tf:ensure-pose-in-frame (stamped "map" 1 2 3) "map")', '("map" 0 (1 2 3) 0)'),
        ('(cram-tf:ensure-pose-in-frame (pose 1 2 3) "hand")', '("hand" 0 (1 2 3) 0)'),
        ('(cram-tf:ensure-point-in-frame (cl-transforms-stamped:make-point-stamped "hand" 5.0 (vec 0 0 0)) "map")', "(1 2.5 1.5)"),
        ('(cram-tf:frame-to-pose-in-fixed-frame "hand")', '("map" 5 (1 2.5 1.5) 1.571)'),
        ("(cram-tf:robot-current-pose :use-current-time-p nil)", '("map" 5 (1 2 0) 1.571)'),
    ],
)
def test_values(tf, form, value):
    assert tf(f"(shown {form})") == value


def test_nothing_is_nowhere(tf):
    assert tf('(list (cram-tf:ensure-pose-in-frame nil "map") (cram-tf:ensure-point-in-frame nil "map"))') == "(NIL NIL)"


@pytest.mark.parametrize(
    "form, text",
    [
        ("(cram-tf:rotate-pose (pose 1 2 3) :up 1)", '"SIMPLE-ERROR: [CRAM-TF:ROTATE-POSE] axis UP not specified properly"'),
        (
            "(let ((cram-tf:*transformer* nil)) (cram-tf:robot-current-pose))",
            '"SIMPLE-ERROR: *transformer* is NIL. Have you called STARTUP-ROS?"',
        ),
        (
            "(let ((cram-tf:*fixed-frame* nil)) (desig:reference (desig:make-designator :location `((:of-plain ,(pose 1 2 3))))))",
            '"SIMPLE-ERROR: cram-tf:*fixed-frame* must be set."',
        ),
    ],
)
def test_what_is_wrong_is_told(tf, form, text):
    tf("""(prolog:def-fact-group plain-poses (desig:location-grounding)
            (prolog:<- (desig:location-grounding ?d ?p) (desig:desig-prop ?d (:of-plain ?p))))""")
    assert tf(form) == text


@pytest.mark.parametrize("x, y, z, u", [("x", "b", "b", "c"), ("a", "b", "q", "c"), ("a", "b", "b", "q")])
def test_frames_that_do_not_fit_are_warned_of(tf, x, y, z, u):
    form = f'(cram-tf:multiply-transform-stampeds "a" "c" (from "{x}" "{y}" 1 0 0) (from "{z}" "{u}" 1 0 0))'
    assert "MULTIPLY-TRANSFORM-STAMPEDS" in tf(f"(handler-case {form} (warning (w) (princ-to-string w)))")
    assert tf(f"(handler-bind ((warning #'muffle-warning)) (shown {form}))") == '("a" "c" 0 (2 0 0) 0)'


@pytest.mark.parametrize("metres, degrees, same", [(0.02, 0, "T"), (0.03, 0, "NIL"), (0, 4, "T"), (0, 6, "NIL"), (0.02, 4, "T")])
def test_solutions_that_are_near_are_the_same(tf, metres, degrees, same):
    form = f"(desig:designator-solutions-equal (pose 1 2 3) (pose (+ 1 {metres}) 2 3 (* {degrees} (/ pi 180))))"
    assert tf(form) == same
    moved = f'(stamped "hand" {metres} 0 0 (* {degrees} (/ pi 180)) 5.0)'
    assert tf(f'(desig:designator-solutions-equal (stamped "map" 1 2.5 1.5 (/ pi 2)) {moved})') == same


def test_how_near_poses_are(tf):
    assert (
        tf("(list (cram-tf:poses-equal-p (pose 0 0 0) (pose 0 0 1) 1.1 0.1) (cram-tf:poses-equal-p (pose 0 0 0) (pose 0 0 1 0.2) 1.1 0.1))")
        == "(T NIL)"
    )
    converged = '(cram-tf:tf-frame-converged "base" (stamped "map" 1.1 2 7 (/ pi 2) 5.0) {} 0.1)'
    assert tf(f"(list {converged.format(0.2)} {converged.format(0.05)})") == "(T NIL)"
    assert (
        tf('(let ((far (cram-tf:make-euclidean-distance-filter (stamped "map" 0 0 0) 1))) (mapcar far (list (pose 0.5 0 0) (pose 2 0 0))))')
        == "(NIL T)"
    )


def test_a_location_of_a_pose(tf):
    place = "(desig:make-designator :location `((:pose ,{})))"
    assert tf(f"(shown (desig:reference {place.format('(stamped `base` 1 0 0)'.replace('`', chr(34)))}))") == '("base" 0 (1 0 0) 0)'
    assert tf(f"(shown (desig:reference {place.format('(pose 1 0 0)')}))") == '("map" 0 (1 0 0) 0)'
    assert (
        tf(
            f"""(let ((a {place.format('(stamped "map" 1 2 0)')}) (b {place.format('(stamped "base" 3 0 -0.5 0 5.0)')}))
              (desig:reference a) (desig:reference b)
              (list (shown (desig:designator-pose a)) (near (desig:designator-distance a b))))"""
        )
        == '(("map" 0 (1 2 0) 0) 3)'
    )


@pytest.mark.parametrize(
    "goal, variable, value",
    [
        ('(cram-tf:pose-stamped ,(stamped "map" 1 2 3) ?frame ?stamp ?position ?orientation)', "?frame", '"map"'),
        ("(cram-tf:pose ,(pose 1 2 3) (?x ?y ?z) ?q)", "(near ?z)", "3"),
        ("(and (cram-tf:position ?p (1 2 3)) (cram-tf:orientation ?q (0 0 0 1)) (cram-tf:pose ?v ?p ?q))", "(shown ?v)", "((1 2 3) 0)"),
        ("(cram-tf:poses-equal ,(pose 1 2 3) ,(pose 1 2 3.1) (?d 1))", None, None),
        ("(and (equal ?d 0.2) (cram-tf:poses-equal ,(pose 1 2 3) ,(pose 1 2 3.1) (?d 1)))", "?d", "0.2"),
        (
            '(cram-tf:location-pose ,(desig:make-designator :location `((:pose ,(stamped "map" 1 2 3)))) ?pose)',
            "(shown ?pose)",
            '("map" 0 (1 2 3) 0)',
        ),
    ],
)
def test_predicates(tf, goal, variable, value):
    if variable is None:
        assert tf(f"(handler-bind ((warning #'muffle-warning)) (prolog:prolog `{goal}))") == "NIL"
    else:
        assert tf(f"(cut:with-vars-bound (?frame ?z ?v ?d ?pose) (cut:lazy-car (prolog:prolog `{goal})) {variable})") == value


def test_the_frames_are_those_of_the_robot_when_the_node_starts(lisp):
    lisp("(asdf:load-system :cram-tf)")
    lisp("(asdf:load-system :cram-pr2-description)")
    lisp('(roslisp-utilities:startup-ros :name "tester")')
    assert lisp(
        "(list cram-tf:*fixed-frame* cram-tf:*odom-frame* cram-tf:*robot-base-frame* cram-tf:*robot-torso-frame* cram-tf:*robot-torso-joint*"
        " cram-tf:*robot-left-tool-frame* cram-tf:*robot-right-tool-frame* cram-tf:*tf-default-timeout* (type-of cram-tf:*transformer*))"
    ) == (
        '("map" "odom_combined" "base_footprint" "torso_lift_link" "torso_lift_joint" "l_gripper_tool_frame" "r_gripper_tool_frame" 4.0 '
        "CL-TF:TRANSFORM-LISTENER)"
    )
    lisp("(roslisp-utilities:shutdown-ros)")
    assert lisp("cram-tf:*transformer*") == "NIL"


BROADCAST = """
(asdf:load-system :cram-tf)
(defvar *heard* nil)
(defun sent (parent child x) (cl-transforms-stamped:make-transform-stamped parent child 0.0 (cl-transforms:make-3d-vector x 0 0)
                               (cl-transforms:make-identity-rotation)))
(roslisp-utilities:startup-ros :name "teller")
(roslisp:subscribe "tf" "tf/tfMessage" (lambda (msg) (push (map 'list (lambda (tr) (roslisp:with-fields (child_frame_id) tr child_frame_id))
                                                    (roslisp:with-fields (transforms) msg transforms)) *heard*)))
(let ((teller cram-tf:*broadcaster*))
  (cram-tf:add-transform teller (sent "map" "base" 1))
  (cram-tf:add-transform teller (sent "map" "base" 2))
  (cram-tf:add-transform teller (sent "map" "cup" 3))
  (cram-tf:publish-transforms teller)
  (cram-tf:remove-transform teller "cup")
  (cram-tf:start-publishing-transforms teller)
  (cpl:sleep 0.5)
  (setf cram-tf:*tf-broadcasting-enabled* t)
  (cram-tf:start-publishing-transforms teller)
  (cpl:sleep 0.35)
  (cram-tf:stop-publishing-transforms teller)
  (cpl:sleep 1)
  (list *heard* (cl-transforms:x (cl-transforms:translation (cl-tf:lookup-transform cram-tf:*transformer* "map" "base")))))"""


def test_transforms_are_published_again_and_again_until_it_is_enough(lisp):
    assert lisp(BROADCAST) == '((("base") ("base") ("base") ("base") ("base" "cup")) 2.0d0)'
    lisp("(roslisp-utilities:shutdown-ros)")


MARKER = """
(asdf:load-system :cram-tf)
(defvar *drawn* nil)
(roslisp-utilities:startup-ros :name "painter")
(roslisp:subscribe "visualization_marker" "visualization_msgs/Marker"
  (lambda (msg) (roslisp:with-fields ((frame (frame_id header)) id type (x (x position pose)) (green (g color))) msg
                  (push (list frame id type x green) *drawn*))))
(cram-tf:visualize-marker (cl-transforms-stamped:make-pose-stamped "base" 0.0 (cl-transforms:make-3d-vector 1 0 0)
                                                                   (cl-transforms:make-identity-rotation)))
(cram-tf:visualize-marker (list (cl-transforms:make-identity-pose) (cl-transforms:make-identity-pose))
                          :r-g-b-list '(0 1 0) :marker-type :sphere :id 7 :in-frame "hand")
(cpl:sleep 0.1)
*drawn*"""


def test_poses_are_drawn(lisp):
    assert lisp(MARKER) == '(("hand" 8 2 0.0d0 1.0d0) ("hand" 7 2 0.0d0 1.0d0) ("base" 1 0 1.0d0 0.0d0))'
    lisp("(roslisp-utilities:shutdown-ros)")
