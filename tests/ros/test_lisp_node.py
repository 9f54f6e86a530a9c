"""The node's life, its names and its log (roslisp.md 2, 3, 4, 16; golden/01)."""

import re

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import Error, SimpleError
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.ros import graph, messages
from cramhy_runtime.ros.names import Naming, qualify, read_private_value
from cramhy_runtime.ros.roslisp import logging, node, parameters, services, topics, utilities

START = """[(ROSLISP TOP) INFO] 1292688669.674: Node name is /turtle1
[(ROSLISP TOP) INFO] 1292688669.674: Namespace is /
[(ROSLISP TOP) INFO] 1292688669.674: Params are NIL
[(ROSLISP TOP) INFO] 1292688669.674: Remappings are:
[(ROSLISP TOP) INFO] 1292688669.674: master URI is 127.0.0.1:11311
[(ROSLISP TOP) INFO] 1292688670.768: Node startup complete
"""


def topic(*names):
    return lisp_list(*(sym(f"COMMON-LISP-USER::{name}") for name in names))


class TestLife:
    def test_the_six_lines_of_the_start(self, printed):
        assert node.start_ros_node("turtle1") == 0
        assert printed() == START

    def test_status_and_name(self):
        assert node.node_status().name == "SHUTDOWN"
        node.start_ros_node("n")
        assert (node.node_status().name, node.NODE_NAME.value) == ("RUNNING", "/n")
        node.shutdown_ros_node()
        assert (node.node_status().name, node.NODE_NAME.value) == ("SHUTDOWN", "/n")
        assert node.shutdown_ros_node() is None

    def test_a_second_start_ends_the_first_node(self, running, printed, warned):
        node.start_ros_node("m")
        assert "node-status equalled RUNNING" in warned()
        lines = printed().splitlines()
        assert [line.split(": ", 1)[1] for line in lines[:2]] == ["Shutdown complete", "Node name is /m"]

    def test_anonymous_names_end_in_microseconds_and_seconds(self):
        node.start_ros_node("n", anonymous=True)
        assert re.fullmatch(r"/n_\d+_\d+", node.NODE_NAME.value)
        assert int(node.NODE_NAME.value.split("_")[2]) == 1292688669

    def test_an_odd_name_is_a_warning(self, warned):
        node.start_ros_node("Bad-name")
        assert "Bad-name is not a legal ROS base name. This may cause problems with other ROS tools" in " ".join(warned().split())

    def test_a_malformed_master(self, fails):
        assert fails(node.start_ros_node, "x", master_uri="foo").report() == "Malformed URI foo"
        assert node.node_status().name == "SHUTDOWN"

    @pytest.mark.parametrize("gone", ["xml_rpc_port", "pub_server_port"])
    def test_arguments_that_are_gone(self, fails, gone):
        assert (
            fails(node.start_ros_node, "x", **{gone: 1}).report()
            == f"start-ros-node no longer accepts the {gone.replace('_', '-')} argument"
        )

    def test_arguments_are_announced(self, printed):
        node.start_ros_node("n", cmd_line_args="_p:=3 _q:=hello foo:=bar")
        text = printed()
        assert "Params are ((~q . hello) (~p . 3))" in text
        assert "Remappings are:\n  /foo = /bar\n" in text

    def test_with_ros_node_shuts_down_on_every_way_out(self, fails):
        assert node.with_ros_node("n", lambda: 7) == 7
        assert node.node_status().name == "SHUTDOWN"
        fails(node.with_ros_node, "n", lambda: conditions.error(SimpleError("no")))
        assert node.node_status().name == "SHUTDOWN"


