"""What is known of robots. Source: mobile-manipulation.md, section 6 and invariant 10; figures: the constants of pr2.json."""

import json

import pytest

from cramhy_runtime.lisp_core.packages import COMMON_LISP, ensure_package, find_package_or_error


@pytest.fixture
def pr2(session, lisp):
    lisp("(asdf:load-system :cram-pr2-description)")
    interfaces = find_package_or_error("CRAM-ROBOT-INTERFACES")
    session.package = ensure_package("ROBOT-DESCRIPTION-TESTS", use=[COMMON_LISP, interfaces])  # where nobody else has an ARM
    return lisp


@pytest.fixture
def ask(pr2):
    """A function: the values of ``?x`` in all solutions of a goal."""
    return lambda goal: pr2(
        f"(cut:force-ll (cut:lazy-mapcar (lambda (s) (cut:var-value '?x s)) (prolog:prolog '({goal.replace('pr2', 'cram-pr2-description:pr2')}))))"
    )


UNKNOWN = (
    "robot robot-base-frame robot-odom-frame robot-torso-link-joint arm required-arms available-arms arm-joints arm-links arm-base-joints "
    "arm-base-links arm-tool-joints hand-links end-effector-link robot-tool-frame gripper-joint gripper-link robot-arms-parking-joint-states "
    "robot-arms-carrying-joint-states end-effector-parking-pose robot-pre-grasp-joint-states planning-group "
    "standard-to-particular-gripper-transform tcp-in-ee-pose gripper-meter-to-joint-multiplier camera-frame camera-minimal-height camera-maximal-height robot-pan-tilt-links "
    "robot-pan-tilt-joints robot-neck-parking-joint-states robot-neck-looking-joint-states trajectory-point joint-lower-limit joint-type"
)


@pytest.mark.soak
def test_nothing_is_known_without_a_description(lisp):
    """It comes first: the tests behind it load a description."""
    lisp("(asdf:load-system :cram-robot-interfaces)")
    assert lisp("(cram-robot-interfaces:current-robot-symbol)") == "NIL"
    for name in UNKNOWN.split():
        for arguments in ("?a", "?a ?b", "?a ?b ?c"):
            assert lisp(f"(handler-bind ((warning #'muffle-warning)) (prolog:prolog '(cram-robot-interfaces:{name} {arguments})))") == "NIL"
    assert lisp('(cram-robot-interfaces:get-joint-type "torso_lift_joint")') == (
        '"SIMPLE-ERROR: It is not known which file describes the robot. Did you forget to load a robot description package?"'
    )


def test_the_robot(pr2):
    assert pr2("(list (current-robot-symbol) (package-name (current-robot-package)) (current-robot-name))") == (
        '(CRAM-PR2-DESCRIPTION:PR2 "CRAM-PR2-DESCRIPTION" "PR2")'
    )


def lisp_text(value):
    if isinstance(value, (list, tuple)):
        return "(" + " ".join(map(lisp_text, value)) + ")"
    return f'"{value}"' if isinstance(value, str) else f"{value!r}d0"


def test_the_facts_are_those_of_the_figures(ask, pr2, shared):
    told = json.loads((shared / "robots" / "pr2.json").read_text())["constants"]
    for goal, value in {
        "robot-base-frame pr2 ?x": [told["base_frame"]],
        "robot-odom-frame pr2 ?x": [told["odom_frame"]],
        "robot-torso-link-joint pr2 ?x ?joint": [told["torso_link"]],
        "robot-torso-link-joint pr2 ?link ?x": [told["torso_joint"]],
        "camera-frame pr2 ?x": told["camera_frames_in_order"],
        "camera-minimal-height pr2 ?x": [told["camera_minimal_height"]],
        "camera-maximal-height pr2 ?x": [told["camera_maximal_height"]],
        "robot-pan-tilt-links pr2 ?x ?tilt": told["pan_tilt_links"][:1],
        "robot-pan-tilt-joints pr2 ?pan ?x": told["pan_tilt_joints"][1:],
        "planning-group pr2 :left ?x": [told["planning_groups"]["left"]],
        "planning-group pr2 (:left :right) ?x": [told["planning_groups"]["left+right"]],
        "robot-pre-grasp-joint-states pr2 ?x": [[[told["torso_joint"], height]] for height in told["pre_grasp_torso"]],
    }.items():
        assert ask(goal) == lisp_text(value), goal
    assert ask("arm pr2 ?x") == "(" + " ".join(f":{arm.upper()}" for arm in told["arms"]["order"]) + ")"
    for arm in ("left", "right"):
        figures = told["arms"][arm]
        for goal, value in {
            f"arm-joints pr2 :{arm} ?x": [figures["joints"]],
            f"arm-base-joints pr2 :{arm} ?x": [told["arm_base_joints"]],
            f"arm-base-links pr2 :{arm} ?x": [told["arm_base_links"]],
            f"end-effector-link pr2 :{arm} ?x": [figures["end_effector_link"]],
            f"robot-tool-frame pr2 :{arm} ?x": [figures["tool_frame"]],
            f"gripper-joint pr2 :{arm} ?x": figures["gripper_joints"],
            f"hand-links pr2 :{arm} ?x": [[name.replace("l_g", f"{arm[0]}_g", 1) for name in told["hand_links"]["left"]]],
            f"robot-arms-parking-joint-states pr2 ?x :{arm}": [list(told["parking_joint_states"][arm].items())],
            f"robot-arms-carrying-joint-states pr2 ?x :{arm}": [list(told["carrying_joint_states"][arm].items())],
        }.items():
            assert ask(goal) == lisp_text(value), goal
        assert ask(f'and (equal ?x "{arm[0]}_gripper_palm_link") (gripper-link pr2 :{arm} ?x)') == f'("{arm[0]}_gripper_palm_link")'
        assert ask(f'and (equal ?x "base_link") (gripper-link pr2 :{arm} ?x)') == "NIL"
        position = lisp_text(told["end_effector_parking_pose"][arm][0])
        pose = pr2(f"(prin1-to-string (cut:var-value '?x (first (prolog:prolog '(end-effector-parking-pose ?r ?x :{arm})))))")
        assert position.strip("()").split("d0")[0] in pose and told["end_effector_parking_pose"]["frame"] in pose
    matrix = pr2(
        "(cl-transforms:quaternion->matrix (cl-transforms:rotation (cut:var-value '?x (first (prolog:prolog"
        " '(standard-to-particular-gripper-transform ?robot ?x))))))"
    )
    assert [round(float(word.strip("()#2A").replace("d", "e"))) for word in matrix.replace("#2A", "").split()] == sum(
        told["standard_to_pr2_gripper_rotation"], []
    )


