"""Topics, services, parameters and time as roslisp's functions show them (roslisp.md 6 to 9, 16; golden/01, 03)."""

import pytest

import cramhy_runtime.languages.commonlisp.faces.ros.package  # noqa: F401
from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import Error, SimpleError
from cramhy_runtime.lisp_core.data import NO_VALUES, MultipleValues, lisp_list, python_list
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.ros import graph, message_building, messages
from cramhy_runtime.ros.roslisp import clock, node, parameters, services, time, topics
from cramhy_runtime.ros.roslisp.errors import RosRpcError, ServiceError

EMPTY, SET_PEN, SPAWN = (sym(name) for name in ("STD_SRVS-SRV::EMPTY", "TURTLESIM-SRV::SETPEN", "TURTLESIM-SRV::SPAWN"))
TWO_INTS = "roscpp_tutorials/TwoInts"


def text(data):
    return message_building.make_message("std_msgs/String", [(("DATA",), data)])


class TestPublishing:
    def test_the_value_is_the_number_of_subscribers(self, running):
        publication = topics.advertise("chatter", "std_msgs/String")
        assert topics.publish(publication, text("a")) == 0
        topics.subscribe("chatter", "std_msgs/String", lambda message: None)
        assert topics.publish(publication, text("a")) == topics.publish("chatter", text("b")) == 1
        assert topics.num_subscribers(publication) == 1

    def test_advertising_twice_gives_the_same_object(self, running):
        assert topics.advertise("t", "std_msgs/String") is topics.advertise("t", "std_msgs/Bool", latch=True)

    @pytest.mark.parametrize(
        "type_name, problem",
        [
            ("std_msgs/Nope", "No datatype std_msgs/Nope known"),
            ("std_msgs/string", "Case mismatch for message type std_msgs/string, did you mean std_msgs/String?"),
            ("nope_msgs/Nope", 'The name "NOPE_MSGS-MSG" does not designate any package.'),
            ("std_msgs", 'Too few or too many slashes in "std_msgs"'),
        ],
    )
    def test_bad_types(self, running, fails, type_name, problem):
        assert fails(topics.advertise, "t", type_name).report() == problem

    def test_an_unknown_topic_is_logged_and_signalled(self, running, fails, printed):
        assert fails(topics.publish, "nochatter", text("a")).report() == "Unknown topic /nochatter"
        assert printed().startswith("[NIL ERROR]") and "Unknown topic" not in printed()

    def test_values_are_checked_when_somebody_listens(self, running, fails):
        publication = topics.advertise("t", "geometry_msgs/Twist")
        bad = message_building.make_message("geometry_msgs/Twist", [(("X", "LINEAR"), "a")])
        assert topics.publish(publication, bad) == 0
        topics.subscribe("t", "geometry_msgs/Twist", lambda message: None)
        assert fails(topics.publish, publication, bad).report() == 'The value\n  "a"\nis not of type\n  REAL\nwhen binding SB-KERNEL::X'

    def test_a_message_of_another_type_is_counted_but_not_delivered(self, running):
        received = []
        publication = topics.advertise("t", "geometry_msgs/Twist")
        topics.subscribe("t", "geometry_msgs/Twist", received.append)
        assert topics.publish(publication, message_building.make_message("turtlesim/Pose")) == 1
        kernel.settle()
        assert received == []

    def test_a_latched_message_reaches_who_comes_later_and_others_do_not(self, running):
        received = []
        topics.publish(topics.advertise("latched", "std_msgs/String", latch=True), text("old"))
        topics.publish(topics.advertise("plain", "std_msgs/String"), text("lost"))
        for name in ("latched", "plain"):
            topics.subscribe(name, "std_msgs/String", received.append)
        kernel.settle()
        assert [message.data for message in received] == ["old"]

    def test_unadvertising_what_is_not_there_warns(self, running, warned):
        assert topics.unadvertise("lat") == 1
        assert "Not publishing on /lat" in warned()


