"""What a robot's ROS has, with the interfaces that this session's own services and parameters have: see `attachment`."""

from __future__ import annotations

import json

from cramhy_runtime.ros import services
from cramhy_runtime.ros.message_json import MessageJsonError, from_json
from cramhy_runtime.ros.messages import message_class_exact
from cramhy_runtime.ros.parameter_tree import ParameterTree
from cramhy_runtime.ros.roslisp import logging
from .no_answers import taken_apart

TOPIC = ("ROSBRIDGE",)
"""The topic of the log lines about the bridge."""


class FarService(services.Service):
    """A service of the other side, offered here."""

    def __init__(self, link, name, service_type):
        super().__init__(link.node, name, service_type, None)
        self.link = link

    def submit(self, call):
        self.pending.add(call)
        self.link.call(self.name, self.link.outward(call.request), self._answer(call), self._no_answer(call))

    def _answer(self, call):
        def answer(values):
            try:
                call.finish(from_json(self.type.response, values))
            except MessageJsonError as problem:
                call.finish(failure=f"the answer of {self.name} cannot be understood here: {problem}")

        return answer

    def _no_answer(self, call):
        def no_answer(text):
            failure, lost = taken_apart(text, self.name)
            call.finish(failure=failure, lost=lost)

        return no_answer


class FarParameters:
    """The parameters of the other side, with the interface of `ros.parameter_tree.ParameterTree`. Each question waits for its answer."""

    def __init__(self, link):
        self._ask = link.ask

    def get(self, name):
        """The value, or `KeyError`."""
        if not self.has(name):
            raise KeyError(name)
        return json.loads(self._ask("/rosapi/get_param", name=name)["value"])

    def has(self, name):
        return self._ask("/rosapi/has_param", name=name)["exists"]

    def set(self, name, value):
        self._ask("/rosapi/set_param", name=name, value=json.dumps(value))

    def delete(self, name):
        """Remove the value, or `KeyError`."""
        if not self.has(name):
            raise KeyError(name)
        self._ask("/rosapi/delete_param", name=name)

    def names(self):
        return sorted(self._ask("/rosapi/get_param_names")["names"])


class NearParameters(ParameterTree):
    """The parameters of this session, where the other side is ROS 2: the user is told once that they are nobody else's."""

    def __init__(self, before, url):
        self.root, self._url, self._told = before.root, url, False

    def set(self, name, value):
        super().set(name, value)
        if not self._told:
            self._told = True
            logging.log_text(
                logging.WARN,
                TOPIC,
                f"The parameter {name} is set in this session only: at {self._url} is ROS 2, where each "
                "parameter belongs to one node. Set it there with: ros2 param set NODE NAME VALUE",
            )


def as_ros2(cls, data):
    """DATA of a message as ROS 2 has it: times are ``sec`` and ``nanosec``, headers have no ``seq``."""
    result = {}
    for field in cls.fields:
        value = data[field.name]
        if cls.ros_type == "std_msgs/Header" and field.name == "seq":
            continue
        if field.base in ("time", "duration"):
            convert = lambda each: {"sec": each["secs"], "nanosec": each["nsecs"]}
        elif field.primitive:
            result[field.name] = value
            continue
        else:
            part = message_class_exact(field.base)
            convert = lambda each: as_ros2(part, each)
        result[field.name] = [convert(each) for each in value] if field.is_array else convert(value)
    return result


def as_ros1(kind):
    """``geometry_msgs/msg/Twist`` is ``geometry_msgs/Twist``."""
    parts = kind.split("/")
    return f"{parts[0]}/{parts[2]}" if len(parts) == 3 else kind
