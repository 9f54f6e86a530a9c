"""The process from which the processes of submissions are forked: ``python -m cramhy_runtime.grading.fork_server``.

It starts once, loads the course, and never runs a line of a submission. For each job it forks a process, which goes into a sandbox and
performs the job; meanwhile this one reads what that tells and prints, and watches its time. Whatever a submission does, its process is
ended as a whole when the job is over. Jobs come and answers go as length and JSON over the standard input and output.

An answer is a dictionary. ``reports``: the lines that the job told, as text, without what is cut off. ``output``: what it printed.
``ended``: "done", "left" (the process ended by itself), "time", "idle", "long", "output" or "disk". ``signal``: the number of the signal
that ended it. ``held``: the locks of the sandbox.
"""

from __future__ import annotations

import contextlib
import json
import os
import select
import shutil
import signal
import struct
import sys
import tempfile
import time
from pathlib import Path

MOST_REPORTED = 24_000_000
"""Bytes of reports of a job. A hundred thousand commands are eight million."""
LOOK = 0.05
"""Seconds between two looks at a process."""
IDLE = 3.0
"""Seconds after which a process that does nothing is ended: it waits for something that never comes, or for the wall clock."""
MOST_ON_DISK = 32 * 1024 * 1024
KEPT_OUTPUT = 20_000


_WARM_UP = """
(roslisp:start-ros-node "warm-up")
(progn (roslisp:subscribe "turtle1/pose" "turtlesim/Pose" (lambda (message) message))
  (let ((commands (roslisp:advertise "turtle1/cmd_vel" "geometry_msgs/Twist")))
    (roslisp:publish commands (roslisp:make-message "geometry_msgs/Twist" (:x :linear) 1)))
  (roslisp:call-service "turtle1/set_pen" "turtlesim/SetPen" :r 1 :g 2 :b 3 :width 4 :off 0)
  (cpl:top-level (cpl:pursue (cpl:sleep 0.1) (cpl:sleep 0.2))))
"""
"""What most plans do. Done once here, it takes a third of the time in each process that is forked later."""


def serve(source, sink):
    """Answer jobs until ``source`` ends. Both are file descriptors."""
    while (job := receive(source)) is not None:
        send(sink, answer(job))


def send(sink, message):
    """Write a message. sink: a file descriptor."""
    data = json.dumps(message).encode()
    data = struct.pack(">Q", len(data)) + data
    while data:
        data = data[os.write(sink, data) :]


def receive(source):
    """The next message of a file descriptor, ``None`` at its end."""
    head = _exactly(source, 8)
    data = _exactly(source, struct.unpack(">Q", head)[0]) if head is not None else None
    return None if data is None else json.loads(data)


def _exactly(source, count):
    pieces = []
    while count:
        piece = os.read(source, min(count, 1 << 20))
        if not piece:
            return None
        pieces.append(piece)
        count -= len(piece)
    return b"".join(pieces)


def prepare(systems):
    """Load what jobs build upon, once."""
    from cramhy_runtime.session.session import Session
    from cramhy_runtime.testing import faults, watched  # noqa: F401  so that no process has to import them

    from . import performing  # noqa: F401

    made = Session(time="virtual")
    for system in systems:
        made.load(system)
    made.evaluate_text(_WARM_UP)


def answer(job):
    """Perform a job in a process of its own; what came of it."""
    if "prepare" in job:
        prepare(job["prepare"])
        return {}
    folder = tempfile.mkdtemp(prefix="cramhy-")
    told, telling = os.pipe()
    printed, printing = os.pipe()
    try:
        child = os.fork()
        if not child:
            _live(job, folder, telling, printing)
        os.close(telling)
        os.close(printing)
        return _Watch(child, told, printed, job, folder).until_its_end()
    finally:
        os.close(told)
        os.close(printed)
        shutil.rmtree(folder, ignore_errors=True)


# ------------------------------------------------------------------------------------------------- in the submission's process


def _live(job, folder, telling, printing):
    """Go into the sandbox and perform the job. Never returns."""
    status = 1
    try:
        tell = _prepare_to_tell(job, folder, telling, printing)
        from .performing import perform

        perform(job, folder, tell)
        status = 0
    except BaseException:
        import traceback

        traceback.print_exc()
    finally:
        with contextlib.suppress(BaseException):
            sys.stdout.flush()
        os._exit(status)


