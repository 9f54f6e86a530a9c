"""The graph of a real ROS 1 for `ros1_peer.py`, through rospy; and, run as a program, a turtle that is a node of rospy's.

Debian has rospy without turtlesim, so its messages are made here from the definitions that come with cramhy, by ROS's own generators.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

DEFINITIONS = Path(__file__).parents[2] / "src" / "cramhy_runtime" / "ros" / "definitions"
GENERATORS = Path("/usr/lib/genpy")  # where Debian has them


def make_package(name, include=()):
    """Make the Python package of the ROS package NAME, and have it found."""
    place = Path(tempfile.mkdtemp(prefix="ros1-messages-"))
    for kind, generator in (("msg", GENERATORS / "genmsg_py.py"), ("srv", GENERATORS / "gensrv_py.py")):
        out, folder = place / name / kind, DEFINITIONS / name / kind
        files = sorted(map(str, folder.glob(f"*.{kind}")))
        if files:
            out.mkdir(parents=True)
            flags = [f"-I{each}:{DEFINITIONS / each / 'msg'}" for each in (name, *include)]
            environment = {**os.environ, "PYTHONPATH": ""}
            for file in files:
                subprocess.run([sys.executable, generator, "-p", name, *flags, "-o", str(out), file], check=True, env=environment)
            subprocess.run([sys.executable, generator, "--initpy", "-p", name, "-o", str(out)], check=True, env=environment)
    (place / name / "__init__.py").touch()
    sys.path.insert(0, str(place))


def plain(message):
    """A message of rospy's as plain data."""
    import genpy

    if isinstance(message, (genpy.Time, genpy.Duration)):
        return {"secs": message.secs, "nsecs": message.nsecs}
    if isinstance(message, (list, tuple)):
        return [plain(each) for each in message]
    if hasattr(message, "__slots__"):
        return {slot: plain(getattr(message, slot)) for slot in message.__slots__}
    return message


def filled(message, values):
    """MESSAGE, a fresh one, with VALUES."""
    import genpy

    genpy.message.fill_message_args(message, [values])
    return message


class RospyGraph:
    """What `ros1_peer.OwnGraph` is, with the master, the topics and the services of a real ROS."""

    def __init__(self):
        make_package("turtlesim", ["std_msgs"])
        make_package("roscpp_tutorials")
        import rosgraph
        import rospy

        self.ros, self.master = rospy, rosgraph.Master("/rosapi")
        rospy.init_node("rosbridge_websocket", disable_signals=True)
        self.publishers = {}
        self.late = 0.0
        self.rosapi = {
            "/rosapi/topics": lambda: {"topics": list(self.types()), "types": list(self.types().values())},
            "/rosapi/topic_type": lambda topic: {"type": self.types().get(topic, "")},
            "/rosapi/services": lambda: {"services": self.services() + list(self.rosapi)},
            "/rosapi/service_type": lambda service: {"type": self.service_type(service)},
            "/rosapi/get_time": lambda: {"time": plain(rospy.get_rostime())},
            "/rosapi/get_param": lambda name, default="": {"value": json.dumps(rospy.get_param(name, default))},
            "/rosapi/has_param": lambda name: {"exists": rospy.has_param(name)},
            "/rosapi/set_param": lambda name, value: rospy.set_param(name, json.loads(value)) or {},
            "/rosapi/delete_param": lambda name: rospy.delete_param(name) or {},
            "/rosapi/get_param_names": lambda: {"names": rospy.get_param_names()},
        }

    def types(self):
        return {name: kind for name, kind in self.master.getTopicTypes() if kind != "*"}

    def services(self):
        return [name for name, _ in self.master.getSystemState()[2]]

    def service_type(self, name):
        import rosservice

        if name in self.rosapi:
            return "rosapi/" + name.rpartition("/")[2].title().replace("_", "")
        return rosservice.get_service_type(name) or ""

    def pose(self):
        import roslib.message

        return plain(self.ros.wait_for_message("/turtle1/pose", roslib.message.get_message_class("turtlesim/Pose"), 10))

    def _class(self, topic, kind):
        import roslib.message

        there = self.types().get(topic)
        if there is not None and kind is not None and there != kind:
            raise TypeError(f"Tried to register topic {topic} with type {kind} but it is already established with type {there}")
        found = roslib.message.get_message_class(kind or there)
        if found is None:
            raise LookupError(f"Unable to load {kind or there}")
        return found

    def advertise(self, client, topic, kind):
        if topic not in self.publishers:
            self.publishers[topic] = self.ros.Publisher(topic, self._class(topic, kind), queue_size=100)
            time.sleep(0.3)  # what PublisherConsistencyListener is for
        elif self.publishers[topic].type != kind:
            raise TypeError(f"{topic} has {self.publishers[topic].type}")

    def publish(self, client, topic, message):
        publisher = self.publishers[topic]
        publisher.publish(filled(publisher.data_class(), message))

    def unadvertise(self, client, topic):
        pass  # the original waits for ten seconds

    def listen(self, topic, kind, listener):
        return self.ros.Subscriber(topic, self._class(topic, kind), lambda message: listener(plain(message))).unregister

    def call(self, name, arguments):
        import rosservice

        if name in self.rosapi:
            time.sleep(self.late)
            return self.rosapi[name](**arguments)
        kind = rosservice.get_service_class_by_name(name)
        return plain(self.ros.ServiceProxy(name, kind)(filled(kind._request_class(), arguments)))

    def offer(self, name, kind, handler):
        import roslib.message

        service = self.ros.Service(name, roslib.message.get_service_class(kind), lambda request: handler(plain(request)))
        return lambda: service.shutdown("Unadvertise request.")

    def response(self, kind, values):
        import roslib.message

        return filled(roslib.message.get_service_class(kind)._response_class(), values)


def run_turtle():
    """A turtle as a node, with turtlesim's names."""
    make_package("turtlesim", ["std_msgs"])
    import rospy
    from geometry_msgs.msg import Twist
    from ros1_peer import Turtle
    from std_srvs.srv import Empty, EmptyResponse
    from turtlesim.msg import Pose
    from turtlesim.srv import SetPen, SetPenResponse, TeleportAbsolute, TeleportAbsoluteResponse

    rospy.init_node("turtlesim")
    turtle, lock = Turtle(), threading.Lock()
    log = open(sys.argv[1], "w", buffering=1) if len(sys.argv) > 1 else sys.stdout

    def command(twist):
        with lock:
            turtle.command(plain(twist))
            print(json.dumps([time.time(), twist.linear.x, twist.angular.z]), file=log, flush=True)

    def teleport(request):
        with lock:
            turtle.teleport_absolute(request.x, request.y, request.theta)
        return TeleportAbsoluteResponse()

    rospy.set_param("~background_b", 255)
    rospy.Subscriber("turtle1/cmd_vel", Twist, command)
    pose = rospy.Publisher("turtle1/pose", Pose, queue_size=1)
    services = [
        rospy.Service("turtle1/teleport_absolute", TeleportAbsolute, teleport),
        rospy.Service("turtle1/set_pen", SetPen, lambda _: SetPenResponse()),
        rospy.Service("clear", Empty, lambda _: EmptyResponse()),
        rospy.Service("reset", Empty, lambda _: EmptyResponse()),
    ]
    rate = rospy.Rate(62.5)
    while not rospy.is_shutdown() and services:
        with lock:
            turtle.step(0.016)
            values = turtle.pose()
        pose.publish(Pose(**values))
        rate.sleep()


if __name__ == "__main__":
    run_turtle()
