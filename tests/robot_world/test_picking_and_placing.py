"""The plans for picking up and placing, run by a robot of tin. Source: mobile-manipulation.md, section 10, invariants 20 to 25, and
bullet-world.md, section 9, for the order of events."""

import pytest

COMMANDS = "CRAM-COMMON-DESIGNATORS:"
EVENTS = "CRAM-PLAN-OCCASIONS-EVENTS:"
MOVED = "ROBOT-STATE-CHANGED"


@pytest.fixture
def told(robot):
    """A function: what the robot's modules were told since the last time, without packages, and the events; both are forgotten."""

    def read():
        answer = robot("(prog1 (list (summary) (reverse *events*)) (setf *told* nil *events* nil))")
        commands, _, events = answer.replace(COMMANDS, "").replace(EVENTS, "").rpartition(" (" if not answer.endswith("NIL)") else " ")
        return commands.removeprefix("("), [] if events == "NIL)" else events.removesuffix("))").split()

    return read


ACTION = "(desig:make-designator :action `({}))"


def perform(*entries):
    return f"(run (exe:perform {ACTION.format(' '.join(f'({entry})' for entry in entries))}))"


def place(*numbers):
    return f",(desig:make-designator :location `((:pose ,(pose {' '.join(map(str, numbers))}))))"


def poses(*heights):
    return "(" + " ".join(f",(pose 0 0 {height})" for height in heights) + ")"


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "entries, commands",
    [
        ((":type :going", f":target {place(1, 2, 0)}"), "(MOVE-BASE 0.0)"),
        ((":type :looking", f":target {place(1, 2, 0.5)}"), "(MOVE-HEAD :POSE 0.5)"),
        ((":type :looking", ':frame "base"', ":camera :head"), '(MOVE-HEAD :FRAME "base")'),
        ((":type :looking", ":direction :forward"), "(MOVE-HEAD :DIRECTION :FORWARD)"),
        ((":type :looking", ":object ,(seen :cup 'cup-1)"), "(MOVE-HEAD :POSE 0.8)"),
        ((":type :releasing", ":gripper :left"), "(MOVE-GRIPPER-JOINT :OPEN :LEFT)"),
        ((":type :gripping", ":gripper :left"), "(MOVE-GRIPPER-JOINT :GRIP :LEFT NIL)"),
        ((":type :gripping", ":gripper :left", ":effort 5"), "(MOVE-GRIPPER-JOINT :GRIP :LEFT 5)"),
        ((":type :opening", ":gripper :left"), "(MOVE-GRIPPER-JOINT :OPEN :LEFT)"),
        ((":type :closing", ":gripper :left"), "(MOVE-GRIPPER-JOINT :CLOSE :LEFT)"),
        ((":type :setting-gripper", ":gripper (:left :right)", ":position 0.1"), "(MOVE-GRIPPER-JOINT 0.1 (:LEFT :RIGHT) NIL)"),
        ((":type :reaching", f":left-poses {poses(1)}"), "(MOVE-TCP 1.0 NIL NIL)"),
        ((":type :lifting", f":right-poses {poses(1)}"), "(MOVE-TCP NIL 1.0 :ALLOW-HAND)"),
        ((":type :putting", f":left-poses {poses(1)}", f":right-poses {poses(2)}"), "(MOVE-TCP 1.0 2.0 :ALLOW-ALL)"),
        ((":type :retracting", ":left-poses ,(pose 0 0 1)"), "(MOVE-TCP 1.0 NIL NIL)"),
    ],
)
def test_an_action_of_one_motion(robot, told, entries, commands):
    robot(perform(*entries))
    assert told() == (f"({commands})", [MOVED])


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("kind", ["pulling", "pushing", "putting", "grasping", "reaching", "retracting", "lifting"])
def test_arms_go_along_their_poses(robot, told, kind):
    robot(perform(f":type :{kind}", f":left-poses {poses(1, 2, 3)}", f":right-poses {poses(4)}"))
    mode = {"lifting": ":ALLOW-HAND", "reaching": "NIL", "retracting": "NIL"}.get(kind, ":ALLOW-ALL")
    assert told() == (f"((MOVE-TCP 1.0 4.0 {mode}) (MOVE-TCP 2.0 NIL {mode}) (MOVE-TCP 3.0 NIL {mode}))", [MOVED] * 3)


