"""A client of the Swank server that needs no socket: it speaks to a `Connection` directly, in the scheduler, as the socket's thread does."""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.session import requests
from cramhy_runtime.swank import streams, wire
from cramhy_runtime.swank.connection import Connection
from cramhy_runtime.swank.wire import Name


class FakeServer:
    """What a `Connection` asks of its server."""

    def __init__(self, session):
        self.kernel, self.session, self.logged, self.connections, self.closed, self.quits = kernel.active(), session, [], [], False, 0

    def log(self, text):
        self.logged.append(text)

    def left(self, connection):
        if connection in self.connections:
            self.connections.remove(connection)

    def quit(self):
        self.quits += 1


class Emacs:
    """One Emacs that is connected to ``session``. ``events`` are the messages that it got, but for the answers."""

    def __init__(self, session, server=None):
        self.server = server or FakeServer(session)
        self.events, self.answers, self.number, self.ended = [], {}, 0, False
        requests.ask_whoever_asked()
        streams.route(self.server, alone=True)
        self.connection = Connection(self.server, self)
        self.server.connections.append(self.connection)

    # what a `Line` does

    def send(self, data):
        text = wire.text_of(data[wire.LENGTH :])
        assert wire.length_of(data[: wire.LENGTH]) == len(data) - wire.LENGTH
        message = wire.read(text)
        if message[0] == ":return":
            self.answers[message[2]] = message[1]
        else:
            self.events.append(message)

    def end(self):
        self.ended = True

    # what Emacs does

    def post(self, text):
        """Send the text of a message."""
        kernel.post(lambda: self.connection.receive(text.encode()))

    def rex(self, form, package="nil", thread="t"):
        """Send a call; its number."""
        self.number += 1
        package = package if package == "nil" else wire.write(package)
        self.post(f"(:emacs-rex {form} {package} {thread} {self.number})")
        return self.number

    def wait(self, number, seconds=200.0):
        """The answer to the call of that number, ``[":ok", value]``. Time of the kernel passes."""
        until = kernel.now() + seconds
        while number not in self.answers:
            assert kernel.now() < until, f"no answer; events: {self.events[-3:]}"
            kernel.sleep(0.05)
        return self.answers.pop(number)

    def call(self, form, package="nil", thread="t"):
        """The value of a call."""
        answer = self.wait(self.rex(form, package, thread))
        assert answer[0] == ":ok", answer
        return answer[1]

    def refused(self, form, package="nil", thread="t"):
        """Why a call was refused."""
        answer = self.wait(self.rex(form, package, thread))
        assert answer[0] == ":abort", answer
        return answer[1]

    def repl(self, text):
        """Type ``text`` into the REPL buffer; what is written there, results and output."""
        start = len(self.events)
        self.call(f"(swank-repl:listener-eval {wire.write(text)})", thread=":repl-thread")
        return "".join(event[1] for event in self.events[start:] if event[0] == ":write-string")

    def interrupt(self, thread=":repl-thread"):
        self.post(f"(:emacs-interrupt {thread})")

    def wait_for(self, name, seconds=200.0):
        """The next event of that name; it and those before it are taken."""
        until = kernel.now() + seconds
        while True:
            for index, event in enumerate(self.events):
                if event[0] == name:
                    del self.events[: index + 1]
                    return event
            assert kernel.now() < until, f"no {name}; events: {self.events[-3:]}; answers: {self.answers}"
            kernel.sleep(0.05)

    def debugged(self):
        """The thread, the level and the rest of the debugger that opens next: (thread, level, condition, restarts, frames)."""
        _, thread, level, condition, restarts, frames, _ = self.wait_for(":debug")
        self.wait_for(":debug-activate")
        return thread, level, condition, restarts, frames

    def restart(self, name, restarts):
        """The number of the first restart of that name."""
        return [restart[0] for restart in restarts].index(name)


__all__ = ["Emacs", "FakeServer", "Name"]
