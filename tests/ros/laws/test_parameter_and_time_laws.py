"""Invariants 45 to 48 of roslisp.md: parameters, time and loops, as a user types them; and what else the page says about them."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class


@pytest.mark.law("roslisp", 45)
def test_parameters_there_and_back(node):
    assert node('(set-param "d" 1.5)') == "0"
    assert node('(list (get-param "d") (has-param "d") (has-param "nope") (get-param "nope" 3) (get-param "nope" nil))') == (
        "(1.5 T NIL 3 NIL)"
    )
    told = "Param /nope does not exist, and no default supplied"
    assert node.error('(get-param "nope")') == told
    assert node.printed() == [f"[NIL ERROR] T: {told}"]


@pytest.mark.parametrize(
    "value, back",
    [
        ("1.5d0", "1.5"),
        ("0.1d0", "0.1"),
        ("1/3", "0.33333334"),
        ("7", "7"),
        ("-2147483648", "-2147483648"),
        ('"text"', '"text"'),
        ("t", "T"),
        ("nil", "NIL"),
        ("'foo-bar", '"FOO-BAR"'),
        (":key", '"KEY"'),
        ('\'(1 "a" (2.5 t nil) foo)', '(1 "a" (2.5 T NIL) "FOO")'),
        ("#(1 2 3)", "(1 2 3)"),
        ("(vector)", "NIL"),
        ('"ünï"', '"ünï"'),
    ],
)
def test_what_values_become(node, value, back):
    assert node(f'(set-param "v" {value}) (get-param "v")') == back
    assert node('(has-param "v")') == "T"


@pytest.mark.parametrize(
    "value, told",
    [
        (
            "2147483648",
            "The integer 2147483648 does not fit into a parameter: those have 32 bits, from -2147483648 to 2147483647. "
            "A float or a string holds it.",
        ),
        (
            "-2147483649",
            "The integer -2147483649 does not fit into a parameter: those have 32 bits, from -2147483648 to 2147483647. "
            "A float or a string holds it.",
        ),
        (
            "(list 1 (expt 10 12))",
            "The integer 1000000000000 does not fit into a parameter: those have 32 bits, from -2147483648 to "
            "2147483647. A float or a string holds it.",
        ),
        ("#\\a", "A parameter can be a string, number, boolean, list or vector of these, but not #\\a."),
    ],
)
def test_values_that_no_parameter_can_have(node, value, told):
    assert node.error(f'(set-param "v" {value})') == told
    assert node('(has-param "v")') == "NIL"


def test_a_namespace_is_a_struct(node):
    node('(set-param "/a/x" 1) (set-param "/a/b/Deep" "z")')
    assert node('(get-param "a")') == (
        '#S(S-XML-RPC:XML-RPC-STRUCT :ALIST ((:|x| . 1) (:|b| . #S(S-XML-RPC:XML-RPC-STRUCT :ALIST ((:|Deep| . "z"))))))'
    )
    assert node("""(let ((a (get-param "a")))
                     (list (s-xml-rpc:get-xml-rpc-struct-member a :|x|) (s-xml-rpc:xml-rpc-struct-p a)
                           (s-xml-rpc:get-xml-rpc-struct-member a "nope") (mapcar #'car (s-xml-rpc:xml-rpc-struct-alist a))))""") == (
        "(1 T NIL (:|x| :|b|))"
    )
    assert node('(set-param "copy" (get-param "a")) (get-param "copy/b/Deep")') == '"z"'
    assert node('(set-param "made" (s-xml-rpc:xml-rpc-struct "x" 1 "y" \'(1 2))) (list (list-params "made") (get-param "made/y"))') == (
        '(("/made/x" "/made/y") (1 2))'
    )


def test_deleting_what_is_not_there_is_no_error(node):
    assert node('(set-param "f" 1) (list (delete-param "f") (has-param "f"))') == "(0 NIL)"
    told = (
        "ros-rpc call (deleteParam /f) to #S(URI :ADDRESS 127.0.0.1 :PORT 11311) failed with code -1, message parameter [/f] is not "
        "set, values 0"
    )
    assert node.error('(handler-case (delete-param "f") (error () :caught))') == told
    assert node('(handler-bind ((roslisp::ros-rpc-error (lambda (c) c (invoke-restart \'continue)))) (delete-param "f"))') == "0"


def test_listing_names_below_a_namespace(node):
    node("""(dolist (name '("/turtle1/x" "/turtle1/sub/y" "/turtle10/z" "top")) (set-param name 1))""")
    assert node("""(list (list-params "turtle1") (list-params "/turtle1/sub") (list-params '(turtle10)) (list-params '(turtle1 sub))
                         (list-params "~") (list-params "nope"))""") == (
        '(("/turtle1/sub/y" "/turtle1/x") ("/turtle1/sub/y") ("/turtle10/z") ("/turtle1/sub/y") NIL NIL)'
    )
    assert node("(list-params)") == '("/rosdistro" "/rosversion" "/run_id" "/top" "/turtle1/sub/y" "/turtle1/x" "/turtle10/z")'


def test_what_roscore_sets_is_there_from_the_start_and_the_same_in_every_run(node):
    assert node('(list (get-param "/rosdistro") (get-param "/rosversion") (get-param "/run_id"))') == (
        '("noetic " "1.15.15 " "6d1da4a0-0ac1-11e0-8000-010000000000")'
    )


@pytest.mark.parametrize("call", ["(get-param 'foo)", "(set-param 'foo 1)", "(has-param 'foo)", "(delete-param 'foo)"])
def test_keys_are_strings(node, call):
    assert node.error(call) == "The value FOO is not of type STRING when binding ROSLISP::KEY"


@pytest.mark.law("roslisp", 46)
def test_spin_until_gives_up_after_its_time(node):
    assert node("(let ((start (ros-time))) (list (multiple-value-list (spin-until nil (0.01 0.1))) (>= (- (ros-time) start) 0.0999)))") == (
        "((NIL T) T)"
    )
    assert node("(let ((n 0)) (list (spin-until (when (= n 3) :three) 0.5 (incf n)) n))") == "(:THREE 3)"
    assert node("(multiple-value-list (spin-until t (1 0)))") == "(T)"
    assert node("(multiple-value-list (spin-until nil (1 0)))") == "(NIL T)"
    assert node("(spin-until nil 0.1 (return :out))") == ":OUT"


@pytest.mark.law("roslisp", 47)
def test_wait_duration_takes_its_time(node):
    assert node("(let ((start (ros-time))) (list (wait-duration 0.3) (<= 0.2999 (- (ros-time) start) 0.35)))") == "(T T)"
    assert node("(let ((start (ros-time))) (list (wait-duration 1/2) (wait-duration 0) (wait-duration -1) (- (ros-time) start)))") == (
        "(T T T 0.5d0)"
    )


@pytest.mark.law("roslisp", 48)
def test_simulated_time_follows_the_clock(lisp):
    assert lisp("""(start-ros-node "setup") (set-param "/use_sim_time" t) (start-ros-node "n") (ros-time)""") == "0.0"
    assert lisp.printed()[-1] == "[(ROSLISP TOP) INFO] T: Node startup complete"
    clock = graph.active().node("clock").advertise("/clock", message_class("rosgraph_msgs/Clock"))
    tell = message_class("rosgraph_msgs/Clock")
    clock.publish(tell(clock=12.5))
    assert lisp("(ros-time)") == "12.5d0"
    kernel.sleep(100)
    assert lisp("(ros-time)") == "12.5d0"
    clock.publish(tell(clock=20))
    lisp('(ros-info (a) "x")')
    assert lisp.output.take() == "[(A) INFO] 20.000: x\n"


@pytest.mark.parametrize(
    "value, simulated",
    [("t", True), ('"true"', True), ("1", True), ("'t", True), ('"false"', False), ("nil", False), ("0", False), ("2", False)],
)
def test_what_turns_simulated_time_on(lisp, value, simulated):
    lisp(f'(start-ros-node "setup") (set-param "/use_sim_time" {value}) (start-ros-node "n")')
    assert (lisp("(ros-time)") == "0.0") is simulated


def test_waits_follow_simulated_time(lisp):
    lisp('(start-ros-node "setup") (set-param "/use_sim_time" t) (start-ros-node "n")')
    clock, tell, begin = (
        graph.active().node("clock").advertise("/clock", message_class("rosgraph_msgs/Clock")),
        message_class("rosgraph_msgs/Clock"),
        kernel.now(),
    )
    kernel.call_every(1.0, lambda: clock.publish(tell(clock=100 + (kernel.now() - begin) / 2)))  # at half the speed
    assert lisp("(spin-until-ros-time-valid) (wait-duration 3) (ros-time)") == "103.5d0"
    assert kernel.now() - begin == pytest.approx(7, abs=0.02)


def test_waiting_for_a_valid_time_warns_now_and_then(lisp):
    lisp('(start-ros-node "setup") (set-param "/use_sim_time" t) (start-ros-node "n")')
    lisp.printed()
    lisp("(cpl:top-level (cpl:pursue (spin-until-ros-time-valid) (cpl:sleep 12)))")
    assert lisp.printed() == ["[(ROSLISP TIME) WARN] T: Waiting for valid ros-time before proceeding"] * 2


def test_a_loop_runs_at_most_every_so_often(node):
    assert (
        node("""(let ((n 0) (start (ros-time)))
                     (list (loop-at-most-every 0.5
                             (note (round (* 10 (- (ros-time) start)))) (when (= (incf n) 3) (return :done)))
                           *notes*))""")
        == "(:DONE (0 5 10))"
    )
    assert (
        node("""(setf *notes* nil)
                   (let ((n 0) (start (ros-time)))  ; a body that takes longer is not repeated to make up for it
                     (loop-at-most-every 0.5 (note (round (* 10 (- (ros-time) start)))) (wait-duration 0.8)
                                         (when (= (incf n) 3) (return))) *notes*)""")
        == "(0 8 16)"
    )


def test_a_thread_beside_a_body_ends_with_it(node):
    node("(defvar *beats* 0) (defun beat () (loop-at-most-every 1 (incf *beats*)))")
    assert node("(list (with-parallel-thread (beat) (wait-duration 2.5) :done) *beats*)") == "(:DONE 3)"
    assert node("(wait-duration 5) *beats*") == "3"
    assert node('(setf *beats* 0) (with-parallel-thread ((lambda () (beat)) "heart") (wait-duration 0.5)) *beats*') == "1"
    assert (
        node("""(setf *beats* 0) (ignore-errors (with-parallel-thread (beat) (wait-duration 0.5) (error "no")))
                   (wait-duration 5) *beats*""")
        == "1"
    )


def test_a_thread_that_fails_is_told(node):
    assert node('(defun fail () (error "kaboom")) (with-parallel-thread (fail) (wait-duration 1) :done)') == ":DONE"
    assert "An error ended FAIL, and nobody waited for it: kaboom" in node.warned()


def test_time_needs_no_node(lisp):
    assert lisp("(ros-time)") == "1.292688669674d9"
    assert lisp("(wait-duration 1) (ros-time)") == "1.292688670674d9"
