"""The plans of the anomaly loop bring kernels of their own, and what they define is there for one file of tests."""

import pytest

from cramhy_runtime import kernel

from . import harness


@pytest.fixture(autouse=True)
def fresh_kernel():
    kernel.stop()


@pytest.fixture(scope="module", autouse=True)
def plans_of_this_file():
    yield
    harness.forget()
