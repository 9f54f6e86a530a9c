"""Listeners, broadcasters and messages of tf on the ROS graph."""

import pytest

from cramhy_runtime import kernel


@pytest.fixture
def listening(node):
    """A node with a listener in ``*listener*`` and a broadcaster in ``*sender*``."""
    node(
        "(defvar *listener* (make-instance 'transform-listener)) (defvar *sender* (make-transform-broadcaster))"
        '(defun seen (child) (x (translation (lookup-transform *listener* "map" child :timeout 2))))'
    )
    return node


def test_what_is_sent_is_heard(listening):
    assert (
        listening(
            '(list (send-transform *sender* (at "map" "base" 1.0 1))'
            ' (send-transforms *sender* (at "map" "cup" 1.0 2) (at "cup" "lid" 1.0 3)))'
        )
        == "(1 1)"
    )
    assert listening('(list (seen "base") (seen "lid"))') == "(1.0d0 5.0d0)"
    assert listening('(can-transform *listener* :target-frame "map" :source-frame "base" :time 1.0)') == "T"


def test_a_broadcaster_is_a_publication(listening):
    assert listening("(type-of *sender*)") == "ROSLISP::PUBLICATION"
    assert listening('(type-of (make-transform-broadcaster :topic "elsewhere"))') == "ROSLISP::PUBLICATION"
    assert listening.error("(send-transform *sender* (make-identity-transform))", "type-error").endswith(
        "which is not of type TRANSFORM-STAMPED."
    )
    assert listening.error('(send-transform "/tf" (at "map" "base" 1.0 1))', "no-applicable-method-error")


def test_the_broadcaster_of_tf2_reaches_the_listener(listening):
    # They have two types of messages with one md5 sum, which is what counts on the wire.
    listening('(defvar *two* (cl-tf2:make-transform-broadcaster :topic "/tf"))')
    assert listening('(list (cl-tf2:send-transform *two* (at "map" "base" 1.0 1) (at "map" "cup" 1.0 2)) (seen "cup"))') == "(1 2.0d0)"
    assert listening("(type-of *two*)") == "CL-TF2:TRANSFORM-BROADCASTER"


def test_static_transforms_are_kept_for_who_comes_later(node):
    node(
        '(defvar *static* (cl-tf2:make-transform-broadcaster :topic "/tf_static" :static t))'
        '(cl-tf2:send-transform *static* (at "map" "door" 77.0 3))'
        "(defvar *late* (make-instance 'transform-listener))"
    )
    assert node('(let ((found (lookup-transform *late* "map" "door" :timeout 1))) (list (x (translation found)) (stamp found)))') == (
        "(3.0d0 0.0)"
    )


def test_a_broken_transform_does_not_spoil_the_others(listening):
    listening(
        '(roslisp:publish *sender* (roslisp:make-msg "tf/tfMessage" :transforms'
        ' (vector (roslisp:make-msg "geometry_msgs/TransformStamped" (frame_id header) "map" :child_frame_id "bad")'
        '         (to-msg (at "map" "good" 1.0 4)))))'
    )
    assert listening('(seen "good")') == "4.0d0"
    assert listening('(can-transform *listener* :target-frame "map" :source-frame "bad")') == "NIL"


def test_a_listener_that_is_destroyed_hears_no_more(listening):
    listening('(send-transform *sender* (at "map" "base" 1.0 1)) (seen "base") (cl-tf::destroy *listener*)')
    assert listening('(list (send-transform *sender* (at "map" "base" 2.0 2)) (seen "base"))') == "(0 1.0d0)"
    assert listening("(cl-tf::destroy *listener*)") == "NIL"


def test_a_listener_needs_a_node(lisp):
    assert lisp.error("(make-instance 'transform-listener)") == "Node status is SHUTDOWN"


def test_transforms_are_sent_again_and_again_during_a_body(listening):
    assert (
        listening("""(let ((count 0))
                          (roslisp:subscribe "/tf" "tf/tfMessage" (lambda (message) (declare (ignore message)) (incf count)))
                          (with-tf-broadcasting (*sender* (at "map" "lid" 0.0 6)) (roslisp:wait-duration 1.05))
                          (let ((then count)) (roslisp:wait-duration 1) (list count (= then count) (seen "lid"))))""")
        == "(11 T 6.0d0)"
    )
    ahead = listening.value('(stamp (lookup-transform *listener* "map" "lid"))') - listening.value("(roslisp:ros-time)")
    assert -1.7 < ahead < -0.5  # the last one was sent 1 s ago, half a second ahead


