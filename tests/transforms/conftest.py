import pytest

from cramhy_runtime import kernel


@pytest.fixture(autouse=True)
def fresh_kernel():
    yield kernel.start(clock="virtual")
    kernel.stop()
