"""Sessions that are looked at, on both back ends, with a wall clock that stands still until a test moves it."""

from __future__ import annotations

import pytest

from cramhy_runtime import chronicle, kernel
from cramhy_runtime.chronicle import service_node as board, chronicler
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.repl.session import Session
from cramhy_runtime.ros import graph, services
from cramhy_runtime.ros.messages import message_class_exact, service_type_exact


@pytest.fixture
def session(backend):
    """A session in virtual time with the turtle, in the package CRAM-USER."""
    made = Session(time="virtual", seed=7, backend=backend)
    made.package = "CRAM-USER"
    yield made
    chronicle.stop()
    kernel.stop()
    PACKAGE.value = COMMON_LISP_USER


class Looker:
    """Looks at the active session: every message by kind, what it hears on the topics, and the services."""

    def __init__(self):
        self.told = {kind: [] for kind in ("world", "tasks", "fluents", "modules", "robots")}
        self.heard = {}
        self.wall = 0.0
        self.chronicler = chronicler.active()
        self.chronicler.listeners.append(lambda kind, message: self.told[kind].append(message))
        self.node = graph.active().node("onlooker", hidden=True)

    def open_board(self):
        chronicle.start()
        self.chronicler.board.wall = lambda: self.wall
        return self.chronicler.board

    def listen(self, topic, ros_type):
        heard = self.heard[topic] = []
        self.node.subscribe(topic, message_class_exact(ros_type), heard.append)
        return heard

    def call(self, name, ros_type, /, **request):
        """(the response, or the text of the refusal)."""
        answer = services.exchange(graph.active().services[name], service_type_exact(ros_type).request(**request))
        return answer.failure or answer.response

    def tasks(self):
        """All that was told of tasks, in order."""
        return [task for message in self.told["tasks"] for task in message.tasks]


@pytest.fixture
def looker(session):
    made = Looker()
    yield made
    made.chronicler.listeners.clear()
    chronicle.stop()
    chronicler.dismiss()


@pytest.fixture
def period():
    return board.PERIOD
