"""rosbridge v2, for one client: operations go in, operations come out. No input and no output happens here.

`Session.receive` takes a parsed operation, does it on the graph, and never raises: what cannot be done is told the client by a
``status``, or by a ``service_response`` with ``"result": false`` where the client waits for one. It is called with the baton, in the
scheduler, so it never waits: a call's answer is sent when it comes. The meaning of the operations is that of rosbridge_suite for ROS 1,
whose texts are not ours. What differs:

* One client may not take a service from another node by advertising it; that is refused.
* A throttled topic always brings its newest message in the end.
* ``cbor-raw`` is there; ``png`` is sent, but not understood. There are no actions: those are of ROS 2.

In virtual time the clock stands still at the prompt. While an answer is outstanding it moves, so that the simulator comes to its next
tick; a call that has had `MOST_PLAN_TIME` seconds of the plan moves it no longer. While a client owes an answer to the plan it stands,
since nobody can say how much plan time that takes. Source: the rosbridge protocol, version 2.0, sections 3 and 4.
"""

from __future__ import annotations

from .. import kernel
from ..extras import install_command
from ..ros import services
from ..ros.message_json import MessageJsonError, from_json, request_from_json, service_named, to_json
from .encoding import COMPRESSIONS, text_of, weight
from .hub import Refused
from .joined_nodes import JoinedNodes
from .no_answers import NOBODY, SESSION_ENDS, reason
from .operation_fields import boolean, integer, shown
from .parsing import json_type

LEVELS = {"info": 0, "warning": 1, "error": 2, "none": 3}
MOST_PLAN_TIME = 600.0
SMALLEST_FRAGMENT = 100
"""Characters of a message that a fragment holds at least: a client that asks for less would get mostly wrapping."""


class Wish:
    """A wish that plan time passes though the prompt waits, until it is fulfilled or has had its time."""

    def __init__(self):
        self._wanted = kernel.time_wanted()
        self._wanted.__enter__()
        self._timer = kernel.call_at(kernel.now() + MOST_PLAN_TIME, self.over)

    def over(self):
        """No more."""
        if self._wanted is not None:
            self._wanted.__exit__(None, None, None)
            self._timer.cancel()
            self._wanted = None


class Interest:
    """A client's subscription to one topic, by one or several ids."""

    def __init__(self, feed):
        self.feed = feed
        self.channel = None
        self.wishes = {}

    def settle(self, limits):
        """The settings that satisfy everybody: the least throttle, the longest queue, the smallest fragment."""
        rates, queues, sizes, forms = zip(*self.wishes.values())
        sizes = [size for size in sizes if size is not None]
        compression = max(forms, key=COMPRESSIONS.index)
        queue = 0 if 0 in queues else max(queues)
        return dict(
            throttle_rate=min(rates),
            queue_length=min(queue, limits.messages),
            compression=compression,
            fragment_size=min(sizes) if sizes else None,
        )


def _fragment_size(operation):
    """The characters of a message that a fragment for the client shall hold, or ``None`` for no fragments; `SMALLEST_FRAGMENT` at least."""
    size = integer(operation, "fragment_size", least=1)
    return size and max(size, SMALLEST_FRAGMENT)


def _compression(operation):
    """The form in which the client wants messages or an answer, one of `COMPRESSIONS`."""
    compression = operation.get("compression", "none")
    if not isinstance(compression, str) or compression not in COMPRESSIONS:
        raise Refused(f"There is no compression {shown(compression)}. There are {', '.join(COMPRESSIONS)}.")
    if compression.startswith("cbor"):
        need_cbor()
    return compression


class ClientService(services.Service):
    """A service that a client offers. A request goes out as an operation; the answer comes in as another one, or never."""

    def __init__(self, session, node, name, service_type):
        super().__init__(node, name, service_type, None)
        self.session = session

    def submit(self, call):
        self.pending.add(call)
        self.session.ask(self, call)


