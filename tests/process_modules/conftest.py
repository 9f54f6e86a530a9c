"""Each test has its own virtual time, on both back ends."""

import pytest

from cramhy_runtime import image, kernel
from cramhy_runtime.lisp.packages import COMMON_LISP_USER
from cramhy_runtime.lisp.printer.print_controls import PACKAGE
from cramhy_runtime.prolog.facts import fact_group_names, remove_fact_group

from .support import Text

image.boot()


@pytest.fixture(params=["threads", "greenlet"], autouse=True)
def fresh_kernel(request):
    yield kernel.start(clock="virtual", backend=request.param, time_limit=3600)
    kernel.stop()


@pytest.fixture
def text(fresh_kernel, tmp_path, monkeypatch):
    """A `Text` in a session of its own, whose fact groups are forgotten afterwards."""
    monkeypatch.chdir(tmp_path)
    before = set(fact_group_names() or ())
    yield Text(fresh_kernel.backend.name)
    PACKAGE.value = COMMON_LISP_USER
    for name in set(fact_group_names() or ()) - before:
        remove_fact_group(name)
