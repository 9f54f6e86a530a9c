"""Actions in Lisp text, in virtual time, on both back ends: a package with both libraries, a node, and a server to ask."""

import itertools

import pytest
from systems import ONE_BACKEND

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from lisp_text import LispText
from tests_of_actions import PRELUDE

boot()

_numbers = itertools.count(1)


@pytest.fixture(params=ONE_BACKEND)
def lisp(request, capsys):
    from cramhy_runtime.repl.session import Session

    session = Session(time="virtual", turtlesim=False, backend=request.param, time_limit=3600)
    yield LispText(session, PRELUDE.format(name=f"ACTION-TEST-{next(_numbers)}"))
    PACKAGE.value = COMMON_LISP_USER
    kernel.stop()
