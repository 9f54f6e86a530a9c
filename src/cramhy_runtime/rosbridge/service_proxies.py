"""The services of the plan, offered to the robot's ROS, where its nodes call them.

A call ends with an answer: at the end calls that wait are answered with a failure, and the services are withdrawn. The rosbridge of ROS 1
hears no failure of a client's service, and forgets neither the service nor its callers when the client is gone. Its callers wait until the
service is withdrawn. So there a service is withdrawn for a moment after a failure, and before it is offered again through a new connection.
"""

from __future__ import annotations

from cramhy_runtime.ros import services
from cramhy_runtime.ros.message_json import MessageJsonError, from_json
from cramhy_runtime.ros.roslisp.services import LispService
from .no_answers import reason

ROS1_SERVERS = ("AutobahnPython", "TornadoServer")
"""What the servers of ROS 1's rosbridge call themselves."""


class Offering:
    """The services that ``link``, an `attachment.Link`, offers: ``services`` by name; ``calls``: those that wait, by their id."""

    def __init__(self, link):
        self.link = link
        self.services, self.calls = {}, {}
        self._refused = set()  # services that have a caller who is told by their withdrawal
        self._connection = 0

    def look(self):
        """Offer what is new here, and withdraw what is gone."""
        here = {name: service for name, service in self.link.graph.services.items() if self._is_offered(service)}
        for name in [name for name, service in self.services.items() if here.get(name) is not service]:
            del self.services[name]
            self.link.say(self._withdrawal(name))
        for name, service in here.items():
            if name not in self.services:
                self.services[name] = service
                self.link.say(self._advertisement(name))

    def _is_offered(self, service):
        """Services of plans are. Where our nodes are shown, so are those that every node has."""
        return isinstance(service, LispService) or self.link.told_nodes.wanted and service.node.name in self.link.told_nodes.own()

    def announce_again(self):
        """The connection is new. The callers of before are not there any more, or are told so."""
        self._connection += 1
        self.calls.clear()
        for name in self.services:
            if self._forgets_nothing():
                self.link.uplink.send(self._withdrawal(name))
            self.link.uplink.send(self._advertisement(name))

    def withdrawals(self):
        """The operations that withdraw all services."""
        return [self._withdrawal(name) for name in self.services]

    def fail_calls(self):
        """Answer the calls that wait with a failure."""
        for call in list(self.calls.values()):
            call.finish(lost=True)

    def serve(self, request):
        """Somebody there calls a service: start it, and answer when it is done."""
        link, name, identity, connection = self.link, request.get("service"), request.get("id"), self._connection

        def answer(values, result):
            if connection != self._connection:
                return  # nobody waits for it any more
            self.calls.pop(identity, None)
            reply = {"op": "service_response", "service": name, "values": values, "result": result}
            link.uplink.send(reply | ({"id": identity} if identity is not None else {}))
            if not result and self._forgets_nothing():
                self._refused.add(name)
            self._withdraw_for_a_moment()

        def refuse(text):
            answer({} if link.ros2 else text, False)  # ROS 2 takes objects only

        def done(call):
            if call.response is None:
                refuse(reason(call))
            else:
                answer(link.outward(call.response), True)

        service = self.services.get(name)
        if service is None:
            return refuse(f"The service {name} is not offered any more.")
        try:
            message = from_json(service.type.request, dict(request.get("args") or {}))
        except MessageJsonError as problem:
            return refuse(str(problem))
        call = services.start_call(service, message, done)
        if not call.done:
            self.calls[identity] = call

    def _withdraw_for_a_moment(self):
        """Tell callers of a failure; not while the service has others who wait for their answer."""
        busy = {call.service.name for call in self.calls.values()}
        for name in self._refused - busy:
            self._refused.discard(name)
            if name in self.services and not self.link.closed:
                self.link.say(self._withdrawal(name))
                self.link.say(self._advertisement(name))

    def _forgets_nothing(self):
        return not self.link.ros2 and self.link.uplink.server.startswith(ROS1_SERVERS)

    def _advertisement(self, name):
        service = self.services[name]
        found = {"op": "advertise_service", "service": name, "type": self.link.spelled(service.type.name, "srv")}
        return {**found, "node": service.node.name} if self.link.told_nodes.wanted else found

    def _withdrawal(self, name):
        return {"op": "unadvertise_service", "service": name}