class Session:
    """One client.

    outbox: has ``put(operation, compression, fragment_size)`` and ``feed(topic)``, for the server's thread. after: a function of
    seconds of the wall and a function that it calls then with the baton. hidden: whether it is an observer (see `hub`).
    """

    def __init__(self, hub, outbox, after=lambda seconds, function: None, hidden=False):
        self.hub, self.outbox, self._after = hub, outbox, after
        self.limits = hub.limits
        self.side = hub.sides[hidden]
        self.level = "error"
        self.interests = {}
        self.advertised = {}
        self.latched = {}  # topic -> bytes of its last message
        self.offered = {}
        self.asked = {}
        self.calls = {}
        self.joined = None
        self.at_end = set()
        self.closed = False
        self._numbers = 0
        hub.sessions.add(self)

    # ------------------------------------------------------------------------------------------------------------- coming in

    def receive(self, operation):
        """Do OPERATION, a dictionary with a string "op"."""
        if self.closed:
            return
        op = operation["op"]
        try:
            self._check_id(operation)
            do = OPERATIONS.get(op)
            if do is None:
                raise Refused(f"There is no operation {shown(op)}. There are {', '.join(OPERATIONS)} and fragment.")
            do(self, operation)
        except Refused as refused:
            self._tell(operation, refused.level, str(refused))
        except MessageJsonError as problem:
            self._tell(operation, "error", str(problem))
        except Exception as problem:  # a defect of ours must neither end the session nor stay unknown
            kernel.unhandled(kernel.current(), problem)
            self._tell(operation, "error", f"The operation {shown(op)} failed: {type(problem).__name__}. This is a defect of the server.")

    def _tell(self, operation, level, text):
        """Tell the client why OPERATION was not done: who calls a service waits for its answer, which this is then."""
        if operation["op"] == "call_service":
            name = operation.get("service")
            self._respond(operation, name if isinstance(name, str) else "", text[:2000], False)
        else:
            self.status(level, text, operation.get("id"))

    def status(self, level, text, identity=None):
        """Tell the client, if it wants to know."""
        if LEVELS[level] < LEVELS[self.level]:
            return
        found = {"op": "status", "level": level, "msg": text}
        if _is_id(identity, self.limits):
            found["id"] = identity
        self.send(found)

    def send(self, operation, compression="none", fragment_size=None):
        """OPERATION goes to the client."""
        self.hub.hand_out(lambda: self.outbox.put(operation, compression, fragment_size))

    def close(self):
        """The client has gone: what it had on the graph goes, too, and whoever waits for its answers hears of it."""
        if self.closed:
            return
        self.closed = True
        for service in list(self.offered.values()):
            self._withdraw(service)
        for topic in list(self.interests):
            self._unsubscribe(topic)
        for topic in list(self.advertised):
            self._unadvertise(topic)
        for wish, _ in self.calls.values():
            wish.over()
        self.calls.clear()
        if self.joined is not None:
            self.joined.close()
        self.hub.sessions.discard(self)
        for end in list(self.at_end):
            end()

    # ------------------------------------------------------------------------------------------------------------ publishing

    def advertise(self, operation):
        topic = self.hub.name(operation.get("topic"), "topic")
        if operation.get("type") is None:
            raise Refused(f'To advertise {topic} takes its type, such as "type": "geometry_msgs/Twist".')
        latch = boolean(operation, "latch")
        integer(operation, "queue_size")
        self._advertise(topic, self.hub.message_type(topic, operation["type"]), operation.get("id"), latch)

    def _advertise(self, topic, message_type, identity, latch):
        ids = self.advertised.get(topic)
        if ids is None:
            if len(self.advertised) >= self.limits.advertisements:
                raise Refused(f"You advertise {len(self.advertised)} topics; more are not allowed. Unadvertise some.")
            ids = self.advertised[topic] = (self.side.advertise(topic, message_type, self, latch), set())
        if len(ids[1]) < self.limits.advertisements:
            ids[1].add(identity)
        return ids[0]

    def unadvertise(self, operation):
        topic = self.hub.name(operation.get("topic"), "topic")
        if topic not in self.advertised:
            raise Refused(f"You do not advertise {topic}.", "warning")
        identity = operation.get("id")
        ids = self.advertised[topic][1]
        if identity is not None and identity not in ids:
            raise Refused(f"You do not advertise {topic} with the id {shown(identity)}.", "warning")
        ids.discard(identity)
        if identity is None or not ids:
            self._unadvertise(topic)

    def _unadvertise(self, topic):
        del self.advertised[topic]
        self.latched.pop(topic, None)
        self.side.unadvertise(topic, self)

    def publish(self, operation):
        topic = self.hub.name(operation.get("topic"), "topic")
        held = self.advertised.get(topic)
        if held is not None:
            publication = held[0]
        else:
            message_type = self.hub.message_type(topic, operation.get("type"))
            publication = self._advertise(topic, message_type, operation.get("id"), boolean(operation, "latch"))
        message = from_json(publication.type, operation.get("msg", {}), self.hub.graph.now())
        if publication.latch:
            self._keep(topic, weight(message))
        publication.send(message)

    def _keep(self, topic, size):
        """Count a latched message, which stays until the topic is unadvertised."""
        others = sum(kept for name, kept in self.latched.items() if name != topic)
        if others + size > self.limits.latched:
            raise Refused(
                f"The latched messages that you publish take {others} bytes, and this one {size}; {self.limits.latched} are "
                "allowed. Unadvertise some."
            )
        self.latched[topic] = size

    # ----------------------------------------------------------------------------------------------------------- subscribing

    def subscribe(self, operation):
        topic = self.hub.name(operation.get("topic"), "topic")
        wish = (
            integer(operation, "throttle_rate") or 0,
            integer(operation, "queue_length") or 0,
            _fragment_size(operation),
            _compression(operation),
        )
        message_type = self.hub.message_type(topic, operation.get("type"))
        interest = self.interests.get(topic)
        if interest is None:
            if len(self.interests) >= self.limits.subscriptions:
                raise Refused(f"You subscribe to {len(self.interests)} topics; more are not allowed. Unsubscribe from some.")
            interest = Interest(self.outbox.feed(topic))
        elif len(interest.wishes) >= self.limits.subscriptions and operation.get("id") not in interest.wishes:
            raise Refused(f"You subscribe to {topic} with {len(interest.wishes)} ids; more are not allowed.")
        interest.wishes[operation.get("id")] = wish
        keep = self._configure(interest)
        if interest.channel is None:
            self.interests[topic] = interest
            interest.channel = self.side.listen(topic, message_type, interest.feed, keep)
        else:
            interest.channel.keep(interest.feed, keep)

    def _configure(self, interest):
        settings = interest.settle(self.limits)
        self.hub.hand_out(lambda: interest.feed.configure(**settings))
        if settings["throttle_rate"] or settings["queue_length"]:
            return settings["queue_length"] or 1
        return self.limits.messages

    def unsubscribe(self, operation):
        topic = self.hub.name(operation.get("topic"), "topic")
        interest = self.interests.get(topic)
        if interest is None:
            raise Refused(f"You do not subscribe to {topic}.", "warning")
        identity = operation.get("id")
        if identity is not None and identity not in interest.wishes:
            raise Refused(f"You do not subscribe to {topic} with the id {shown(identity)}.", "warning")
        interest.wishes.pop(identity, None)
        if identity is None or not interest.wishes:
            self._unsubscribe(topic)
        else:
            interest.channel.keep(interest.feed, self._configure(interest))

    def _unsubscribe(self, topic):
        interest = self.interests.pop(topic)
        interest.channel.remove(interest.feed)

    # --------------------------------------------------------------------------------------------------------------- calling

    def call_service(self, operation):
        """A client calls. It waits for a ``service_response``, so whatever is wrong is told by one (`_tell`)."""
        _compression(operation), _fragment_size(operation)  # before anything is done whose answer could not be sent
        name = self.hub.name(operation.get("service"), "service")
        service = self.hub.graph.service(name)
        if service is None:
            raise Refused(NOBODY.format(name))
        if len(self.calls) >= self.limits.calls:
            raise Refused(f"{len(self.calls)} of your calls are not answered yet; more are not allowed.")
        request = request_from_json(service.type.request, operation.get("args"), self.hub.graph.now())
        self._numbers += 1
        number = self._numbers
        wish = Wish()
        self.calls[number] = wish, operation

        def done(call):
            wish.over()
            if self.calls.pop(number, None) is not None and not self.closed:
                self._answer(operation, operation["service"], call)

        services.start_call(service, request, done, caller=self)

    def _answer(self, operation, name, call):
        if call.response is None:
            self._respond(operation, name, reason(call), False)
            return
        try:
            values = to_json(call.response)
        except MessageJsonError as problem:
            self._respond(operation, name, str(problem), False)
        else:
            self._respond(operation, name, values, True)

    def answer_all(self):
        """The session ends: every call that the client waits for is answered."""
        waiting, self.calls = self.calls, {}
        for wish, operation in waiting.values():
            wish.over()
            self._respond(operation, operation["service"], SESSION_ENDS.format(operation["service"]), False)

    def _respond(self, operation, name, values, result):
        answer = {"op": "service_response", "service": name, "values": values, "result": result}
        if operation.get("id") is not None and _can_be_repeated(operation["id"], self.limits):
            answer["id"] = operation["id"]
        compression, size = "none", None
        if result:  # otherwise the operation itself may be what is wrong
            compression, size = _compression(operation), _fragment_size(operation)
        self.send(answer, "cbor" if compression == "cbor-raw" else compression, size)

    # -------------------------------------------------------------------------------------------------------------- offering

    def advertise_service(self, operation):
        name = self.hub.name(operation.get("service"), "service")
        kind = service_named(operation.get("type"))
        there = self.hub.graph.services.get(name)
        if there is not None and name not in self.offered:
            raise Refused(f"The service {name} is offered already, by {there.node.name}.")
        if name not in self.offered and len(self.offered) >= self.limits.services:
            raise Refused(f"You offer {len(self.offered)} services; more are not allowed. Unadvertise some.")
        if name in self.offered:
            self._withdraw(self.offered[name])
        own = operation.get("node")
        node = self.joined.get(own) if self.joined is not None and isinstance(own, str) else None
        service = ClientService(self, node or self.side.node, name, kind)
        self.offered[name] = service
        service.node.add_service(service)

    def unadvertise_service(self, operation):
        name = self.hub.name(operation.get("service"), "service")
        if name not in self.offered:
            raise Refused(f"You do not offer the service {name}.", "warning")
        self._withdraw(self.offered[name])

    def _withdraw(self, service):
        del self.offered[service.name]
        for key, (call, _) in list(self.asked.items()):
            if call.service is service:
                self._settled(key)
        service.node.withdraw(service.name)
        self.side.tidy()

    def ask(self, service, call):
        """Send the request of CALL to the client, which offers SERVICE."""
        if len(self.asked) >= self.limits.calls:
            return call.finish(failure=f"the client that offers {service.name} has {len(self.asked)} requests to answer already")
        try:
            arguments = to_json(call.request)
        except MessageJsonError as problem:
            return call.finish(failure=str(problem))
        self._numbers += 1
        key = f"service_request:{service.name}:{self._numbers}"
        hold = kernel.time_held()
        hold.__enter__()
        self.asked[key] = call, hold
        self.send({"op": "call_service", "id": key, "service": service.name, "args": arguments})
        self._after(self.limits.answer, lambda: self._too_late(key, service))

    def _too_late(self, key, service):
        if key in self.asked:
            call = self._settled(key)
            call.finish(failure=f"the client that offers {service.name} did not answer within {self.limits.answer:g} s")

    def _settled(self, key):
        call, hold = self.asked.pop(key)
        hold.__exit__(None, None, None)
        return call

    def service_response(self, operation):
        key = operation.get("id")
        if not isinstance(key, str) or key not in self.asked:
            raise Refused("Nobody waits for this answer: its id is none that you were called with, or it came too late.")
        result = operation.get("result", True)
        if result.__class__ is not bool:
            raise Refused(f'"result" must be true or false, but it is {json_type(result)}.')
        call = self._settled(key)
        values = operation.get("values", {})
        if not result:
            text = values if isinstance(values, str) else "" if values in ({}, None, []) else str(values)
            return call.finish(failure=text[:2000])
        try:
            response = request_from_json(call.service.type.response, values, self.hub.graph.now())
        except MessageJsonError as problem:
            call.finish(failure=f"the answer of the client that offers {call.service.name} is wrong: {problem}")
            raise
        call.finish(response)

    # -------------------------------------------------------------------------------------------------------------- the rest

    def nodes(self, operation):
        """The client is a process that has joined: these nodes are its."""
        if self.joined is None:
            if self.advertised or self.interests or self.offered:
                raise Refused("Tell your nodes before you advertise, subscribe to and offer anything.")
            self.joined, self.side = JoinedNodes(self), self.hub.sides[True]
        self.joined.declare(operation.get("nodes"))

    def set_level(self, operation):
        level = operation.get("level")
        if not isinstance(level, str) or level not in LEVELS:
            raise Refused(f"There is no level {shown(level)}. There are {', '.join(LEVELS)}.")
        self.level = level
        self.hub.hand_out(lambda: setattr(self.outbox, "level", level))

    def heard(self, operation):
        """A status from the client: nothing follows from it. A second ``auth`` likewise."""

    def png(self, operation):
        raise Refused("Operations in pictures (png) are not understood here; send JSON.")

    def _check_id(self, operation):
        if "id" in operation and operation["id"] is not None and not _is_id(operation["id"], self.limits):
            raise Refused(f'An "id" is a string of at most {self.limits.name} characters, or a number.')


OPERATIONS = {
    "advertise": Session.advertise, "unadvertise": Session.unadvertise, "publish": Session.publish, "subscribe": Session.subscribe,
    "unsubscribe": Session.unsubscribe, "call_service": Session.call_service, "service_response": Session.service_response,
    "advertise_service": Session.advertise_service, "unadvertise_service": Session.unadvertise_service, "set_level": Session.set_level,
    "status": Session.heard, "auth": Session.heard, "png": Session.png, "nodes": Session.nodes,
}  # fmt: skip


def _is_id(value, limits):
    if value.__class__ is str:
        return len(value) <= limits.name
    return value.__class__ in (int, float) and abs(value) < 2**63


def _can_be_repeated(identity, limits):
    """Whether an answer may have this id, though it may be none that is allowed: who waits for the answer knows it by that."""
    if _is_id(identity, limits):
        return True
    try:
        return len(text_of(identity)) <= limits.name
    except ValueError:  # an infinity
        return False


def need_cbor():
    """Refuse when there is no package for CBOR."""
    from importlib.util import find_spec

    if find_spec("cbor2") is None:
        raise Refused(
            "The server cannot write CBOR, because the Python package cbor2 is not installed there. Type there: " + install_command("web")
        )