def test_nowhere_to_go_is_no_motion(robot, told):
    assert robot(perform(":type :reaching", ":left-poses ()")) == "NIL"
    assert told() == ("NIL", [])


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "entries", [(":type :looking", ":direction :up", ":camera :wrist"), (":type :gripping",), (":type :going",), (":type :dusting",)]
)
def test_an_action_that_means_nothing(robot, entries):
    assert robot(perform(*entries)).startswith('"DESIGNATOR-REFERENCE-FAILURE: Designator #<A ACTION')


def failing(command, count, failure):
    """The form that lets that many motions fail; after the name of the failure come the arguments of the motions that it is about."""
    failure, *arguments = failure.split()
    return f"(setf *failures* (list (list '{command} {count} 'common-fail:{failure} {' '.join(arguments)})))"


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "action, command, failure, tries, outcome",
    [
        ((":type :going", f":target {place(1, 0, 0)}"), "move-base", "navigation-goal-not-reached", 1, "fails"),
        ((":type :gripping", ":gripper :left"), "move-gripper-joint", "gripper-closed-completely", 2, "fails"),
        ((":type :looking", ":direction :forward"), "move-head", "ptu-goal-not-reached", 2, "fails"),
        (
            (":type :detecting", ":object ,(desig:make-designator :object '((:type :cup)))"),
            "detect",
            "perception-low-level-failure",
            5,
            "fails",
        ),
        (
            (":type :detecting", ':object ,(desig:make-designator :object \'((:type :cup) (:cad-model "cup")))'),
            "detect",
            "perception-low-level-failure",
            2,
            "fails",
        ),
        ((":type :releasing", ":gripper :left"), "move-gripper-joint", "gripper-goal-not-reached", 1, "goes on"),
        ((":type :opening", ":gripper :left"), "move-gripper-joint", "gripper-goal-not-reached", 1, "goes on"),
        ((":type :setting-gripper", ":gripper :left", ":position 0.1"), "move-gripper-joint", "gripper-goal-not-reached", 1, "goes on"),
        ((":type :reaching", f":left-poses {poses(1)}"), "move-tcp", "manipulation-pose-unreachable", 1, "fails"),
    ],
)
def test_how_often_it_is_tried(robot, action, command, failure, tries, outcome):
    robot(failing(command, 99, failure))
    answer = robot(perform(*action))
    assert robot("(length *told*)") == str(tries)
    assert answer == (f'"{failure.upper()}: The robot is of tin."' if outcome == "fails" else "NIL")


def test_gripping_works_the_second_time(robot, told):
    robot(failing("move-gripper-joint", 1, "gripper-closed-completely"))
    robot(perform(":type :gripping", ":gripper :left"))
    assert told() == ("((MOVE-GRIPPER-JOINT :GRIP :LEFT NIL) (MOVE-GRIPPER-JOINT :GRIP :LEFT NIL))", [MOVED])


def test_on_the_way_an_arm_may_fail(robot, told):
    robot(failing("move-tcp", 2, "manipulation-goal-not-reached"))
    assert robot(perform(":type :reaching", f":left-poses {poses(1, 2, 3)}")) == "NIL"
    assert told() == ("((MOVE-TCP 1.0 NIL NIL) (MOVE-TCP 2.0 NIL NIL) (MOVE-TCP 3.0 NIL NIL))", [MOVED] * 3)
    robot(failing("move-tcp", 3, "manipulation-goal-not-reached"))
    assert "MANIPULATION-GOAL-NOT-REACHED" in robot(perform(":type :reaching", f":left-poses {poses(1, 2, 3)}"))