class TestWithoutANode:
    @pytest.mark.parametrize(
        "call",
        [
            lambda: topics.advertise("t", "std_msgs/String"),
            lambda: topics.subscribe("t", "std_msgs/String", print),
            lambda: topics.publish("t", messages.message_class("std_msgs/String")()),
            lambda: services.call_service("/clear", sym("STD_SRVS-SRV::EMPTY")),
            lambda: services.wait_for_service("/clear", 1),
        ],
    )
    def test_the_error_offers_to_start_a_dummy(self, fails, call):
        condition = fails(call)
        assert condition.report() == "Node status is SHUTDOWN"
        restart = condition.restarts[0]
        assert (restart.name.name, restart.report()) == ("CONTINUE", "Start a dummy node")

    def test_the_restart_starts_it_and_carries_on(self):
        publication = conditions.handler_bind(
            [(SimpleError, lambda _: conditions.continue_())], lambda: topics.advertise("t", "std_msgs/String")
        )
        assert publication.name == "/t"
        assert node.NODE_NAME.value == "/dummy"

    def test_parameters_need_a_master_only(self, fails):
        assert fails(parameters.get_param, "x").report() == "Master uri not set"

    def test_publishing_on_nothing(self, fails):
        condition = fails(topics.publish, None, messages.message_class("std_msgs/Empty")())
        assert condition.report().startswith(
            "There is no primary method for the generic function\n  #<STANDARD-GENERIC-FUNCTION ROSLISP:PUBLISH (3)>"
        )


class TestNames:
    @pytest.mark.parametrize("name, full", [("foo", "/foo"), ("/foo", "/foo"), ("~foo", "/n/foo"), ("~/foo", "/n//foo")])
    def test_resolution(self, running, name, full):
        assert node.fully_qualified_name(name) == full

    def test_before_any_node_a_private_name_has_no_node(self):
        assert qualify("~foo", "/", None) == "/foo"

    def test_the_command_line(self):
        node.start_ros_node("n", cmd_line_args="a:=b _x:=1.5 _y:=true __name:=renamed")
        assert node.NODE_NAME.value == "/renamed"
        assert node.fully_qualified_name("a") == "/b"
        assert parameters.get_param("~x") == 1.5
        assert parameters.get_param("~y") == "true"

    @pytest.mark.parametrize("arguments, resolved", [(["foo:=bar", "__ns:=myns"], "/myns/foo"), (["__ns:=myns", "foo:=bar"], "/myns/bar")])
    def test_the_order_of_arguments_matters(self, arguments, resolved):
        naming = Naming("n")
        naming.apply_arguments(arguments, read_private_value)
        assert naming.resolve("foo") == resolved


class TestLogging:
    def test_the_form_of_a_line(self, running, printed):
        logging.ros_log(logging.INFO, topic("A", "B"), "hello ~a", 3)
        logging.ros_log(logging.WARN, None, "x")
        logging.ros_log(logging.INFO, sym(":A"), "x")
        assert [re.sub(r"\d+\.\d{3}", "T", line) for line in printed().splitlines()] == [
            "[(A B) INFO] T: hello 3",
            "[NIL WARN] T: x",
            "[(A) INFO] T: x",
        ]

    def test_levels_are_inherited_down_the_tree(self):
        logging.set_debug_levels(topic("A"), sym(":DEBUG"), topic("A", "B"), sym(":ERROR"))
        assert logging.enabled(logging.DEBUG, topic("A"))
        assert logging.enabled(logging.DEBUG, topic("A", "X"))
        assert not logging.enabled(logging.WARN, topic("A", "B"))
        assert logging.enabled(logging.ERROR, topic("A", "B", "C"))
        assert not logging.enabled(logging.DEBUG, topic("Z"))

    def test_a_level_becomes_a_parameter(self, running):
        assert logging.set_debug_level(topic("FOO", "BAR"), sym(":DEBUG")) == 0
        assert parameters.get_param("~debug/foo/bar/level") == "debug"

    def test_levels_are_read_back_on_request(self, running, printed):
        parameters.set_param("~debug/foo/level", "bogus")
        parameters.set_param("~debug/bar/level", "debug")
        services.call_service("~reset_debug_levels", sym("STD_SRVS-SRV::EMPTY"))
        assert printed().rstrip().endswith("to unknown level BOGUS")
        assert logging.enabled(logging.DEBUG, topic("BAR"))

    def test_a_bad_level(self, fails):
        assert (
            fails(logging.set_debug_level, None, sym(":BOGUS")).report() == "Could not get symbol code for BOGUS for ROS message type <LOG>"
        )

    def test_the_table_of_levels(self, printed):
        logging.set_debug_levels(topic("A"), sym(":DEBUG"), topic("A", "B"), sym(":ERROR"))
        logging.print_debug_levels()
        assert printed() == "[NIL : INFO\n (A) : DEBUG\n (B A) : ERROR]"

    def test_rosout_carries_name_level_and_text(self, running):
        received = []
        graph.active().node("listener").subscribe("/rosout", messages.message_class("rosgraph_msgs/Log"), received.append)
        for level in (logging.INFO, logging.WARN, logging.ERROR, logging.FATAL):
            logging.ros_log(level, None, "x")
        assert [(entry.level, entry.name, entry.msg, entry.header.stamp) for entry in received] == [
            (level, "/n", "x", 0) for level in (2, 4, 8, 16)
        ]

    def test_the_value_is_the_number_of_listeners(self, running):
        assert logging.ros_log(logging.INFO, None, "x") == 0
        kernel.sleep(0.1)
        assert logging.ros_log(logging.INFO, None, "x") == 1

    def test_a_log_file_on_request(self, tmp_path):
        node.start_ros_node("n", cmd_line_args=f"__log:={tmp_path / 'x.log'}")
        node.shutdown_ros_node()
        assert (tmp_path / "x.log").read_text().count("[(ROSLISP TOP) INFO]") == 7


