"""Invariants 41 to 44 of roslisp.md: services, as a user types them; and what else the page says about them."""

import pytest

from cramhy_runtime.ros import graph, services
from cramhy_runtime.ros.messages import service_type_exact
from cramhy_runtime.turtlesim.node import start_turtlesim

ADDING = """
    (def-service-callback (add-two roscpp_tutorials-srv:TwoInts) (a b) (make-response :sum (+ a b)))
    (register-service-fn "s" #'add-two 'roscpp_tutorials-srv:TwoInts)"""
EMPTY = "'std_srvs-srv:Empty"


@pytest.mark.law("roslisp", 41)
def test_a_call_with_fields_or_with_a_request(node):
    assert node(ADDING) == "1"
    assert node('(call-service "s" "roscpp_tutorials/TwoInts" :a 3 :b 4)') == "[ROSCPP_TUTORIALS-SRV:TWOINTS-RESPONSE SUM: 7]"
    assert (
        node('(with-fields (sum) (call-service "s" "roscpp_tutorials/twoints" (make-request "roscpp_tutorials/TwoInts" :a 3 :b 4)) sum)')
        == "7"
    )
    assert node('(roscpp_tutorials-srv:sum (call-service "s" \'roscpp_tutorials-srv:TwoInts :b 4))') == "4"


@pytest.mark.law("roslisp", 42)
def test_an_absent_service_is_no_error(node):
    told = "ros-rpc call (lookupService /nosrv) to #S(URI :ADDRESS 127.0.0.1 :PORT 11311) failed with code -1, message no provider, values"
    assert node.error(f'(handler-case (call-service "nosrv" {EMPTY}) (error () :caught))') == told
    assert node(f"""(handler-case (call-service "nosrv" {EMPTY}) (condition (c) (list (typep c 'error) (type-of c))))""") == (
        "(NIL ROSLISP::ROS-RPC-ERROR)"
    )


@pytest.mark.law("roslisp", 43)
def test_waiting_for_a_service(node):
    assert node("""(let ((start (ros-time))) (list (wait-for-service "/absent" 0.5) (<= 0.5 (- (ros-time) start) 0.6)))""") == "(NIL T)"
    assert (
        node(
            ADDING
            + """(let ((start (ros-time))) (list (wait-for-service "/s" 0.5) (wait-for-service "/s") (wait-for-service "/s" 0)
                                                             (= start (ros-time))))"""
        )
        == "(T T T T)"
    )


@pytest.mark.law("roslisp", 44)
def test_a_callback_that_fails_tells_the_client(node):
    node(f'(register-service-fn "bad" (lambda (request) request (error "kaboom ~a" 3)) {EMPTY})')
    told = node.error(f'(call-service "bad" {EMPTY})')
    assert told.startswith("service-call to 127.0.0.1:") and told.endswith(
        "with request [EMPTY-REQUEST] failed with message: error processing request: kaboom 3"
    )
    lines = node.printed()
    assert lines[:2] == ["[(ROSLISP SERVICE TCP) ERROR] T: Error processing request [EMPTY-REQUEST]:", " kaboom 3"]
    assert lines[2].startswith("[NIL ERROR] T: service-call to 127.0.0.1:")


def test_the_restart_of_an_absent_service_ignores_it(node):
    assert (
        node(f"""
        (defun ignoring (action)
          (handler-bind ((roslisp::ros-rpc-error
                           (lambda (c) (note (format nil "~a" (first (compute-restarts c)))) (funcall action) (invoke-restart 'continue))))
            (call-service "late" {EMPTY})))
        (list (ignoring (lambda ()))
              (ignoring (lambda () (register-service-fn "late" (lambda (r) r (make-response {EMPTY})) {EMPTY})))
              *notes*)""")
        == '(NIL [STD_SRVS-SRV:EMPTY-RESPONSE] ("Ignore and continue" "Ignore and continue"))'
    )


def test_a_refusal_of_the_server_has_no_error_line_of_its_own(node):
    node(f"""(register-service-fn "no" (lambda (r) r (error 'service-error :format-control "not ~a" :format-arguments '(today)))
                                  {EMPTY})""")
    assert node.error(f'(call-service "no" {EMPTY})').endswith("failed with message: service cannot process request: not TODAY")
    assert [line.split("]")[0] for line in node.printed()] == ["[NIL ERROR"]


