"""ROS commands for a running REPL: ``rosservice call /clear`` from another terminal, or typed at the prompt.

The graph lives in the REPL's process. A REPL started with ``--commands`` (the shell functions of ``cramhy ros-shims`` ask for it)
listens on a socket file in a folder that only its user can enter, and nowhere else (law 9); each connection brings one command
and gets its text and exit status. Serving is a task like any other, so a command sees the graph between two steps of a plan.
"""

from __future__ import annotations

import json
import os
import shlex
import socket
import tempfile
from pathlib import Path

from cramhy_runtime import kernel
from cramhy_runtime.ros import command_line

TOOLS = ("rosservice", "rostopic", "rosnode", "rosparam", "rosmsg", "rossrv")
_POLL = 0.2  # s; a blocking accept could not be ended
_LIMIT = 1 << 20  # bytes of one command


def address():
    """The socket file of this user: ``$XDG_RUNTIME_DIR`` or the temporary folder, ``cramhy-<uid>/ros``."""
    base = os.environ.get("XDG_RUNTIME_DIR") or tempfile.gettempdir()
    return Path(base) / f"cramhy-{os.getuid()}" / "ros"


def is_command(line):
    """Whether a line typed at the prompt is a ROS command and no Lisp."""
    return line.split(" ", 1)[0] in TOOLS and "(" not in line


def run(words):
    """(text, exit status) of a command, which may take some time of the kernel's clock."""
    return command_line.run(words)


def run_line(line):
    try:
        return run(shlex.split(line))
    except ValueError as problem:
        return f"{line.split()[0]}: {problem}", 2


def listen():
    """Serve commands until the kernel stops. To be called in wall time; another REPL's socket that still answers is left alone."""
    path = address()
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    status = path.parent.lstat()
    if status.st_uid != os.getuid() or status.st_mode & 0o077:
        raise PermissionError(f"{path.parent} does not belong to this user alone, so no ROS commands are served there")
    if path.exists():
        if _answers(path):
            return False
        path.unlink()
    server = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    server.bind(str(path))
    server.listen()
    server.settimeout(_POLL)
    kernel.spawn(_serve, server, path, name="ROS commands from other terminals")
    return True


def _answers(path):
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
        try:
            probe.connect(str(path))
        except OSError:
            return False
    return True


def _serve(server, path):
    try:
        while True:
            connection = kernel.run_blocking(_accept, server)
            if connection is not None:
                kernel.spawn(_answer, connection, name="a ROS command")
            kernel.checkpoint()
    finally:
        server.close()
        path.unlink(missing_ok=True)


def _accept(server):
    try:
        connection, _ = server.accept()
    except OSError:
        return None
    connection.settimeout(5)
    return connection


def _answer(connection):
    with connection:
        try:
            words = json.loads(kernel.run_blocking(_receive, connection))
            if not isinstance(words, list) or not all(isinstance(word, str) for word in words) or not words or words[0] not in TOOLS:
                raise ValueError("a command is a list of words")
            text, status = run(words)
        except (OSError, ValueError) as problem:
            text, status = f"cramhy: not understood: {problem}", 2
        try:
            kernel.run_blocking(connection.sendall, json.dumps([text, status]).encode())
        except OSError:
            pass  # the other terminal has gone


def _receive(connection):
    data = b""
    while not data.endswith(b"\n") and len(data) < _LIMIT:
        part = connection.recv(65536)
        if not part:
            break
        data += part
    return data


def send(words):
    """(text, exit status) from the REPL that serves commands; ``None`` when there is none."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as client:
        try:
            client.connect(str(address()))
        except OSError:
            return None
        client.sendall(json.dumps(words).encode() + b"\n")
        client.shutdown(socket.SHUT_WR)
        data = b"".join(iter(lambda: client.recv(65536), b""))
    return tuple(json.loads(data)) if data else ("cramhy: the REPL ended before it answered", 1)
