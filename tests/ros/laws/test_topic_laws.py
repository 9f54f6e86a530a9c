"""Invariants 34 to 40 of roslisp.md: topics, as a user types them; and what else the page says about them."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.packages import intern
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class

HELPERS = """
    (defvar *got* nil)
    (defun text (data) (make-msg "std_msgs/String" :data data))
    (defun hear (name) (lambda (m) (setf *got* (append *got* (list (list name (std_msgs-msg:data m)))))))
"""


@pytest.fixture
def node(node):
    node(HELPERS)
    return node


@pytest.mark.law("roslisp", 34)
def test_publish_returns_how_many_listen(node):
    assert node("""(defvar *pub* (advertise "t" "std_msgs/String")) (publish *pub* (text "a"))""") == "0"
    assert node("""(subscribe "t" "std_msgs/String" #'identity)
                   (list (publish *pub* (text "b")) (publish "t" (text "c")) (publish-msg *pub* :data "d") (num-subscribers *pub*))""") == (
        "(1 1 1 1)"
    )


@pytest.mark.law("roslisp", 35)
def test_callbacks_run_newest_first_in_the_thread_of_their_topic(node):
    intern("HERE", node.session.package).function = lambda: kernel.current().name
    assert (
        node("""
        (defun who (name) (lambda (m) m (note (list name (here)))))
        (subscribe "t" "std_msgs/String" (who 'old)) (subscribe "t" "std_msgs/String" (who 'new))
        (publish (advertise "t" "std_msgs/String") (text "a"))
        (wait-duration 0.1)
        *notes*""")
        == '((NEW "Subscriber thread for topic /t") (OLD "Subscriber thread for topic /t"))'
    )


@pytest.mark.law("roslisp", 36)
def test_a_callback_that_fails_costs_a_line_and_nothing_else(node):
    node("""(subscribe "t" "std_msgs/String" (hear 'other))
            (subscribe "t" "std_msgs/String" (lambda (m) (error "kaboom ~a" (std_msgs-msg:data m))))
            (defvar *pub* (advertise "t" "std_msgs/String"))""")
    assert node('(publish *pub* (text "a")) (wait-duration 0.1) (publish *pub* (text "b")) (wait-duration 0.1) *got*') == (
        '((OTHER "a") (OTHER "b"))'
    )
    assert node.printed() == [
        line
        for data in "ab"
        for line in (
            f"[(ROSLISP SERVICE TCP) ERROR] T: Error during subscriber callback: 'kaboom {data}' for topic item: ",
            "[STRING",
            "   DATA:",
            f"     {data}] ",
        )
    ]


@pytest.mark.law("roslisp", 37)
def test_of_a_short_queue_the_oldest_are_dropped(node):
    node("""(set-debug-level '(roslisp deserialization-thread) :debug)
            (subscribe "t" "std_msgs/String" (lambda (m) (note (std_msgs-msg:data m)) (wait-duration 0.3)) :max-queue-length 2)""")
    node.printed()
    assert (
        node("""(let ((pub (advertise "t" "std_msgs/String"))) (dotimes (i 10) (publish pub (text (format nil "~a" i)))))
                   (wait-duration 2) *notes*""")
        == '("0" "8" "9")'
    )
    assert node.printed() == ["[(ROSLISP DESERIALIZATION-THREAD) DEBUG] T: Dropped 1 messages on topic /t"] * 7


@pytest.mark.law("roslisp", 38)
def test_a_latched_message_waits_for_who_comes_later(node):
    assert (
        node("""
        (publish (advertise "latched" "std_msgs/String" :latch t) (text "first"))
        (publish "latched" (text "last")) (publish (advertise "plain" "std_msgs/String") (text "lost"))
        (dolist (topic '("latched" "plain")) (subscribe topic "std_msgs/String" (hear topic)))
        (wait-duration 0.1)
        (subscribe "latched" "std_msgs/String" (hear 'second-callback))
        (wait-duration 0.1) *got*""")
        == '(("latched" "last"))'
    )


@pytest.mark.law("roslisp", 39)
def test_an_unknown_type_stops_advertise_and_only_warns_in_subscribe(node):
    assert node("""(subscribe "t" "std_msgs/Nope" #'identity)""") == "NIL"
    assert node.warned() == "WARNING: Couldn't lookup topic type std_msgs/Nope for t, so not subscribing."
    assert node.error('(advertise "t" "std_msgs/Nope")') == "No datatype std_msgs/Nope known"


@pytest.mark.law("roslisp", 40)
def test_an_unknown_topic_is_logged_and_signalled(node):
    assert node.error('(publish "name" (text "a"))') == "Unknown topic /name"
    assert node.printed() == ["[NIL ERROR] T: Unknown topic /name"]


@pytest.mark.parametrize(
    "type_, told",
    [
        ('"std_msgs/string"', "Case mismatch for message type std_msgs/string, did you mean std_msgs/String?"),
        ('"nopkg_msgs/Nope"', 'The name "NOPKG_MSGS-MSG" does not designate any package.'),
        ('"std_msgs"', 'Too few or too many slashes in "std_msgs"'),
        ('"a/b/c"', 'Too few or too many slashes in "a/b/c"'),
    ],
)
def test_types_that_advertise_refuses(node, type_, told):
    assert node.error(f'(advertise "t" {type_})') == told
    assert node(f"""(subscribe "t" {type_} #'identity)""") == "NIL"


@pytest.mark.parametrize("call", ['(advertise \'x "std_msgs/String")', "(subscribe 'x \"std_msgs/String\" #'identity)", "(unadvertise 'x)"])
def test_a_topic_is_a_string(node, call):
    assert node.error(call) == "The value X is not of type STRING when binding ROSLISP::TOPIC"


def test_types_may_be_symbols(node):
    assert (
        node("""(subscribe "t" 'std_msgs-msg:String (hear 'x)) (publish (advertise "t" 'std_msgs-msg:String) (text "a"))
                   (wait-duration 0.1) *got*""")
        == '((X "a"))'
    )


def test_what_advertise_returns_prints_as_a_structure(node):
    assert node('(advertise "chatter" "std_msgs/String")') == (
        '#S(ROSLISP::PUBLICATION :PUB-TOPIC-TYPE "std_msgs/String" :SUBSCRIBER-CONNECTIONS NIL :IS-LATCHING NIL :LAST-MESSAGE NIL)'
    )
    assert node("""(subscribe "chatter" "std_msgs/String" #'identity)""").startswith('#S(ROSLISP::SUBSCRIBER :TOPIC "/chatter" ')


def test_advertising_twice_returns_the_first_unchanged(node):
    assert (
        node("""(let ((first (advertise "t" "std_msgs/String")))
                     (list (eq first (advertise "t" "std_msgs/Bool" :latch t))
                           (eq first (advertise "/t" "std_msgs/String"))))""")
        == "(T T)"
    )


def test_unadvertise_ends_it_and_warns_the_second_time(node):
    assert node("""(subscribe "t" "std_msgs/String" (hear 'x)) (advertise "t" "std_msgs/String") (unadvertise "t")""") == "1"
    assert node.error('(publish "t" (text "a"))') == "Unknown topic /t"
    assert node('(unadvertise "t")') == "1"
    assert node.warned() == "WARNING: Not publishing on /t"
    assert node.printed()[-1] == "[(ROSLISP TOP) WARN] T: Not publishing on /t"


def test_a_callback_is_a_function_and_a_queue_holds_something(node):
    assert node.error('(subscribe "t" "std_msgs/String" \'foo)') == ("The value FOO is not of type FUNCTION when binding ROSLISP::CALLBACK")
    assert node.error('(subscribe "t" "std_msgs/String" #\'identity :max-queue-length 0)') == (
        "The queue of a subscription must hold at least one message, but :max-queue-length is 0."
    )
    assert node('(subscribe "t" "std_msgs/String" #\'identity :max-queue-length \'infty) 1') == "1"


def test_the_queue_of_the_first_subscription_counts(node):
    assert (
        node("""(subscribe "t" "std_msgs/String" (lambda (m) (note (std_msgs-msg:data m)) (wait-duration 0.3)) :max-queue-length 1)
                   (subscribe "t" "std_msgs/String" #'identity :max-queue-length 100)
                   (let ((pub (advertise "t" "std_msgs/String"))) (dotimes (i 5) (publish pub (text (format nil "~a" i)))))
                   (wait-duration 2) *notes*""")
        == '("0" "4")'
    )


def test_another_type_for_a_topic_that_is_subscribed_already(node):
    told = "Asserted topic type std_msgs/Bool for new subscription to /t did not match existing type std_msgs/String"
    assert node.error("""(subscribe "t" "std_msgs/String" #'identity) (subscribe "t" "std_msgs/Bool" #'identity)""") == told
    assert node.printed() == [f"[NIL ERROR] T: {told}"]


def test_unsubscribe_removes_one_callback_and_returns_nothing(node):
    assert (
        node("""(defvar *pub* (advertise "t" "std_msgs/String"))
                   (defvar *one* (subscribe "t" "std_msgs/String" (hear 1))) (defvar *two* (subscribe "t" "std_msgs/String" (hear 2)))
                   (multiple-value-list (unsubscribe *one*))""")
        == "NIL"
    )
    assert node('(list (publish *pub* (text "a")) (progn (wait-duration 0.1) *got*))') == '(1 ((2 "a")))'
    assert node('(unsubscribe *two*) (publish *pub* (text "b"))') == "0"
    assert node.error("(unsubscribe *one*)") == "Subscription to topic `/t' invalid."
    assert node.error("(unsubscribe *two*)") == "Subscription to topic `/t' invalid."


def test_the_same_function_subscribed_twice_is_two_callbacks(node):
    assert (
        node("""(let ((f (hear 'x))) (defvar *a* (subscribe "t" "std_msgs/String" f)) (defvar *b* (subscribe "t" "std_msgs/String" f)))
                   (unsubscribe *a*) (publish (advertise "t" "std_msgs/String") (text "a")) (wait-duration 0.1) *got*""")
        == '((X "a"))'
    )
    assert node.error("(unsubscribe *a*)") == "Subscription to topic `/t' invalid."


def test_a_callback_may_unsubscribe_itself_and_others(node):
    assert (
        node("""(defvar *subs* nil)
                   (dotimes (i 3) (push (subscribe "t" "std_msgs/String" (let ((i i)) (lambda (m) m (note i) (mapc #'unsubscribe *subs*)
                                                                                                        (setf *subs* nil)))) *subs*))
                   (publish (advertise "t" "std_msgs/String") (text "a")) (wait-duration 0.1) *notes*""")
        == "(2)"
    )


def test_store_message_in_is_a_callback(node):
    assert (
        node("""(defvar *last* nil) (subscribe "t" "std_msgs/String" (store-message-in *last*))
                   (publish (advertise "t" "std_msgs/String") (text "a")) (wait-duration 0.1) (std_msgs-msg:data *last*)""")
        == '"a"'
    )


def test_callbacks_of_different_topics_run_side_by_side_and_those_of_one_in_turn(node):
    assert (
        node("""(flet ((slow (name) (lambda (m) m (note (list name :in)) (wait-duration 0.5) (note (list name :out)))))
                     (subscribe "a" "std_msgs/String" (slow :a)) (subscribe "b" "std_msgs/String" (slow :b)))
                   (let ((a (advertise "a" "std_msgs/String")) (b (advertise "b" "std_msgs/String")))
                     (publish a (text "1")) (publish b (text "1")) (publish a (text "2")))
                   (wait-duration 2)
                   (remove :b *notes* :key #'first)""")
        == "((:A :IN) (:A :OUT) (:A :IN) (:A :OUT))"
    )
    assert node("(subseq *notes* 0 2)") == "((:A :IN) (:B :IN))"


def test_subscribing_with_another_type_than_the_publishers_warns(node):
    graph.active().node("talker").advertise("/chatter", message_class("std_msgs/String"))
    assert node("""(subscribe "chatter" "std_msgs/Bool" #'identity)""") == "NIL"
    assert node.warned() == (
        "WARNING: Received error Client [/n] wants topic /chatter to have datatype [std_msgs/Bool], but our version has [std_msgs/String]. "
        "Dropping connection. when attempting to setup subscription to /chatter of type std_msgs/Bool, so not subscribing."
    )
    assert node("""(subscribe "chatter" "std_msgs/String" #'identity) 1""") == "1"


def test_advertising_another_type_than_the_listeners_warns(node):
    graph.active().node("turtle").subscribe("/turtle1/cmd_vel", message_class("geometry_msgs/Twist"), print)
    assert node('(publish (advertise "turtle1/cmd_vel" "geometry_msgs/Vector3") (make-msg "geometry_msgs/Vector3"))') == "0"
    assert node.warned() == (
        "WARNING: /turtle listens to /turtle1/cmd_vel for messages of type geometry_msgs/Twist, so it gets no message "
        "that is published there as geometry_msgs/Vector3."
    )


def test_publishing_a_message_of_another_type_is_counted_and_not_delivered(node):
    assert node("""(subscribe "t" "std_msgs/String" (hear 'x)) (defvar *pub* (advertise "t" "std_msgs/String"))
                   (list (publish *pub* (make-msg "std_msgs/Bool")) (publish *pub* (text "a")) (progn (wait-duration 0.1) *got*))""") == (
        '(1 1 ((X "a")))'
    )


def test_publishing_on_what_is_no_publication(node):
    assert node.error('(publish nil (text "a"))').startswith(
        "There is no primary method for the generic function #<STANDARD-GENERIC-FUNCTION ROSLISP:PUBLISH (3)>"
    )
    assert node.error('(publish (advertise "t" "std_msgs/String") 5)').startswith(
        "There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION ROSLISP-MSG-PROTOCOL:SERIALIZE"
    )
    assert node.error('(num-subscribers "t")') == ('The value "t" is not of type ROSLISP::PUBLICATION when binding ROSLISP::PUB')


def test_a_node_hears_itself(node):
    assert (
        node("""(subscribe "t" "std_msgs/String"
                              (lambda (m) (when (string= (std_msgs-msg:data m) "a") (publish "t" (text "b"))) (note (std_msgs-msg:data m))))
                   (publish (advertise "t" "std_msgs/String") (text "a")) (wait-duration 0.1) *notes*""")
        == '("a" "b")'
    )


def test_a_condition_that_nobody_handles_costs_a_line_and_nothing_else(node):
    node("""(subscribe "t" "std_msgs/String" (lambda (m) (note (std_msgs-msg:data m)) (call-service "nosrv" 'std_srvs-srv:Empty)))
            (defvar *pub* (advertise "t" "std_msgs/String"))""")
    assert node('(publish *pub* (text "a")) (wait-duration 0.1) (publish *pub* (text "b")) (wait-duration 0.1) *notes*') == '("a" "b")'
    assert sum("Error during subscriber callback: 'ros-rpc call (lookupService /nosrv)" in line for line in node.printed()) == 2


def test_messages_that_cause_each_other_for_ever_stop_neither_time_nor_the_program(node):
    node("""(defvar *count* 0)
            (subscribe "t" "std_msgs/Empty" (lambda (m) (incf *count*) (publish "t" m)))
            (advertise "t" "std_msgs/Empty")""")
    assert node('(publish "t" (make-msg "std_msgs/Empty")) (wait-duration 0.01) (shutdown-ros-node) (node-status)') == ":SHUTDOWN"
    assert int(node("*count*")) > 100
