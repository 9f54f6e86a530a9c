"""A kernel in virtual time, the captured output, and roslisp's functions; and Lisp as users write it, on both back ends."""

import itertools
import re

import pytest
from systems import ONE_BACKEND
from lisp_text import LispLine

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.packages import sym

OUTPUT = sym("*STANDARD-OUTPUT*")
ERRORS = sym("*ERROR-OUTPUT*")


@pytest.fixture(autouse=True)
def session():
    """A fresh kernel; the output of the test in a stream with the attribute ``text``."""
    kernel.start(clock="virtual")
    boot()
    from cramhy_runtime.languages.commonlisp.streams.streams import StringOutputStream
    from cramhy_runtime.ros.roslisp import master, node, utilities

    saved = OUTPUT.value, ERRORS.value
    OUTPUT.value, ERRORS.value = StringOutputStream(), StringOutputStream()
    for symbol in (node.NODE_NAME, master.MASTER_URI, master.DEFAULT_MASTER_URI):
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
    from cramhy_runtime.ros import graph
    from cramhy_runtime.ros.roslisp import node

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
    from cramhy_runtime.lisp_core.condition_types import Condition

    def check(function, *arguments, **keywords):
        with pytest.raises(Condition) as caught:
            function(*arguments, **keywords)
        return caught.value

    return check


class Lisp(LispLine):
    """Lisp in one line, without the name of the package, of which each has its own.

    ``(note x)`` adds to the list ``*notes*``. A session in virtual time, without a simulator unless the test starts one.
    """

    name = "<repl>"
    numbers = itertools.count(1)
    prelude = """
        (defpackage {0} (:use :common-lisp :roslisp :roslisp-utilities))
        (in-package {0})
        (defvar *notes* nil)
        (defun note (thing) (setf *notes* (append *notes* (list thing))) thing)"""

    def __init__(self, backend, output):
        from cramhy_runtime.repl.session import Session

        self.output = output
        super().__init__(
            Session(time="virtual", turtlesim=False, backend=backend, time_limit=3600),
            self.prelude.format(f"ROS-TEXT-{next(self.numbers)}"),
        )

    def __call__(self, text):
        return super().__call__(text).replace(self.session.package.name + "::", "")

    def printed(self):
        """The lines that were printed since the last time, each with ``T`` for the time of a log line."""
        return [re.sub(r"\] \d+\.\d{3}: ", "] T: ", line) for line in self.output.take().splitlines()]

    def warned(self):
        """What was written to ``*error-output*`` since the last time, in one line."""
        return " ".join(ERRORS.value.take().split())


@pytest.fixture(params=ONE_BACKEND)
def lisp(request, session):
    from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
    from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE

    yield Lisp(request.param, session)
    PACKAGE.value = COMMON_LISP_USER


@pytest.fixture
def node(lisp):
    """`lisp` with the node ``/n``, its start-up lines taken away."""
    lisp('(start-ros-node "n")')
    lisp.printed()
    return lisp
