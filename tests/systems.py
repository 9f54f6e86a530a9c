"""What the interpreter and the system that run the tests have, and marks for tests that need more."""

import os
import sys

import hy
import pytest

RUNS_HY_FILES = not (3, 12) <= sys.version_info < (3, 12, 6) or tuple(map(int, hy.__version__.split(".")[:2])) < (1, 3)
WHY_NO_HY_FILES = "Hy 1.3 runs no file at all with Python 3.12.0 to 3.12.5"


IN_WEBASSEMBLY = sys.platform == "emscripten"
"""Whether this is Pyodide, in Node or a browser; see tests/webassembly."""
BACKENDS = ["jspi"] if IN_WEBASSEMBLY else ["threads", "greenlet"]
"""The names of the kernel's back ends that this system can have."""
ONE_BACKEND = BACKENDS if IN_WEBASSEMBLY else [pytest.param("threads", marks=pytest.mark.soak), "greenlet"]
"""The same for tests that meet the other back end in `make soak`. The tests of `kernel` and the laws of `cpl` always meet both."""
needs_threads = pytest.mark.skipif(IN_WEBASSEMBLY, reason="WebAssembly has no threads")
needs_processes = pytest.mark.skipif(IN_WEBASSEMBLY, reason="WebAssembly has no processes and no signals")


def has_module(name):
    """Whether a module of that name can be imported."""
    try:
        __import__(name)
    except ImportError:
        return False
    return True


def needs(module, *names):
    """The mark of a test that uses names of a module of Python's which not every system has."""
    missing = [name for name in names if not hasattr(module, name)]
    return pytest.mark.skipif(bool(missing), reason=f"this system has no {module.__name__}.{' and no '.join(missing)}")


IS_POSIX = os.name == "posix" and "CRAMHY_TEST_HIDDEN" not in os.environ
"""Whether users, modes, links, signals and pipes are those of POSIX. Not in a process of ``tests/without_posix``."""
posix = pytest.mark.skipif(not IS_POSIX, reason="users, modes, links, signals and pipes of POSIX")
SOAK = bool(os.environ.get("CRAMHY_SOAK"))
"""Whether `make soak` runs the tests: all of them, and in their long form."""
linux = pytest.mark.skipif(sys.platform != "linux" or not IS_POSIX, reason="/proc, /dev/full and limits of Linux")
needs_terminals = pytest.mark.skipif(not has_module("termios"), reason="this system has no terminals of POSIX")
needs_deep_stacks = pytest.mark.skipif(
    not has_module("resource") and sys.version_info < (3, 14),
    reason="this system gives the main thread a small stack, which limits recursion",
)