class TestUtilities:
    def test_init_functions_run_by_descending_rank(self, printed):
        ran = []
        for name, rank in (("LOW", 0), ("HIGH", 5)):
            symbol = sym(f"CL-USER::{name}")
            symbol.function = lambda name=name: ran.append(name)
            utilities.register_ros_init_function(symbol, rank)
        assert utilities.startup_ros() is None
        assert ran == ["HIGH", "LOW"]
        assert len(re.findall(r"\[\(ROSNODE\) INFO\] [\d.]+: ROS init ", printed())) == 2
        assert re.fullmatch(r"/cram_hl_\d+_\d+", node.NODE_NAME.value)

    @pytest.mark.parametrize(
        "ros, lisp",
        [("HelloWorld", "HELLO-WORLD"), ("FooBAR2Baz", "FOO-BAR2-BAZ"), ("turtle1Pose", "TURTLE1-POSE"), ("foo_bar", "FOO_BAR")],
    )
    def test_camel_case_to_lisp(self, ros, lisp):
        assert utilities.lispify_ros_name(ros).name == lisp

    def test_the_other_conversions(self):
        assert utilities.rosify_lisp_name(sym("CL-USER::HELLO-WORLD")) == "HelloWorld"
        assert utilities.rosify_lisp_name(sym(":FOO-BAR2-BAZ")) == "FooBar2Baz"
        assert utilities.lispify_ros_underscore_name("foo_bar_Baz").name == "FOO-BAR-BAZ"
        assert utilities.rosify_underscores_lisp_name(sym("CL-USER::FOO-BAR")) == "foo_bar"
        assert utilities.rosify_underscores_lisp_name(sym("CL-USER::Foo-bar")) == "Foo-bar"


@pytest.mark.parametrize("package", ["roslisp", "roslisp-utilities", "turtlesim", "ros-load-manifest"])
def test_who_goes_into_a_package_of_ros_has_common_lisp_there(lisp, package):
    """As in the original, whose packages use COMMON-LISP."""
    assert lisp(f"(in-package :{package}) (let ((sum 0)) (dotimes (i 4 sum) (incf sum i)))") == "6"


@pytest.mark.parametrize("form, hint", [
    ('(call-service "/spawn" "turtlesim/Spawn" :why 1)', "turtlesim/Spawn has the fields x y theta name."),
    ('(make-msg "geometry_msgs/Twist" :why 1)', "geometry_msgs/Twist has the fields linear angular."),
])  # fmt: skip
def test_a_form_with_a_wrong_field_says_which_there_are(node, form, hint):
    with pytest.raises(Error) as caught:
        node(f"(in-package :roslisp) {form}")
    assert caught.value.hint == hint
