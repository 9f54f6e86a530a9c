"""The Python library roslibpy, as it is, drives the turtle, calls every service, and serves a plan in Lisp."""

from __future__ import annotations

import time

import pytest

from cramhy_runtime import kernel

roslibpy = pytest.importorskip("roslibpy")
SECONDS = 20
roslibpy.set_rosapi_timeout(SECONDS)


@pytest.fixture
def connect():
    """A function from a server to a connected `roslibpy.Ros`."""
    made = []

    def start(server):
        ros = roslibpy.Ros(server.address)
        made.append(ros)
        ros.run(SECONDS)
        return ros

    yield start
    for ros in made:
        ros.close()


@pytest.fixture
def lisp(serve):
    """A session in wall time with the turtle and a server: (its server, a function that evaluates Lisp)."""
    from cramhy_runtime import rosbridge
    from cramhy_runtime.repl.session import Session

    session = Session(time="wall")
    session.package = "CRAM-USER"
    server = rosbridge.start(session)
    session.evaluate_text('(roslisp:start-ros-node "lisp")')
    yield server, session.evaluate_text


def test_it_drives_the_turtle(lisp, connect, beside):
    from cramhy_runtime.turtlesim.node import running_simulator

    server, _ = lisp
    turtle = running_simulator().turtles["turtle1"]

    def client():
        ros = connect(server)
        poses = []
        listener = roslibpy.Topic(ros, "/turtle1/pose", "turtlesim/Pose", throttle_rate=50)
        listener.subscribe(poses.append)
        talker = roslibpy.Topic(ros, "/turtle1/cmd_vel", "geometry_msgs/Twist")
        talker.publish(roslibpy.Message({"linear": {"x": 2.0}, "angular": {"z": 1.0}}))
        while not (poses and poses[-1]["x"] > 5.8 and poses[-1]["theta"] > 0):
            kernel_time_passes()
        listener.unsubscribe()
        talker.unadvertise()
        assert "/turtle1/pose" in ros.get_topics()
        assert ros.get_topic_type("/turtle1/cmd_vel") == "geometry_msgs/Twist"

    beside(client)()
    assert turtle.x > 5.8


def kernel_time_passes():
    time.sleep(0.02)  # between two looks at what the other threads have done


def test_it_calls_the_services_of_the_turtle(lisp, connect, beside):
    from cramhy_runtime.turtlesim.node import running_simulator

    server, _ = lisp
    simulator = running_simulator()
    seen = {}

    def client():
        ros = connect(server)

        def call(name, kind, /, **arguments):
            return dict(roslibpy.Service(ros, name, kind).call(roslibpy.ServiceRequest(arguments), timeout=SECONDS))

        assert call("/spawn", "turtlesim/Spawn", x=2, y=3, theta=0.5, name="anna") == {"name": "anna"}
        call("/anna/set_pen", "turtlesim/SetPen", r=1, g=2, b=3, width=4, off=0)
        call("/anna/teleport_absolute", "turtlesim/TeleportAbsolute", x=7, y=8, theta=0)
        call("/anna/teleport_relative", "turtlesim/TeleportRelative", linear=1, angular=0)
        while simulator.turtles["anna"].pose()[0] == 7:  # she moves with the next tick, which may come after the answer
            call("/anna/set_pen", "turtlesim/SetPen", r=1, g=2, b=3, width=4, off=0)
        seen["anna"] = simulator.turtles["anna"].pose()
        call("/kill", "turtlesim/Kill", name="anna")
        seen["turtles"] = list(simulator.turtles)
        call("/clear", "std_srvs/Empty")
        call("/turtle1/teleport_absolute", "turtlesim/TeleportAbsolute", x=1, y=1, theta=0)
        call("/reset", "std_srvs/Empty")
        with pytest.raises(roslibpy.core.ServiceException) as refused:
            call("/kill", "turtlesim/Kill", name="anna")
        assert str(refused.value) == "The service /kill refused, without a reason."

    beside(client)()
    assert seen["anna"][:2] == pytest.approx((8, 8), abs=1e-4)
    assert seen["turtles"] == ["turtle1"]
    assert simulator.turtles["turtle1"].pose()[0] == pytest.approx(5.5444, abs=1e-3)


def test_a_plan_in_lisp_calls_a_service_that_it_offers(lisp, connect, beside):
    server, evaluate = lisp
    done = []

    def client():
        ros = connect(server)
        service = roslibpy.Service(ros, "/sum", "roscpp_tutorials/TwoInts")

        def answer(request, response):
            response["sum"] = request["a"] + request["b"]
            return True

        service.advertise(answer)
        while not done:
            kernel_time_passes()
        service.unadvertise()

    finish = beside(client)
    (total,) = evaluate("""(progn (roslisp:wait-for-service "/sum" 20)
                                  (roslisp:msg-slot-value (roslisp:call-service "/sum" "roscpp_tutorials/TwoInts" :a 20 :b 22) :sum))""")
    done.append(True)
    finish()
    assert total == 42


def test_parameters(lisp, connect, beside):
    server, evaluate = lisp

    def client():
        ros = connect(server)
        assert ros.get_param("/turtlesim/background_b") == 255
        ros.set_param("/limits", {"speed": 1.5, "names": ["a", "b"], "on": True})
        assert "/limits/speed" in ros.get_params()
        ros.set_param("/gone", "x")
        ros.delete_param("/gone")
        assert "/gone" not in ros.get_params()

    beside(client)()
    assert evaluate('(list (roslisp:get-param "/limits/speed") (roslisp:get-param "/limits/names"))')[0].car == 1.5


def test_every_service_there_is_can_be_called(lisp, connect, beside):
    """What a service is asked with here may be refused, but it is answered."""
    server, _ = lisp
    answers = {}

    def client():
        ros = connect(server)
        names = [*ros.get_services(), *server.rosapi.node.services]
        for name in names:
            kind = ros.get_service_type(name)
            assert kind, name
            service = roslibpy.Service(ros, name, kind)
            try:
                answers[name] = service.call(roslibpy.ServiceRequest({}), timeout=SECONDS)
            except roslibpy.core.ServiceException as refused:
                answers[name] = str(refused)

    beside(client)()
    assert len(answers) >= 36
    refused = {name: answer for name, answer in answers.items() if isinstance(answer, str)}
    no_type = "There is no type ''. A type is written \"package/Name\"; its package must be on ROS_PACKAGE_PATH."
    assert refused == {
        **{
            name: f"The service {name} refused, without a reason."
            for name in ("/kill", "/rosout/set_logger_level", "/turtlesim/set_logger_level")
        },
        "/rosapi/message_details": no_type,
        "/rosapi/service_request_details": no_type,
        "/rosapi/service_response_details": no_type,
        "/rosapi/delete_param": "A parameter needs a name; all of them at once cannot be changed.",
        "/rosapi/set_param": "A parameter needs a name; all of them at once cannot be changed.",
    }


@pytest.mark.soak
def test_it_connects_anew_when_the_connection_is_lost(lisp, connect, beside):
    server, _ = lisp

    def client():
        ros = connect(server)
        lost = []
        ros.on("close", lost.append)
        kernel.active().post(lambda: server.hand_out(lambda: [each.end(1001, "test") for each in server.connections]))
        while not (lost and ros.is_connected):
            kernel_time_passes()
        assert ros.get_topic_type("/turtle1/pose") == "turtlesim/Pose"

    beside(client)()
