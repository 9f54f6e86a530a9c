"""Messages that wait because the network carries nothing, and those that have become stale meanwhile.

A velocity that was right a minute ago is wrong now, and fifty of them in a burst are worse. So a message that has waited for more than
`STALE` s is dropped and counted. The last one of each topic is kept however old it is: it may be the command to stop.
"""

from __future__ import annotations

from collections import deque

from cramhy_runtime import kernel
from cramhy_runtime.ros.roslisp import logging

STALE = 0.5  # s


class Held:
    """The messages that wait, by topic."""

    def __init__(self):
        self._topics = {}
        self._count = 0
        self.dropped = {}

    def __bool__(self):
        return bool(self._topics)

    def __contains__(self, topic):
        return topic in self._topics

    def topics(self):
        """The names of the topics that have messages here."""
        return list(self._topics)

    def add(self, topic, message, now):
        """Keep MESSAGE, which was published on TOPIC at the time NOW, in seconds."""
        self._count += 1
        self._topics.setdefault(topic, deque()).append((self._count, now, message))
        self._drop(topic, now)

    def add_first(self, topic, message):
        """Keep MESSAGE, the last one that was sent on TOPIC and may have been lost; older than all others and stale."""
        self._count += 1
        self._topics.setdefault(topic, deque()).appendleft((-self._count, float("-inf"), message))

    def _drop(self, topic, now):
        waiting = self._topics[topic]
        while len(waiting) > 1 and waiting[0][1] < now - STALE:
            _, came, _ = waiting.popleft()
            if came != float("-inf"):  # that one was sent
                self.dropped[topic] = self.dropped.get(topic, 0) + 1

    def take(self, now):
        """(messages, dropped): those to send now, the oldest first, and how many were dropped of each topic; nothing waits afterwards."""
        for topic in self._topics:
            self._drop(topic, now)
        found = sorted((entry for waiting in self._topics.values() for entry in waiting), key=lambda entry: entry[0])
        dropped, self._topics, self.dropped = self.dropped, {}, {}
        return [message for _, _, message in found], dropped


class Outflow:
    """What is published through ``uplink``: sent, or held while the network carries nothing. ``log(level, text)`` tells the user."""

    def __init__(self, uplink, log):
        self.uplink, self._log = uplink, log
        self.held = Held()
        self._under_way = {}  # by topic: (number, operation) of those that the other side has not confirmed, and always of the last one

    def publish(self, operation, announced):
        """Send a message, or keep it. announced: whether the other side knows the topic."""
        if announced and self.uplink.open and not self.uplink.quiet and not self.held:
            self._send(operation)
        else:
            self.held.add(operation["topic"], operation, kernel.now())

    def _send(self, operation):
        sent = self._under_way.setdefault(operation["topic"], deque())
        sent.append((self.uplink.send(operation), operation))
        while len(sent) > 1 and sent[0][0] <= self.uplink.acknowledged:
            sent.popleft()

    def flush(self):
        """The network carries again: send what waits, without what has become stale."""
        messages, dropped = self.held.take(kernel.now())
        for operation in messages:
            self._send(operation)
        self.tell(dropped)

    def lost(self):
        """The connection is lost. The last message of each topic may have been under way, so it is kept: it may be the command to stop.

        Returns how many others were under way."""
        count = 0
        for name, sent in self._under_way.items():
            number, operation = sent[-1]
            if number > self.uplink.acknowledged:
                self.held.add_first(name, operation)
                count += sum(each > self.uplink.acknowledged for each, _ in sent) - 1
        self._under_way.clear()
        return count

    def end(self, in_order):
        """(topics, messages, dropped): what is to be sent last, and the topics whose last message the other side has not confirmed.

        in_order: whether what was sent before comes before what is sent now.
        """
        doubtful = [name for name, sent in self._under_way.items() if sent[-1][0] > self.uplink.acknowledged]
        if not in_order:
            self.lost()
        topics = sorted({*self.held.topics(), *doubtful})
        return topics, *self.held.take(kernel.now())

    def tell(self, dropped):
        """Tell the user what was dropped."""
        if dropped:
            count, topics = sum(dropped.values()), ", ".join(f"{number} on {name}" for name, number in sorted(dropped.items()))
            those = "messages that would have come" if count > 1 else "message that would have come"
            verb = "were" if count > 1 else "was"
            self._log(
                logging.WARN,
                f"{count} {those} to {self.uplink.shown} more than {STALE:g} s late {verb} dropped ({topics}). The "
                "last one of each topic was delivered.",
            )
