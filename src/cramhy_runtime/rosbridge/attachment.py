"""A session joined to a real ROS, through the rosbridge server that runs there: its topics and services become the plan's.

The far graph is mirrored by a node ``/rosbridge_client`` of ours, so that nothing else in the house needs to know:

* What a node here publishes is published there; what it subscribes to is subscribed to there. A topic that is used on both sides
  here goes over the bridge too, so that every message arrives once.
* Services there are offered here, under their names; services that the plan registers are offered there.
* Parameters are those of ROS 1's server. ROS 2 has none that belong to all, so there they stay in this session, and the first that is
  set says so.

Types are spelled as the other side spells them, ``geometry_msgs/msg/Twist`` in ROS 2, and times likewise. While the connection is lost no
service is there, calls that wait fail, with the reason, and both loss and return are logged; roslibpy connects anew. All of it is in
wall time: a robot does not wait for a virtual clock. What roslibpy's thread brings is posted to the kernel. What the other side's rosbridge
complains of is logged.
"""

from __future__ import annotations

import json
from importlib.util import find_spec

from .. import kernel
from ..extras import install_command
from ..lisp import conditions
from ..lisp.condition_types import SimpleError
from ..ros import graph, services
from ..ros.message_json import MessageJsonError, from_json, service_named, to_json
from ..ros.messages import message_class_exact
from ..ros.parameter_tree import ParameterTree
from ..ros.roslisp import logging
from ..ros.roslisp.services import LispService
from .no_answers import reason, taken_apart
from .refusal import connect, leave
from .server import ServerError

NODE = "rosbridge_client"
LOCAL = {"/rosout", "/rosout_agg"}
LOOK = 0.05  # s between two looks at what the plan publishes and subscribes to
ASK = 1.0  # s between two questions what services are there
PATIENCE = 10.0  # s until the other side must have answered what we ask ourselves
LONGEST_DELAY = 2  # s between two attempts to connect anew
TOPIC = ("ROSBRIDGE",)


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
            logging.log_text(logging.WARN, TOPIC, f"The parameter {name} is set in this session only: at {self._url} is ROS 2, where each "
                                                  "parameter belongs to one node. Set it there with: ros2 param set NODE NAME VALUE")


