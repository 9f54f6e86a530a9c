"""Starts what should live longer than it: daemons, by each call that there is, in sessions of their own; and hides from its end."""
# ruff: noqa: F821

import ctypes
import os
import signal
import time

system = ctypes.CDLL(None, use_errno=True)
for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGXCPU, signal.SIGUSR1):
    signal.signal(number, signal.SIG_IGN)
system.prctl(1, 0, 0, 0, 0)  # nobody tells when the parent ends
system.prctl(15, b"GIVEN_MARK", 0, 0, 0)


def daemon(start):
    try:
        if start():
            return
    except OSError as problem:
        print(start.__name__, problem.strerror)
        return
    try:
        os.setsid()
        if os.fork():
            os._exit(0)
    except OSError:
        pass
    system.prctl(15, b"GIVEN_MARK", 0, 0, 0)
    system.prctl(1, 0, 0, 0, 0)
    os.closerange(0, 200)
    while True:
        time.sleep(100)


def fork():
    return os.fork()


def vfork():
    raw(58)
    return 1


def clone():
    return raw(56, 17, 0, 0, 0, 0)


def clone3():
    return raw(435, ctypes.byref((ctypes.c_uint64 * 11)(0, 0, 0, 0, 17, 0, 0, 0, 0, 0, 0)), 88)


def raw(*numbers):
    found = system.syscall(*numbers)
    if found < 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
    return found


def program():
    return os.posix_spawn("/bin/sh", ["GIVEN_MARK", "-c", "sleep 1000 & setsid sleep 1000 &"], {})


for start in (fork, clone, clone3, program):
    daemon(start)
print("went on")
if GIVEN_STAYS:
    while True:
        time.sleep(1000 if GIVEN_STAYS == 1 else 0.01)
