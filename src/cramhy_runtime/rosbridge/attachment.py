"""A session joined to a real ROS, through the rosbridge server that runs there: its topics and services become the plan's.

The far graph is mirrored by a node ``/rosbridge_client`` of ours, so that nothing else in the house needs to know:

* What a node here publishes is published there; what it subscribes to is subscribed to there. A topic that is used on both sides
  here goes over the bridge too, so that every message arrives once. A topic that has another type there is an error in Lisp.
* Services there are offered here, under their names; services that the plan registers are offered there, and withdrawn at the end.
* Parameters are those of ROS 1's server. ROS 2 has none that belong to all, so there they stay in this session, and the first that is
  set says so.

Types are spelled as the other side spells them, ``geometry_msgs/msg/Twist`` in ROS 2, and times likewise. A network that carries nothing
any more (`uplink`) counts as a lost connection. While it is lost no service is there, calls that wait fail, with the reason, what is
published waits (`held`), and both loss and return are logged. All of it is in wall time: a robot does not wait for a virtual clock. What
the other side's rosbridge complains of is logged.
"""

from __future__ import annotations

from datetime import datetime
from importlib.util import find_spec

from .. import kernel
from ..extras import install_command
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import Condition, SimpleError
from ..ros import graph
from ..ros.message_json import MessageJsonError, from_json, service_named, to_json, type_named
from ..ros.roslisp import logging
from ..ros.type_texts import same_on_the_wire
from . import addresses
from .remote_types import TOPIC, FarParameters, FarService, NearParameters, as_ros1, as_ros2
from .outbound_queue import Outflow
from .service_proxies import Offering
from .server import ServerError
from .uplink import Uplink
from .joined_nodes import END
from .told_nodes import ToldNodes

NODE = "rosbridge_client"
LOCAL = {"/rosout", "/rosout_agg"}
LOOK = 0.05  # s between two looks at what the plan publishes and subscribes to
ASK = 1.0  # s between two questions what services are there
PATIENCE = 10.0  # s until the other side must have answered what we ask ourselves
WITHDRAWING = 1.5  # s that the withdrawal of a service may take there: ROS 1 waits one second for its callers
LONGEST_FAREWELL = 5.0  # s
RETURNING = 3.0  # s that the end waits for a lost connection when there are messages to deliver