def test_a_refusal_with_an_empty_text_ends_in_a_colon_and_a_space(node):
    start_turtlesim()
    condition = node.condition('(call-service "kill" \'turtlesim-srv:Kill :name "nobody")')
    assert condition.report().endswith("nobody] failed with message: ")


@pytest.mark.parametrize(
    "call, told",
    [
        ('(call-service "s")', "too few elements in () to satisfy lambda list (SERVICE-TYPE &REST REQUEST-ARGS)"),
        ('(call-service "s" "nopkg/Nope")', "Service-package not found. Maybe it is not loaded?"),
        ('(call-service "s" "Nope")', "The value NIL is not of type STRING"),
        (
            '(call-service "s" "roscpp_tutorials/Nope")',
            "There is no applicable method for the generic function #<STANDARD-GENERIC-FUNCTION ROSLISP-MSG-PROTOCOL:SERVICE-RESPONSE-TYPE",
        ),
        ('(call-service "s" "roscpp_tutorials/TwoInts" :c 1)', "Invalid initialization argument: :C in call for class"),
        ('(call-service "s" "roscpp_tutorials/TwoInts" :a 1.5)', "The value 1.5 is not of type INTEGER"),
        ('(call-service "s" "std_srvs/Empty")', "with request [EMPTY-REQUEST] failed."),
        (
            '(make-service-client "s" \'std_srvs-srv:Empty)',
            "The value of ROSLISP::SERVICE-TYPE is STD_SRVS-SRV:EMPTY, which is not of type STRING.",
        ),
        ('(make-service-client \'s "std_srvs/Empty")', "The value of ROSLISP::SERVICE-NAME is S, which is not of type STRING."),
        (
            "(register-service-fn \"s\" #'identity 'std_srvs-srv:Empty)",
            "Cannot create service /s as it already exists with info #S(SERVICE",
        ),
    ],
)
def test_mistakes_in_calls(node, call, told):
    node(ADDING)
    assert told in node.error(call)


def test_a_client_stands_for_name_and_type(node):
    assert (
        node(
            ADDING
            + """(let ((client (make-service-client "s" "roscpp_tutorials/TwoInts")))
                              (list (wait-for-service client 0) (roscpp_tutorials-srv:sum (call-service client :a 1 :b 2))))"""
        )
        == "(T 3)"
    )


def test_a_call_as_a_function(node):
    node(
        ADDING
        + """(def-service-call (sum-of roscpp_tutorials-srv:TwoInts) "s" :return-field sum)
                     (def-service-call roscpp_tutorials-srv:TwoInts "s")"""
    )
    assert node("(list (sum-of :a 1 :b 2) (roscpp_tutorials-srv:sum (roscpp_tutorials-srv:TwoInts :a 2 :b 3)))") == "(3 5)"


def test_a_service_named_as_its_callback(node):
    assert (
        node("""(def-service-callback roscpp_tutorials-srv:TwoInts ((x a) b) (make-response :sum (* x b)))
                   (list (register-service "product" roscpp_tutorials-srv:TwoInts) (register-service "quoted" 'roscpp_tutorials-srv:TwoInts)
                         (roscpp_tutorials-srv:sum (call-service "product" "roscpp_tutorials/TwoInts" :a 6 :b 7)))""")
        == "(1 1 42)"
    )


def test_a_callback_that_returns_no_response_is_told(node):
    node(f'(register-service-fn "five" (lambda (r) r 5) {EMPTY})')
    assert node.error(f'(call-service "five" {EMPTY})').endswith(
        "failed with message: error processing request: The callback of service /five must return a STD_SRVS-SRV:EMPTY-RESPONSE "
        "(see make-response), but it returned 5."
    )


def test_a_callback_that_calls_an_absent_service_fails_and_the_others_go_on(node):
    node(ADDING + f"""(register-service-fn "outer" (lambda (r) r (call-service "nosrv" {EMPTY})) {EMPTY})""")
    assert node.error(f'(call-service "outer" {EMPTY})').endswith(
        "failed with message: error processing request: ros-rpc call (lookupService /nosrv) to #S(URI :ADDRESS 127.0.0.1 :PORT 11311) "
        "failed with code -1, message no provider, values"
    )
    assert node('(roscpp_tutorials-srv:sum (call-service "s" \'roscpp_tutorials-srv:TwoInts :a 1 :b 2))') == "3"


