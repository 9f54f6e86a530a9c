"""rosapi: the services by which clients of rosbridge ask what there is on the graph.

They are those of the ROS 1 node ``/rosapi``, with its names and types. Here a hidden node of that name offers them: who starts a server
sees nothing new in ``rosservice list``. What they tell is what users are shown, without hidden nodes. An unknown name gives the
empty answer that ROS 1 gives, and no error. Values of parameters travel as JSON texts. Source: rosapi's service definitions.
"""

from __future__ import annotations

import json

from ..ros.message_json import MessageJsonError, service_named, type_named
from ..ros.messages import message_class_exact, service_type_exact
from ..ros.services import OfCaller, Refusal, Service
from ..ros.type_texts import complete_text
from ..ros.wire import ros_text
from .guard import Limits
from .parsing import Malformed, check_depth

NODE = "rosapi"
ACTION_TOPICS = {"goal", "cancel", "status", "feedback", "result"}
ROS_VERSION = (1, "noetic")
DEEPEST = 50

EXAMPLES = {
    "bool": "false",
    "string": "",
    "float32": "0.0",
    "float64": "0.0",
    "time": '{"secs": 0, "nsecs": 0}',
    "duration": '{"secs": 0, "nsecs": 0}',
}


class RosApi:
    """The services of one graph; each method takes a request and gives the values of the response's fields."""

    def __init__(self, graph, limits=None):
        self.graph = graph
        self.shelf = Shelf(graph.parameters, limits or Limits())
        self.node = graph.node(NODE, hidden=True)
        for name, kind in SERVICES.items():
            made = OfCaller if name == "set_param" else Service
            self.node.add_service(made(self.node, f"/{NODE}/{name}", service_type_exact(f"rosapi/{kind}"), self._handler(name, kind)))

    def close(self):
        self.node.shutdown()

    def _handler(self, name, kind):
        answer = getattr(self, name)
        response = service_type_exact(f"rosapi/{kind}").response

        def handle(request, *caller):
            return response(*answer(*request.values(), *caller))

        return handle

    # ------------------------------------------------------------------------------------------------------ topics and nodes

    def _topics(self):
        return self.graph.visible_topics()

    def topics(self):
        topics = self._topics()
        return list(topics), [topic.type.ros_type for topic in topics.values()]

    def topics_and_raw_types(self):
        return *self.topics(), [complete_text(topic.type) for topic in self._topics().values()]

    def topics_for_type(self, ros_type):
        return ([name for name, topic in self._topics().items() if topic.type.ros_type == ros_type],)

    def topic_type(self, name):
        topic = self.graph.topics.get(global_name(name))
        return ("" if topic is None else topic.type.ros_type,)

    def publishers(self, name):
        return (self._ends(name, "visible_publications"),)

    def subscribers(self, name):
        return (self._ends(name, "visible_subscriptions"),)

    def _ends(self, name, ends):
        topic = self.graph.topics.get(global_name(name))
        return [] if topic is None else sorted({end.node.name for end in getattr(topic, ends)})

    def nodes(self):
        return (list(self.graph.visible_nodes()),)

    def node_details(self, name):
        node = self.graph.nodes.get(global_name(name))
        return ([], [], []) if node is None else (sorted(node.subscriptions), sorted(node.publications), sorted(node.services))

    def action_servers(self):
        found = {}
        for name in self._topics():
            server, _, part = name.rpartition("/")
            found.setdefault(server, set()).add(part)
        return ([server for server, parts in found.items() if parts >= ACTION_TOPICS],)

    # -------------------------------------------------------------------------------------------------------------- services

    def services(self):
        return (list(self.graph.visible_services()),)

    def _service(self, name):
        return self.graph.service(global_name(name))

    def services_for_type(self, ros_type):
        return ([name for name, service in self.graph.visible_services().items() if service.type.name == ros_type],)

    def service_providers(self, ros_type):
        return (sorted({service.node.name for service in self.graph.visible_services().values() if service.type.name == ros_type}),)

    def service_type(self, name):
        service = self._service(name)
        return ("" if service is None else service.type.name,)

    def service_node(self, name):
        service = self._service(name)
        return ("" if service is None else service.node.name,)

    def service_host(self, name):
        service = self._service(name)
        return ("" if service is None else service.node.address.partition(":")[0],)

    # ----------------------------------------------------------------------------------------------------------------- types

    def message_details(self, ros_type):
        return (type_definitions(_named(type_named, ros_type)),)

    def service_request_details(self, ros_type):
        return (type_definitions(_named(service_named, ros_type).request),)

    def service_response_details(self, ros_type):
        return (type_definitions(_named(service_named, ros_type).response),)

    # ------------------------------------------------------------------------------------------------------------ parameters

    def get_param(self, name, default):
        try:
            value = self.graph.parameters.get(global_name(name))
        except KeyError:
            value = _value(default)
        try:
            return (ros_text(json.dumps(value, ensure_ascii=False, allow_nan=False)),)
        except (TypeError, ValueError, RecursionError) as problem:
            raise Refusal(f"The parameter {global_name(name)} cannot be sent as JSON: {problem}") from None

    def set_param(self, name, value, caller=None):
        full, found = _parameter(name), _value(value)
        if caller is not None:
            self.shelf.put(full, found, len(value))
        self.graph.parameters.set(full, found)
        return ()

    def has_param(self, name):
        return (self.graph.parameters.has(global_name(name)),)

    def delete_param(self, name):
        try:
            self.graph.parameters.delete(_parameter(name))
        except KeyError:
            raise Refusal(f"The parameter {global_name(name)} is not set.") from None
        return ()

    def search_param(self, name):
        return (global_name(name) if self.graph.parameters.has(global_name(name)) else "",)

    def get_param_names(self):
        return (self.graph.parameters.names(),)

    # -------------------------------------------------------------------------------------------------------------- the rest

    def get_time(self):
        return (self.graph.now(),)

    def get_ros_version(self):
        return ROS_VERSION


