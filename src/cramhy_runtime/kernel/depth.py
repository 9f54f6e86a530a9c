"""How deep code may recurse: Python's limit, and the room for it on the stacks.

Lisp programs recurse where Python programs loop, so Python's limit of 1000 levels is raised. Only this limit turns an endless
recursion into an error: at the end of a stack the process dies without a message. Python code that calls Python code does not
use the stack, but each call that goes through C (`f(*args)`, `sorted(key=...)`, `__lt__`) does, up to 2.5 KiB a level
(measured with Python 3.11 on Linux, 64 bit: 24 MiB for 10,000 levels of `sorted` within `sorted`). So every stack has 64 MiB,
that is 6.5 KiB a level: the main thread's by `RLIMIT_STACK`, those of tasks when their threads start. Room is reserved, not
used: 1000 parked tasks take 30 MB of memory with stacks of 16 MiB and with stacks of 64 MiB, and start as fast.

If the main thread's stack cannot grow, as on Windows, the limit is lower. From Python 3.14 on it need not be: that Python checks the
stack itself, and an endless recursion through C is an error, too. In WebAssembly the stacks are JavaScript's, of 1 MB, which end before
Python expects it, and that ends Python. With 1,000 levels there is room for recursion through functions, callbacks of C and handlers; an
endless ``__add__`` still ends it (Pyodide 314 in Node 26).
"""

from __future__ import annotations

import sys
import threading

LEVELS = 1_000 if sys.platform == "emscripten" else 10_000
SMALL_STACK = 2_000_000
"""Bytes of the main thread's stack if the system has no limit that could be raised: python.exe of Windows is linked with so many."""
STACK_SIZE = 64 << 20 if sys.maxsize > 2**32 else 1 << 20  # bytes


def allow_deep_recursion() -> None:
    """Raise Python's recursion limit to `LEVELS`, or as far as the main thread's stack allows. It never lowers the limit.

    In other threads than the main one it does nothing, since the size of their stack was fixed when they were started.
    """
    if threading.current_thread() is threading.main_thread():
        levels = LEVELS * _main_stack() // STACK_SIZE
        sys.setrecursionlimit(max(sys.getrecursionlimit(), levels))


def _main_stack() -> int:
    """Give the main thread's stack `STACK_SIZE` bytes if the system allows it. Returns its size, at most `STACK_SIZE`."""
    try:
        import resource
    except ImportError:
        return STACK_SIZE if sys.version_info >= (3, 14) else min(STACK_SIZE, SMALL_STACK)  # from 3.14 on Python looks at the stack itself
    soft, hard = resource.getrlimit(resource.RLIMIT_STACK)
    if soft == resource.RLIM_INFINITY or soft >= STACK_SIZE:
        return STACK_SIZE
    wanted = STACK_SIZE if hard == resource.RLIM_INFINITY else min(hard, STACK_SIZE)
    try:
        resource.setrlimit(resource.RLIMIT_STACK, (wanted, hard))
    except (ValueError, OSError):
        return soft
    return wanted
