"""Names of topics, services and parameters are checked by ROS's rules, with roscpp's texts (turtlesim.md 6, golden/turtle-facts)."""

import pytest

from cramhy_runtime.ros import graph
from cramhy_runtime.ros.names import allowed_name, check_graph_name

AT = "Character [{}] at element [{}] is not valid in Graph Resource Name [{}].  Valid characters are a-z, A-Z, 0-9, / and _."
FIRST = (
    "Character [{}] is not valid as the first character in Graph Resource Name [{}].  Valid characters are a-z, A-Z, / and in some cases ~."
)
CALLS = {
    "topic": [
        '(advertise "{}" "std_msgs/String")',
        '(unadvertise "{}")',
        '(subscribe "{}" "std_msgs/String" (lambda (m) m))',
        '(publish "{}" (make-msg "std_msgs/String"))',
        '(publish-msg (advertise "{}" "std_msgs/String") :data "x")',
    ],
    "service": [
        '(call-service "{}" \'std_srvs-srv:empty)',
        '(wait-for-service "{}" 1)',
        '(make-service-client "{}" "std_srvs/Empty")',
        '(register-service-fn "{}" (lambda (r) r) \'std_srvs-srv:empty)',
        '(make-instance \'persistent-service :service-name "{}" :service-type "std_srvs/Empty")',
    ],
    "parameter": [
        '(get-param "{}")',
        '(get-param "{}" 1)',
        '(set-param "{}" 1)',
        '(has-param "{}")',
        '(delete-param "{}")',
        '(list-params "{}")',
    ],
}
BAD = {
    "bad name": (AT.format(" ", 3, "bad name"), "bad_name"),
    "/turtle 1/pose": (AT.format(" ", 7, "/turtle 1/pose"), "/turtle_1/pose"),
    "~my-speed": (AT.format("-", 3, "~my-speed"), "~my_speed"),
    "a~b": (AT.format("~", 1, "a~b"), "a_b"),
    "türtle": (AT.format("ü", 1, "türtle"), "t_rtle"),
    "1abc": (FIRST.format("1", "1abc"), "n1abc"),
    "_x": (FIRST.format("_", "_x"), "n_x"),
    " x": (FIRST.format(" ", " x"), "n_x"),
}


@pytest.mark.soak(all_but=6)
@pytest.mark.parametrize(("kind", "call"), [(kind, call) for kind, calls in CALLS.items() for call in calls])
def test_every_function_refuses_a_name_that_ros_does_not_allow(lisp, kind, call):
    lisp('(start-ros-node "n")')
    for name, (text, instead) in BAD.items():
        condition = lisp.condition(call.format(name))
        assert condition.report() == text
        assert condition.hint == f'"{name}" cannot be the name of a {kind}, since ROS does not allow it. Try "{instead}".'


@pytest.mark.parametrize("name", ["a", "/a", "~a", "~/a", "/a//b", "A1_b/c", "/1", "a/1", "//a"])
def test_what_ros_allows_is_taken(lisp, name):
    lisp(f'(start-ros-node "n") (advertise "{name}" "std_msgs/String") (set-param "{name}" 3)')
    assert lisp(f'(list (publish "{name}" (make-msg "std_msgs/String")) (get-param "{name}"))') == "(0 3)"


def test_what_is_proposed_is_allowed():
    for name in [*BAD, "-", "9", "~", "a b/c d", "ä"]:
        assert check_graph_name(allowed_name(name)) is None


def test_an_empty_name_is_the_index_error_that_it_is(lisp):
    lisp('(start-ros-node "n")')
    assert "Invalid index 0" in lisp.error('(advertise "" "std_msgs/String")')


def test_a_node_whose_own_name_is_odd_keeps_its_private_names(lisp):
    lisp('(handler-bind ((warning (function muffle-warning))) (start-ros-node "my-node")) (set-param "~speed" 2)')
    assert lisp('(list (get-param "~speed") (fully-qualified-name "~speed"))') == '(2 "/my-node/speed")'


def test_the_turtle_of_the_lectures(lisp):
    lisp("""(start-ros-node "n")
            (defun init-ros-turtle (name)
              (subscribe (format nil "~a/pose" name) "turtlesim/Pose" (lambda (m) m))
              (advertise (format nil "~a/cmd_vel" name) "geometry_msgs/Twist"))""")
    assert lisp.condition('(init-ros-turtle "bad name")').report() == AT.format(" ", 3, "bad name/pose")


def test_the_error_is_logged_and_the_node_goes_on(lisp):
    lisp('(start-ros-node "n") (ignore-errors (advertise "bad name" "std_msgs/String"))')
    assert any(AT.format(" ", 3, "bad name") in text for _, _, text in graph.active().log)
    assert lisp("(node-status)") == ":RUNNING"