class Link:
    """The connection; made by `join`. ``connected``; ``ros2``: whether the other side is ROS 2."""

    def __init__(self, here, url, ros, refusal):
        self.graph, self.url, self.ros, self._refusal = here, url, ros, refusal
        self._begun = False
        self.kernel = here.kernel
        self.node = here.node(NODE)
        self.connected, self.closed, self.ros2 = True, False, False
        self._incoming, self._outgoing, self._offered = {}, {}, {}
        self._waiting = {}
        self._not_known = set()  # services whose types no package here defines
        self._timers = ()
        self._delivering = False
        self._numbers = 0
        self._parameters = here.parameters
        here.before_first_node.clear()  # our turtle is not started: the robot is there
        self.kernel.count_outside(1)
        self.kernel.at_stop(self.close)
        ros.on("close", lambda *_: self.kernel.post(self._lost))
        refusal.complained = lambda text: self.kernel.post(lambda: self._hear(text))

    # ------------------------------------------------------------------------------------------------------ beginning and end

    def begin(self):
        """Look what is there, and mirror it from now on."""
        types = self.ask("/rosapi/topics")["types"]
        self.ros2 = any(kind.count("/") == 2 for kind in types)
        self.graph.parameters = NearParameters(self._parameters, self.url) if self.ros2 else FarParameters(self)
        self._services_are(self.ask("/rosapi/services")["services"])
        self._timers = [self.kernel.call_every(LOOK, self.look), self.kernel.call_every(ASK, self._ask_for_services)]
        self.graph.on_change.append(self._changed)
        self._begun = True

    def close(self):
        """End the connection. To be called with the baton; a second time it does nothing."""
        if self.closed:
            return
        self.closed = True
        for timer in self._timers:
            timer.cancel()
        if self._changed in self.graph.on_change:
            self.graph.on_change.remove(self._changed)
        self.graph.parameters = self._parameters
        self.kernel.count_outside(-1)
        self.kernel.not_at_stop(self.close)
        self._fail_all("the connection was closed")
        self.node.shutdown()
        leave(self.ros)

    def _lost(self):
        if self.connected and not self.closed:
            self.connected = False
            if self._begun:
                logging.log_text(logging.ERROR, TOPIC, f"The connection to {self.url} is lost. It is tried again and again.")
            self._fail_all(f"the connection to {self.url} was lost")
            self._services_are([])

    def _fail_all(self, text):
        waiting, self._waiting = self._waiting, {}
        for fail in waiting.values():
            fail(text)

    def _is_back(self):
        if not self.connected:
            self.connected = True
            logging.log_text(logging.WARN, TOPIC, f"The connection to {self.url} is there again.")

    def _hear(self, text):
        if not self.closed:
            logging.log_text(logging.WARN, TOPIC, f"{self.url} complains: {text}")

    # --------------------------------------------------------------------------------------------------------------- calling

    def call(self, name, values, done, failed):
        """Call a service there: DONE gets the values of the answer, FAILED a text. With the baton, and so are these called.

        Returns the number under which the answer is waited for in ``_waiting``; ``None`` when it is not."""
        import roslibpy

        if not self.ros.is_connected:
            failed(f"there is no connection to {self.url}")
            return None
        self._numbers += 1
        number = self._numbers
        self._waiting[number] = failed

        def over(function):
            def arrive(value):
                def act():
                    if self._waiting.pop(number, None) is not None:
                        function(value)

                self.kernel.post(act)

            return arrive

        roslibpy.Service(self.ros, name, "").call(
            roslibpy.ServiceRequest(values), over(lambda found: done(dict(found))), over(lambda problem: failed(str(problem))))
        return number

    def ask(self, name, /, **values):
        """The values of the answer of a service there; waits for it. An error when none comes."""
        task, outcome = kernel.current(), []

        def arrive(*found):
            outcome.append(found)
            kernel.unpark(task)

        number = self.call(name, values, lambda found: arrive(found, None), lambda text: arrive(None, text))
        until = kernel.now() + PATIENCE
        try:
            while not outcome and kernel.now() < until:
                kernel.park(f"the answer of {name} at {self.url}", until)
        finally:
            self._waiting.pop(number, None)  # an answer that comes later wakes nobody
        found, problem = outcome[0] if outcome else (None, f"no answer came within {PATIENCE:g} s")
        if problem is not None:
            if self._refusal.why and not self._begun:
                raise ServerError(self._refusal.why)
            return conditions.error(SimpleError("~a", f"{name} cannot be asked at {self.url}: {problem}"))
        return found

    # ------------------------------------------------------------------------------------------------------------- mirroring

    def outward(self, message):
        """MESSAGE as plain data, as the other side spells it."""
        data = to_json(message)
        return as_ros2(type(message), data) if self.ros2 else data

    def _spelled(self, ros_type, kind):
        package, _, name = ros_type.partition("/")
        return f"{package}/{kind}/{name}" if self.ros2 else ros_type

    def _changed(self, kind, name, there):
        if kind in ("topic", "service"):
            self.look()

    def look(self):
        """Mirror what nodes here publish, subscribe to and offer."""
        if self.closed:
            return
        for name, topic in list(self.graph.topics.items()):
            if name in LOCAL:
                continue
            own = self.node.publications.get(name), *self.node.subscriptions.get(name, ())
            spoken = [each for each in topic.publications if each not in own]
            heard = [each for each in topic.subscriptions if each not in own]
            if not spoken and not heard:
                self._stop_topic(name)
                continue
            if spoken and name not in self._outgoing:
                self._speak(name, topic.type)
            if heard and name not in self._incoming:
                self._listen(name, topic.type)
            if spoken and heard:
                for publication in spoken:
                    for subscription in [each for each in publication.connections if each in heard]:
                        publication.disconnect(subscription)  # it comes back over the bridge
        offered = {name: service for name, service in self.graph.services.items() if isinstance(service, LispService)}
        for name in list(self._offered):
            if name not in offered:
                self._offered.pop(name).unadvertise()
        for name, service in offered.items():
            if name not in self._offered:
                self._offer(name, service)

    def _far_topic(self, name, message_type):
        import roslibpy

        return roslibpy.Topic(self.ros, name, self._spelled(message_type.ros_type, "msg"))

    def _speak(self, name, message_type):
        far = self._outgoing[name] = self._far_topic(name, message_type)
        far.advertise()

        def forward(message):
            if not self._delivering and self.ros.is_connected:
                far.publish(self.outward(message))

        self.node.subscribe(name, message_type, forward)

    def _listen(self, name, message_type):
        far = self._incoming[name] = self._far_topic(name, message_type)
        publication = self.node.advertise(name, message_type)

        def arrive(data):
            try:
                message = from_json(message_type, dict(data))
            except MessageJsonError as problem:
                return logging.log_text(logging.ERROR, TOPIC, f"A message on {name} from {self.url} is dropped: {problem}")
            self._delivering = True
            try:
                publication.send(message)
            finally:
                self._delivering = False

        far.subscribe(lambda data: self.kernel.post(lambda: arrive(data)))

    def _stop_topic(self, name):
        if name in self._outgoing:
            self._outgoing.pop(name).unadvertise()
            self.node.unsubscribe(name)
        if name in self._incoming:
            self._incoming.pop(name).unsubscribe()
            self.node.unadvertise(name)

    def _offer(self, name, service):
        import roslibpy

        far = self._offered[name] = roslibpy.Service(self.ros, name, self._spelled(service.type.name, "srv"))
        # roslibpy would want the answer at once, in its thread; the plan takes its time.
        far._service_response_handler = lambda request: self.kernel.post(lambda: self._serve(service, request))
        far.advertise(lambda request, response: True)

    def _serve(self, service, request):
        import roslibpy

        def answer(values, result):
            found = {"op": "service_response", "service": service.name, "values": values, "result": result}
            if "id" in request:
                found["id"] = request["id"]
            if self.ros.is_connected:
                self.ros.send_on_ready(roslibpy.Message(found))

        def done(call):
            if call.response is None:
                answer({} if self.ros2 else reason(call), False)
            else:
                answer(self.outward(call.response), True)

        try:
            message = from_json(service.type.request, dict(request.get("args") or {}))
        except MessageJsonError as problem:
            return answer({} if self.ros2 else str(problem), False)
        services.start_call(service, message, done)

    # --------------------------------------------------------------------------------------------------- services over there

    def _ask_for_services(self):
        if not self.ros.is_connected:
            return self._lost()
        self.call("/rosapi/services", {}, lambda found: self._services_are(found["services"]), lambda text: None)

    def _services_are(self, names):
        there = set(names)
        if names:
            self._is_back()
        for name in [name for name, service in self.node.services.items() if isinstance(service, FarService) and name not in there]:
            self.node.withdraw(name)
        self._not_known &= there
        for name in names:
            if name not in self.graph.services and name not in self._not_known:
                self.call("/rosapi/service_type", {"service": name}, self._type_is(name), lambda text: None)

    def _type_is(self, name):
        def known(found):
            if name in self.graph.services or self.closed:
                return
            try:
                kind = service_named(found["type"])
            except MessageJsonError:
                self._not_known.add(name)  # of a package whose definitions are not here: nobody here could call it
                return
            self.node.add_service(FarService(self, name, kind))

        return known


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


