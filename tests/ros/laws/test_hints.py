"""What the REPL says below an error of roslisp: what to try."""

import pytest


@pytest.mark.soak(all_but=8)
@pytest.mark.parametrize(
    "text, hint",
    [
        (
            '(start-ros-node "x" :master-uri "http://127.0.0.1:1")',
            "The master is in this process, and a node finds it when :master-uri is left out.",
        ),
        ('(advertise "chatter" "std_msgs/String") (publish "chater" (make-msg "std_msgs/String"))', "Did you mean /chatter?"),
        ('(publish "x" (make-msg "std_msgs/String"))', 'One publishes on a topic that was advertised before: (advertise "/x" type).'),
        ('(set-param "/turtle/speed" 1) (get-param "/turtle/sped")', "Did you mean /turtle/speed?"),
        ('(get-param "x")', "(list-params) shows those that there are; a second argument of get-param is a default."),
        (
            '(call-service "~reset_debug_levels" "roscpp_tutorials/TwoInts" :a 1)',
            "The service /n/reset_debug_levels is of type std_srvs/Empty, which has another request.",
        ),
        (
            '(call-service "/clear" \'std_srvs-srv:Empty)',
            "No node offers this service. rosservice list, typed at the prompt, shows those that there are; (wait-for-service name) waits for "
            "one.",
        ),
        ('(advertise "x" "std_msgs/Strng")', "Did you mean std_msgs/String?"),
        ('(advertise "x" "std_msgs/Nope")', "rosmsg package std_msgs, typed at the prompt, lists those that there are."),
        ('(call-service "/spawn" "turtlesim/Span" :x 1)', "Did you mean turtlesim/Spawn?"),
        ('(call-service "/spawn" "turtlesim/Drive" :x 1)', "rossrv package turtlesim, typed at the prompt, lists those that there are."),
        ('(advertise "x" "std_msgs/String" :latched t)', "The function takes :LATCH."),
        ("(defun keyed (&key a (b 1)) (list a b)) (keyed :c 1)", "The function takes :A, :B."),
        ("(defun keyed (&key) 1) (keyed :c 1)", "The function takes no keywords."),
        ('(make-msg "turtlesin/Pose")', "Did you mean turtlesim?"),
        (
            '(make-msg "nowhere/Pose")',
            "No package nowhere with a msg/Pose.msg is below ROS_PACKAGE_PATH (which is not set), the current folder and src of the workspace.",
        ),
        ('(make-msg "turtlesim/Posee")', "Did you mean turtlesim/Pose?"),
        ('(call-service "/spawn" "turtlesin/Spawn" :x 1)', "Did you mean turtlesim?"),
        (
            '(call-service "/spawn" \'spawn :x 1)',
            'A service type is a symbol, such as turtlesim-srv:Spawn, or a text, such as "turtlesim/Spawn".',
        ),
        (
            '(advertise "x" "std_msgs/String") (publish "x" "hello")',
            'What is published is a message: (make-msg "std_msgs/String" field value ...).',
        ),
        (
            '(publish-msg "x" :data "hello")',
            "This macro takes what (advertise topic type) returns. With a topic's name one writes (publish name (make-msg ...)).",
        ),
        (
            "(modify-message-copy nil :x 1)",
            "No message is there yet: a fluent is NIL until the first one comes. Has its topic been subscribed to, and does somebody publish on "
            "it?",
        ),
        (
            "(roslisp-msg-protocol:list-to-ros-message '(turtlesim-msg:pose 3))",
            "The list form is (CLASS (FIELD . value) ...), as ros-message-to-list gives it.",
        ),
        ("(wait-for-service nil 1)", 'A service is named by a string, such as "/clear". Has the variable been set that holds it?'),
        (
            '(advertise "x" "std_msgs/Header" :latch t) (publish "x" (make-msg "std_msgs/Header" :stamp :positive-infinity))',
            "std_msgs/Header: stamp holds :POSITIVE-INFINITY, which is no time.",
        ),
        ("(ros-info)", 'It is written (ros-info (topic...) [condition] "text" argument...).'),
        ("(spin-until nil)", "It is written (spin-until test seconds form...) or (spin-until test (seconds timeout) form...)."),
        ('(shutdown-ros-node) (advertise "x" "std_msgs/String")', 'No ROS node runs here. (start-ros-node "name") starts one.'),
    ],
)
def test_what_to_try(node, text, hint):
    assert node.hint(text) == hint


