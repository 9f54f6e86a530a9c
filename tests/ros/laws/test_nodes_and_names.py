"""Invariants 1 to 12 of roslisp.md: the life of a node and its names, as a user types them."""

import re
import socket

import pytest

from cramhy_runtime.ros import graph

START = [
    "[(ROSLISP TOP) INFO] T: Node name is /n",
    "[(ROSLISP TOP) INFO] T: Namespace is /",
    "[(ROSLISP TOP) INFO] T: Params are NIL",
    "[(ROSLISP TOP) INFO] T: Remappings are:",
    "[(ROSLISP TOP) INFO] T: master URI is 127.0.0.1:11311",
    "[(ROSLISP TOP) INFO] T: Node startup complete",
]


@pytest.mark.law("roslisp", 1)
def test_the_status_follows_the_node(lisp):
    assert lisp("(node-status)") == ":SHUTDOWN"
    assert lisp('(start-ros-node "n") (node-status)') == ":RUNNING"
    assert lisp("(shutdown-ros-node) (node-status)") == ":SHUTDOWN"


@pytest.mark.law("roslisp", 2)
def test_a_start_prints_six_lines(lisp):
    assert lisp('(start-ros-node "n")') == "0"
    assert lisp.printed() == START


@pytest.mark.law("roslisp", 3)
def test_a_second_node_ends_the_first_with_a_warning(node):
    node('(start-ros-node "m")')
    assert node.warned() == (
        "WARNING: Before starting node, node-status equalled RUNNING instead of :shutdown. Shutting the previous node invocation down now."
    )
    assert node.printed()[:2] == ["[(ROSLISP TOP) INFO] T: Shutdown complete", "[(ROSLISP TOP) INFO] T: Node name is /m"]


@pytest.mark.law("roslisp", 4)
def test_the_name_is_global_and_may_end_in_microseconds_and_seconds(node):
    assert node("*ros-node-name*") == '"/n"'
    now = int(float(node("(ros-time)").replace("d9", "e9")))
    name = node('(start-ros-node "n" :anonymous t) *ros-node-name*').strip('"')
    assert re.fullmatch(r"/n_\d+_\d+", name)
    assert abs(int(name.rpartition("_")[2]) - now) <= 2


@pytest.mark.law("roslisp", 5)
@pytest.mark.parametrize("name", ["Bad-name", "/slash", "2nd", ""])
def test_an_illegal_name_is_only_a_warning(lisp, name):
    lisp(f'(start-ros-node "{name}")')
    assert lisp.warned() == f"WARNING: {name} is not a legal ROS base name. This may cause problems with other ROS tools".replace(
        ":  is", ": is"
    )
    assert lisp("(node-status)") == ":RUNNING"


@pytest.mark.law("roslisp", 6)
@pytest.mark.parametrize("uri", ["foo", "http://h", "http://h:", "http://:11311", "https://h:1", "http://h:p", "http://h:1/x"])
def test_a_malformed_master_is_told_as_it_was_given(lisp, uri):
    assert lisp.error(f'(start-ros-node "x" :master-uri "{uri}")') == f"Malformed URI {uri}"
    assert lisp("(node-status)") == ":SHUTDOWN"


@pytest.mark.law("roslisp", 7)
def test_without_a_master_no_node_starts(lisp):
    told = (
        "Could not contact master at #S(URI :ADDRESS 127.0.0.1 :PORT 1) when getting param list: "
        'Socket error in "connect": ECONNREFUSED (Connection refused)'
    )
    assert lisp.error('(start-ros-node "x" :master-uri "http://127.0.0.1:1")') == told
    assert lisp("(node-status)") == ":SHUTDOWN"
    assert " ".join(" ".join(lisp.printed()).split()) == f"[NIL ERROR] T: {told}"


@pytest.mark.law("roslisp", 8)
def test_what_names_mean(node):
    assert node("""(mapcar #'fully-qualified-name '("foo" "/foo" "~foo" "~/foo"))""") == '("/foo" "/foo" "/n/foo" "/n//foo")'


