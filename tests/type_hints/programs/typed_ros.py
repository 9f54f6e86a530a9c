"""What a type checker knows of ROS in the process: `cramhy_runtime.ros`, without any Lisp."""

from typing import Any, assert_type

from cramhy_runtime import chronicle, kernel, rosbridge
from cramhy_runtime.ros import graph, message_json, wire
from cramhy_runtime.ros.graph import Node
from cramhy_runtime.ros.messages import RosMessage, ServiceType, message_class, message_class_exact, service_type
from cramhy_runtime.ros.roslisp import node as roslisp_node
from cramhy_runtime.ros.roslisp import parameters, services, topics
from cramhy_runtime.ros.services import Call, Refusal, exchange, start_call
from cramhy_runtime.ros.topics import NativeSubscription, Publication

Pose = message_class("turtlesim/Pose")
Twist = message_class("geometry_msgs/Twist")


class Follower:
    """A node that drives to where another turtle is."""

    def __init__(self, leader: str) -> None:
        self.node = graph.active().node("follower", namespace="/left")
        assert_type(self.node, Node)
        self.commands = self.node.advertise("turtle2/cmd_vel", Twist, latch=True)
        assert_type(self.commands, Publication)
        assert_type(self.node.subscribe(f"{leader}/pose", Pose, self.see, queue=1), NativeSubscription)
        self.node.serve("~stop", service_type("std_srvs/Empty"), self.stop)
        self.stopped = False

    def see(self, pose: RosMessage) -> None:
        command = Twist()
        command.linear.x = float(pose.x) / 2
        assert_type(self.commands.publish(command), int)

    def stop(self, request: RosMessage) -> RosMessage:
        if self.stopped:
            raise Refusal("It stands already.")
        self.stopped = True
        return service_type("std_srvs/Empty").response()


def services_and_parameters() -> None:
    here = graph.active()
    assert_type(message_class_exact("turtlesim/Pose"), type[RosMessage] | None)
    spawn = service_type("turtlesim/Spawn")
    assert_type(spawn, ServiceType)
    offered = here.services.get("/spawn")
    if offered is not None:
        answer = exchange(offered, spawn.request(x=2.0, y=3.0, theta=0.0, name="anna"))
        assert_type(answer, Call)
        if answer.response is not None:
            print(answer.response.name)
        start_call(offered, spawn.request(), lambda call: print(call.failure or call.lost))
    here.parameters.set("/limits", {"speed": 1.5, "names": ["a", "b"]})
    if isinstance(limits := here.parameters.get("/limits"), dict):
        print(limits["speed"], here.parameters.has("/limits/speed"), here.parameters.names())
    here.on_change.append(lambda kind, name, there: print(kind, name, there))
    pose = Pose(x=1.0, y=2.0)
    assert_type(wire.transmit(pose), RosMessage)
    assert_type(message_json.to_json(pose), dict[str, Any])
    assert_type(message_json.from_json(Pose, {"x": 1.0}), RosMessage)
    assert_type([field.type for field in Pose.fields], list[str])


def as_roslisp() -> None:
    roslisp_node.start_ros_node("me", anonymous=True)
    subscriber = topics.subscribe("/turtle1/pose", "turtlesim/Pose", lambda pose: print(pose.x), max_queue_length=1)
    if subscriber is not None:
        topics.unsubscribe(subscriber)
    publication = topics.advertise("/turtle1/cmd_vel", "geometry_msgs/Twist")
    assert_type(publication, Publication | None)
    if publication is not None:
        assert_type(topics.publish(publication, Twist()), int)
    if services.wait_for_service("/clear", timeout=2.0):
        services.call_service("/clear", "std_srvs/Empty")
    assert_type(parameters.has_param("/rosdistro"), bool | None)
    print(parameters.get_param("/rosdistro", "noetic"))
    roslisp_node.shutdown_ros_node()


def others() -> None:
    server = rosbridge.start()
    assert_type(server.address, str)
    server.close()
    recording = chronicle.read("errand.mcap")
    for seconds, topic, kind, data in recording.messages():
        assert_type(seconds, float)
        print(topic, kind, data["tasks"], recording.about["seed"])
    with chronicle.record("run.mcap"):
        kernel.sleep(1)
    player = chronicle.replay("run.mcap")
    player.set_pace(paused=True, speed=1)
    assert_type(player.position, float)
