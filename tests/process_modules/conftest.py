"""Each test has its own virtual time, on both back ends."""

import pytest
from cramhy_runtime.session import Image
from systems import ONE_BACKEND

from cramhy_runtime import kernel
from cramhy_runtime.session import boot

from .support import Text

boot()


@pytest.fixture(params=ONE_BACKEND, autouse=True)
def fresh_kernel(request):
    with Image(as_now=True):
        yield kernel.start(clock="virtual", backend=request.param, time_limit=3600)
        kernel.stop()


@pytest.fixture
def text(fresh_kernel, tmp_path, monkeypatch):
    """A `Text` in a session of its own."""
    monkeypatch.chdir(tmp_path)
    yield Text(fresh_kernel.backend.name)
