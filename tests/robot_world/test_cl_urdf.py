"""CL-URDF: a robot is an object with the original's slots, which programs read and change; a world takes the changes."""

from __future__ import annotations

import pytest
from lisp_text import LispText

from cramhy_runtime.lisp_core.packages import find_package

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

ARM = """<robot name="arm">
  <material name="red"><color rgba="1 0 0 1"/></material>
  <link name="odom"/>
  <link name="base"><inertial><mass value="2"/></inertial>
    <collision><origin xyz="0 0 0.1"/><geometry><box size="0.2 0.3 0.2"/></geometry></collision>
    <visual><geometry><mesh filename="package://arm/base.stl" scale="2 2 2"/></geometry><material name="red"/></visual></link>
  <link name="upper"><collision><geometry><cylinder radius="0.02" length="0.4"/></geometry></collision></link>
  <link name="tip"/>
  <joint name="drive" type="prismatic"><parent link="odom"/><child link="base"/><axis xyz="1 0 0"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <joint name="lift" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.3"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="2" effort="5" velocity="3"/></joint>
  <joint name="end" type="fixed"><parent link="upper"/><child link="tip"/><origin xyz="0 0 0.4"/><mimic joint="lift" multiplier="2" offset="1"/></joint>
</robot>"""
PRELUDE = f"""
(asdf:load-system :cram-bullet-reasoning)
(defpackage :urdf-tests (:use :cl))
(in-package :urdf-tests)
(defparameter *text* {'"' + ARM.replace('"', chr(92) + '"') + '"'})
(defun arm () (cl-urdf:parse-urdf *text*))
(defun link (robot name) (gethash name (cl-urdf:links robot)))
(defun joint (robot name) (gethash name (cl-urdf:joints robot)))
(defun at (x y z) (cl-transforms:make-transform (cl-transforms:make-3d-vector x y z) (cl-transforms:make-identity-rotation)))
(defun near (transform) (list (round (cl-transforms:x transform) 0.001) (round (cl-transforms:z transform) 0.001)))
(defun in-world (robot)
  (btr:add-object (setf btr:*current-bullet-world* (make-instance 'btr:bt-reasoning-world)) :urdf :arm '((0 0 0) (0 0 0 1)) :urdf robot))
(defun height (machine link) (round (cl-transforms:z (cl-transforms:origin (btr:link-pose machine link))) 0.001))
"""
NAMES = """upper lower effort velocity joint-type joint type name axis origin parent child limits mimics multiplier offset inertial mass inertia
    geometry box size cylinder radius length cylinder-length sphere mesh filename scale material color texture visual visuals collision
    collisions link from-joint to-joints robot links joints root-link materials urdf-type-not-supported urdf-attribute-not-supported
    urdf-malformed parse-urdf generate-urdf-xml generate-urdf-string *display-ignored-warning* get-link-chain get-joint-chain""".split()


@pytest.fixture
def lisp(session):
    return LispText(session, "(in-package :urdf-tests)" if find_package("URDF-TESTS") else PRELUDE)


def test_the_exported_names_are_the_original_s(lisp):
    names = lisp("(let (names) (do-external-symbols (name :cl-urdf) (push (string-downcase name) names)) names)")
    assert sorted(names.replace('"', " ").strip("()").split()) == sorted(NAMES)


