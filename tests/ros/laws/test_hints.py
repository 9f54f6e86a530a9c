"""What the REPL says below an error of roslisp: what to try."""

import pytest


@pytest.mark.parametrize("text, hint", [
    ('(start-ros-node "x" :master-uri "http://127.0.0.1:1")',
     "The master is in this process, and a node finds it when :master-uri is left out."),
    ('(advertise "chatter" "std_msgs/String") (publish "chater" (make-msg "std_msgs/String"))', "Did you mean /chatter?"),
    ('(publish "x" (make-msg "std_msgs/String"))', 'One publishes on a topic that was advertised before: (advertise "/x" type).'),
    ('(set-param "/turtle/speed" 1) (get-param "/turtle/sped")', "Did you mean /turtle/speed?"),
    ('(get-param "x")', "(list-params) shows those that there are; a second argument of get-param is a default."),
    ("(call-service \"~reset_debug_levels\" \"roscpp_tutorials/TwoInts\" :a 1)",
     "The service /n/reset_debug_levels is of type std_srvs/Empty, which has another request."),
    ("(call-service \"/clear\" 'std_srvs-srv:Empty)",
     "No node offers this service. rosservice list, typed at the prompt, shows those that there are; (wait-for-service name) waits for "
     "one."),
    ('(advertise "x" "std_msgs/Strng")', "Did you mean std_msgs/String?"),
    ('(advertise "x" "std_msgs/Nope")', "rosmsg package std_msgs, typed at the prompt, lists those that there are."),
    ('(call-service "/spawn" "turtlesim/Span" :x 1)', "Did you mean turtlesim/Spawn?"),
    ('(call-service "/spawn" "turtlesim/Drive" :x 1)', "rossrv package turtlesim, typed at the prompt, lists those that there are."),
    ('(shutdown-ros-node) (advertise "x" "std_msgs/String")', 'No ROS node runs here. (start-ros-node "name") starts one.'),
])
def test_what_to_try(node, text, hint):
    assert node.hint(text) == hint


@pytest.mark.parametrize("text, problem", [
    ("(wait-duration 'soon)", "The value SOON is not of type REAL"),
    ("(loop-at-most-every nil (return 1))", "The value NIL is not of type REAL"),
    ("(unsubscribe 4)", "The value 4 is not of type ROSLISP::SUBSCRIBER when binding ROSLISP::SUBSCRIBER"),
])
def test_a_wrong_type_is_told_in_lisp(node, text, problem):
    assert node.error(text) == problem
