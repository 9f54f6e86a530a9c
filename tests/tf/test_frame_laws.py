"""The invariants of cl-transforms.md section 10 about frames, as a user types them, and what sections 5 and 7 record beside them."""

import math

import pytest

from cramhy_runtime.tf.buffer import FrameBuffer, Unavailable
from cramhy_runtime.tf.stamped import TransformStamped
from cramhy_runtime.transforms.quaternions import quaternion
from cramhy_runtime.transforms.vectors import vector


@pytest.mark.law("cl-transforms", 39)
def test_how_stamped_things_print(lisp):
    vector, rotation = "#<3D-VECTOR (1.0d0 2.0d0 3.0d0)>", "#<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>"
    assert lisp('(make-pose-stamped "map" 1.5d0 (vec 1 2 3) (still))') == (
        f'#<POSE-STAMPED \n   FRAME-ID: "map", STAMP: 1.5d0\n   {vector}\n   {rotation}>'
    )
    assert lisp('(make-transform-stamped "map" "base" 0.0 (vec 1 2 3) (still))') == (
        f'#<TRANSFORM-STAMPED \n   FRAME-ID: "map", CHILD-FRAME-ID: "base", STAMP: 0.0\n   {vector}\n   {rotation}>'
    )
    for kind in ("POINT", "VECTOR"):
        assert lisp(f'(make-{kind}-stamped "map" 0.0 (vec 1 2 3))') == (
            f'#<{kind}-STAMPED \n   FRAME-ID: "map" STAMP: 0.0\n   V: (1.0d0 2.0d0 3.0d0)>'
        )
    assert lisp("(make-point-stamped nil nil #(1 2 1/2))") == '#<POINT-STAMPED \n   FRAME-ID: "NIL" STAMP: NIL\n   V: (1 2 1/2)>'
    assert lisp('(format nil "     ~a" (make-point-stamped "map" 3 (vec 1 2 3)))') == (
        '"     #<POINT-STAMPED \n   FRAME-ID: \\"map\\" STAMP: 3\n   V: (1.0d0 2.0d0 3.0d0)>"'
    )
    assert lisp("(in-package :cl-user)").endswith(">")
    assert lisp('(cl-tf:make-vector-stamped "map" 0.0 #(1 2 3))').startswith("#<CL-TRANSFORMS-STAMPED:VECTOR-STAMPED \n")


@pytest.mark.law("cl-transforms", 40)
def test_a_pose_goes_into_a_message_and_comes_back(lisp):
    text = '(make-pose-stamped "map" 1.5d0 (vec 1 2 3) (yaw 0.5))'
    assert lisp(f"(from-msg (to-msg {text}))") == lisp(text)
    assert lisp(f"(roslisp:with-fields ((frame (frame_id header)) (x (x position pose))) (to-msg {text}) (list frame x))") == (
        '("map" 1.0d0)'
    )


@pytest.mark.law("cl-transforms", 41)
def test_the_pose_of_a_transform_is_that_of_its_child(lisp):
    assert lisp('(transform-stamped->pose-stamped (at "map" "base" 3.0 1))') == (
        '#<POSE-STAMPED \n   FRAME-ID: "base", STAMP: 3.0\n   #<3D-VECTOR (0.0d0 0.0d0 0.0d0)>\n   #<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>>'
    )


@pytest.mark.law("cl-transforms", 42)
def test_what_becomes_a_pose_in_a_frame(lisp):
    text = "Cannot convert POSE into POSE-STAMPED without `frame-id' and `stamp'."
    assert lisp.error("(ensure-pose-stamped (make-identity-pose))") == text
    assert lisp.error('(ensure-pose-stamped (make-identity-pose) "map")') == text
    assert lisp.condition("(ensure-pose-stamped (make-identity-pose))").hint == (
        'A pose does not know its frame: (ensure-pose-stamped pose "map" 0.0).'
    )
    assert lisp('(let ((pose (ensure-pose-stamped (make-identity-pose) "map" 1.0))) (list (frame-id pose) (stamp pose)))') == '("map" 1.0)'
    assert lisp('(let ((pose (make-pose-stamped "map" 1.0 (vec 1 2 3) (still)))) (eq pose (ensure-pose-stamped pose "odom" 2.0)))') == "T"
    assert lisp("""(mapcar (lambda (pose) (list (frame-id pose) (stamp pose) (numbers (origin pose))))
                     (list (ensure-pose-stamped (at "map" "base" 3.0 1)) (ensure-pose-stamped (at "map" "base" 3.0 1) "odom" 4.0)))""") == (
        '(("map" 3.0 (1.0d0 0.0d0 0.0d0)) ("odom" 4.0 (1.0d0 0.0d0 0.0d0)))'
    )
    assert lisp.error("(ensure-pose-stamped 3)", "no-applicable-method-error")


