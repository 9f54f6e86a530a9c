"""A kernel in virtual time, the captured output, and roslisp's functions."""

import pytest

from cramhy_runtime import image, kernel
from cramhy_runtime.lisp.packages import sym

OUTPUT = sym("*STANDARD-OUTPUT*")
ERRORS = sym("*ERROR-OUTPUT*")


@pytest.fixture(autouse=True)
def session():
    """A fresh kernel; the output of the test in a stream with the attribute ``text``."""
    kernel.start(clock="virtual")
    image.boot()
    from cramhy_runtime.lisp.streams.streams import StringOutputStream
    from cramhy_runtime.ros import node, utilities

    saved = OUTPUT.value, ERRORS.value
    OUTPUT.value, ERRORS.value = StringOutputStream(), StringOutputStream()
    for symbol in (node.NODE_NAME, node.MASTER_URI, node.DEFAULT_MASTER_URI):
        symbol.value = None
    yield OUTPUT.value
    OUTPUT.value, ERRORS.value = saved
    utilities.forget_registrations()
    kernel.stop()


@pytest.fixture
def printed(session):
    """Takes what was printed since the last time."""
    return session.take


@pytest.fixture
def warned(session):
    """Takes what was written to ``*error-output*`` since the last time."""
    return ERRORS.value.take


@pytest.fixture
def running(session):
    """A running node ``/n``, its start-up lines taken away."""
    from cramhy_runtime.ros import graph, node

    node.start_ros_node("n")
    session.take()
    return graph.active().lisp_node


@pytest.fixture
def simulator(running):
    from cramhy_runtime.turtlesim.node import start_turtlesim

    return start_turtlesim()


@pytest.fixture
def fails():
    """Calls a function and returns the condition it signals."""
    from cramhy_runtime.lisp.condition_types import Condition

    def check(function, *arguments, **keywords):
        with pytest.raises(Condition) as caught:
            function(*arguments, **keywords)
        return caught.value

    return check