def test_transforms_are_sent_in_the_background_until_the_node_ends(listening):
    listening('(send-static-transforms *sender* 0.2 t (at "map" "door" 0.0 3))')
    assert listening('(seen "door")') == "3.0d0"
    assert "static transforms" in [task.name for task in kernel.active().tasks]
    listening("(roslisp:shutdown-ros-node) (cpl:top-level (cpl:sleep 1))")
    assert "static transforms" not in [task.name for task in kernel.active().tasks]


@pytest.mark.parametrize("interval", ['"often"', "0", "-1.0", "nil"])
def test_the_interval_must_be_a_time_that_passes(listening, interval):
    shown = interval.upper() if interval == "nil" else interval
    for call in ("send-static-transforms *sender* {} t", "send-static-transforms-blocking *sender* {}"):
        assert listening.error(f'({call.format(interval)} (at "map" "door" 0.0 3))', "type-error") == (
            f"The value\n  {shown}\nis not of type\n  (REAL (0))"
        )


def test_messages_of_tf(node):
    assert (
        node(
            '(let ((message (transforms->tf-msg (list (at "map" "a" 1.0 1) (at "map" "b" 1.0 2)))))'
            " (mapcar #'child-frame-id (tf-msg->transforms message)))"
        )
        == '("a" "b")'
    )
    assert node('(stamp (first (tf-msg->transforms (restamp-tf-msg (transform->tf-msg (at "map" "a" 1.0 1)) 9.0))))') == "9.0"
    assert node(
        '(let ((message (to-msg (at "map" "a" 1.0 1)))) (list (eq message (restamp-msg message 5.0)) (stamp (from-msg message))))'
    ) == ("(T 5.0)")


def test_each_kind_of_geometry_has_its_message(node):
    assert node("""(mapcar (lambda (thing) (type-of (to-msg thing)))
                     (list (vec 1 2 3) (make-vector-stamped "map" 0.0 (vec 1 2 3)) (still) (make-identity-pose) (make-identity-transform)
                           (make-point-stamped "map" 0.0 (vec 1 2 3)) (at "map" "a" 1.0 1)))""").replace("GEOMETRY_MSGS-MSG:", "") == (
        "(VECTOR3 VECTOR3 QUATERNION POSE TRANSFORM POINTSTAMPED TRANSFORMSTAMPED)"
    )
    assert node("(map 'list #'type-of (to-msg (list (vec 1 2 3) (still))))") == "(GEOMETRY_MSGS-MSG:VECTOR3 GEOMETRY_MSGS-MSG:QUATERNION)"
    assert node("(to-msg nil)") == "#()"
    for text in ("(to-msg 3)", '(from-msg (roslisp:make-msg "turtlesim/Pose"))', "(from-msg 3)"):
        assert node.error(text, "no-applicable-method-error")
    assert (
        node('(list (x (from-msg (make-point-msg (vec 1 2 3)))) (stamp (from-msg (to-msg (make-point-stamped "map" 2.5 #(1 2 3))))))')
        == "(1.0d0 2.5)"
    )
    assert node('(frame-id (from-msg (make-pose-stamped-msg (make-identity-pose) "map" 1.0)))') == '"map"'
    assert node('(numbers (from-msg (pose-stamped->point-stamped-msg (make-pose-stamped "map" 1.0 (vec 1 2 3) (still)))))') == (
        "(1.0d0 2.0d0 3.0d0)"
    )


def test_messages_that_nobody_filled_in(node):
    assert node('(from-msg (roslisp:make-msg "geometry_msgs/Quaternion"))') == "#<QUATERNION (0.0d0 0.0d0 0.0d0 0.0d0)>"
    assert node('(rotation (from-msg (roslisp:make-msg "geometry_msgs/Transform")))') == "#<QUATERNION (0.0d0 0.0d0 0.0d0 0.0d0)>"
    assert node.error('(from-msg (roslisp:make-msg "geometry_msgs/Pose"))').startswith("Attempted to normalize quaternion")