@pytest.mark.soak(all_but=12)
@pytest.mark.parametrize(
    ("form", "value"),
    [
        ("(cl-urdf:name (cl-urdf:root-link r))", '"odom"'),
        ("(cl-urdf:name (slot-value r 'cl-urdf:root-link))", '"odom"'),
        ("(sort (loop for name being the hash-keys of (slot-value r 'cl-urdf:links) collect name) #'string<)", '("base" "odom" "tip" "upper")'),
        ("(hash-table-count (slot-value r 'cl-urdf:joints))", "3"),
        ("(with-slots (cl-urdf:name cl-urdf:materials) r (list cl-urdf:name (hash-table-count cl-urdf:materials)))", '("arm" 1)'),
        ("(cl-urdf:color (gethash \"red\" (cl-urdf:materials r)))", "(1.0d0 0.0d0 0.0d0 1.0d0)"),
        ("(slot-value (joint r \"lift\") 'cl-urdf:type)", ":REVOLUTE"),
        ("(cl-urdf:joint-type (joint r \"drive\"))", ":PRISMATIC"),
        ("(let ((limits (cl-urdf:limits (joint r \"lift\")))) (list (cl-urdf:lower limits) (cl-urdf:upper limits) (cl-urdf:velocity limits)))",
         "(-1.0d0 2.0d0 3.0d0)"),
        ("(list (slot-boundp (joint r \"lift\") 'cl-urdf:mimics) (cl-urdf:mimics (joint r \"lift\")))", "(NIL NIL)"),
        ("(let ((m (cl-urdf:mimics (joint r \"end\")))) (list (cl-urdf:joint m) (cl-urdf:multiplier m) (cl-urdf:offset m)))", '("lift" 2.0d0 1.0d0)'),
        ("(cl-urdf:mass (cl-urdf:inertial (link r \"base\")))", "2.0d0"),
        ("(let ((v (cl-urdf:visual (link r \"base\")))) (list (cl-urdf:filename (cl-urdf:geometry v)) (cl-urdf:name (cl-urdf:material v))))",
         '("package://arm/base.stl" "red")'),
        ("(cl-transforms:y (cl-urdf:size (cl-urdf:geometry (cl-urdf:collision (link r \"base\")))))", "0.3d0"),
        ("(list (typep (cl-urdf:geometry (cl-urdf:collision (link r \"upper\"))) 'cl-urdf:geometry) (slot-value (cl-urdf:geometry (cl-urdf:collision"
         " (link r \"upper\"))) 'cl-urdf:length))", "(T 0.4d0)"),
        ("(list (cl-urdf:collision (link r \"tip\")) (length (cl-urdf:visuals (link r \"base\"))))", "(NIL 1)"),
        ("(mapcar #'cl-urdf:name (cl-urdf:get-joint-chain r \"odom\" \"tip\"))", '("drive" "lift")'),
        ("(mapcar #'cl-urdf:name (cl-urdf:get-link-chain r \"odom\" \"tip\"))", '("odom" "base" "upper")'),
        ("(list (cl-urdf:get-joint-chain r \"tip\" \"odom\") (cl-urdf:get-link-chain r \"tip\" \"odom\"))", "(NIL NIL)"),
        ("(cl-urdf:name (cl-urdf:parse-urdf (cl-urdf:generate-urdf-string r)))", '"arm"'),
        ("(princ-to-string r)", '"#<ROBOT arm>"'),
        ("(hash-table-count (cl-urdf:links (make-instance 'cl-urdf:robot :name \"new\")))", "0"),
    ],
)  # fmt: skip
def test_what_a_file_says(lisp, form, value):
    assert lisp(f"(let ((r (arm))) {form})") == value


def test_a_robot_in_a_world_is_the_one_that_was_put_there(lisp):
    assert lisp(
        "(let* ((r (arm)) (machine (in-world r))) (list (eq r (btr:urdf machine)) (eq (btr:urdf machine) (slot-value machine 'btr:urdf))))"
    ) == ("(T T)")
    assert lisp("(typep (btr:urdf (in-world *text*)) 'cl-urdf:robot)") == "T"


def test_a_world_begins_with_the_root_that_a_program_has_set(lisp):
    machine = '(in-world (let ((r (arm))) (setf (slot-value r \'cl-urdf:root-link) (link r "base")) r))'
    assert lisp(f"(let ((machine {machine})) (list (sort (btr:link-names machine) #'string<) (btr:joint-names machine)))") == (
        '(("base" "tip" "upper") ("lift"))'
    )
    assert lisp(f"(cl-urdf:name (cl-urdf:root-link (btr:urdf {machine})))") == '"base"'