@pytest.mark.law("cl-transforms", 43)
def test_names_of_frames(lisp):
    assert lisp('(list (unslash-frame "/map/") (unslash-frame " map") (unslash-frame nil) (unslash-frame "a/b"))') == (
        '("map" "map" NIL "a/b")'
    )
    assert lisp('(list (resolve-frame "/pre/" "/map") (resolve-frame nil "map"))') == '("pre/map" "/map")'
    assert lisp.error("(unslash-frame 3)", "type-error") == (
        "The value\n  3\nis not of type\n  STRING\nwhen binding CL-TRANSFORMS-STAMPED::FRAME"
    )


@pytest.mark.law("cl-transforms", 44)
def test_the_example_of_the_buffer(example):
    assert example('(numbers (translation (cached "map" "base" 1.5)))') == "(1.5d0 0.0d0 0.0d0)"
    assert example('(numbers (translation (cached "map" "tool" 1.5)))') == "(1.5d0 1.5d0 0.0d0)"
    assert example('(numbers (translation (cached "tool" "map" 1.5)))') == "(-1.5d0 -1.5d0 -0.0d0)"
    for time in ("nil", "0", "0.0"):
        assert example(f'(let ((newest (cached "map" "base" {time}))) (list (x (translation newest)) (stamp newest)))') == "(2.0d0 2.0)"
    assert example('(let ((found (cached "/map" "base/" 1.5))) (list (frame-id found) (child-frame-id found)))') == '("map" "base")'
    assert example.error('(cached "map" "nope")', "lookup-error") == "The frame nope is not in the graph"
    assert example.condition('(cached "map" "nope")').hint == "Known frames: base, map, tool."
    assert example.error('(lookup-transform *tf* "map" "nope")', "timeout-error") == (
        "No transform was published between frames nope and map"
    )
    assert example.condition('(lookup-transform *tf* "map" "nope")').hint == (
        "The frame nope is not in the graph. Known frames: base, map, tool."
    )
    assert (
        example(
            '(list (can-transform *tf* :target-frame "map" :source-frame "nope")'
            ' (can-transform *tf* :target-frame "map" :source-frame "tool" :time 1.5))'
        )
        == "(NIL T)"
    )
    assert example.error('(can-transform *tf* :target-frame \'map :source-frame "base")', "type-error").startswith("The value\n  ")


@pytest.mark.law("cl-transforms", 45)
def test_a_frame_seen_from_itself(lisp):
    assert lisp("""(let* ((before (roslisp:ros-time)) (found (lookup-transform *tf* "/nowhere" "nowhere")))
                     (list (numbers (translation found)) (q= (rotation found) 1) (<= before (stamp found) (roslisp:ros-time))))""") == (
        "((0.0d0 0.0d0 0.0d0) T T)"
    )


def test_times_that_the_buffer_does_not_know(example):
    known = "What is known of the transform from base to map is from 1.0 to 2.0 s; {} of that. Without a time the newest is taken."
    for time, kind, text in (
        ("0.5", "simple-error", "The assertion (NOT (CL-TF::CACHE-EMPTY CL-TF::CACHE)) failed."),
        ("2.5", "extrapolation-error", "The requested time stamp does not point into the cache."),
        ("11.5", "extrapolation-error", "Requested time points to the future. Cannot transform."),
        ("3.5", "simple-error", "The assertion (NOT (CL-TF::CACHE-EMPTY CL-TF::CACHE)) failed."),
    ):
        asked = f'(cached "map" "base" {time})'
        assert example.error(asked, kind) == text
        where = "0.5 s is 0.5 s in the past" if time == "0.5" else f"{time} s is {float(time) - 2:g} s in the future"
        assert example.condition(asked).hint == known.format(where)
        assert example(f'(can-transform *tf* :target-frame "map" :source-frame "base" :time {time})') == "NIL"