def test_callbacks_run_one_at_a_time(node):
    assert (
        node(f"""
        (register-service-fn "slow" (lambda (r) r (note :in) (wait-duration 0.5) (note :out) (make-response {EMPTY})) {EMPTY})
        (cpl:top-level (cpl:par (call-service "slow" {EMPTY}) (call-service "slow" {EMPTY})))
        *notes*""")
        == "(:IN :OUT :IN :OUT)"
    )


def test_a_service_that_ends_with_its_node_while_it_is_called(node):
    server = graph.active().node("server", spins=True)
    server.serve("hang", service_type_exact("std_srvs/Empty"), print)
    server.graph.kernel.call_at(server.graph.kernel.now() + 1, server.shutdown)
    assert node.error(f'(call-service "hang" {EMPTY})') == f"service-call to {server.address} with request [EMPTY-REQUEST] failed."


def test_the_nodes_services_end_with_it(node):
    node(ADDING + "(shutdown-ros-node)")
    assert "/s" not in graph.active().services
    assert "/n/reset_debug_levels" not in graph.active().services


def test_a_call_that_is_cut_off_leaves_the_server_alone(node):
    node(f"""(register-service-fn "slow" (lambda (r) r (note :in) (wait-duration 1) (note :out) (make-response {EMPTY})) {EMPTY})""")
    assert (
        node(f"""(cpl:top-level (cpl:pursue (call-service "slow" {EMPTY}) (cpl:sleep 0.2)))
                    (wait-duration 2) (call-service "slow" {EMPTY}) *notes*""")
        == "(:IN :OUT :IN :OUT)"
    )


class TestPersistentServices:
    PERSISTENT = (
        ADDING
        + """
        (defvar *service* (make-instance 'persistent-service :service-name "s" :service-type 'roscpp_tutorials-srv:TwoInts))"""
    )

    def test_it_is_called_again_and_again(self, node):
        node(self.PERSISTENT)
        assert (
            node("""(defun sum (&rest request) (roscpp_tutorials-srv:sum (apply #'call-persistent-service *service* request)))
                       (list (persistent-service-ok *service*) (sum :a 1 :b 2) (sum (make-request "roscpp_tutorials/TwoInts" :a 5)))""")
            == "(T 3 5)"
        )

    def test_a_closed_one_fails_and_reconnects(self, node):
        node(self.PERSISTENT + "(close-persistent-service *service*)")
        assert node("(persistent-service-ok *service*)") == "NIL"
        assert node.error("(call-persistent-service *service* :a 1)") == "service-call-error: The connection is closed."
        assert (
            node("""(handler-bind ((service-call-error (lambda (c) (note (type-of c)) (invoke-restart 'reconnect))))
                         (roscpp_tutorials-srv:sum (call-persistent-service *service* :a 1 :b 1)))""")
            == "2"
        )
        assert node("(list *notes* (persistent-service-ok *service*))") == "((SERVICE-CALL-ERROR) T)"

    def test_a_server_that_fails_is_an_error_here(self, node):
        node(f"""(register-service-fn "bad" (lambda (r) r (error "kaboom")) {EMPTY})
                 (defvar *bad* (make-instance 'persistent-service :service-name "bad" :service-type "std_srvs/Empty"))""")
        assert node('(handler-case (call-persistent-service *bad*) (error (c) (format nil "~a" c)))') == (
            '"service-call-error: error processing request: kaboom"'
        )

    def test_one_of_a_service_that_nobody_offers_cannot_be_made(self, node):
        assert node.error('(make-instance \'persistent-service :service-name "nosrv" :service-type "std_srvs/Empty")').startswith(
            "ros-rpc call (lookupService /nosrv) to "
        )


def test_python_nodes_may_refuse_with_a_text(node):
    def refuse(request):
        raise services.Refusal("not now")

    graph.active().node("server").serve("no", service_type_exact("std_srvs/Empty"), refuse)
    assert node.error(f'(call-service "no" {EMPTY})').endswith("with request [EMPTY-REQUEST] failed with message: not now")
