"""Does something to the processes of others, to the network and to its own sandbox."""
# ruff: noqa: F821

import ctypes
import os
import signal
import socket

system = ctypes.CDLL(None, use_errno=True)
own = os.getpid()
OTHERS = [number for number in (1, 2, os.getppid(), GIVEN_PROCESSES) if number and number != own]


def attempt(name, work, *words):
    try:
        found = work(*words)
    except (OSError, AttributeError, ValueError, OverflowError):
        return
    if found not in (-1, None) or name in ("kill", "priority"):
        print("ESCAPED:", name, words, found)


def call(number, *words):
    found = system.syscall(number, *words)
    return None if found < 0 else found


for process in OTHERS:
    for number in (0, signal.SIGSTOP, signal.SIGKILL):
        attempt("kill", os.kill, process, number)
    attempt("trace", call, 101, 16, process, 0, 0)
    attempt("pidfd", lambda process=process: signal.pidfd_send_signal(os.pidfd_open(process), 9))
    attempt("affinity", lambda process=process: (os.sched_setaffinity(process, {0}), 1)[1])
    attempt("limits", call, 302, process, 7, 0, ctypes.byref((ctypes.c_uint64 * 2)()))
    attempt("memory", call, 310, process, ctypes.byref((ctypes.c_uint64 * 2)()), 1, ctypes.byref((ctypes.c_uint64 * 2)(4096, 1)), 1, 0)
attempt("kill", os.kill, -1, signal.SIGKILL) if GIVEN_ALL else None
attempt("priority", os.setpriority, os.PRIO_USER, os.getuid(), 19)
for kind in (socket.AF_INET, socket.AF_INET6, socket.AF_UNIX, 16):
    attempt("socket", socket.socket, kind)
for name, *words in [
    ("unshare", 272, 0x10000000 | 0x20000),
    ("mount", 165, b"tmpfs", b".", b"tmpfs", 0, b""),
    ("remount", 165, b"tmpfs", os.getcwd().encode(), b"tmpfs", 32, b"size=10g,nr_inodes=0"),
    ("umount", 166, os.getcwd().encode(), 2),
    ("chroot", 161, b"/"),
    ("setns", 308, 3, 0),
    ("sethostname", 170, b"x", 1),
    ("settimeofday", 164, 0, 0),
    ("keyctl", 248, b"user", b"x", b"y", 1, -3),
    ("setuid", 105, 0) if own and os.getuid() else ("setgroups", 116, 0, 0),
]:
    attempt(name, call, *words)
print("went on")
