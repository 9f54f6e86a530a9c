"""Each test has its own virtual time, on both back ends."""

import pytest
from image_as_it_was import image_as_it_was

from cramhy_runtime import image, kernel

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
    with image_as_it_was():
        yield Text(fresh_kernel.backend.name)