def test_frames_of_two_trees(example):
    example('(told "moon" "crater" 1.0 1)')
    assert example.error('(cached "map" "crater")', "connectivity-error") == (
        "The frames crater\nand map are not connected in the reference frame tree"
    )
    assert example.condition('(cached "map" "crater")').hint == "crater hangs on moon, map on nothing."


def test_the_newest_is_taken_link_by_link(example):
    example('(told "base" "tool" 5.0 0 7)')
    assert example('(let ((found (cached "map" "tool"))) (list (numbers (translation found)) (stamp found)))') == (
        "((2.0d0 7.0d0 0.0d0) 2.0)"
    )
    assert example('(let ((found (cached "tool" "map"))) (list (numbers (translation found)) (stamp found)))') == (
        "((-2.0d0 -7.0d0 -0.0d0) 5.0)"
    )


def test_rotations_are_interpolated_on_the_sphere(lisp):
    lisp('(told "map" "base" 1.0 0) (told "map" "base" 2.0 0 0 (yaw 2d0)) (told "base" "tool" 1.0 1) (told "base" "tool" 2.0 1)')
    assert lisp('(< (abs (- (get-yaw (rotation (cached "map" "base" 1.5))) 1)) 1d-9)') == "T"
    assert lisp('(let ((place (translation (cached "map" "tool" 1.5)))) (< (v-dist place (vec (cos 1d0) (sin 1d0) 0)) 1d-9))') == "T"
    assert (
        lisp("""(let ((there (cached "map" "tool" 1.25)) (back (cached "tool" "map" 1.25)))
                     (< (v-norm (cl-transforms:transform (transform* there back) (vec 0 0 0))) 1d-9))""")
        == "T"
    )


def test_what_comes_late_is_ignored(lisp):
    lisp('(told "map" "base" 5.8 1) (told "map" "base" 5.2 2) (told "map" "base" 5.8 3)')
    assert lisp('(x (translation (cached "map" "base")))') == "3.0d0"
    assert lisp.error('(cached "map" "base" 5.5)', "extrapolation-error")
    lisp('(told "map" "base" 25.0 4) (told "map" "base" 5.9 5)')  # the same bucket, twenty seconds later
    assert lisp('(x (translation (cached "map" "base")))') == "4.0d0"


def test_a_stamp_may_be_any_real(lisp):
    lisp('(told "map" "base" 1/2 1) (told "map" "base" 3/2 2)')
    assert lisp('(list (x (translation (cached "map" "base" 1))) (x (translation (cached "map" "base" 3/2))))') == "(1.5d0 2.0d0)"


def test_a_static_transform_is_found_without_a_time(example):
    example('(told "tool" "tip" 0.0 9)')
    assert example('(x (translation (cached "map" "tip")))') == "11.0d0"
    assert example.error('(cached "tool" "tip" 20.5)', "extrapolation-error") == ("Requested time points to the future. Cannot transform.")
    assert example.condition('(cached "tool" "tip" 20.5)').hint == (
        "The transform from tip to tool is a static one, with the stamp 0: it is found when no time is asked for."
    )


def test_a_frame_that_hangs_on_another_parent_now(example):
    example('(told "hand" "tool" 3.0 5) (told "map" "hand" 3.0 1)')
    assert example('(x (translation (cached "map" "tool")))') == "6.0d0"
    example('(told "base" "tool" 2.5 0 0)')  # late news of the old parent
    assert example('(x (translation (cached "map" "tool")))') == "6.0d0"


def test_transforms_in_a_circle_have_no_result_and_an_end(lisp):
    lisp('(told "a" "b" 1.0 1) (told "b" "c" 1.0 1) (told "c" "a" 1.0 1) (told "x" "y" 1.0 1)')
    assert lisp.error('(cached "x" "a")', "connectivity-error") == "The frame a hangs on itself in the reference frame tree"
    assert lisp.condition('(cached "x" "a")').hint == "Somebody publishes transforms in a circle: a -> c -> b -> a"