class Link:
    """The connection; made by `join`. ``connected``; ``ros2``: is the other side ROS 2?; ``lost_since``: a time of day, or ``None``."""

    def __init__(self, here, uplink):
        self.graph, self.uplink, self.kernel = here, uplink, here.kernel
        self.shown, self.ros = uplink.shown, uplink.ros
        self.node = here.node(NODE)
        self.connected, self.closed, self.ros2 = True, False, False
        self.lost_since = None
        self._begun, self.announced = False, True
        self._incoming, self._outgoing = {}, {}
        self._waiting = {}  # the calls there, by number
        self._not_known = set()  # services whose types no package here defines
        self._asked = set()  # services whose types have been asked for
        self._types = {}  # of topics, as the other side has them
        self.told_nodes = ToldNodes(self)
        self.outflow, self.offering = Outflow(uplink, self._log), Offering(self)
        self._timers, self._joiner = (), None
        self._delivering = False
        self._numbers = 0
        self._parameters = here.parameters
        here.before_first_node.clear()  # our turtle is not started: the robot is there
        here.on_demand.clear()
        here.type_elsewhere, here.cut_off, here.joined = self.type_there, None, self
        self.kernel.count_outside(1)
        self.kernel.at_stop(self.close)
        uplink.on_open, uplink.on_lost, uplink.on_flow, uplink.on_operation = self._opened, self._lost, self._flows, self._hear

    # ------------------------------------------------------------------------------------------------------ beginning and end

    def begin(self):
        """Look what is there, and mirror it from now on. The services that are there are known when it returns."""
        types = self.ask("/rosapi/topics")["types"]
        self.ros2 = any(kind.count("/") == 2 for kind in types)
        self.graph.parameters = NearParameters(self._parameters, self.shown) if self.ros2 else FarParameters(self)
        self._services_are(self.ask("/rosapi/services")["services"])
        self._wait_for_types()
        self._timers = [self.kernel.call_every(LOOK, self.look), self.kernel.call_every(ASK, self._ask_for_services)]
        self.graph.on_change.append(self._changed)
        self._begun = True
        if not self.announced:
            self._opened()  # it was lost meanwhile, and may be back

    def _wait_for_types(self):
        self._joiner = kernel.current()
        until = kernel.now() + PATIENCE
        while self._asked and self.uplink.open and kernel.now() < until:
            kernel.park(f"the types of {len(self._asked)} services at {self.shown}", until)
        self._joiner = None
        if self._asked:
            self._log(
                logging.WARN,
                f"{self.shown} has not told the types of these services within {PATIENCE:g} s: "
                f"{', '.join(sorted(self._asked))}. They can be called as soon as it does.",
            )

    def close(self):
        """End the connection. To be called with the baton; a second time it does nothing.

        What was published last is delivered before, calls from there that wait are answered with a failure, and our services are withdrawn.
        """
        if self.closed:
            return
        self.closed = True
        for timer in self._timers:
            timer.cancel()
        if self._changed in self.graph.on_change:
            self.graph.on_change.remove(self._changed)
        self.graph.parameters = self._parameters
        self.graph.type_elsewhere = self.graph.cut_off = self.graph.joined = None
        self.kernel.count_outside(-1)
        self.kernel.not_at_stop(self.close)
        self._fail_all("the connection was closed")
        self.offering.fail_calls()
        self._say_farewell()
        self.node.shutdown()

    def _say_farewell(self):
        """Send what is left, and wait until it has arrived."""
        in_order = self.announced and self.uplink.open  # what was sent before comes before what is sent now
        topics, messages, dropped = self.outflow.end(in_order)
        again = [] if in_order else [self._advertisement(topic) for topic in topics if topic in self._outgoing]
        ends = [
            *self.offering.withdrawals(),
            *({"op": "unsubscribe", "topic": name} for name in self._incoming),
            *({"op": "unadvertise", "topic": name} for name in self._outgoing),
        ]
        patience = min(RETURNING + WITHDRAWING * len(self.offering.services), LONGEST_FAREWELL)
        heard = self.uplink.leave([*again, *messages, *ends], patience, RETURNING if messages else 0.0)
        self.outflow.tell(dropped)
        if not heard and topics:
            self._log(
                logging.ERROR,
                f"{self.shown} has not confirmed the last messages on {', '.join(topics)} before the session left. "
                "If one of them was to stop the robot, stop it there.",
            )

    def _lost(self, why):
        if self.closed:
            return
        self.announced = False
        doubtful = self.outflow.lost()
        if self.connected:
            self.connected = False
            self.lost_since = datetime.fromtimestamp(self.graph.now()).strftime("%H:%M:%S")
            self.graph.cut_off = self._no_connection()
        if self._begun:
            self._log(
                logging.ERROR,
                f"The connection to {self.shown} is lost{why and ': '}{why}. It is tried again and again."
                + (f" {doubtful} of the messages that were under way may be lost." if doubtful else ""),
            )
        self._asked.clear()
        self._wake_joiner()
        self._fail_all(f"the connection to {self.shown} was lost{why and ': '}{why}")
        self._services_are([])

    def _log(self, level, text):
        logging.log_text(level, TOPIC, text)

    def _no_connection(self):
        return f"the connection to {self.shown} is lost since {self.lost_since}, and is tried again"

    def _fail_all(self, text):
        waiting, self._waiting = self._waiting, {}
        for _, failed in waiting.values():
            failed(text)

    def _opened(self):
        """The connection is new: what we are to the other side is told it again."""
        if self.closed or not self._begun or not self.uplink.open:
            return
        self.told_nodes.tell(again=True)
        for name in self._outgoing:
            self.uplink.send(self._advertisement(name))
            self._compare(name, self._outgoing[name])
        for name, message_type in self._incoming.items():
            self.uplink.send(self._subscription(name, message_type))
            self._compare(name, message_type)
        self.offering.announce_again()
        self.announced = True
        self._flows()
        self._ask_for_services()

    def _flows(self):
        if self.announced and not self.closed:
            self.outflow.flush()

    def _is_back(self):
        if not self.connected and not self._asked:
            self.connected, self.lost_since, self.graph.cut_off = True, None, None
            self._log(logging.WARN, f"The connection to {self.shown} is there again.")

    # --------------------------------------------------------------------------------------------------------------- hearing

    def _hear(self, operation):
        """An operation has come."""
        if self.closed:
            return
        handler = self.HANDLERS.get(operation.get("op"))
        if handler is not None:
            handler(self, operation)

    def _answered(self, operation):
        done, failed = self._waiting.pop(operation.get("id"), (None, None))
        if done is None:
            return
        values = operation.get("values")
        if operation.get("result") is False:
            failed(str(values))
        else:
            done(values if isinstance(values, dict) else {})

    def _status(self, operation):
        self._log(logging.WARN, f"{self.shown} complains: {operation.get('msg', '')}")

    # --------------------------------------------------------------------------------------------------------------- calling

    def call(self, name, values, done, failed):
        """Call a service there: DONE gets the values of the answer, FAILED a text. With the baton, and so are these called.

        Returns the number under which the answer is waited for in ``_waiting``; ``None`` when it is not."""
        if not self.uplink.open:
            failed(self._no_connection() if self.lost_since else f"there is no connection to {self.shown}")
            return None
        self._numbers += 1
        number = f"call_service:{name}:{self._numbers}"
        self._waiting[number] = done, failed
        self.uplink.send({"op": "call_service", "id": number, "service": name, "args": values})
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
                kernel.park(f"the answer of {name} at {self.shown}", until)
        finally:
            self._waiting.pop(number, None)  # an answer that comes later wakes nobody
        found, problem = outcome[0] if outcome else (None, f"no answer came within {PATIENCE:g} s")
        if problem is not None:
            if not self._begun:
                raise ServerError(
                    self.uplink.refusal.why
                    or f"{self.shown} cannot be joined, since {name} cannot be asked there: "
                    f"{problem}. Does the node rosapi run there, and does the network carry?"
                )
            return conditions.error(SimpleError("~a", f"{name} cannot be asked at {self.shown}: {problem}"))
        return found

    # ----------------------------------------------------------------------------------------------------------------- types

    def type_there(self, name, message_class):
        """The type of the topic NAME there and the address, when messages of MESSAGE_CLASS do not fit; else ``None``. Waits."""
        if name in LOCAL or not self.uplink.open:
            return None
        try:
            found = self.ask("/rosapi/topic_type", topic=name).get("type")
        except Condition:
            return None  # the connection was lost meanwhile: the topic is compared when it is back
        return self._differs(name, message_class, found)

    def _differs(self, name, message_class, found):
        kind = as_ros1(found or "")
        if kind in ("", "*", message_class.ros_type):  # "*": somebody listens to whatever comes
            self._types.pop(name, None)
            return None
        try:
            if same_on_the_wire(type_named(kind), message_class):
                self._types[name] = kind
                return None
        except MessageJsonError:
            pass
        return kind, self.shown

    def _compare(self, name, message_class):
        """Ask for the type of a topic that is used already; a difference is logged."""

        def known(found):
            other = self._differs(name, message_class, found.get("type"))
            if other is not None:
                self._log(
                    logging.ERROR,
                    f"{name} has messages of the type {other[0]} at {self.shown}, not {message_class.ros_type}, so none of them arrives.",
                )

        self.call("/rosapi/topic_type", {"topic": name}, known, lambda text: None)

    # ------------------------------------------------------------------------------------------------------------- mirroring

    def outward(self, message):
        """MESSAGE as plain data, as the other side spells it."""
        data = to_json(message)
        return as_ros2(type(message), data) if self.ros2 else data

    def spelled(self, ros_type, kind):
        package, _, name = ros_type.partition("/")
        return f"{package}/{kind}/{name}" if self.ros2 else ros_type

    def _changed(self, kind, name, there):
        if kind in ("node", "topic", "service"):
            self.look()

    def look(self):
        """Mirror what nodes here publish, subscribe to and offer."""
        if self.closed:
            return
        self.told_nodes.tell()
        for name, topic in list(self.graph.topics.items()):
            if name in LOCAL:
                continue
            own = self.node.publications.get(name), *self.node.subscriptions.get(name, ())
            spoken = [each for each in topic.publications if each not in own]
            heard = [each for each in topic.subscriptions if each not in own]
            if spoken and name not in self._outgoing:
                self._speak(name, topic.type)
            elif not spoken and name in self._outgoing:
                self._speak_no_more(name)
            if heard and name not in self._incoming:
                self._listen(name, topic.type)
            elif not heard and name in self._incoming:
                self._listen_no_more(name)
            if spoken and heard:
                for publication in spoken:
                    for subscription in [each for each in publication.connections if each in heard]:
                        publication.disconnect(subscription)  # it comes back over the bridge
        self.offering.look()

    def say(self, operation):
        """Send an operation that needs not be said again when the connection is new."""
        if self.announced:
            self.uplink.send(operation)

    def _type_of(self, name, message_type):
        return self.spelled(self._types.get(name, message_type.ros_type), "msg")

    def _latches(self, name):
        return any(publication.latch for publication in self.graph.topics[name].publications) if name in self.graph.topics else False

    def _advertisement(self, name):
        return {
            "op": "advertise",
            "id": f"advertise:{name}",
            "topic": name,
            "type": self._type_of(name, self._outgoing[name]),
            "latch": self._latches(name),
            "queue_size": 100,
        }

    def _subscription(self, name, message_type):
        return {
            "op": "subscribe",
            "id": f"subscribe:{name}",
            "topic": name,
            "type": self._type_of(name, message_type),
            "compression": "none",
            "throttle_rate": 0,
            "queue_length": 0,
        }

    def _speak(self, name, message_type):
        self._outgoing[name] = message_type
        self.say(self._advertisement(name))

        def forward(message):
            if not self._delivering:
                operation = {"op": "publish", "topic": name, "msg": self.outward(message), "latch": self._latches(name)}
                self.outflow.publish(operation, self.announced)

        self.node.subscribe(name, message_type, forward)

    def _speak_no_more(self, name):
        del self._outgoing[name]
        self.say({"op": "unadvertise", "id": f"advertise:{name}", "topic": name})
        self.node.unsubscribe(name)

    def _listen(self, name, message_type):
        self.node.advertise(name, message_type)
        self._incoming[name] = message_type
        self.say(self._subscription(name, message_type))

    def _listen_no_more(self, name):
        del self._incoming[name]
        self.say({"op": "unsubscribe", "id": f"subscribe:{name}", "topic": name})
        self.node.unadvertise(name)

    def _arrive(self, operation):
        """A message of a topic has come."""
        name = operation.get("topic")
        message_type, publication = self._incoming.get(name), self.node.publications.get(name)
        if message_type is None or publication is None:
            return
        try:
            message = from_json(message_type, operation.get("msg"))
        except MessageJsonError as problem:
            return self._log(logging.ERROR, f"A message on {name} from {self.shown} is dropped: {problem}")
        self._delivering = True
        try:
            publication.send(message)
        finally:
            self._delivering = False

    # --------------------------------------------------------------------------------------------------- services over there

    def _ask_for_services(self):
        if self.uplink.open and self.announced:
            self.call("/rosapi/services", {}, lambda found: self._services_are(found.get("services", ())), lambda text: None)

    def _services_are(self, names):
        there = set(names)
        for name in [name for name, service in self.node.services.items() if isinstance(service, FarService) and name not in there]:
            self.node.withdraw(name)
        self._not_known &= there
        for name in names:
            if name not in self.graph.services and name not in self._not_known and name not in self._asked:
                self._asked.add(name)
                self.call("/rosapi/service_type", {"service": name}, self._type_is(name), lambda text, name=name: self._told(name))
        if names:
            self._is_back()

    def _type_is(self, name):
        def known(found):
            if name not in self.graph.services and not self.closed:
                try:
                    self.node.add_service(FarService(self, name, service_named(found.get("type", ""))))
                except MessageJsonError:
                    self._not_known.add(name)  # of a package whose definitions are not here: nobody here could call it
            self._told(name)

        return known

    def _told(self, name):
        """The type of a service is known, or will not be."""
        self._asked.discard(name)
        if not self._asked:
            self._wake_joiner()
            if self.uplink.open:
                self._is_back()

    def _wake_joiner(self):
        if self._joiner is not None:
            kernel.unpark(self._joiner)

    HANDLERS = {
        "publish": _arrive,
        "service_response": _answered,
        "status": _status,
        END: lambda self, operation: self.told_nodes.end(operation),
        "call_service": lambda self, operation: self.offering.serve(operation),
    }