def test_what_is_seen_is_told_and_equated(robot, told):
    robot("(setf *things* '((:cup cup-1) (:cup cup-2) (:bowl bowl-1)))")
    assert (
        robot(
            """(let* ((cup (desig:make-designator :object '((:type :cup))))
                  (found (run (exe:perform (desig:make-designator :action `((:type :detecting) (:object ,cup)))))))
             (list (desig:desig-prop-value found :name) (eq found (desig:current-desig cup))))"""
        )
        == "(CUP-1 T)"
    )
    assert told()[1] == ["OBJECT-PERCEIVED-EVENT"]
    assert (
        robot(
            """(let* ((cup (desig:all object (type cup)))
                  (found (run (pp-plans:perceive cup :object-chosing-function #'second))))
             (list (desig:desig-prop-value found :name) (eq found (desig:current-desig cup))))"""
        )
        == "(CUP-2 T)"
    )
    assert told()[1] == ["OBJECT-PERCEIVED-EVENT"] * 2


def test_what_is_not_seen_is_a_failure_about_it(robot):
    assert robot("(run (pp-plans:perceive (desig:make-designator :object '((:type :cup)))))").startswith(
        '"PERCEPTION-OBJECT-NOT-FOUND: Low-level failure happened"'
    )


def test_looking_at_what_was_never_seen(robot):
    assert robot(perform(":type :looking", ":object ,(desig:make-designator :object '((:type :cup)))")).startswith(
        '"PTU-LOW-LEVEL-FAILURE: It is not known where to look for #<A OBJECT'
    )


CARRYING, PARKING = (
    {"left": "1.9652919379395388d0", "right": "-1.712587449591307d0"},
    {"left": "0.1709440184822959d0", "right": "-0.08181428617939712d0"},
)


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    "call, first_angles",
    [
        ("(pp-plans:park-arms)", [(CARRYING["left"], CARRYING["right"])]),
        ("(pp-plans:park-arms :arm :left)", [(CARRYING["left"], None)]),
        ("(pp-plans:park-arms :arm '(:right))", [(None, CARRYING["right"])]),
        ("(pp-plans:park-arms :carry nil)", [(PARKING["left"], None), (None, PARKING["right"])]),
        ("(progn (setf *held* (list '(cup :left))) (pp-plans:park-arms :carry nil))", [(CARRYING["left"], CARRYING["right"])]),
    ],
)
def test_parking(robot, told, call, first_angles):
    robot(f"(run {call})")
    seen = robot("(mapcar (lambda (told) (list (first (second told)) (first (third told)))) (reverse *told*))")
    assert seen == "(" + " ".join(f"({left or 'NIL'} {right or 'NIL'})" for left, right in first_angles) + ")"
    assert told()[1] == [MOVED] * len(first_angles)


def test_parking_may_fail_and_needs_a_description(robot):
    robot(failing("move-joints", 9, "manipulation-goal-not-reached"))
    assert robot("(run (pp-plans:park-arms))") == "NIL"
    assert (
        robot("(pp-plans::parking-values :middle t)")
        == '"SIMPLE-ERROR: ROBOT-ARMS-PARKING-JOINT-STATES undefined! Did you forget to load a robot description package?"'
    )


PICKING = perform(":type :picking-up", ":object ,(seen :bottle 'bottle-1)", ":arm :right", ":grasp :left-side")
PICKED = (
    "((MOVE-GRIPPER-JOINT 0.1 :RIGHT NIL) (MOVE-TCP NIL 0.955 NIL) (MOVE-TCP NIL 0.805 NIL) (MOVE-TCP NIL 0.805 :ALLOW-ALL) "
    "(MOVE-GRIPPER-JOINT :GRIP :RIGHT 60) (MOVE-TCP NIL 0.955 :ALLOW-HAND) (MOVE-TCP NIL 0.955 :ALLOW-HAND))"
)


