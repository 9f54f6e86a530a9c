"""The process that watches the runs of submissions: ``python -m cramhy_runtime.grading.watcher``.

It stands between the grader and the fork server: it gives the job to the process that the fork server forked, reads what that tells and
prints, and looks at its time, memory and disk. It loads nothing of the course and runs nothing of a submission. When its standard input
ends, because the grader has ended in whatever way, it ends the job that runs and removes its files. Jobs come and answers go as
`messages` over the standard input and output.

An answer is a dictionary. ``reports``: the lines that the job told, as text, without what is cut off. ``output``: what it printed.
``ended``: "left" (the process ended by itself), "time", "idle", "long", "output", "memory", "threads", "disk", or "sandbox" (there was
none, and ``why``). ``signal``: the number of the signal that ended it. ``seconds``: of processor time. The answer to the preparation
has ``bubblewrap``: why it is not used, or ``None``.
"""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from . import messages
from .sandbox import bubblewrap, removal

MOST_REPORTED = 24_000_000
"""Bytes of reports of a job. A hundred thousand commands are eight million."""
LOOK = 0.05
"""Seconds between two looks at a process."""
IDLE = 3.0
"""Seconds after which a process that does nothing is ended: it waits for something that never comes, or for the wall clock."""
MOST_THREADS = 500
LARGEST_HELD = 4 * 1024 * 1024
"""Bytes that a file without a name may have, which is open or in memory: the limit for files."""
KEPT_OUTPUT = 20_000
TRIES = 3
"""So often a sandbox is made for a job, if Linux has no more name spaces or processes at the moment."""
AT_ITS_END = 0.5
"""Seconds in which a process that tells and prints nothing more may end by itself."""
LAST = 10.0
"""Seconds in which a process that was killed must be gone."""


class Lost(Exception):
    """The grader has ended, or the fork server."""


