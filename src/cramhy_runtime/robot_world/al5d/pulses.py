"""Messages that are made at a fixed rate, as long as somebody listens.

A node with many topics would keep the clock busy with messages that nobody hears, and each of them is an instant of virtual time. A pulse
has a timer only while its publication has a subscriber.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ... import kernel

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...kernel.timers import Timer
    from ...ros.messages import RosMessage
    from ...ros.topics import Publication


class Pulse:
    """Publishes ``make()`` each ``period`` seconds while ``publication`` has subscribers, the first one a period after the first came."""

    def __init__(self, publication: Publication, period: float, make: Callable[[], RosMessage]) -> None:
        self.publication, self.period, self.make = publication, period, make
        self._timer: Timer | None = None
        publication.on_listeners = self._look
        publication.node.on_shutdown.append(self.end)
        self._look()

    def _look(self) -> None:
        if not self.publication.connections:
            self.end()
        elif self._timer is None:
            self._timer = kernel.call_every(self.period, self._beat)

    def _beat(self) -> None:
        self.publication.send(self.make())

    def end(self) -> None:
        """Make no more."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
