"""The process from which the processes of submissions are forked: ``python -m cramhy_runtime.grading.fork_server``.

It starts once with a small environment, loads the course, and never runs a line of a submission. It never sees one, either: what it has in
its memory, each process that is forked from it has, too. So a forked process reads its job from a pipe of its own, and what it tells and
prints goes to the process that watches it (`watcher`). What this one gets for each job is four ends of pipes and which sandbox to join.

Between the two there is a process that joins the sandbox, forks once more, and says what it forked and how that ended. It is outside of the
sandbox's space of processes, so a submission cannot reach it.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import socket
import sys
import tempfile

from . import sandbox
from .sandbox import bubblewrap, linux

ENDS = 4
"""What comes with each job: where to read it, where to tell, where to print, and where the status goes."""
_MOST = 100_000  # bytes of a message

_WARM_UP = """
(roslisp:start-ros-node "warm-up")
(progn (roslisp:subscribe "turtle1/pose" "turtlesim/Pose" (lambda (message) message))
  (let ((commands (roslisp:advertise "turtle1/cmd_vel" "geometry_msgs/Twist")))
    (roslisp:publish commands (roslisp:make-message "geometry_msgs/Twist" (:x :linear) 1)))
  (roslisp:call-service "turtle1/set_pen" "turtlesim/SetPen" :r 1 :g 2 :b 3 :width 4 :off 0)
  (cpl:top-level (cpl:pursue (cpl:sleep 0.1) (cpl:sleep 0.2))))
"""
"""What most plans do. Done once here, it takes a third of the time in each process that is forked later."""


def serve(watcher: socket.socket) -> None:
    """Fork a process for each message of ``watcher``, until it closes. It sends one, and waits for what comes of it."""
    while True:
        data, ends, _, _ = socket.recv_fds(watcher, _MOST, ENDS)
        with contextlib.suppress(ChildProcessError):  # the last one has told how it ended
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        if not data:
            return
        message = json.loads(data)
        if "prepare" in message:
            prepare(message["prepare"])
            watcher.send(b".")
            continue
        if not os.fork():
            watcher.close()
            _supervise(message, *ends)
        for end in ends:
            os.close(end)


def prepare(systems):
    """Load what jobs build upon, once."""
    from cramhy_runtime.session.session import Session
    from cramhy_runtime.testing import faults, watched  # noqa: F401  so that no process has to import them

    from . import performing  # noqa: F401

    made = Session(time="virtual")
    for system in systems:
        made.load(system)
    made.evaluate_text(_WARM_UP)


# --------------------------------------------------------------------------------------------- between server and submission


def _supervise(message, source, telling, printing, status):
    """Fork the process of a submission and wait for it. Never returns.

    Writes the process's number, and then its status and the seconds of processor time that it used; or "!" and what went wrong.
    """
    try:
        os.setsid()
        if message["join"]:
            bubblewrap.join(message["join"])
        if sys.platform == "linux":
            linux.prctl(linux.PARENT_DEATH_SIGNAL, signal.SIGKILL)
            linux.prctl(linux.SUBREAPER, 1)
        child = os.fork()
        if not child:
            _live(message, source, telling, printing)
        for end in (source, telling, printing):
            os.close(end)
        os.write(status, f"{child}\n".encode())
        _, ended, usage = os.wait4(child, 0)
        _end_others()
        os.write(status, f"{ended} {usage.ru_utime + usage.ru_stime:.3f}\n".encode())
    except BaseException as problem:
        with contextlib.suppress(OSError):
            os.write(status, f"!{type(problem).__name__}: {problem}\n".encode())
    finally:
        os._exit(0)


def _end_others():
    """End what the submission has started, where no lock forbids to start anything: its orphans are children of this process."""
    with contextlib.suppress(OSError):  # there is no /proc, and no such process, or none is left
        while children := open(f"/proc/self/task/{os.getpid()}/children").read().split():
            for child in children:
                os.kill(int(child), signal.SIGKILL)
                os.waitpid(int(child), 0)


# ------------------------------------------------------------------------------------------------- in the submission's process


def _live(message, source, telling, printing):
    """Lock the process up, read the job and perform it. Never returns."""
    status = 1
    try:
        job, folder, tell = _prepare_to_tell(message, source, telling, printing)
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


def _prepare_to_tell(message, source, telling, printing):
    """The job, the folder of its files, and the function that reports. Nothing else is open then."""
    from . import performing

    os.setsid()
    if sys.platform == "linux":
        linux.prctl(linux.PARENT_DEATH_SIGNAL, signal.SIGKILL)
    signal.signal(signal.SIGXCPU, signal.SIG_DFL)
    nothing = os.open(os.devnull, os.O_RDONLY)
    kept = [os.dup(end) for end in (nothing, printing, printing, telling, source)]  # none of them has the number that it shall have
    kept = [os.dup2(end, 200 + number) for number, end in enumerate(kept)]
    for number, end in enumerate(kept):
        os.dup2(end, number)
    os.closerange(5, 4096)
    data = bytearray()
    while piece := os.read(4, 1 << 20):
        data += piece
    os.close(4)
    job = json.loads(data)
    folder = bubblewrap.FOLDER if message["join"] else message["folder"]
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(HOME=folder, TMPDIR=folder, PATH="/usr/bin:/bin", LANG="C.UTF-8", CRAMHY_TIME="virtual")
    tempfile.tempdir = folder
    performing.lay_out(job, folder)
    held = sandbox.close(folder, job["seconds"], job["megabytes"], bool(message["join"]), message["hidden"])
    nonce, write = job["nonce"], os.write

    def tell(kind, **facts):
        data = f"{nonce} {json.dumps({'kind': kind, **facts})}\n".encode("utf-8", "replace")
        while data:
            data = data[write(3, data) :]

    tell("held", locks=held)
    return job, folder, tell


if __name__ == "__main__":
    serve(socket.socket(fileno=os.dup(0)))