@pytest.mark.law("roslisp", 9)
def test_the_command_line_renames_remaps_and_sets_parameters(lisp):
    lisp('(start-ros-node "n" :cmd-line-args "a:=b _x:=1.5 _y:=true __name:=renamed")')
    assert lisp('(list *ros-node-name* (fully-qualified-name "a") (get-param "~x") (get-param "~y"))') == '("/renamed" "/b" 1.5 "true")'


@pytest.mark.law("roslisp", 10)
def test_arguments_count_in_their_order(lisp):
    resolved = """(progn (start-ros-node "n" :cmd-line-args '{0}) (mapcar #'fully-qualified-name '("foo" "/foo")))"""
    assert lisp(resolved.format('("foo:=bar" "__ns:=myns")')) == '("/myns/foo" "/bar")'
    assert lisp(resolved.format('("__ns:=myns" "foo:=bar")')) == '("/myns/bar" "/foo")'


@pytest.mark.law("roslisp", 11)
@pytest.mark.parametrize(
    "call",
    [
        '(advertise "t" "std_msgs/String")',
        '(unadvertise "t")',
        '(publish "t" (make-msg "std_msgs/String"))',
        """(subscribe "t" "std_msgs/String" #'identity)""",
        """(register-service-fn "s" #'identity 'std_srvs-srv:Empty)""",
        '(register-service "s" std_srvs-srv:Empty)',
        '(call-service "s" \'std_srvs-srv:Empty)',
        '(wait-for-service "s" 0)',
    ],
)
def test_a_call_without_a_node_offers_a_dummy(lisp, call):
    assert lisp.error(call) == "Node status is SHUTDOWN"
    assert lisp(f"""
        (handler-case
            (handler-bind ((simple-error
                             (lambda (condition)
                               (when (find-restart 'continue condition)
                                 (note (format nil "~a" condition))
                                 (note (format nil "~a" (find-restart 'continue condition)))
                                 (continue condition)))))
              {call})
          (condition () nil))  ; what this very call fails with when there is a node
        (list (first *notes*) (second *notes*) (node-status) *ros-node-name*)""") == (
        '("Node status is SHUTDOWN" "Start a dummy node" :RUNNING "/dummy")'
    )


@pytest.mark.law("roslisp", 12)
@pytest.mark.parametrize(
    "call", ['(get-param "x")', '(set-param "x" 1)', '(has-param "x")', '(delete-param "x")', '(list-params "x")', "(list-params)"]
)
def test_parameters_need_a_master_and_no_node(lisp, call):
    assert lisp.error(call) == "Master uri not set"
    assert lisp('(start-ros-node "n") (shutdown-ros-node) (set-param "x" 1) (get-param "x")') == "1"


def test_a_publication_of_an_ended_node_needs_a_node(node):
    node('(defvar *pub* (advertise "t" "std_msgs/String")) (shutdown-ros-node)')
    assert node.error('(publish *pub* (make-msg "std_msgs/String"))') == "Node status is SHUTDOWN"


@pytest.mark.parametrize(
    "call, told",
    [
        ('(get-param "x")', "Could not contact master when getting param /x: {}"),
        ('(set-param "x" 1)', "Could not contact master at {uri} when setting param /x"),
        ('(has-param "x")', "Could not contact master at {uri} for call to hasParam /x: {}"),
        ('(delete-param "x")', "Could not contact master at {uri} when deleting param /x: {}"),
        ("(list-params)", "Could not contact master at {uri} when getting param list: {}"),
        (
            '(start-ros-node "x" :master-uri "http://localhost:1" :cmd-line-args "_a:=1 _b:=2")',
            "Could not contact master at {uri} when setting param /x/a",
        ),
    ],
)
def test_a_master_that_is_not_there_is_told_by_every_call(lisp, call, told):
    lisp.error('(start-ros-node "x" :master-uri (make-uri "127.0.0.1" 1))')
    uri, problem = "#S(URI :ADDRESS 127.0.0.1 :PORT 1)", 'Socket error in "connect": ECONNREFUSED (Connection refused)'
    assert lisp.error(call) == told.format(problem, uri=uri)
    assert lisp('(start-ros-node "x") (get-param "x" 7)') == "7"