@pytest.mark.parametrize(
    "joint, kind, lower, upper, parent, child",
    [
        ("torso_lift_joint", ":PRISMATIC", "0.0d0", "0.33d0", "base_link", "torso_lift_link"),
        ("head_pan_joint", ":REVOLUTE", "-3.007d0", "3.007d0", "torso_lift_link", "head_pan_link"),
        ("r_wrist_roll_joint", ":CONTINUOUS", "NIL", "NIL", "r_wrist_flex_link", "r_wrist_roll_link"),
        ("base_footprint_joint", ":FIXED", "NIL", "NIL", "base_footprint", "base_link"),
    ],
)
def test_joints(pr2, ask, joint, kind, lower, upper, parent, child):
    for name, value in {
        "type": kind, "lower-limit": lower, "upper-limit": upper, "parent": f'"{parent}"', "child": f'"{child}"',
    }.items():  # fmt: skip
        assert pr2(f'(get-joint-{name} "{joint}")') == value
        link = "-link" if value in (f'"{parent}"', f'"{child}"') else ""
        assert ask(f'joint-{name}{link} pr2 "{joint}" ?x') == f"({value})"


def test_axes_and_origins(pr2):
    assert pr2('(cl-transforms:z (get-joint-axis "torso_lift_joint"))') == "1.0d0"
    assert pr2('(cl-transforms:z (cl-transforms:translation (get-joint-origin "base_footprint_joint")))') == "0.051d0"
    assert pr2('(cl-transforms:w (cl-transforms:rotation (get-joint-origin "base_footprint_joint")))') == "1.0d0"


@pytest.mark.parametrize("function", "get-joint-type get-joint-axis get-joint-origin get-joint-child get-joint-lower-limit".split())
def test_a_joint_that_is_not_there(pr2, function):
    assert pr2(f'({function} "torso_joint")') == (
        '"SIMPLE-ERROR: The robot pr2 has no joint \\"torso_joint\\". Did you mean torso_lift_joint?"'
    )


def test_a_description_on_the_parameter_server(pr2):
    robot = (
        "<robot name='toy'><link name='a'/><link name='b'/><joint name='j' type='{}'><parent link='a'/><child link='b'/></joint></robot>"
    )
    pr2('(roslisp-utilities:startup-ros :name "describer")')
    pr2(f'(roslisp:set-param "robot_description" "{robot.format("continuous")}")')
    assert pr2('(list (get-joint-type "j") (get-joint-upper-limit "j"))') == "(:CONTINUOUS NIL)"
    pr2(f'(roslisp:set-param "robot_description" "{robot.format("elastic")}")')
    assert pr2('(get-joint-type "j")').startswith("\"SIMPLE-ERROR: The robot's description cannot be read: ")
    pr2("(roslisp-utilities:shutdown-ros)")
    assert pr2('(get-joint-type "torso_lift_joint")') == ":PRISMATIC"


def test_a_rule_of_the_robots_own(pr2):
    pr2("(prolog:def-fact-group own () (prolog:<- (cram-pr2-description::favourite-cup :left blue)))")
    assert pr2(
        "(list (symbol-to-prolog-rule 'favourite-cup :left) (symbol-to-prolog-rule 'favourite-cup :right) (symbol-to-prolog-rule :no-rule))"
    ) == ("(BLUE CRAM-PR2-DESCRIPTION::FAVOURITE-CUP :NO-RULE)")


def test_designators_about_robots(pr2):
    place = "(desig:make-designator :location '((:{} pr2)))"
    assert pr2(f"(mapcar #'reachability-designator-p (list {place.format('reachable-for')} {place.format('visible-for')}))") == "(T NIL)"
    assert pr2(f"(mapcar #'visibility-designator-p (list {place.format('reachable-for')} {place.format('visible-for')}))") == "(NIL T)"
    action = "(desig:make-designator :action '((:type :{})))"
    for kind, goal in (("trajectory", "trajectory-desig?"), ("constraints", "constraints-desig?")):
        assert pr2(f"(and (prolog:prolog `({goal} ,{action.format(kind)})) t)") == "T"
        assert pr2(f"(prolog:prolog `({goal} ,{action.format('going')}))") == "NIL"
    reach = "(cut:with-vars-bound (?p ?a) (cut:lazy-car (prolog:prolog `(designator-reach-pose ,{} ?p ?a))) (list ?p ?a))"
    assert pr2(reach.format("(desig:make-designator :action '((:pose here) (:arm :left)))")) == "(HERE :LEFT)"
    assert pr2(reach.format("(desig:make-designator :action '((:pose here)))")) == "(HERE :RIGHT)"
