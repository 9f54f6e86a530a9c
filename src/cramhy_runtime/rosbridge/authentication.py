"""Strangers at the door: connections that have not shown a token yet, and how they are kept from keeping others out.

Nobody can tell a stranger from a client before the token comes. So strangers wait in three rooms, apart from the clients: connections that
have said nothing (`Door`), connections that have not finished a request (`http`), and WebSockets without a token (`connection`). Each room
has a limit and a time (`Limits.silent`, `Limits.strangers`, `Limits.first_message`). When a room is full, the stranger that has waited
longest goes, never the one that comes: a client needs a few milliseconds in each room, so it is through before its turn to go has come.

A connection that says nothing costs a socket and nothing else. The first words of the others decide when they have their turn: one that
shows the token at once, then whole plain requests, such as for files of the page, then the rest. Few of the latter two are taken in at a
time, so that a flood of them does not keep the thread from those that it serves.
"""

from __future__ import annotations

import asyncio
import socket
from collections import deque

AT_ONCE = 16  # connections that are taken before those that are there have their turn
TURNS = (3, 1)  # plain requests, and others, that are taken in before those that are there have their turn
FIRST_WORDS = 4096  # bytes that are looked at
LATE = 0.05  # s; a loop that comes later than that has been kept from looking, and gives those who wait so much more
PAUSE = 0.05  # s; until connections are taken again, when the system has no room for one more


class WaitingRoom:
    """Those who wait for something, the longest first. most: how many. seconds: how long. end: a function of one who has waited too long,
    or the longest of too many, and of which of the two it is (``late``); it gives false for one who shall wait on."""

    def __init__(self, loop, most, seconds, end):
        self._loop, self._most, self._seconds, self._end = loop, most, seconds, end
        self._since = {}
        self._timer = None
        self._due = 0.0

    def __len__(self):
        return len(self._since)

    def enter(self, one):
        """ONE waits from now on; for one who waits already the time begins anew, but not its turn to make room."""
        self._since[one] = self._loop.time()
        if len(self._since) > self._most:
            self.make_room(one)
        if self._timer is None:
            self._watch()

    def leave(self, one):
        """ONE waits no more; whether it did."""
        return self._since.pop(one, None) is not None

    def make_room(self, newcomer=None):
        """End the one who has waited longest, but not NEWCOMER; whether there was one."""
        for one in list(self._since):
            if one is not newcomer and self._end_one(one, False):
                return True
        return False

    def _end_one(self, one, late):
        self._since.pop(one, None)
        if self._end(one, late):
            return True
        self._since[one] = self._loop.time()
        return False

    def _watch(self):
        if self._since:
            self._due = max(min(self._since.values()) + self._seconds, self._loop.time())
            self._timer = self._loop.call_at(self._due, self._look)
        else:
            self._timer = None

    def _look(self):
        now = self._loop.time()
        if now - self._due > LATE:  # it is we who were slow: what they have sent may not have been read
            self._since = {one: since + (now - self._due) for one, since in self._since.items()}
        else:
            for one in [one for one, since in self._since.items() if since + self._seconds <= now]:
                self._end_one(one, True)
        self._watch()

    def close(self):
        """End all."""
        if self._timer is not None:
            self._timer.cancel()
        for one in list(self._since):
            self._end(one, False)
        self._since.clear()


class Door:
    """Takes the connections that come to a listening socket, and hands those that say something to a protocol.

    loop: of the server's thread. token: which those who may come in know. protocol: makes an `asyncio.Protocol`. To be used in that thread.
    """

    def __init__(self, loop, listening, limits, token, protocol):
        self._loop, self._listening, self._limits, self._token, self._protocol = loop, listening, limits, token.encode(), protocol
        self._silent = WaitingRoom(loop, limits.silent, limits.first_message, self._end)
        self._queues = deque(), deque()
        self._admitting = False
        self._coming = set()
        self._open = False

    def open(self):
        """Take connections from now on."""
        self._open = True
        self._loop.add_reader(self._listening, self._accept)

    def close(self):
        """Take none, and close those that have not come in."""
        if self._open:
            self._open = False
            self._loop.remove_reader(self._listening)
            self._silent.close()
            for queue in self._queues:
                while queue:
                    queue.popleft().close()

    def _accept(self):
        for _ in range(AT_ONCE):
            try:
                found, _ = self._listening.accept()
            except (BlockingIOError, InterruptedError):
                return
            except ConnectionAbortedError:
                continue
            except OSError:  # no more files, or no memory
                if not self._silent.make_room():
                    self._loop.remove_reader(self._listening)
                    self._loop.call_later(PAUSE, self._go_on)
                return
            found.setblocking(False)
            if not self._look(found):
                self._silent.enter(found)
                self._loop.add_reader(found, self._speaks, found)

    def _go_on(self):
        if self._open:
            self.open()

    def _speaks(self, found):
        self._silent.leave(found)
        self._loop.remove_reader(found)
        if not self._look(found):
            found.close()

    def _look(self, found):
        """Hand the connection on if it has said something, and close it if it has gone; false when it is silent."""
        try:
            said = found.recv(FIRST_WORDS, socket.MSG_PEEK)
        except (BlockingIOError, InterruptedError):
            return False
        except OSError:
            said = b""
        if not said:
            found.close()
        elif self._token in said.partition(b"\r\n")[0]:
            self._come_in(found)
        else:
            whole_and_plain = said.startswith((b"GET ", b"HEAD ")) and said.endswith(b"\r\n\r\n") and b"\r\nupgrade:" not in said.lower()
            queue = self._queues[0 if whole_and_plain else 1]
            queue.append(found)
            if len(queue) > self._limits.silent:
                queue.popleft().close()
            if not self._admitting:
                self._admitting = True
                self._loop.call_soon(self._admit)
        return True

    def _admit(self):
        for queue, number in zip(self._queues, TURNS):
            for _ in range(min(number, len(queue))):
                self._come_in(queue.popleft())
        self._admitting = any(self._queues)
        if self._admitting:
            self._loop.call_soon(self._admit)  # when the others have had their turn

    def _come_in(self, found):
        task = self._loop.create_task(self._enter(found))
        self._coming.add(task)
        task.add_done_callback(self._coming.discard)

    async def _enter(self, found):
        try:
            await self._loop.connect_accepted_socket(self._protocol, found)
        except (OSError, asyncio.CancelledError):
            found.close()

    def _end(self, found, late):
        self._loop.remove_reader(found)
        found.close()
        return True