def _prepare_to_tell(job, folder, telling, printing):
    from . import sandbox, performing

    os.setsid()
    _die_with_parent()
    nothing = os.open(os.devnull, os.O_RDONLY)
    for number, place in ((nothing, 0), (printing, 1), (printing, 2)):
        os.dup2(number, place)
    os.dup2(telling, 3)
    os.closerange(4, 4096)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(HOME=folder, TMPDIR=folder, PATH="/usr/bin:/bin", LANG="C.UTF-8", CRAMHY_TIME="virtual")
    tempfile.tempdir = folder
    signal.signal(signal.SIGXCPU, signal.SIG_DFL)
    performing.lay_out(job, folder)
    held = sandbox.close(folder, job["seconds"], job["megabytes"])
    nonce, write = job["nonce"], os.write

    def tell(kind, **facts):
        data = f"{nonce} {json.dumps({'kind': kind, **facts})}\n".encode("utf-8", "replace")
        while data:
            data = data[write(3, data) :]

    tell("held", locks=held)
    return tell


def _die_with_parent():
    """Let Linux end this process when the fork server ends."""
    if sys.platform == "linux":
        import ctypes

        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(1, signal.SIGKILL, 0, 0, 0)


# --------------------------------------------------------------------------------------------------------------- in the fork server


class _Watch:
    """The process ``child``, which is read and watched until it ends or has to be ended."""

    def __init__(self, child, told, printed, job, folder):
        self.child, self.told, self.printed, self.job, self.folder = child, told, printed, job, folder
        self.reports, self.output = bytearray(), bytearray()
        self.printed_bytes = 0
        self.reason = None
        self.worked, self.used = time.monotonic(), -1

    def until_its_end(self):
        """The answer to the job."""
        begun = looked = time.monotonic()
        sources = {self.told, self.printed}
        while sources and self.reason is None:
            ready = select.select(sources, (), (), LOOK)[0]
            for source in ready:
                data = os.read(source, 1 << 16)
                if not data:
                    sources.discard(source)
                elif source == self.told:
                    self.reports += data
                else:
                    self._take_output(data)
            now = time.monotonic()
            if now - looked > LOOK:
                looked = now
                self._look(now - begun)
        status, usage = self._end()
        return {
            "reports": self.reports.decode("utf-8", "replace").splitlines()[:5000],
            "output": self.output.decode("utf-8", "replace"),
            "ended": self.reason or "left",
            "signal": os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0,
            "seconds": round(usage, 3),
        }

    def _take_output(self, data):
        self.printed_bytes += len(data)
        self.output += data[: max(KEPT_OUTPUT - len(self.output), 0)]
        if self.printed_bytes > self.job["output"]:
            self.reason = "output"

    def _look(self, passed):
        if len(self.reports) > MOST_REPORTED:
            self.reason = "output"
        elif passed > self.job["wall"]:
            self.reason = "long"
        elif _size(self.folder) > MOST_ON_DISK:
            self.reason = "disk"
        elif _memory(self.child) > self.job["megabytes"] << 20:
            self.reason = "memory"
        else:
            self._look_for_idleness()

    def _look_for_idleness(self):
        threads = _threads(self.child)
        if threads is None:  # no Linux: the wall clock decides
            return
        used = sum(ticks for _, ticks in threads)
        if used != self.used or any(state != "S" for state, _ in threads):
            self.worked, self.used = time.monotonic(), used
        elif time.monotonic() - self.worked > IDLE:
            self.reason = "idle"

    def _end(self):
        """End the process with all that it has started; its status, and the processor time that it used in seconds."""
        for end in (os.killpg, os.kill):
            with contextlib.suppress(OSError):
                end(self.child, signal.SIGKILL)
        _, status, usage = os.wait4(self.child, 0)
        used = usage.ru_utime + usage.ru_stime
        ended = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
        if self.reason is None and (ended == signal.SIGXCPU or (ended and used > self.job["seconds"] - 0.2)):
            self.reason = "time"
        return status, used


def _threads(process):
    """For each thread of a process its state, "S" if it sleeps, and its processor time; ``None`` if the system does not tell."""
    found = []
    for thread in Path(f"/proc/{process}/task").glob("*"):
        try:
            state, *fields = (thread / "stat").read_text().rpartition(")")[2].split()
        except OSError:  # it has just ended
            continue
        found.append((state, int(fields[10]) + int(fields[11])))
    return found or None


def _memory(process):
    """The bytes of memory that a process uses; 0 if the system does not tell."""
    try:
        return int(Path(f"/proc/{process}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, IndexError, ValueError):
        return 0


def _size(folder):
    total = 0
    for place, _, names in os.walk(folder):
        for name in names:
            with contextlib.suppress(OSError):
                total += os.lstat(os.path.join(place, name)).st_size
    return total


if __name__ == "__main__":
    sink = os.dup(1)
    os.dup2(2, 1)  # what loading prints does not get between the answers
    serve(os.dup(0), sink)
