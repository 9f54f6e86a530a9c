"""Messages that wait because the network carries nothing, and those that have become stale meanwhile.

A velocity that was right a minute ago is wrong now, and fifty of them in a burst are worse. So a message that has waited for more than
`STALE` s is dropped and counted. The last one of each topic is kept however old it is: it may be the command to stop.
"""

from __future__ import annotations

from collections import deque

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