def test_a_real_master_is_told_from_one_that_is_not_there(lisp):
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        assert lisp.error(f'(start-ros-node "x" :master-uri "http://localhost:{port}")') == (
            f"Could not contact master at #S(URI :ADDRESS 127.0.0.1 :PORT {port}) when getting param list: a master outside of this "
            "process answers there. Start the session with --ros ws://127.0.0.1:9090 to work with its nodes, through the rosbridge server "
            "on that machine; without :master-uri the node is started here."
        )


@pytest.mark.parametrize("uri", ["http://localhost:11311/", "http://127.0.0.1:11311", "http://robot:11311"])
def test_the_master_of_the_session_is_here_under_each_of_its_names(lisp, uri, monkeypatch):
    monkeypatch.setenv("ROS_MASTER_URI", "http://robot:11311")
    lisp(f'(start-ros-node "x" :master-uri "{uri}")')
    assert lisp("(node-status)") == ":RUNNING"
    assert lisp.printed()[4] == f"[(ROSLISP TOP) INFO] T: master URI is {uri[7:].strip('/').replace('localhost', '127.0.0.1')}"


def test_the_address_of_the_master_is_the_argument_the_variable_or_the_environment(lisp, monkeypatch):
    monkeypatch.setenv("ROS_MASTER_URI", "http://robot:11312")
    assert lisp('(start-ros-node "x") *master-uri*') == '#S(ROSLISP::URI :ADDRESS "robot" :PORT 11312)'
    assert lisp('(setf *default-master-uri* "http://localhost:11311") (start-ros-node "x") *master-uri*') == (
        '#S(ROSLISP::URI :ADDRESS "127.0.0.1" :PORT 11311)'
    )
    for wrong in ("5", '(make-uri "localhost" 11311)', '""'):
        assert lisp.error(f'(setf *default-master-uri* {wrong}) (start-ros-node "x")') == (
            "Master uri needs to be supplied either as an argument to start-ros-node, or through the environment variable ROS_MASTER_URI, "
            "or by setting the lisp variable *default-master-uri*"
        )


@pytest.mark.parametrize("gone", ["xml-rpc-port", "pub-server-port"])
def test_ports_are_no_arguments_any_more(lisp, gone):
    assert lisp.error(f'(start-ros-node "x" :{gone} 8001)') == f"start-ros-node no longer accepts the {gone} argument"


def test_arguments_are_announced(lisp):
    lisp("""(start-ros-node "turtle1" :cmd-line-args '("_p:=3" "_q:=hello" "foo:=bar" "ignored" "__ns:=a/b" "~x:=/y"))""")
    assert lisp.printed()[:6] == [
        "[(ROSLISP TOP) INFO] T: Node name is /a/b/turtle1",
        "[(ROSLISP TOP) INFO] T: Namespace is /a/b/",
        "[(ROSLISP TOP) INFO] T: Params are ((~q . hello) (~p . 3))",
        "[(ROSLISP TOP) INFO] T: Remappings are:",
        "  /foo = /bar",
        "  /a/b/turtle1/x = /y",
    ]


@pytest.mark.parametrize(
    "raw, value",
    [
        ("3", "3"),
        ("-1.5", "-1.5"),
        ("1e3", "1000.0"),
        ("1/2", "0.5"),
        ("true", '"true"'),
        ("t", '"t"'),
        ("hello", '"hello"'),
        ("(1", '"(1"'),
        ('"quoted"', '"quoted"'),
        ("", '""'),
        ("a:b:", '"a:b:"'),
    ],
)
def test_the_reader_reads_private_parameters(lisp, raw, value):
    lisp(f"""(start-ros-node "n" :cmd-line-args (list {'"_p:=' + raw.replace('"', chr(92) + '"') + '"'}))""")
    assert lisp('(get-param "~p")') == value


def test_a_second_underscore_belongs_to_the_name(lisp):
    lisp('(start-ros-node "n" :cmd-line-args "__master:=http://x __log_level:=3")')
    assert lisp('(list (get-param "~_master") (get-param "~_log_level"))') == '("http://x" 3)'