class Shelf:
    """How much clients have added to the parameters. A program of this process is not limited, and what it sets does not count."""

    def __init__(self, tree, limits):
        self.tree, self.limits = tree, limits
        self._sizes = {}  # name -> values below it, bytes of them as JSON

    def put(self, name, value, size):
        """Count what a client is about to set; raises `Refusal` when that is too much."""
        limits = self.limits
        if len(name) > limits.name:
            raise Refusal(f"The name of the parameter has {len(name)} characters; {limits.name} are allowed.")
        if size > limits.parameter:
            raise Refusal(f"The value of {name} has {size} bytes; {limits.parameter} are allowed.")
        kept = {
            other: sizes
            for other, sizes in self._sizes.items()
            if other != name and not other.startswith(name + "/") and self.tree.has(other)
        }
        number = sum(values for values, _ in kept.values()) + _leaves(value)
        total = sum(taken for _, taken in kept.values()) + size
        if number > limits.parameters:
            raise Refusal(f"Clients have set {number - _leaves(value)} parameters; {limits.parameters} are allowed. Delete some.")
        if total > limits.parameter_bytes:
            raise Refusal(
                f"The parameters that clients have set take {total - size} bytes; {limits.parameter_bytes} are allowed. Delete some."
            )
        self._sizes = {**kept, name: (_leaves(value), size)}


def _leaves(value):
    return sum(map(_leaves, value.values())) or 1 if isinstance(value, dict) else 1


SERVICES = {
    "topics": "Topics", "topics_and_raw_types": "TopicsAndRawTypes", "topics_for_type": "TopicsForType", "topic_type": "TopicType",
    "publishers": "Publishers", "subscribers": "Subscribers", "nodes": "Nodes", "node_details": "NodeDetails",
    "action_servers": "GetActionServers", "services": "Services", "services_for_type": "ServicesForType",
    "service_providers": "ServiceProviders", "service_type": "ServiceType", "service_node": "ServiceNode", "service_host": "ServiceHost",
    "message_details": "MessageDetails", "service_request_details": "ServiceRequestDetails",
    "service_response_details": "ServiceResponseDetails", "get_param": "GetParam", "set_param": "SetParam", "has_param": "HasParam",
    "delete_param": "DeleteParam", "search_param": "SearchParam", "get_param_names": "GetParamNames", "get_time": "GetTime",
    "get_ros_version": "GetROSVersion",
}  # fmt: skip


def global_name(name):
    """NAME with a slash before it."""
    return name if name.startswith("/") else "/" + name


def _parameter(name):
    """The global name of a parameter that is to be changed; the root of all may not be."""
    if not name.strip("/"):
        raise Refusal("A parameter needs a name; all of them at once cannot be changed.")
    return global_name(name)


def _named(find, ros_type):
    try:
        return find(ros_type)
    except MessageJsonError as problem:
        raise Refusal(str(problem)) from None


def _value(text):
    """The value of a parameter: what TEXT is in JSON, or TEXT itself when it is no JSON."""
    try:
        check_depth(text, DEEPEST)
        value = json.loads(text)
    except Malformed:
        raise Refusal(f"The value of a parameter has lists and dictionaries more than {DEEPEST} deep in each other.") from None
    except ValueError:
        return text
    if _has_null(value):
        raise Refusal("A parameter has no value null. To remove one, call /rosapi/delete_param.")
    return value


def _has_null(value):
    if isinstance(value, (list, dict)):
        return any(map(_has_null, value.values() if isinstance(value, dict) else value))
    return value is None


def type_definitions(cls):
    """``rosapi/TypeDef`` of a message class and of all that it is made of, each once."""
    definition = message_class_exact("rosapi/TypeDef")
    found, waiting = {}, [cls]
    while waiting:
        kind = waiting.pop(0)
        if kind.ros_type in found:
            continue
        fields = kind.fields
        found[kind.ros_type] = definition(
            kind.ros_type,
            [field.name for field in fields],
            [field.base for field in fields],
            [-1 if field.length is None else field.length for field in fields],
            ["[]" if field.is_array else EXAMPLES.get(field.base, "0") if field.primitive else "{}" for field in fields],
            list(kind.constants),
            [str(value) for value in kind.constants.values()],
        )
        waiting += [part for part in map(message_class_exact, (field.base for field in fields if not field.primitive)) if part is not None]
    return list(found.values())
