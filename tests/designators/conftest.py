"""Each test has its own virtual time, on both back ends."""

import pytest

from cramhy_runtime import image, kernel

image.boot()


@pytest.fixture(params=["threads", "greenlet"], autouse=True)
def fresh_kernel(request):
    yield kernel.start(clock="virtual", backend=request.param, time_limit=3600)
    kernel.stop()