def test_the_environment_gives_the_namespace_and_the_command_line_another(lisp, monkeypatch):
    monkeypatch.setenv("ROS_NAMESPACE", "wg")
    assert lisp('(fully-qualified-name "foo")') == '"/wg/foo"'
    assert lisp('(start-ros-node "n") (list *ros-node-name* (fully-qualified-name "foo") (fully-qualified-name "~foo"))') == (
        '("/wg/n" "/wg/foo" "/wg/n/foo")'
    )
    assert lisp('(start-ros-node "n" :cmd-line-args "__ns:=/other/") (fully-qualified-name "foo")') == '"/other/foo"'


def test_names_before_any_node_and_bad_ones(lisp):
    assert lisp("""(mapcar #'fully-qualified-name '("foo" "~foo" "a//b"))""") == '("/foo" "/foo" "/a//b")'
    assert lisp.error('(fully-qualified-name "")').startswith("Invalid index 0 for (SIMPLE-ARRAY CHARACTER (0))")
    assert lisp.error("(fully-qualified-name 'foo)") == "The value FOO is not of type STRING when binding ROSLISP::NAME"


def test_remapped_names_are_used_by_topics_services_and_parameters_but_not_by_waiting(lisp):
    lisp('(start-ros-node "n" :cmd-line-args "a:=b")')
    lisp("""(defvar *got* nil)
            (subscribe "b" "std_msgs/String" (lambda (m) (push (std_msgs-msg:data m) *got*)))
            (publish (advertise "a" "std_msgs/String") (make-msg "std_msgs/String" :data "x"))
            (register-service-fn "a" (lambda (request) request (make-response 'std_srvs-srv:Empty)) 'std_srvs-srv:Empty)
            (set-param "a" 5)""")
    assert (
        lisp("""(list *got* (get-param "/b") (call-service "a" 'std_srvs-srv:Empty)
                         (wait-for-service "b" 0) (wait-for-service "a" 0))""")
        == '(("x") 5 [STD_SRVS-SRV:EMPTY-RESPONSE] T NIL)'
    )


class TestWithRosNode:
    def test_it_returns_what_the_body_returns_and_shuts_down(self, lisp):
        assert lisp('(list (with-ros-node ("n" :anonymous nil) 1 (node-status)) (node-status))') == "(:RUNNING :SHUTDOWN)"

    @pytest.mark.parametrize(
        "exit",
        [
            "(catch 'out (with-ros-node (\"n\") (throw 'out 1)))",
            '(ignore-errors (with-ros-node ("n") (error "no")))',
            '(block b (with-ros-node ("n") (return-from b 1)))',
        ],
    )
    def test_it_shuts_down_on_every_way_out(self, lisp, exit):
        assert lisp(f"{exit} (node-status)") == ":SHUTDOWN"

    def test_the_restart_ends_it(self, lisp):
        lisp("""(handler-bind ((simple-error (lambda (c) (invoke-restart 'roslisp::shutdown-ros-node c))))
                  (with-ros-node ("n") (error "kaboom ~a" 3)))""")
        assert lisp.printed()[-2:] == [
            "[(ROSLISP TOP) INFO] T: About to shutdown due to condition kaboom 3",
            "[(ROSLISP TOP) INFO] T: Shutdown complete",
        ]

    def test_with_spin_it_waits_until_somebody_ends_it(self, lisp):
        assert (
            lisp("""(cpl:top-level (cpl:pursue (with-ros-node ("n" :spin t) (note 'body)) (cpl:sleep 500)))
                       (list *notes* (node-status))""")
            == "((BODY) :SHUTDOWN)"
        )

    def test_a_node_as_a_function_takes_private_parameters(self, lisp):
        lisp("""(def-ros-node listener (speed colour) () (note (list *ros-node-name* speed colour)) 5)""")
        lisp('(start-ros-node "n") (set-param "/listener/speed" 2) (set-param "/listener/colour" "red") (shutdown-ros-node)')
        assert lisp("(list (listener) *notes* (node-status))") == '(5 (("/listener" 2 "red")) :SHUTDOWN)'
        assert lisp.warned() == ""
        lisp("(def-ros-node my-node () () 1) (my-node)")
        assert lisp.warned() == "WARNING: my-node is not a legal ROS base name. This may cause problems with other ROS tools"

    def test_the_hook_of_executables_ends_a_running_node(self, lisp):
        assert lisp("(standalone-exec-debug-hook nil nil)") == "NIL"
        lisp("""(with-ros-node ("n")
                  (let ((*debugger-hook* #'standalone-exec-debug-hook))
                    (invoke-debugger (make-condition 'simple-error :format-control "kaboom"))))""")
        assert any("About to shutdown due to condition kaboom" in line for line in lisp.printed())
        assert lisp("(node-status)") == ":SHUTDOWN"