def join(url, patience=PATIENCE):
    """Join the active session to the ROS whose rosbridge server listens at URL (``ws://robot:9090``); returns the `Link`.

    patience: seconds until the server must have answered. Raises `ServerError`. To be called by a task that may wait.
    """
    if find_spec("roslibpy") is None:
        raise ServerError(f"To join a real ROS needs roslibpy, which is not installed. Type: {install_command('ros')}")
    here = graph.active()
    if here.kernel.clock.virtual:
        raise ServerError(f"A session in virtual time cannot join {url}: the robot there lives in wall time. Start it with --time wall.")
    if here.visible_nodes():
        raise ServerError(f"Nodes run here already ({', '.join(here.visible_nodes())}), so this session cannot join {url} any more. "
                          "Do it before the first start-ros-node.")
    import roslibpy

    ros, refusal = connect(url)
    ros.factory.set_max_delay(LONGEST_DELAY)

    try:
        kernel.run_blocking(ros.run, patience)
    except roslibpy.core.RosTimeoutError:
        leave(ros)
        raise ServerError(f"No rosbridge server answers at {url}. Does it run there (roslaunch rosbridge_server rosbridge_websocket.launch,"
                          " or ros2 launch rosbridge_server rosbridge_websocket_launch.xml), and can this machine reach it?") from None
    refusal.waited_for = False
    if refusal.why:
        leave(ros)
        raise ServerError(refusal.why)
    link = Link(here, url, ros, refusal)
    try:
        link.begin()
    except BaseException:
        link.close()
        raise
    return link
