"""What waits to be sent to one client: bounded, in order, and slowed down where the client asked for it.

The simulation never waits for a client. What is promised (answers, and each message of a topic that is subscribed to without
conditions) waits here up to a limit; who reads too slowly for that is closed, with the reason. What was asked for *with* conditions is
not promised to be complete: ``queue_length`` N keeps the newest N messages of a topic, ``throttle_rate`` MS sends one in so many
milliseconds, and always the newest in the end (rosbridge's own server forgets that one when there is no queue).

What cannot be encoded for the client costs that one message: the client is told by a ``status``, or by the answer of the service that it
called. No input and no output happens here; times are given. All of it lives in the server's thread.
"""

from __future__ import annotations

from collections import deque
from heapq import heappop, heappush

from .encoding import encoded, fragments_of, text_of

REASON_BYTES = 120  # what fits into the frame that closes a WebSocket


class Feed:
    """One client's messages of one topic."""

    def __init__(self, outbox, topic):
        self.outbox, self.topic = outbox, topic
        self.queue = deque()
        self.promised = True
        self.pause = 0.0
        self.compression, self.fragment_size = "none", None
        self.last = float("-inf")
        self.listed = False
        self.closed = False

    def configure(self, throttle_rate=0, queue_length=0, compression="none", fragment_size=None):
        """throttle_rate: milliseconds between two messages. queue_length: the most that wait, 0 for all (with a throttle: one)."""
        self.pause = throttle_rate / 1000
        self.promised = not (throttle_rate or queue_length)
        keep = None if self.promised else queue_length or 1
        if keep != self.queue.maxlen:
            waiting, self.queue = self.queue, deque(self.queue, maxlen=keep)
            self.outbox.weight += sum(parcel.weight for parcel in self.queue) - sum(parcel.weight for parcel in waiting)
        self.compression, self.fragment_size = compression, fragment_size

    def offer(self, parcel):
        """A new message; what has no room falls out at the other end."""
        if self.closed:
            return
        outbox = self.outbox
        if len(self.queue) == self.queue.maxlen:
            outbox.weight -= self.queue[0].weight
        self.queue.append(parcel)
        outbox.weight += parcel.weight
        if not self.listed:
            self.listed = True
            outbox.items.append(self)
        if self.promised and len(self.queue) > outbox.limits.messages:
            outbox.overflow(
                f"More than {outbox.limits.messages} messages of {self.topic} wait for you. Subscribe with throttle_rate or queue_length."
            )
        while not self.promised and outbox.weight > outbox.limits.heavy and len(self.queue) > 1:
            outbox.weight -= self.queue.popleft().weight
        if outbox.weight > outbox.limits.heavy and self.promised:
            outbox.overflow(
                f"More than {outbox.limits.heavy >> 20} MB of messages wait for you. Subscribe with throttle_rate or queue_length."
            )

    def close(self):
        """Nothing more comes."""
        self.closed = True
        self.outbox.weight -= sum(parcel.weight for parcel in self.queue)
        self.queue.clear()


class Outbox:
    """All that one client gets. ``reason``: why the client must be closed, or ``None``. ``level``: of the ``status`` that it wants."""

    def __init__(self, limits):
        self.limits = limits
        self.level = "error"
        self.items = deque()
        self.later = []
        self.bytes = self.weight = 0
        self.reason = None
        self._fragments = self._order = 0

    def feed(self, topic):
        return Feed(self, topic)

    def put(self, operation, compression="none", fragment_size=None):
        """An operation that must arrive."""
        try:
            form = encoded(operation, compression)
            frames = self._frames(form, fragment_size)
        except Exception as problem:  # whatever it is, it concerns this message and no other
            frames = [text_of(_instead_of(operation, problem))]
        for frame in frames:
            self.items.append(frame)
            self.bytes += len(frame)
        if self.bytes > self.limits.buffer:
            self.overflow(f"More than {self.limits.buffer >> 20} MB of answers wait for you.")

    def overflow(self, reason):
        """Give the client up: nothing that waits is worth keeping."""
        if self.reason is None:
            self.reason = reason
        self.items.clear()

    def next(self, now):
        """What to send at the time NOW: (frames, 0), or (no frames, seconds until there may be some, ``None`` for nobody knows)."""
        later, items = self.later, self.items
        while later and later[0][0] <= now:
            items.append(heappop(later)[2])
        while items:
            item = items.popleft()
            if item.__class__ is not Feed:
                self.bytes -= len(item)
                return [item], 0.0
            if not item.queue:
                item.listed = False
            elif item.last + item.pause > now:
                self._order += 1
                heappush(later, (item.last + item.pause, self._order, item))
            else:
                parcel = item.queue.popleft()
                self.weight -= parcel.weight
                item.last = now
                if item.queue:
                    items.append(item)
                else:
                    item.listed = False
                frames = self._frames_of(parcel, item)
                if frames:
                    return frames, 0.0
        return [], later[0][0] - now if later else None

    def _frames_of(self, parcel, feed):
        try:
            return self._frames(parcel.form(feed.compression), feed.fragment_size)
        except Exception as problem:
            if self.level == "none":
                return []
            return [
                text_of(
                    {
                        "op": "status",
                        "level": "error",
                        "msg": f"A message of {parcel.topic} could not be sent to you{_as(feed.compression)}: {_short(problem)}",
                    }
                )
            ]

    def _frames(self, form, size):
        if size is None or form.__class__ is bytes or len(form) <= size:
            return [form]
        self._fragments += 1
        return fragments_of(form, size, f"fragment:{self._fragments}")


def reason_text(reason):
    """REASON, cut to what a closing frame can hold."""
    return reason.encode()[:REASON_BYTES].decode("utf-8", "ignore")


def _short(problem):
    """What went wrong, in a text that may go out whatever it was."""
    return f"{problem or type(problem).__name__}"[:1000]


def _as(compression):
    return "" if compression == "none" else f" as {compression}"


def _instead_of(operation, problem):
    """What the client gets instead of an operation that cannot be encoded because of ``problem``."""
    kept = {"id": operation["id"]} if "id" in operation else {}
    if operation["op"] == "service_response":
        text = f"The answer of the service {operation['service']} could not be sent to you: {_short(problem)}"
        return {"op": "service_response", "service": operation["service"], "values": text, "result": False, **kept}
    return {"op": "status", "level": "error", "msg": f"An operation {operation['op']} could not be sent to you: {_short(problem)}", **kept}