@pytest.mark.soak
def test_picking_up_and_placing(robot, told, capsys):
    robot(PICKING)
    assert told() == (PICKED, [MOVED] * 5 + ["OBJECT-ATTACHED"] + [MOVED] * 2)
    assert (
        robot("(mapcar (lambda (held) (list (desig:desig-prop-value (first held) :name) (second held))) *held*)") == "((BOTTLE-1 :RIGHT))"
    )
    robot(perform(":type :placing", f":target {place(0.5, 0.2, 0.7)}"))
    assert told() == (
        "((MOVE-TCP NIL 0.855 NIL) (MOVE-TCP NIL 0.855 NIL) (MOVE-TCP NIL 0.705 :ALLOW-ALL) (MOVE-GRIPPER-JOINT :OPEN :RIGHT) "
        "(MOVE-TCP NIL 0.705 NIL) (MOVE-TCP NIL 0.855 NIL))",
        [MOVED] * 4 + ["OBJECT-DETACHED"] + [MOVED] * 2,
    )
    assert robot("*held*") == "NIL"
    assert [line.rpartition(": ")[2] for line in capsys.readouterr().out.splitlines() if line.startswith("[(PICK-PLACE P")] == [
        *("Opening gripper", "Reaching", "Gripping", "Assert grasp into knowledge base", "Lifting"),
        *("Reaching", "Putting", "Opening gripper", "Retract grasp in knowledge base", "Retracting"),
    ]


def test_an_object_is_put_down_by_the_grasp_with_which_it_was_taken(robot, told):
    placing = ACTION.format(f"(:type :placing) (:target {place(0.5, 0.2, 0.7)})")
    sideways = f"(mapcar (lambda (p) (round (* 100 (cl-transforms:x (cl-transforms:origin p))))) (fifth (desig:reference {placing})))"
    robot(PICKING)
    assert robot(sideways) == "(50 50)"
    robot("(setf *held* nil)")
    robot(PICKING.replace(":left-side", ":back"))
    assert robot(sideways) == "(52 52)"


def test_placing_without_a_target_puts_it_back(robot, told):
    robot("(setf *held* (list (list (seen :cup 'cup-1) :left)))")
    robot(perform(":type :placing"))
    assert told()[0].startswith(
        "((MOVE-TCP 0.98 NIL NIL) (MOVE-TCP 0.98 NIL NIL) (MOVE-TCP 0.83 NIL :ALLOW-ALL) (MOVE-GRIPPER-JOINT :OPEN :LEFT)"
    )


@pytest.mark.parametrize("given, found", [("(:arm :left)", "(CUP-1 :LEFT)"), ("(:arm :right)", "(BOWL-1 :RIGHT)"), ("", "(BOWL-1 :RIGHT)")])
def test_what_is_placed_is_what_is_held(robot, given, found):
    robot("(setf *held* (list (list (seen :cup 'cup-1) :left) (list (seen :bowl 'bowl-1) :right)))")
    solution = f"(desig:reference {ACTION.format(f'(:type :placing) {given}')})"
    assert (
        robot(f"(destructuring-bind (object arm &rest poses) (rest {solution}) (list (desig:desig-prop-value object :name) arm))") == found
    )


def test_nothing_held_nothing_placed(robot):
    assert "DESIGNATOR-REFERENCE-FAILURE" in robot(perform(":type :placing", f":target {place(0.5, 0.2, 0.7)}"))


def choices(entries=""):
    action = ACTION.format(f"(:type :picking-up) (:object ,(seen :bottle 'bottle-1)) {entries}")
    all_of_them = f"(cut:force-ll (cut:lazy-mapcar #'identity (desig:designator-solutions {action})))"
    return f"(remove-duplicates (mapcar (lambda (s) (list (third s) (sixth s))) {all_of_them}) :test #'equal :from-end t)"


GRASPS = ":LEFT-SIDE", ":RIGHT-SIDE", ":BACK", ":FRONT"


@pytest.mark.parametrize(
    "entries, arms, grasps",
    [
        ("", (":RIGHT", ":LEFT"), GRASPS),
        ("(:arm :left)", (":LEFT",), GRASPS),
        ("(:grasp :back)", (":RIGHT", ":LEFT"), (":BACK",)),
        ("(:arm :left) (:grasp :front)", (":LEFT",), (":FRONT",)),
    ],
)
def test_one_way_to_pick_up_for_each_arm_and_grasp(robot, entries, arms, grasps):
    assert robot(choices(entries)) == "(" + " ".join(f"({arm} {grasp})" for arm in arms for grasp in grasps) + ")"