@pytest.mark.soak(all_but=12)
@pytest.mark.parametrize(
    "text, problem",
    [
        ("(wait-duration 'soon)", "The value SOON is not of type REAL"),
        ('(with-parallel-thread (3 "x") 3)', "The value 3 is not of type FUNCTION"),
        ('(set-param "x" \'(1 . 2))', "A parameter can be a string, number, boolean, list or vector of these, but not (1 . 2)."),
        ("(loop-at-most-every nil (return 1))", "The value NIL is not of type REAL"),
        ('(wait-for-service "/x" \'soon)', "The value SOON is not of type (OR NULL REAL)"),
        ("(close-persistent-service 4)", "The value 4 is not of type ROSLISP:PERSISTENT-SERVICE"),
        ("(call-persistent-service nil)", "The value NIL is not of type ROSLISP:PERSISTENT-SERVICE"),
        ("(persistent-service-ok nil)", "The value NIL is not of type ROSLISP:PERSISTENT-SERVICE"),
        (
            "(make-instance 'persistent-service :service-name 'x :service-type \"std_srvs/Empty\")",
            "The value X is not of type STRING when binding ROSLISP::SERVICE-NAME",
        ),
        ("(pprint-ros-message 4)", "The value 4 is not of type ROSLISP:ROS-MESSAGE"),
        ("(pprint-ros-message t nil)", "The value NIL is not of type ROSLISP:ROS-MESSAGE"),
        ("(modify-message-copy 4 :x 1)", "The value 4 is not of type ROSLISP:ROS-MESSAGE"),
        ("(symbol-code 'rosgraph_msgs-msg:Log 4)", "The value 4 is not of type SYMBOL"),
        ("(list-params '(1 2))", "The value 1 is not of type SYMBOL"),
        ("(roslisp-utilities:lispify-ros-name 4)", "The value 4 is not of type STRING"),
        ("(roslisp-utilities:lispify-ros-underscore-name nil)", "The value NIL is not of type STRING"),
        ("(roslisp-utilities:rosify-lisp-name 4)", "The value 4 is not of type SYMBOL"),
        ('(shutdown-ros-node) (start-ros-node "x" :cmd-line-args 4)', "The value 4 is not of type LIST"),
        (
            '(set-param "/" 4)',
            "ros-rpc call (setParam /) to #S(URI :ADDRESS 127.0.0.1 :PORT 11311) failed with code -1, message cannot set "
            "root of parameter tree to non-dictionary, values 0",
        ),
        (
            "(roslisp-msg-protocol:list-to-ros-message '(turtlesim-msg:pose (3 . 4)))",
            "(3 . 4) is no field of a message in list form, in (TURTLESIM-MSG:POSE (3 . 4)).",
        ),
        (
            '(subscribe "x" "std_msgs/String" #\'car :max-queue-length \'many)',
            "The queue of a subscription must hold at least one message, but :max-queue-length is MANY.",
        ),
        ("(unsubscribe 4)", "The value 4 is not of type ROSLISP::SUBSCRIBER when binding ROSLISP::SUBSCRIBER"),
    ],
)
def test_a_wrong_type_is_told_in_lisp(node, text, problem):
    assert node.error(text) == problem


@pytest.mark.parametrize(
    "text, why",
    [
        (
            "(ros-info (a) name)",
            "what stands between the topic and a literal text is a condition, and here no text follows. A text that is "
            'computed is an argument: (ros-... topic "~a" NAME).',
        ),
        (
            '(make-msg "turtlesim/Pose" "x" 1)',
            'a field is named by a symbol, such as :x, or from the inside out by a list of them, such as (:x :position), but not by "x".',
        ),
        (
            '(make-msg "turtlesim/Pose" nil 1)',
            "a field is named by a symbol, such as :x, or from the inside out by a list of them, such as (:x :position), but not by NIL.",
        ),
        (
            "(with-fields ((x (x 3))) nil x)",
            "a field is named by a symbol, such as :x, or from the inside out by a list of them, such as (:x :position), but not by (X 3).",
        ),
        ('(with-ros-node "n" 1)', "its first part is a list: the name of the node, then keywords and values in turn."),
        ('(with-ros-node ("n" :spin) 1)', "its first part is a list: the name of the node, then keywords and values in turn."),
    ],
)
def test_what_is_wrong_with_a_form_of_a_macro(node, text, why):
    form = node(f"(quote {text})")
    assert node.error(text) == f"The {form.split()[0].strip('(')} form {form} is malformed: {why}"


def test_a_refusal_without_a_reason_is_told_with_what_the_server_said_last(node):
    from cramhy_runtime.ros import graph, messages, rosout
    from cramhy_runtime.ros.services import Refusal

    server = graph.active().node("server")

    def refuse(_):
        raise Refusal("")

    server.serve("/refuse", messages.service_type_exact("std_srvs/Empty"), refuse)
    call = '(call-service "/refuse" "std_srvs/Empty")'
    assert node.hint(call) == (
        "/server refused to do /refuse, and gave no reason. rostopic echo /rosout, typed at the prompt, shows what it logs."
    )
    rosout.report(server, rosout.ERROR, "There is no time.")
    assert node.hint(call) == "/server refused to do /refuse, and gave no reason. The error that it logged last: There is no time."