@pytest.mark.parametrize(
    "text, message",
    [
        ('(told "map" "/map" 1.0 1)', "The frame map cannot be its own parent."),
        ('(told "" "base" 1.0 1)', "A transform needs the names of both frames: the parent's and the child's."),
        ('(told nil "base" 1.0 1)', "A transform needs the names of both frames: the parent's and the child's."),
        ('(told "map" "base" nil 1)', "The transform from base to map needs the time it holds for, in seconds."),
    ],
)
def test_what_is_no_transform_between_frames(lisp, text, message):
    assert lisp.error(text, "invalid-argument-error") == message


def test_arguments_that_are_no_transforms(lisp):
    assert lisp.error("(set-transform *tf* (make-identity-transform))", "type-error").endswith("which is not of type TRANSFORM-STAMPED.")
    assert lisp.error('(set-transform *tf* (make-transform-stamped "map" "base" 1.0 \'(1 2 3) (still)))', "type-error")
    assert lisp.error('(transform-pose-stamped *tf* :target-frame "map" :pose 3)', "type-error").endswith(
        "POSE is 3, which is not of type POSE-STAMPED."
    )
    assert lisp.error('(transform-point-stamped *tf* :target-frame "map" :point (vec 1 2 3))', "type-error").endswith(
        "POINT is #<3D-VECTOR (1.0d0 2.0d0 3.0d0)>, which is not of type POINT-STAMPED."
    )
    assert lisp.error('(lookup-transform 3 "map" "base")', "no-applicable-method-error")


def test_poses_and_points_seen_from_elsewhere(example):
    pose = '(make-pose-stamped "tool" 1.5 (vec 1 0 0) (yaw 0.5))'
    for function in ("transform-pose-stamped", "transform-pose"):
        assert (
            example(
                f'(let ((pose ({function} *tf* :target-frame "map" :pose {pose})))'
                " (list (frame-id pose) (stamp pose) (numbers (origin pose))))"
            )
            == '("map" 1.5d0 (2.5d0 1.5d0 0.0d0))'
        )
    for function in ("transform-point-stamped", "transform-point"):
        assert example(f'({function} *tf* :target-frame "map" :point (make-point-stamped "tool" 1.5 (vec 1 0 0)))') == (
            '#<POINT-STAMPED \n   FRAME-ID: "map" STAMP: 1.5d0\n   V: (2.5d0 1.5d0 0.0d0)>'
        )
    assert example.error(f'(transform-pose-stamped *tf* :target-frame "map" :pose {pose} :use-current-ros-time t)', "timeout-error")


def test_options_that_only_a_server_knows_are_warned_of(example):
    assert example.warnings('(lookup-transform *tf* "map" "base" :fixed-frame "map")') == (
        "WARNING:\n   TARGET-TIME and FIXED-FRAME are ignored by CL-TF; a CL-TF2:BUFFER-CLIENT knows them.\n"
    )


@pytest.mark.parametrize(
    "text",
    [
        '(lookup-transform *tf* "map" "base" :time "now")',
        '(lookup-transform *tf* "map" "base" :timeout "now")',
        '(wait-for-transform *tf* :target-frame "map" :source-frame "base" :timeout "now")',
        '(cached "map" "base" "now")',
        '(can-transform *tf* :target-frame "map" :source-frame "base" :time "now")',
    ],
)
def test_a_time_is_a_number(lisp, text):
    assert lisp.error(text, "type-error") == 'The value\n  "now"\nis not of type\n  REAL'


@pytest.mark.parametrize(
    "text, value, type_, parameter",
    [
        ('(make-pose-stamped 1.5 "map" (vec 1 2 3) (still))', "1.5", "STRING", "FRAME-ID"),
        ('(make-pose-stamped "map" "now" (vec 1 2 3) (still))', '"now"', "REAL", "STAMP"),
        ('(make-point-stamped 1.5 "map" (vec 1 2 3))', "1.5", "STRING", "FRAME-ID"),
        ('(make-vector-stamped "map" \'now (vec 1 2 3))', "NOW", "REAL", "STAMP"),
        ('(make-transform-stamped "map" 1.5 "base" (vec 1 2 3) (still))', '"base"', "REAL", "STAMP"),
        ('(make-transform-stamped "map" 2 1.5 (vec 1 2 3) (still))', "2", "STRING", "CHILD-FRAME-ID"),
        ('(pose->pose-stamped 0 "map" (make-identity-pose))', "0", "STRING", "FRAME-ID"),
        ("(make-instance 'pose-stamped :frame-id 1.5)", "1.5", "STRING", "FRAME-ID"),
        ('(copy-pose-stamped (make-pose-stamped "map" 0 (vec 1 2 3) (still)) :stamp "now")', '"now"', "REAL", "STAMP"),
    ],
)
def test_frame_and_stamp_exchanged(lisp, text, value, type_, parameter):
    assert lisp.error(text, "type-error") == (
        f"The value\n  {value}\nis not of type\n  {type_}\nwhen binding CL-TRANSFORMS-STAMPED:{parameter}"
    )
    assert lisp.hint(text) == "Frames come first, then the stamp in seconds, then the geometry."


