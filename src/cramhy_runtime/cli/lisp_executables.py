"""``rosrun PACKAGE EXECUTABLE`` of Lisp, and ``<node>`` in launch files: what ``add_lisp_executable`` in ``CMakeLists.txt`` names.

catkin makes a script of such a line, which loads the system and calls the function. Nothing is built here: the line itself says what to do.
The program is a process of its own, as in ROS. It joins the session that runs on this machine, so that its topics and services are those
of all others; if there is none, the process is a session itself, which others can join. Source: roslisp.md section 12.
"""

from __future__ import annotations

import os
import re
import sys
from contextlib import ExitStack
from functools import partial
from typing import NamedTuple

_CALL = re.compile(r"\b(?:rosbuild_)?add_(?:compiled_)?lisp_executable\s*\(([^()]*)\)", re.IGNORECASE)
INTERRUPTED = 15.0  # s that a program gets to end after Ctrl-C, as with roslaunch
TERMINATED = 2.0  # s after SIGTERM
LAUNCHER = "CRAMHY_LAUNCHER"
"""The environment variable that tells a program which process roslaunch is."""
LOOK = 0.5  # s between two looks whether roslaunch is still there
_COMMENT = re.compile(r"#\[\[.*?\]\]|#[^\n]*", re.DOTALL)


class LispExecutable(NamedTuple):
    """A function without arguments, written ``package:function``, and the ASDF system that defines it."""

    system: str
    function: str


def lisp_executables(folder):
    """The Lisp executables of the package in ``folder``, by name: those that its ``CMakeLists.txt`` names."""
    if folder is None:
        return {}
    try:
        with open(os.path.join(folder, "CMakeLists.txt"), encoding="utf-8", errors="replace") as file:
            text = file.read()
    except OSError:
        return {}
    calls = [found.replace('"', " ").split() for found in _CALL.findall(_COMMENT.sub("", text))]
    return {words[0]: LispExecutable(words[1], words[2]) for words in calls if len(words) >= 3}


def run(package, executable, arguments):
    """Run a `LispExecutable` of ``package`` with the words of its command line until it returns, or Ctrl-C; the exit status."""
    from cramhy_runtime import cli
    from cramhy_runtime.languages.commonlisp.reader.dispatch_macros import add_features
    from cramhy_runtime.repl.session import Interruption
    from cramhy_runtime.ros.roslisp import node

    options = _options(f"{package} {executable.system}")
    if options is None:
        return 2
    with ExitStack() as closings:
        closings.callback(_end_line)

        def work():
            made = cli.session(options, closings)
            _end_with_launcher()
            add_features(["ROSLISP-STANDALONE-EXECUTABLE"])
            node.command_line.value = tuple(arguments)
            made.evaluate_text(f'(ros-load:load-system "{package}" "{executable.system}")', "<rosrun>")
            try:
                made.evaluate_text(f"({executable.function})", "<rosrun>")
            except Interruption:  # Ctrl-C is how such programs are ended
                return 0
            return 0

        return cli.status_of(work)


def _end_with_launcher():
    """Have this program end as by the end of its terminal when the roslaunch that started it is gone, even by SIGKILL.

    ROS leaves such programs behind. A process whose parent has ended gets another one, which POSIX systems tell (getppid(2)); Windows
    does not, so there the program stays.
    """
    launcher = os.environ.pop(LAUNCHER, None)
    if launcher is None:
        return
    import signal

    from cramhy_runtime import kernel

    session = kernel.active()

    def look():
        if str(os.getppid()) != launcher:
            timer.cancel()
            print(f"[rosrun] roslaunch [pid {launcher}] is gone, so the programs that it started end.", file=sys.stderr, flush=True)
            session.terminate(getattr(signal, "SIGHUP", signal.SIGTERM))

    timer = kernel.call_every(LOOK, look)


def _end_line():
    from cramhy_runtime.languages.commonlisp.tools.error_reports import end_line

    end_line()


def _options(what):
    """The options of ``cramhy run`` for such a program: in wall time, without a turtle of its own; ``None`` if it cannot be had, which is
    told."""
    from cramhy_runtime.rosbridge import sessions

    from . import servers
    from .options import parser

    words = ["run", "--time", "wall", "--no-turtlesim", what]
    options = parser(words).parse_args(words)
    try:
        if not os.environ.get("CRAMHY_ROS"):
            found = sessions.current()
            if found is None:
                options.serve = True
            else:
                servers.require("ros", "To join the session that runs")
                options.ros = found.address
                return options
        servers.check(options)
    except (servers.NotPossible, sessions.Unsafe) as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        return None
    return options


class Processes:
    """The Lisp programs among those that roslaunch starts: each is a process, and joins the session. A context manager, which ends them.

    wait: calls a function that blocks, and returns its result: as `kernel.run_blocking` does where this process is the session, which
    must answer its programs when they take their leave.
    """

    def __init__(self, wait):
        self._wait = wait
        self._running = {}

    def __enter__(self):
        return self

    def start(self, program, number):
        """Start ``program``, whose number among the programs of the launch file is given; the id of its process."""
        import subprocess

        from .shims import words_of

        words = [*words_of("rosrun"), program.package, program.executable, *program.arguments]
        surroundings = {**os.environ, LAUNCHER: str(os.getpid())}
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, start_new_session=True, env=surroundings)  # Ctrl-C is ours to hand on
        self._running[f"{program.label}-{number}"] = process
        return process.pid

    def running(self):
        """Whether one of them still runs. It is told, as by roslaunch, which have ended since the last call."""
        for label, process in list(self._running.items()):
            status = process.poll()
            if status is not None:
                del self._running[label]
                ending = f"died [pid {process.pid}, exit code {status}]" if status else "finished cleanly"
                print(f"[{label}] process has {ending}", flush=True)
        return bool(self._running)

    def __exit__(self, *_):
        import signal
        from subprocess import TimeoutExpired

        for process in self._running.values():
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
        for process in self._running.values():
            for patience, harder in ((INTERRUPTED, process.terminate), (TERMINATED, process.kill)):
                try:
                    self._wait(partial(process.wait, patience))
                    break
                except TimeoutExpired:
                    harder()
        self._running.clear()


__all__ = ["LispExecutable", "Processes", "lisp_executables", "run"]
