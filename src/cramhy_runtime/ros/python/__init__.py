"""ROS from Python: a node, topics, services, parameters and the log, for programs that need no Lisp.

    from cramhy_runtime.ros.python import advertise, call_service, message_class, publish, ros_node, subscribe

    Twist, Vector3 = message_class("geometry_msgs/Twist"), message_class("geometry_msgs/Vector3")

    with ros_node("driver"):
        subscribe("turtle1/pose", "turtlesim/Pose", lambda pose: print(pose.x))
        publish(advertise("turtle1/cmd_vel", "geometry_msgs/Twist"), Twist(linear=Vector3(x=2.0)))
        turtle = call_service("/spawn", "turtlesim/Spawn", x=2, y=3, name="anna")

They are roslisp's functions (``ros/roslisp``) with what Python expects: keyword arguments for fields, and ``with`` blocks. A message is an
object with the fields of its ``.msg`` file as attributes. All waits are the kernel's, so a plan may use these functions in any branch.
Where the parts are: `running` the node, services and the log; `parameters` what parameters are in Python. Source: roslisp.md 2 to 9.
"""

from ..messages import RosMessage, message_class, service_type
from ..roslisp.clock import ros_time
from ..roslisp.node import node_status, shutdown_ros_node, start_ros_node
from ..roslisp.parameters import delete_param
from ..roslisp.services import wait_for_service
from ..roslisp.time import wait_duration
from ..roslisp.topics import advertise, unadvertise, unsubscribe
from .parameters import get_param, has_param, set_param
from .running import (
    call_service, log_level, publish, register_service, ros_debug, ros_error, ros_fatal, ros_info, ros_node, ros_warn, subscribe,
)  # fmt: skip

__all__ = [
    "advertise", "call_service", "delete_param", "get_param", "has_param", "log_level", "message_class", "node_status", "publish",
    "register_service", "ros_debug", "ros_error", "ros_fatal", "ros_info", "ros_node", "ros_time", "ros_warn", "RosMessage",
    "service_type", "set_param", "shutdown_ros_node", "start_ros_node", "subscribe", "unadvertise", "unsubscribe", "wait_duration",
    "wait_for_service",
]  # fmt: skip
