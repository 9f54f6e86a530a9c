"""Whatever works beside a plan comes late, at random: finds tests, and code, that lean on who is faster.

``CRAMHY_LATE=7 pytest …`` begins with the seed 7. Threads start late, event loops look at their sockets late, messages from outside come
into the kernel late and are read late there, and WebSocket clients speak and listen late. Plans in virtual time do not notice.
"""

from __future__ import annotations

import functools
import importlib
import random
import time

SELDOM, LONG = 0.02, 0.2  # how often something is late, and by how many seconds at most
POINTS = (
    ("threading", "Thread", "run"),
    ("selectors", "EpollSelector", "select"),
    ("twisted.internet.epollreactor", "EPollReactor", "doPoll"),
    ("websockets.sync.connection", "Connection", "send"),
    ("websockets.sync.connection", "Connection", "recv"),
    ("cramhy_runtime.kernel.inbox", "Outside", "post"),
    ("cramhy_runtime.kernel.inbox", "Outside", "_read_inbox"),
)


def install(seed):
    """Make everything beside the plan late, from now on."""
    dice = random.Random(seed)

    def wait():
        if dice.random() < SELDOM:
            time.sleep(dice.random() * LONG)

    for module, owner, name in POINTS:
        try:
            owner = getattr(importlib.import_module(module), owner)
        except (ImportError, AttributeError):
            continue  # an extra, or another system's way to wait for sockets
        setattr(owner, name, _late(getattr(owner, name), wait))


def _late(function, wait):
    @functools.wraps(function)
    def late(*arguments, **keywords):
        wait()
        return function(*arguments, **keywords)

    return late
