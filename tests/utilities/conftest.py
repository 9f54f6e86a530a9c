"""Each test has its own virtual time, on both back ends; Lisp text is evaluated in a session."""

import pytest
from systems import ONE_BACKEND

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session

boot()


@pytest.fixture(params=ONE_BACKEND, autouse=True)
def fresh_kernel(request):
    yield kernel.start(clock="virtual", backend=request.param, time_limit=3600)
    kernel.stop()


class Lisp:
    """``lisp(text)``: the values of the last form of ``text`` as they print, with spaces between them."""

    def __init__(self, backend):
        self.session = Session(time="virtual", backend=backend, turtlesim=False)
        self.session.package = "CRAM-USER"

    def __call__(self, text):
        return " ".join(map(prin1_to_string, self.session.evaluate_text(text)))


@pytest.fixture
def lisp(request):
    yield Lisp(request.node.callspec.params["fresh_kernel"])
    kernel.stop()
    PACKAGE.value = COMMON_LISP_USER
