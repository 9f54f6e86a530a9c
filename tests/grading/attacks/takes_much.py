"""Takes memory and threads where nobody looks, or makes looking slow."""
# ruff: noqa: F821

import ctypes
import os
import signal
import threading
import time

system = ctypes.CDLL(None, use_errno=True)


def threads():
    threading.stack_size(32 * 1024)
    for _ in range(3000):
        try:
            threading.Thread(target=time.sleep, args=(1000,), daemon=True).start()
        except RuntimeError:
            break
    print("threads", threading.active_count())
    while True:
        time.sleep(0.01)


def after_the_main_thread():
    """Linux shows no memory for a process whose first thread has ended."""

    def take():
        kept = []
        while True:
            kept.append(bytearray(20_000_000))
            time.sleep(0.02)

    threading.Thread(target=take).start()
    system.syscall(60, 0)


def stopped():
    os.kill(os.getpid(), signal.SIGSTOP)


def deaf():
    os.closerange(0, 100)
    while True:
        time.sleep(0.2)


def busy_threads():
    for _ in range(40):
        threading.Thread(target=lambda: sum(range(10**12)), daemon=True).start()
    signal.signal(signal.SIGXCPU, signal.SIG_IGN)
    while True:
        pass


GIVEN_WHICH()
