"""The pytest plugin: plans in test functions.

Lisp systems can be imported as Python modules from the first test on. Every test starts with a fresh kernel in virtual time, so
no test waits on the wall clock and none hears of another's tasks; the turtlesim starts with the first ROS node, as in the REPL.
Nothing is loaded before a test imports a Lisp system or asks for the fixture ``cramhy``.
"""

from __future__ import annotations

import importlib.abc
import importlib.util
import sys

import pytest


class _SystemsOnDemand(importlib.abc.MetaPathFinder):
    """Makes the image when a module is imported that Python does not know; then Lisp systems are found."""

    def find_spec(self, name, path=None, target=None):
        if path is not None or "." in name or name.startswith("_") or "cramhy_runtime.image" in sys.modules:
            return None
        from cramhy_runtime.lisp import systems

        if systems.find_asd(name.replace("_", "-")) is None:
            return None
        from cramhy_runtime import image

        image.fresh_start()
        return importlib.util.find_spec(name)


def pytest_configure(config):
    sys.meta_path.append(_SystemsOnDemand())


@pytest.fixture
def cramhy():
    """A fresh `Session` in virtual time; ``cramhy.evaluate_text("(+ 1 2)")``."""
    from cramhy_runtime import kernel
    from cramhy_runtime.repl.session import Session

    yield Session(time="virtual")
    kernel.stop()


@pytest.fixture(autouse=True)
def _fresh_kernel(request):
    if "cramhy_runtime.image" not in sys.modules or "cramhy" in request.fixturenames or "session" in request.fixturenames:
        yield
        return
    from cramhy_runtime import image, kernel

    image.fresh_start()
    yield
    kernel.stop()
