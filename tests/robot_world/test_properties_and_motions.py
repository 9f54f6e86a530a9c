"""PROPERTY, and what motions resolve to. Source: mobile-manipulation.md, sections 3 and 4, and invariants 3 to 7."""

import pytest

DEFINE = """(defvar *place* (desig:make-designator :location '((:name here))))
            (defvar *cup* (desig:make-designator :object '((:type :cup))))
            (defun pose (x) (cl-transforms-stamped:make-pose-stamped
                              "map" 0.0 (cl-transforms:make-3d-vector x 0 0) (cl-transforms:make-identity-rotation)))
            (defun location (&rest xs) (desig:make-designator :location `((:at ,(mapcar #'pose xs)))))
            (defun motion (&rest entries) (desig:make-designator :motion (loop for (key value) on entries by #'cddr collect (list key value))))
            (defun plain (thing)
              (cond ((consp thing) (mapcar #'plain thing))
                    ((typep thing 'cl-transforms:pose) (list :at (round (cl-transforms:x (cl-transforms:origin thing)))))
                    (t thing)))
            (defun solutions (designator)
              (mapcar #'plain (cut:force-ll (cut:lazy-mapcar #'identity (desig:designator-solutions designator)))))
            (defun values-of (designator key)
              (cut:force-ll (cut:lazy-mapcar (lambda (s) (cut:var-value '?v s)) (prolog:prolog `(spec:property ,designator (,key ?v))))))
            (prolog:def-fact-group places (desig:location-grounding)
              (prolog:<- (desig:location-grounding ?d ?pose) (desig:desig-prop ?d (:at ?poses)) (member ?pose ?poses)))"""


@pytest.fixture
def motions(lisp):
    if lisp("(fboundp 'motion)") == "NIL":
        for name in ("cram-common-designators", "cram-tf"):
            lisp(f"(asdf:load-system '#:{name})")
        lisp(DEFINE)
    yield lisp
    lisp("(setf prolog:*break-on-lisp-errors* nil)")


PROPERTIES = {
    "motion": {
        "*place*": "target left-target right-target",
        "*cup*": "object objects",
        '"base"': "frame",
        "0.5": "effort joint-angle",
        ":left": "gripper direction arm",
        "'(:left :right)": "gripper direction arm",
        "'(1 2)": "left-configuration right-configuration",
    },
    "action": {
        "*place*": "target location",
        "'(1 2)": "left-poses right-poses",
        ":left": "gripper arm direction grasp camera type for",
        "'(:left :right)": "gripper arm direction grasp camera",
        "*cup*": "object on-object with-object for",
        "0.5": "position effort distance",
    },
    "location": {"(pose 1)": "pose", "*cup*": "object", ":left": "arm"},
    "object": {":cup": "type part-of", "'cup": "name urdf-name"},
}
LISTED = [(kind, key, value) for kind, values in PROPERTIES.items() for value, keys in values.items() for key in keys.split()]


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("kind", PROPERTIES)
def test_a_listed_property_gives_its_value_and_a_known_one_is_found_twice(motions, kind):
    motions("(setf prolog:*break-on-lisp-errors* t)")
    for _, key, value in (row for row in LISTED if row[0] == kind):
        form = f"(let* ((v {value}) (d (desig:make-designator :{kind} `((:{key} ,v))))) "
        assert motions(form + f"(equal (values-of d :{key}) (list v)))") == "T", (key, value)
        assert motions(form + f"(length (cut:force-ll (prolog:prolog `(spec:property ,d (:{key} ,v))))))") == "2", (key, value)


@pytest.mark.parametrize(
    "kind, key", [("motion", "type"), ("motion", "constraints"), ("motion", "collision-mode"), ("location", "on"), ("object", "size")]
)
def test_a_property_that_is_not_listed_is_found_once_if_it_is_known(motions, kind, key):
    designator = f"(desig:make-designator :{kind} '((:{key} :it)))"
    assert motions(f"(values-of {designator} :{key})") == "NIL"
    assert motions(f"(length (cut:force-ll (prolog:prolog `(spec:property ,{designator} (:{key} :it)))))") == "1"
    assert motions(f"(prolog:prolog `(spec:property ,{designator} (:{key} :other)))") == "NIL"


@pytest.mark.parametrize(
    "kind, key, value, tag, expected",
    [
        ("motion", "target", "5", "MOTION SPEC:PROPERTY", "LOCATION-DESIGNATOR"),
        ("motion", "frame", ":base", "MOTION SPEC:PROPERTY", "STRING"),
        ("action", "effort", ":strong", "ACTION SPEC:PROPERTY", "NUMBER"),
        ("action", "object", "*place*", "ACTION SPEC:PROPERTY", "OBJECT-DESIGNATOR"),
        ("action", "arm", "1", "ACTION SPEC:PROPERTY", "(OR KEYWORD LIST)"),
        ("location", "pose", "'(1 2)", "LOCATION SPEC:PROPERTY", "POSE-STAMPED"),
        ("object", "name", '"cup"', "OBJECT SPEC:PROPERTY", "SYMBOL"),
    ],
)
def test_a_value_of_a_wrong_type_is_told_in_break_mode_only(motions, kind, key, value, tag, expected):
    designator = f"(desig:make-designator :{kind} `((:{key} ,{value})))"
    assert motions(f"(length (values-of {designator} :{key}))") == "1"
    motions("(setf prolog:*break-on-lisp-errors* t)")
    told = motions(f"(values-of {designator} :{key})")
    assert f"[{tag}]: " in told and told.endswith(f'had to be of type {expected}"')