def test_ending_an_executable_exits(lisp):
    with pytest.raises(SystemExit):
        lisp('(setf *running-from-command-line* t) (start-ros-node "n") (shutdown-ros-node)')
    lisp("(setf *running-from-command-line* nil)")


def test_a_node_that_is_interrupted_while_it_starts_leaves_nothing_behind(lisp):
    assert lisp('(cpl:top-level (cpl:pursue (start-ros-node "n" :anonymous t) (cpl:sleep 0.5))) (node-status)') == ":SHUTDOWN"
    assert [name for name in graph.active().nodes if name.startswith("/n")] == []
    assert lisp('(start-ros-node "n") (node-status)') == ":RUNNING"


def test_the_status_is_printed(node):
    node("""(advertise "chatter" "std_msgs/String") (subscribe "chatter" "std_msgs/String" #'identity) (print-status)""")
    assert node.printed() == [
        "Node /n is RUNNING, master #S(URI :ADDRESS 127.0.0.1 :PORT 11311)",
        "Publications:",
        "  /rosout [rosgraph_msgs/Log]",
        "  /chatter [std_msgs/String]",
        "Subscriptions:",
        "  /chatter [std_msgs/String]",
    ]
    node("(shutdown-ros-node) (print-status)")
    assert node.printed()[1:] == ["Node /n is SHUTDOWN, master #S(URI :ADDRESS 127.0.0.1 :PORT 11311)", "Publications:", "Subscriptions:"]


class TestShuttingDown:
    SLOW = """(defun text (data) (make-msg "std_msgs/String" :data data))
              (subscribe "t" "std_msgs/String"
                         (lambda (m) m (unwind-protect (wait-duration 100) (note (list :cleaned (node-status))) {0})))
              (publish (advertise "t" "std_msgs/String") (text "a")) (wait-duration 1)"""

    def test_it_waits_for_the_cleanup_of_callbacks(self, node):
        assert node(self.SLOW.format("(wait-duration 0.5) (note :done)") + "(shutdown-ros-node) *notes*") == "((:CLEANED :SHUTDOWN) :DONE)"

    def test_but_not_for_ever(self, node):
        assert (
            node(
                self.SLOW.format("(wait-duration 1000)")
                + """
            (let ((start (ros-time))) (shutdown-ros-node) (values (round (* 10 (- (ros-time) start)))))"""
            )
            == "35"
        )

    def test_a_callback_may_end_the_node_itself(self, node):
        assert (
            node("""(subscribe "t" "std_msgs/String" (lambda (m) m (shutdown-ros-node) (note (node-status))))
                       (publish (advertise "t" "std_msgs/String") (make-msg "std_msgs/String")) (wait-duration 1)
                       (list *notes* (node-status))""")
            == "((:SHUTDOWN) :SHUTDOWN)"
        )
        node.printed()
        assert (
            node("""(start-ros-node "n")
                       (register-service-fn "end" (lambda (r) r (shutdown-ros-node) (make-response 'std_srvs-srv:Empty))
                                            'std_srvs-srv:Empty)
                       (handler-case (call-service "end" 'std_srvs-srv:Empty) (error () :lost))""")
            == ":LOST"
        )
        assert node("(node-status)") == ":SHUTDOWN"

    def test_somebody_else_may_end_it(self, node):
        node.output.take()
        graph.active().nodes["/n"].shutdown()
        assert node("(node-status)") == ":SHUTDOWN"
        assert node.printed() == ["[(ROSLISP TOP) INFO] T: Shutdown complete"]

    def test_a_node_that_takes_its_name_ends_it(self, node):
        graph.active().node("n")
        assert node("(node-status)") == ":SHUTDOWN"
        assert node.printed() == ["[(ROSLISP TOP) INFO] T: Shutdown complete"]