class TestSubscribing:
    def test_callbacks_run_newest_first_in_the_task_of_the_topic(self, running):
        ran = []
        publication = topics.advertise("t", "std_msgs/String")
        for name in ("old", "new"):
            topics.subscribe("t", "std_msgs/String", lambda message, name=name: ran.append((name, kernel.current().name)))
        topics.publish(publication, text("a"))
        kernel.settle()
        assert ran == [("new", "Subscriber thread for topic /t"), ("old", "Subscriber thread for topic /t")]

    def test_an_error_in_a_callback_is_logged_and_the_others_run(self, running, printed):
        received = []
        publication = topics.advertise("t", "std_msgs/String")
        topics.subscribe("t", "std_msgs/String", received.append)
        topics.subscribe("t", "std_msgs/String", lambda message: conditions.error(SimpleError("kaboom ~a", 3)))
        topics.publish(publication, text("a"))
        topics.publish(publication, text("b"))
        kernel.settle()
        assert [message.data for message in received] == ["a", "b"]
        output = printed()
        assert output.count("[(ROSLISP SERVICE TCP) ERROR]") == 2
        assert "Error during subscriber callback: 'kaboom 3' for topic item: \n[STRING" in output

    def test_an_error_of_python_is_logged_too(self, running, printed):
        publication = topics.advertise("t", "std_msgs/String")
        topics.subscribe("t", "std_msgs/String", lambda message: 1 // 0)
        topics.publish(publication, text("a"))
        kernel.settle()
        assert "DIVISION-BY-ZERO" in printed()

    def test_of_a_short_queue_the_oldest_are_dropped(self, running):
        received = []

        def slow(message):
            received.append(message.data)
            kernel.sleep(0.3)

        publication = topics.advertise("t", "std_msgs/String")
        topics.subscribe("t", "std_msgs/String", slow, max_queue_length=2)
        topics.publish(publication, text("0"))
        kernel.settle()
        for number in range(1, 10):
            topics.publish(publication, text(str(number)))
        kernel.sleep(2)
        assert received == ["0", "8", "9"]

    def test_a_bad_type_is_a_warning_and_nil(self, running, warned):
        assert topics.subscribe("foo", "nope_msgs/Nope", print) is None
        assert " ".join(warned().split()) == "WARNING: Couldn't lookup topic type nope_msgs/Nope for foo, so not subscribing."

    def test_a_callback_must_be_a_function(self, running, fails):
        assert "is not of type\n  FUNCTION" in fails(topics.subscribe, "t", "std_msgs/String", sym("CL-USER::FOO")).report()

    def test_another_type_for_the_same_topic(self, running, fails):
        topics.subscribe("t", "std_msgs/String", print)
        assert fails(topics.subscribe, "t", "std_msgs/Bool", print).report() == (
            "Asserted topic type std_msgs/Bool for new subscription to /t did not match existing type std_msgs/String"
        )

    def test_unsubscribing_ends_it_and_twice_is_an_error(self, running, fails):
        received = []
        publication = topics.advertise("t", "std_msgs/String")
        subscriber = topics.subscribe("t", "std_msgs/String", received.append)
        assert topics.unsubscribe(subscriber) is NO_VALUES
        assert topics.publish(publication, text("a")) == 0
        assert fails(topics.unsubscribe, subscriber).report() == "Subscription to topic `/t' invalid."

    def test_what_is_received_is_not_what_was_sent(self, running):
        received = []
        publication = topics.advertise("t", "geometry_msgs/Twist")
        topics.subscribe("t", "geometry_msgs/Twist", received.append)
        sent = message_building.make_message("geometry_msgs/Twist")
        topics.publish(publication, sent)
        kernel.settle()
        assert received[0] is not sent and received[0].linear is not sent.linear

    def test_the_first_pose_is_there_when_subscribe_returns(self, simulator):
        poses = []
        topics.subscribe("turtle1/pose", "turtlesim/Pose", poses.append)
        assert len(poses) == 1
        assert type(poses[0].x) is float

    def test_subscribing_before_the_simulator_runs_returns_at_once(self, running):
        from cramhy_runtime.turtlesim.node import start_turtlesim

        poses, before = [], kernel.now()
        topics.subscribe("turtle1/pose", "turtlesim/Pose", poses.append)
        assert kernel.now() == before
        start_turtlesim()
        kernel.sleep(0.05)
        assert poses

    def test_tasks_end_with_the_node(self, running):
        publication = topics.advertise("t", "std_msgs/String")
        topics.subscribe("t", "std_msgs/String", lambda message: kernel.sleep(100))
        topics.publish(publication, text("a"))
        kernel.settle()
        node.shutdown_ros_node()
        kernel.settle()
        assert [task.name for task in kernel.active().tasks] == ["main"]


class TestServices:
    def test_the_simulators_services(self, simulator):
        from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

        response = services.call_service("/turtle1/set_pen", SET_PEN, sym(":R"), 300, sym(":WIDTH"), 4)
        assert prin1_to_string(response) == "[TURTLESIM-SRV:SETPEN-RESPONSE]"
        assert simulator.turtles["turtle1"].pen_colour == (44, 0, 0)
        assert services.call_service("spawn", "turtlesim/spawn", sym(":X"), 3, sym(":NAME"), "t2").name == "t2"

    def test_the_answer_comes_before_the_update_of_its_tick(self, simulator):
        kernel.sleep(0.1)
        services.call_service("/turtle1/teleport_absolute", "turtlesim/TeleportAbsolute", sym(":X"), 2)
        assert simulator.turtles["turtle1"].x == 2.0
        assert kernel.now() * 1000 % 16 == pytest.approx(1094 % 16, abs=1e-6)

    def test_a_refusal_is_a_simple_error_with_the_empty_text_of_roscpp(self, simulator, fails, printed):
        for _ in range(2):
            call = lambda: services.call_service("/spawn", SPAWN, sym(":NAME"), "t2")  # noqa: E731
            if _ == 0:
                call()
        condition = fails(call)
        assert isinstance(condition, SimpleError)
        lines = condition.report().splitlines()
        assert lines[0] == f"service-call to {simulator.node.address} with request [SPAWN-REQUEST"
        assert lines[-1].strip() == "t2] failed with message:"
        assert condition.report().endswith("message: ")
        assert "[NIL ERROR]" in printed()

    def test_nobody_offers_the_service(self, running, fails):
        condition = fails(services.call_service, "/no_such_service", EMPTY)
        assert isinstance(condition, RosRpcError) and not isinstance(condition, Error)
        assert " ".join(condition.report().split()) == (
            "ros-rpc call (lookupService /no_such_service) to #S(URI :ADDRESS 127.0.0.1 :PORT 11311) failed "
            "with code -1, message no provider, values"
        )
        assert [restart.report() for restart in condition.restarts] == ["Ignore and continue"]

    def test_another_type_than_the_servers(self, simulator, fails):
        assert fails(services.call_service, "/turtle1/set_pen", EMPTY).report() == (
            f"service-call to {simulator.node.address} with request [EMPTY-REQUEST] failed."
        )

    def test_a_value_of_the_wrong_type(self, simulator, fails):
        assert (
            fails(services.call_service, "/turtle1/set_pen", SET_PEN, sym(":R"), 1.5).report()
            == "The value\n  1.5d0\nis not of type\n  INTEGER"
        )

    def adding(self, request):
        return messages.service_type(TWO_INTS).response(sum=request.a + request.b)

    def test_a_service_of_the_program(self, running):
        assert services.register_service_fn("add", self.adding, sym("ROSCPP_TUTORIALS-SRV::TWOINTS")) == 1
        assert services.call_service("add", TWO_INTS, sym(":A"), 3, sym(":B"), 4).sum == 7
        request = message_building.make_request(TWO_INTS, [(("A",), 3), (("B",), 4)])
        assert services.call_service("add", TWO_INTS, request).sum == 7
        assert services.call_service(services.make_service_client("add", TWO_INTS), sym(":A"), 1).sum == 1

    def test_registering_twice(self, running, fails):
        services.register_service_fn("add", self.adding, TWO_INTS)
        assert (
            fails(services.register_service_fn, "add", self.adding, TWO_INTS)
            .report()
            .startswith("Cannot create service /add as it already exists with info")
        )

    @pytest.mark.parametrize(
        "condition, ending, logged",
        [
            (lambda: SimpleError("kaboom ~a", 3), "failed with message: error processing request: kaboom 3", True),
            (lambda: ServiceError("no ~a", 3), "failed with message: service cannot process request: no 3", False),
        ],
    )
    def test_errors_of_the_server(self, running, fails, printed, condition, ending, logged):
        services.register_service_fn("bad", lambda request: conditions.error(condition()), EMPTY)
        assert fails(services.call_service, "bad", EMPTY).report().endswith(ending)
        assert ("[(ROSLISP SERVICE TCP) ERROR]" in printed()) is logged

    def test_a_service_may_call_a_service_of_its_own_node(self, running):
        services.register_service_fn("inner", self.adding, TWO_INTS)
        services.register_service_fn("outer", lambda request: services.call_service("inner", TWO_INTS, request), TWO_INTS)
        assert services.call_service("outer", TWO_INTS, sym(":A"), 2).sum == 2

    def test_waiting_for_a_service(self, running):
        before = kernel.now()
        assert services.wait_for_service("/absent", 0.5) is None
        assert kernel.now() - before == pytest.approx(0.5)
        kernel.call_at(
            kernel.now() + 1, lambda: graph.active().node("server").serve("late", messages.service_type(EMPTY), lambda request: None)
        )
        assert services.wait_for_service("late") is True
        assert services.wait_for_service("late", 0) is True

    def test_a_persistent_service(self, running, fails):
        services.register_service_fn("add", self.adding, TWO_INTS)
        service = services.PersistentService("add", TWO_INTS)
        assert services.persistent_service_ok(service) is True
        assert services.call_persistent_service(service, sym(":A"), 5).sum == 5
        services.close_persistent_service(service)
        assert services.persistent_service_ok(service) is None
        condition = fails(services.call_persistent_service, service)
        assert condition.restarts[0].name.name == "RECONNECT"

    def test_the_server_goes_away_while_a_caller_waits(self, simulator, fails):
        kernel.call_at(kernel.now() + 0.001, simulator.shutdown)
        assert fails(services.call_service, "/clear", EMPTY).report().endswith("[EMPTY-REQUEST] failed.")


class TestParameters:
    def test_there_and_back(self, running, fails):
        assert parameters.set_param("d", 1.5) == 0
        assert parameters.get_param("d") == 1.5 and type(parameters.get_param("d")) is SingleFloat
        assert parameters.has_param("nope") is None
        assert parameters.get_param("nope", 3) == 3
        assert fails(parameters.get_param, "nope").report() == "Param /nope does not exist, and no default supplied"

    def test_false_is_a_value(self, running):
        parameters.set_param("n", None)
        assert parameters.has_param("n") is True
        assert parameters.get_param("n", 7) is None

    def test_symbols_and_lists(self, running):
        parameters.set_param("l", lisp_list(1, "a", sym(":FOO")))
        assert python_list(parameters.get_param("l")) == [1, "a", "FOO"]

    def test_deleting(self, running, fails):
        parameters.set_param("f", 1)
        assert parameters.delete_param("f") == 0
        condition = fails(parameters.delete_param, "f")
        assert not isinstance(condition, Error)
        assert condition.report().endswith("failed with code -1, message parameter [/f] is not set, values 0")

    def test_listing_a_namespace(self, running):
        for name in ("/turtle1/x", "/turtle10/y"):
            parameters.set_param(name, 1)
        assert python_list(parameters.list_params("turtle1")) == ["/turtle1/x"]
        assert python_list(parameters.list_params(lisp_list(sym("TURTLE10")))) == ["/turtle10/y"]

    def test_a_key_is_a_string(self, running, fails):
        assert "is not of type\n  STRING" in fails(parameters.get_param, sym("CL-USER::FOO")).report()


class TestTime:
    def test_it_begins_on_the_slide(self):
        assert clock.ros_time() == 1292688669.674
        kernel.sleep(1)
        assert clock.ros_time() == pytest.approx(1292688670.674)

    def test_wait_duration(self):
        assert time.wait_duration(0.3) is True
        assert kernel.now() == pytest.approx(0.3)

    def test_spin_until(self):
        assert time.spin_until(lambda: None, 0.01, timeout=0.1) == MultipleValues((None, True))
        assert kernel.now() == pytest.approx(0.1)
        assert time.spin_until(lambda: 7, 0.01) == 7

    def test_a_loop_runs_at_most_every_so_often(self):
        times = []

        def body():
            times.append(round(kernel.now(), 3))
            if len(times) == 3:
                raise StopIteration

        with pytest.raises(StopIteration):
            time.loop_at_most_every(0.5, body)
        assert times == [0.0, 0.5, 1.0]

    def test_a_parallel_task_ends_with_the_body(self):
        ran = []

        def beside():
            while True:
                ran.append(kernel.now())
                kernel.sleep(1)

        assert time.with_parallel_thread(beside, "beside", lambda: kernel.sleep(2.5) or 5) == 5
        kernel.sleep(5)
        assert len(ran) == 3

    def test_simulated_time(self):
        graph.active().parameters.set("/use_sim_time", True)
        node.start_ros_node("n")
        assert clock.ros_time() == 0.0
        publication = graph.active().node("clock").advertise("/clock", messages.message_class("rosgraph_msgs/Clock"))
        publication.publish(messages.message_class("rosgraph_msgs/Clock")(clock=12.5))
        assert clock.ros_time() == 12.5