class Watcher:
    """Gives jobs to processes of a fork server. choice: "bubblewrap", "locks" for those of cramhy alone, or ``None`` for what works.

    systems: what the fork server loads. folder: where files are that need no sandbox of bubblewrap's. grader: the file descriptor of jobs.
    """

    def __init__(self, systems, choice, folder, grader):
        self.folder = folder
        self.gone = select.poll()  # without events: tells only that the other end was closed
        self.gone.register(grader, 0)
        self.why_not = "The grader was told not to use it." if choice == "locks" else bubblewrap.why_not()
        self.next = None
        self.server, other = socket.socketpair()
        with other:
            words = [sys.executable, "-P", "-m", f"{__package__}.fork_server"]
            self.process = subprocess.Popen(words, stdin=other, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.server.send(json.dumps({"prepare": systems}).encode())
        while not select.select([self.server], (), (), LOOK)[0]:
            self.check_grader()
        if not self.server.recv(1):
            raise Lost

    def check_grader(self):
        """Raise `Lost` if the grader has ended."""
        if self.gone.poll(0):
            raise Lost

    def answer(self, job):
        """Let a process perform a job; what came of it."""
        hidden = job.pop("hidden")
        for _ in range(TRIES):
            try:
                return self._answer(job, hidden)
            except (bubblewrap.Unusable, OSError) as problem:
                why = str(problem)
        return {"reports": [], "output": "", "ended": "sandbox", "signal": 0, "seconds": 0.0, "why": why}

    def _answer(self, job, hidden):
        made = self._sandbox(hidden) if self.why_not is None else None
        folder = tempfile.mkdtemp(dir=self.folder) if made is None else None
        try:
            message = {"join": made.first() if made is not None else 0, "folder": folder, "hidden": hidden}
            return _Run(self, job, message, made).until_its_end()
        finally:
            if made is not None:
                made.end()
            else:
                removal.remove(folder)

    def _sandbox(self, hidden):
        """A sandbox of bubblewrap's, and the next one begins to be made: bwrap waits for Linux, and takes hardly any processor time."""
        kept, self.next = self.next, None
        if kept is not None and kept[0] != hidden:
            kept[1].end()
            kept = None
        made = kept[1] if kept is not None else bubblewrap.Bubblewrap(hidden)
        self.next = hidden, bubblewrap.Bubblewrap(hidden)
        return made

    def close(self):
        """End the fork server, and the sandbox that waits."""
        if self.next is not None:
            self.next[1].end()
        self.server.close()
        self.process.kill()
        self.process.wait()


class _Run:
    """A process that the fork server forks for ``job``, read and watched until it ends or has to be ended."""

    def __init__(self, watcher, job, message, made):
        self.watcher, self.job, self.folder, self.sandbox = watcher, job, message["folder"], made
        self.unsent = json.dumps(job).encode()
        self.reports, self.output, self.status = bytearray(), bytearray(), bytearray()
        self.printed_bytes = 0
        self.reason = None
        self.worked, self.used = time.monotonic(), -1
        (source, self.giving), (self.told, telling), (self.printed, printing), (self.state, saying) = (os.pipe() for _ in range(4))
        os.set_blocking(self.giving, False)
        ends = [source, telling, printing, saying]
        try:
            socket.send_fds(watcher.server, [json.dumps(message).encode()], ends)
        finally:
            for end in ends:
                os.close(end)

    def until_its_end(self):
        """The answer to the job."""
        try:
            self._watch()
            status, seconds = self._end()
        finally:
            for end in (self.giving, self.told, self.printed, self.state):
                if end is not None:
                    os.close(end)
        return {
            "reports": self.reports.decode("utf-8", "replace").splitlines()[:5000],
            "output": self.output.decode("utf-8", "replace"),
            "ended": self.reason or "left",
            "signal": os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0,
            "seconds": seconds,
        }

    def _watch(self):
        begun = looked = time.monotonic()
        sources = {self.told, self.printed, self.state}
        while sources & {self.told, self.printed} and self.reason is None and not self._is_over():
            ready, free, _ = select.select(sources, [self.giving] if self.giving is not None else (), (), LOOK)
            if free:
                self._give()
            for source in ready:
                data = os.read(source, 1 << 16)
                if not data:
                    sources.discard(source)
                elif source == self.told:
                    self.reports += data
                elif source == self.state:
                    self.status += data
                else:
                    self._take_output(data)
            now = time.monotonic()
            if now - looked > LOOK:
                looked = now
                self.watcher.check_grader()
                self._look(now - begun)
        if self.reason is None:  # what is in the pipes was told before the end
            self._drain()

    def _drain(self):
        for source in (self.told, self.printed):
            os.set_blocking(source, False)
            with contextlib.suppress(BlockingIOError):
                while self.reason is None and (data := os.read(source, 1 << 16)):
                    if source == self.told:
                        self.reports += data
                    else:
                        self._take_output(data)

    def _give(self):
        """Write what the pipe takes of the job."""
        with contextlib.suppress(BrokenPipeError):
            self.unsent = self.unsent[os.write(self.giving, self.unsent) :]
            if self.unsent:
                return
        os.close(self.giving)
        self.giving = None

    def _is_over(self):
        return self.status.count(b"\n") >= 2 or self.status.startswith(b"!")

    def _number(self):
        """The number of the submission's process, 0 if it is not known yet or the process has ended."""
        lines = self.status.split(b"\n")
        return int(lines[0]) if len(lines) == 2 and lines[0].isdigit() else 0

    def _take_output(self, data):
        self.printed_bytes += len(data)
        self.output += data[: max(KEPT_OUTPUT - len(self.output), 0)]
        if self.printed_bytes > self.job["output"]:
            self.reason = "output"

    def _look(self, passed):
        process = self._number()
        if len(self.reports) > MOST_REPORTED:
            self.reason = "output"
        elif passed > self.job["wall"]:
            self.reason = "long"
        elif process:
            if self.folder is not None and _holds_too_much(self.folder, process):
                self.reason = "disk"
            elif _thread_count(process) > MOST_THREADS:
                self.reason = "threads"
            elif _memory(process) > self.job["megabytes"] << 20:
                self.reason = "memory"
            else:
                self._look_for_idleness(process)

    def _look_for_idleness(self, process):
        threads = _threads(process)
        if threads is None:  # no Linux: the wall clock decides
            return
        used = sum(ticks for _, ticks in threads)
        if used != self.used or any(state in "RD" for state, _ in threads):
            self.worked, self.used = time.monotonic(), used
        elif time.monotonic() - self.worked > IDLE:
            self.reason = "idle"

    def _end(self):
        """End the process with all that it has started; its status, and the processor time that it used in seconds."""
        if self.reason is None:
            self._await_status(AT_ITS_END)
        if not self._is_over():
            if self.sandbox is not None:
                self.sandbox.end()
            elif process := self._number():
                with contextlib.suppress(OSError):
                    os.kill(process, signal.SIGKILL)
        self._await_status(LAST)
        if not self._is_over():
            raise Lost
        if self.status.startswith(b"!"):
            raise bubblewrap.Unusable(self.status[1:].decode("utf-8", "replace").strip())
        status, used = self.status.split(b"\n")[1].split()
        ended = os.WTERMSIG(int(status)) if os.WIFSIGNALED(int(status)) else 0
        if self.reason is None and (ended == signal.SIGXCPU or (ended and float(used) > self.job["seconds"] - 0.2)):
            self.reason = "time"
        return int(status), float(used)

    def _await_status(self, seconds):
        """Read the status until the process is over, for so long at most."""
        latest = time.monotonic() + seconds
        while not self._is_over() and select.select([self.state], (), (), max(latest - time.monotonic(), 0))[0]:
            data = os.read(self.state, 4096)
            if not data:
                raise Lost
            self.status += data


# ---------------------------------------------------------------------------------------------------- what Linux says of a process


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


def _thread_count(process):
    """How many threads a process has; 0 if the system does not tell."""
    try:
        return os.stat(f"/proc/{process}/task").st_nlink - 2
    except OSError:
        return 0


def _memory(process):
    """The bytes of memory that a process uses; 0 if the system does not tell. Its first thread may have ended, and shows none then."""
    for place in (Path(f"/proc/{process}"), *Path(f"/proc/{process}/task").glob("*")):
        with contextlib.suppress(OSError, IndexError, ValueError):
            if pages := int((place / "statm").read_text().split()[1]):
                return pages * os.sysconf("SC_PAGE_SIZE")
    return 0


def _holds_too_much(folder, process):
    """Whether a folder has more than it may, with the files that have no name any more and that the process still holds."""
    held = set()
    with contextlib.suppress(OSError):
        for name in os.listdir(f"/proc/{process}/fd"):
            with contextlib.suppress(OSError):
                found = os.stat(f"/proc/{process}/fd/{name}")
                if not found.st_nlink and found.st_size:
                    held.add((found.st_dev, found.st_ino))
        if folder in (text := Path(f"/proc/{process}/maps").read_text(errors="replace")):
            held |= {tuple(line.split()[3:5]) for line in text.splitlines() if line.endswith("(deleted)") and folder in line}
    return removal.is_over(folder, bubblewrap.MOST_ON_DISK - len(held) * LARGEST_HELD, bubblewrap.MOST_FILES)


def main():
    """Answer jobs until the standard input ends."""
    sink = os.dup(1)
    os.dup2(2, 1)
    source = os.dup(0)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    folder = os.getcwd()
    watcher = None
    try:
        begin = messages.receive(source)
        if begin is None:
            return
        watcher = Watcher(begin["prepare"], begin["choice"], folder, source)
        messages.send(sink, {"bubblewrap": watcher.why_not})
        while (job := messages.receive(source)) is not None:
            messages.send(sink, watcher.answer(job))
    except Lost:
        pass
    finally:
        if watcher is not None:
            watcher.close()
        removal.remove(folder)


if __name__ == "__main__":
    main()
