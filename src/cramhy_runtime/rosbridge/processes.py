"""Which process something belongs to, and whether that process is surely dead.

A number alone does not say it: the system gives numbers of dead processes to new ones, each PID namespace (each container) counts
from 1, and two machines may share a folder. So an `Identity` holds the name of the machine, its boot, the PID namespace, the number, and
when the process began. Only who knows all of these, and finds them to be its own, may say that a process is dead. Where the system
does not tell them (Linux does, in ``/proc``; macOS and Windows don't), every process counts as alive.

Source: proc(5), ``/proc/PID/stat`` field 22 and ``/proc/sys/kernel/random/boot_id``; pid_namespaces(7).
"""

from __future__ import annotations

import hashlib
import os
import socket
from dataclasses import dataclass
from pathlib import Path

UNKNOWN = ""
_DEAD_STATES = ("Z", "X", "x")  # a zombie has ended; its parent has only not asked how


@dataclass(frozen=True)
class Identity:
    """A process. machine: the name of the host. boot: the id of its boot. namespace: of process numbers. began: clock ticks from the boot
    to the start of the process, as a text. What the system does not tell is `UNKNOWN`."""

    pid: int
    machine: str = UNKNOWN
    boot: str = UNKNOWN
    namespace: str = UNKNOWN
    began: str = UNKNOWN

    @property
    def place(self):
        """A short text that is the same for all processes of one machine, boot and PID namespace; `UNKNOWN` if one of these is."""
        parts = self.machine, self.boot, self.namespace
        return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:12] if all(parts) else UNKNOWN


def own():
    """The `Identity` of this process."""
    pid = os.getpid()
    return Identity(pid, socket.gethostname(), _text("/proc/sys/kernel/random/boot_id"), _namespace(), _state_and_start(pid)[1])


def surely_dead(identity):
    """Whether the process has ended for sure. False where this process cannot tell."""
    return dead(identity, own())


def dead(identity, here):
    """As `surely_dead`, with the `Identity` of the process that asks."""
    if not identity.machine or identity.machine != here.machine or not identity.boot or not here.boot:
        return False
    if identity.boot != here.boot:
        return True  # this machine has been started anew since
    if not identity.namespace or identity.namespace != here.namespace or not identity.began or not here.began:
        return False
    state, began = _state_and_start(identity.pid)
    if began == UNKNOWN:
        return not _exists(identity.pid)  # ``/proc`` may hide the processes of others
    return began != identity.began or state in _DEAD_STATES


def _exists(pid):
    if os.name == "nt":  # where 0 is no signal that only asks, but Ctrl-C
        return True
    try:
        os.kill(pid, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        pass
    return True


def _text(path):
    try:
        return Path(path).read_text(encoding="utf-8").strip()
    except (OSError, ValueError):
        return UNKNOWN


def _namespace():
    try:
        return os.readlink("/proc/self/ns/pid")
    except (OSError, AttributeError):
        return UNKNOWN


def _state_and_start(pid):
    """The state of a process and when it began, as the system says them; two times `UNKNOWN` where it does not."""
    fields = _text(f"/proc/{pid}/stat").rpartition(")")[2].split()
    return (fields[0], fields[19]) if len(fields) > 19 else (UNKNOWN, UNKNOWN)