def test_a_world_takes_joints_and_shapes_that_a_program_has_put_elsewhere(lisp):
    assert lisp('(let ((m (in-world (arm)))) (list (height m "upper") (height m "tip")))') == "(300 700)"
    moved = '(let ((r (arm))) (setf (slot-value (joint r "lift") \'cl-urdf:origin) (at 0 0 1)) r)'
    assert lisp(f'(let ((m (in-world {moved}))) (list (height m "upper") (height m "tip")))') == "(1000 1400)"
    larger = """(let ((r (arm))) (setf (slot-value (link r "odom") 'cl-urdf:collision)
        (make-instance 'cl-urdf:collision :origin (at 0 0 3) :geometry (make-instance 'cl-urdf:box :size (cl-transforms:make-3d-vector 1 1 1))))
        r)"""
    top = "(round (+ (cl-transforms:z (btr:bounding-box-center (btr:aabb m))) (/ (cl-transforms:z (btr:bounding-box-dimensions (btr:aabb m))) 2)) 0.001)"
    assert lisp(f"(let ((m (in-world {larger}))) (values {top}))") == "3500"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("<robot", "this is no XML"),
        ("<robot/>", "the robot has no <link>."),
        ("<robot><link/></robot>", 'the attribute name="..." is missing.'),
    ],
)
def test_a_text_that_is_wrong_is_malformed(lisp, text, said):
    assert said in lisp(f'(handler-case (cl-urdf:parse-urdf "{text}") (cl-urdf:urdf-malformed (e) (princ-to-string e)))').replace("\\", "")


NO_FILE = "there is no file of this name, and it is not the text of a description: that begins with <."


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("/missing.urdf", f"/missing.urdf: {NO_FILE}"),
        ("missing.urdf", f"missing.urdf: {NO_FILE}"),
        ("robots/missing.xacro", f"robots/missing.xacro: {NO_FILE}"),
        ("package://nowhere/arm.urdf", f"package://nowhere/arm.urdf: {NO_FILE}"),
        ("", "the description, line 1: this is no XML: it is empty."),
        ("hello", "the description, line 1: this is no XML: syntax error, column 1."),
    ],
)
def test_a_name_instead_of_a_text_is_told(lisp, text, said):
    """In both readers of a text, of which the second looks for what worlds do not need."""
    report = "(cl-urdf:urdf-malformed (e) (princ-to-string e))"
    assert lisp(f'(handler-case (cl-urdf:parse-urdf "{text}") {report})') == f'"{said}"'
    assert lisp.error(f'(robot-world:description-parts "{text}")') == said


def test_a_file_that_is_there_is_given_as_a_pathname(lisp, tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text("<robot name='r'><link name='a'/></robot>")
    said = lisp(f'(handler-case (cl-urdf:parse-urdf "{path}") (cl-urdf:urdf-malformed (e) (princ-to-string e)))').replace("\\", "")
    assert said == (
        f'"{path} is the name of a file, and PARSE-URDF takes a string for the text of a robot. '
        f'A file is given as a pathname: (cl-urdf:parse-urdf #P"{path}")"'
    )
    assert lisp(f'(cl-urdf:name (cl-urdf:parse-urdf #p"{path}"))') == '"r"'
    path.write_text("")
    assert (
        lisp(f'(handler-case (cl-urdf:parse-urdf #p"{path}") (cl-urdf:urdf-malformed (e) (princ-to-string e)))')
        == f'"{path}, line 1: this is no XML: it is empty."'
    )


def test_a_file_that_is_missing_is_named(lisp):
    assert "missing.urdf" in lisp.error('(cl-urdf:parse-urdf #p"/missing.urdf")')
    assert "missing.xacro" in lisp.error('(cl-urdf:parse-urdf #p"/missing.xacro")')
    assert "missing.urdf" in lisp.error('(robot-world:description-text "/missing.urdf")')


def test_a_robot_as_an_element_of_s_xml(lisp):
    assert lisp("(s-xml:xml-element-name (cl-urdf:generate-urdf-xml (arm)))") == ":|robot|"
    again = "(cl-urdf:parse-urdf (s-xml:print-xml-string (cl-urdf:generate-urdf-xml (arm)) :input-type :xml-struct))"
    assert lisp(f"(equal (cl-urdf:generate-urdf-string {again}) (cl-urdf:generate-urdf-string (arm)))") == "T"


def test_what_is_missing_is_named(lisp):
    assert lisp.error('(cl-urdf:get-link-chain (arm) "odom" "hand")') == 'There is no link "hand" in #<ROBOT arm>.'
    assert "was not read from a description" in lisp.error('(in-world (make-instance \'cl-urdf:robot :name "r"))')
