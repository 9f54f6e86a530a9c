"""Kernels for the tests: every test runs on both back ends, in virtual time unless it says otherwise."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.kernel import reports


@pytest.fixture(autouse=True)
def kernel_alone(monkeypatch):
    """Whatever rooms above were loaded before: frames are described as the kernel itself describes them."""
    monkeypatch.setattr(reports.installed, "reporter", reports.PlainReporter())


@pytest.fixture
def start(backend):
    """Starts a kernel on the back end of this run; it is stopped after the test."""

    def start(**options):
        return kernel.start(backend=backend, **options)

    yield start
    kernel.stop()


@pytest.fixture
def k(start):
    """A kernel in virtual time."""
    return start()


@pytest.fixture
def reported(monkeypatch):
    """What the reporter was told of unhandled exceptions: pairs of the task's name and the exception."""
    told = []
    monkeypatch.setattr(kernel.reports.installed.reporter, "unhandled", lambda task, exception: told.append((task.name, exception)))
    return told