@pytest.mark.parametrize(
    "arm, sides", [(":left", (2, 0, 1, 0, 2, 0)), (":right", (0, 2, 0, 1, 0, 2)), ("(:left :right)", (2, 2, 1, 1, 2, 2))]
)
def test_the_poses_are_split_two_one_and_the_rest(robot, arm, sides):
    reference = (
        f"(desig:reference {ACTION.format(f'(:type :picking-up) (:object ,(seen :cup (quote cup-1))) (:arm {arm}) (:grasp :back)')})"
    )
    assert robot(f"(mapcar #'length (nthcdr 6 {reference}))") == "(" + " ".join(map(str, sides)) + ")"


def test_a_plate_is_taken_with_one_hand(robot, told):
    robot(perform(":type :picking-up", ":object ,(seen :plate 'plate-1)", ":arm :left", ":grasp :left-side"))
    assert told()[0].startswith("((MOVE-GRIPPER-JOINT 0.02 :LEFT NIL) (MOVE-TCP 0.965 NIL NIL)")


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "thing",
    [
        "(seen :mug 'mug-1)",
        "(desig:make-designator :object '((:type :cup)))",
        "(desig:make-designator :object '((:type :cup) (:name cup-1)))",
    ],
)
def test_what_cannot_be_picked_up(robot, thing):
    assert "DESIGNATOR-REFERENCE-FAILURE: Designator #<A ACTION" in robot(perform(":type :picking-up", f":object ,{thing}"))


def test_an_arm_that_cannot_reach_ends_it_before_the_object_is_touched(robot, told):
    robot(failing("move-tcp", 2, "manipulation-pose-unreachable"))
    assert "MANIPULATION-POSE-UNREACHABLE" in robot(PICKING)
    assert "OBJECT-ATTACHED" not in told()[1]
    assert robot("*held*") == "NIL"


def test_an_arm_that_gets_not_quite_there_grips_all_the_same(robot, told):
    robot(failing("move-tcp", 9, "manipulation-goal-not-reached :allow-all :allow-hand"))
    robot(PICKING)
    assert told() == (PICKED, [MOVED] * 5 + ["OBJECT-ATTACHED"] + [MOVED] * 2)


def test_a_hand_that_closes_on_nothing_holds_nothing(robot, told):
    robot(failing("move-gripper-joint", 9, "gripper-closed-completely :grip"))
    assert robot(PICKING) == '"GRIPPER-CLOSED-COMPLETELY: The robot is of tin."'
    assert robot("*held*") == "NIL"
    commands, events = told()
    assert commands.count(":GRIP") == 2 and "OBJECT-ATTACHED" not in events


def test_the_gripper_opens_while_the_arm_reaches(robot):
    robot(PICKING)
    assert (
        robot("(destructuring-bind (opening reaching then . more) (reverse *times*) (list (= opening reaching) (< reaching then)))")
        == "(T T)"
    )


def test_a_plan_that_tries_the_other_arm(robot, told):
    """What the readers of the tutorial write: park, and take the other arm."""
    robot(failing("move-tcp", 2, "manipulation-pose-unreachable"))
    robot(
        """(run (let ((arm :right))
                  (cpl:with-retry-counters ((arms 1))
                    (cpl:with-failure-handling
                        (((or common-fail:manipulation-pose-unreachable common-fail:gripper-closed-completely) (e)
                           (declare (ignore e))
                           (cpl:do-retry arms
                             (pp-plans:park-arms :arm arm)
                             (setf arm :left)
                             (cpl:retry))))
                      (exe:perform (desig:make-designator
                                    :action `((:type :picking-up) (:object ,(seen :cup 'cup-1)) (:arm ,arm) (:grasp :back))))))))"""
    )
    commands, events = told()
    assert "(MOVE-JOINTS" in commands and commands.count(":GRIP :LEFT") == 1 and events.count("OBJECT-ATTACHED") == 1
    assert robot("(mapcar #'second *held*)") == "(:LEFT)"