def test_a_time_without_end_is_no_time(example):
    for text in (
        '(cached "map" "base" sb-ext:double-float-positive-infinity)',
        '(lookup-transform *tf* "map" "base" :time sb-ext:double-float-positive-infinity)',
    ):
        assert example.error(text, "invalid-argument-error") == (
            "The transform from base to map cannot be known at the time inf: a time is a number of seconds."
        )


@pytest.mark.parametrize("time", [math.inf, -math.inf, math.nan, "now"])
def test_python_asks_the_buffer_for_a_time_that_is_none(time):
    buffer = FrameBuffer()
    buffer.store(TransformStamped("map", "base", 1.0))
    with pytest.raises(ValueError) as problem:
        buffer.lookup("map", "base", time)
    assert str(problem.value) == f"The transform from base to map cannot be known at the time {time}: a time is a number of seconds."


@pytest.mark.parametrize(
    "text, kind, hint",
    [
        ("(transforms->tf-msg 3)", "type-error", None),
        (
            '(from-msg (roslisp:make-msg "geometry_msgs/Pose" :position nil))',
            "no-applicable-method-error",
            "geometry_msgs/Pose: position holds NIL, which is no geometry_msgs/Point.",
        ),
        (
            '(from-msg (roslisp:make-msg "geometry_msgs/PoseStamped" :header nil))',
            "no-applicable-method-error",
            "geometry_msgs/PoseStamped: header holds NIL, which is no std_msgs/Header.",
        ),
        ("(slerp (still) (yaw 1.0) sb-ext:double-float-positive-infinity)", "floating-point-invalid-operation", None),
    ],
)
def test_what_python_would_stumble_over(lisp, text, kind, hint):
    condition = lisp.condition(text)
    assert lisp.error(text, kind) and getattr(condition, "hint", None) == hint


@pytest.mark.parametrize(
    ("time", "where"),
    [
        (0.5, "0.5 s is 0.5 s in the past of that"),
        (-30.0, "-30.0 s is 31 s in the past of that"),
        (9.5, "9.5 s is 0.5 s in the future of that"),
        (40, "40.0 s is 31 s in the future of that"),
    ],
)
def test_python_is_told_whether_a_time_is_past_or_future(time, where):
    frames = FrameBuffer()
    for stamp in (1.0, 2.0, 9.0):
        frames.store(TransformStamped("map", "base", stamp, vector((stamp, 0.0, 0.0)), quaternion((0.0, 0.0, 0.0, 1.0))))
    with pytest.raises(Unavailable) as caught:
        frames.lookup("map", "base", time)
    assert str(caught.value) == (
        f"The transform from base to map is not known at {float(time)} s. What is known of the transform from base to map is from 1.0 to "
        f"9.0 s; {where}. Without a time the newest is taken."
    )


@pytest.mark.parametrize("frame", ["map", "base", "/base"])
@pytest.mark.parametrize(("time", "stamp"), [(None, {"map": 0.0, "base": 2.0}), (0.3, {"map": 0.3, "base": 0.3})])
def test_the_transform_from_a_frame_to_itself_is_the_identity(frame, time, stamp):
    frames = FrameBuffer()
    frames.store(TransformStamped("map", "base", 2.0, vector((7.0, 0.0, 0.0)), quaternion((0.0, 0.0, 0.0, 1.0))))
    same = frames.lookup(frame, frame, time)
    assert list(same.translation) == [0.0, 0.0, 0.0] and same.rotation.w == 1.0 and same.stamp == stamp[frame.strip("/")]
    assert same.frame_id == same.child_frame_id == frame.strip("/")
    with pytest.raises(Unavailable, match="The frame nowhere is not in the graph"):
        frames.lookup("nowhere", "nowhere", time)