def test_what_is_no_designator_has_no_properties(motions):
    motions("(setf prolog:*break-on-lisp-errors* t)")
    assert "[PROPERTY-MEMBER]: 5 had to be of type" in motions("(values-of 5 :type)")


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    "entries, solution",
    [
        (":type :going :target (location 1)", "(MOVE-BASE (:AT 1))"),
        (":type :moving-torso :joint-angle 0.3", "(MOVE-TORSO 0.3)"),
        (":type :looking :target (location 1)", "(MOVE-HEAD :POSE (:AT 1))"),
        (':type :looking :frame "base"', '(MOVE-HEAD :FRAME "base")'),
        (":type :looking :direction :forward", "(MOVE-HEAD :DIRECTION :FORWARD)"),
        (":type :opening :gripper :left", "(MOVE-GRIPPER-JOINT :OPEN :LEFT)"),
        (":type :closing :gripper :left", "(MOVE-GRIPPER-JOINT :CLOSE :LEFT)"),
        (":type :gripping :gripper :left", "(MOVE-GRIPPER-JOINT :GRIP :LEFT NIL)"),
        (":type :gripping :gripper :left :effort 30", "(MOVE-GRIPPER-JOINT :GRIP :LEFT 30)"),
        (":type :moving-gripper-joint :gripper :left :joint-angle 0.1", "(MOVE-GRIPPER-JOINT 0.1 :LEFT NIL)"),
        (":type :moving-tcp", "(MOVE-TCP NIL NIL NIL)"),
        (":type :moving-tcp :left-target (location 1)", "(MOVE-TCP (:AT 1) NIL NIL)"),
        (
            ":type :moving-tcp :left-target (location 1 2) :right-target (location 3) :collision-mode :allow-all",
            "(MOVE-TCP (:AT 1) (:AT 3) :ALLOW-ALL)",
        ),
        (":type :moving-arm-joints", "(MOVE-JOINTS NIL NIL)"),
        (":type :moving-arm-joints :right-configuration '(1 2)", "(MOVE-JOINTS NIL (1 2))"),
        (':type :moving-with-constraints :constraints "x > 0"', '(MOVE-WITH-CONSTRAINTS "x > 0")'),
    ],
)
def test_a_motion_resolves_to_a_command(motions, entries, solution):
    assert motions(
        f"(let ((*package* (find-package :cram-common-designators))) (prin1-to-string (plain (desig:reference (motion {entries})))))"
    ) == ('"' + solution.replace('"', '\\"') + '"')


@pytest.mark.parametrize("kind, command", [("detecting", "detect"), ("inspecting", "inspect")])
def test_looking_for_an_object_is_about_what_is_known_of_it_now(motions, kind, command):
    assert (
        motions(
            f"(let* ((cup (desig:make-designator :object '((:type :cup)))) (seen (desig:make-designator :object '((:name it)) cup))"
            f" (found (desig:reference (motion :type :{kind} :object cup)))) (list (eq (second found) seen) (eq (first found) 'cram-common-designators:{command})))"
        )
        == "(T T)"
    )


@pytest.mark.parametrize("places", [(1,), (1, 2, 3)])
def test_a_going_motion_has_as_many_solutions_as_its_target(motions, places):
    xs = " ".join(map(str, places))
    expected = "".join(f"(CRAM-COMMON-DESIGNATORS:MOVE-BASE (:AT {x})) " for x in places).strip()
    assert motions(f"(solutions (motion :type :going :target (location {xs})))") == f"({expected})"


@pytest.mark.parametrize(
    "entries", [":type :going", ":type :going :target (location)", ":type :dancing", ":type :opening", ":gripper :left"]
)
def test_a_motion_that_lacks_something_is_not_resolved(motions, entries):
    assert motions(f"(desig:reference (motion {entries}))").startswith('"DESIGNATOR-ERROR: Cannot resolve motion designator')


@pytest.mark.soak
def test_opening_is_another_thing_as_a_motion_than_as_an_action(motions):
    motions("(asdf:load-system :cram-mobile-pick-place-plans)")
    description = "'((:type :opening) (:gripper :left))"
    assert (
        motions(f"(desig:reference (desig:make-designator :motion {description}))")
        == "(CRAM-COMMON-DESIGNATORS:MOVE-GRIPPER-JOINT :OPEN :LEFT)"
    )
    assert motions(
        f"(desig:reference (desig:make-designator :action {description}))"
    ) == "(PP-PLANS::OPEN-OR-CLOSE-GRIPPER :LEFT :OPENING)".replace("PP-PLANS", "CRAM-MOBILE-PICK-PLACE-PLANS")