def join(url, patience=PATIENCE):
    """Join the active session to the ROS whose rosbridge server listens at URL (``ws://robot:9090``); returns the `Link`.

    patience: seconds until the server must have answered. Raises `ServerError`. To be called by a task that may wait.
    """
    if find_spec("roslibpy") is None:
        raise ServerError(f"To join a real ROS needs roslibpy, which is not installed. Type: {install_command('ros')}")
    here, shown = graph.active(), addresses.shown(url)
    if here.kernel.clock.virtual:
        raise ServerError(f"A session in virtual time cannot join {shown}: the robot there lives in wall time. Start it with --time wall.")
    if here.visible_nodes():
        raise ServerError(
            f"Nodes run here already ({', '.join(here.visible_nodes())}), so this session cannot join {shown} any more. "
            "Do it before the first start-ros-node."
        )
    import roslibpy

    uplink = Uplink(url, here.kernel)
    try:
        kernel.run_blocking(uplink.run, patience)
    except roslibpy.core.RosTimeoutError:
        uplink.leave()
        raise ServerError(
            f"No rosbridge server answers at {shown}. Does it run there (roslaunch rosbridge_server "
            "rosbridge_websocket.launch, or ros2 launch rosbridge_server rosbridge_websocket_launch.xml), "
            "and can this machine reach it?"
        ) from None
    uplink.refusal.waited_for = False
    if uplink.refusal.why:
        uplink.leave()
        raise ServerError(uplink.refusal.why)
    link = Link(here, uplink)
    try:
        link.begin()
    except BaseException:
        link.close()
        raise
    return link
