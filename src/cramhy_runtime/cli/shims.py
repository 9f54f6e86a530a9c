"""The ROS commands of the slides, for machines without ROS.

``cramhy ros-shims`` prints shell functions: ``eval "$(.venv/bin/cramhy ros-shims)"`` in bash, zsh, dash and other shells that read POSIX's
language, ``.venv/bin/cramhy ros-shims --shell fish | source`` in fish, and ``| Invoke-Expression`` in PowerShell (`shells`).
``cramhy ros-shims --install FOLDER`` writes them as programs. All of them call ``cramhy ros TOOL ...``, which is carried out here, by the
absolute path of this Python, so that they work where nothing of cramhy's is on the PATH. A real ROS on the PATH is left alone.
"""

from __future__ import annotations

import os
import shlex
import sys
from importlib import import_module
from pathlib import Path

from cramhy_runtime import storage
from cramhy_runtime.ros_tools import running

from . import shells
from .process_environment import missing, working_folder

_HOMES = {
    **dict.fromkeys(("catkin_create_pkg", "catkin_make", "rosls", "rospack", "rosversion", "roscd"), "workspace"),
    **dict.fromkeys(("roscore", "rosrun"), "programs"),
    "roslaunch": "launch",
}
TOOLS = (*(name for name in _HOMES if name != "roscd"), *running.TOOLS)
_OF_A_REAL_SHELL = ("roscd", "rosls")
"""What a real ROS defines as functions of the shell, which no other process sees; where it has ``rospack``, it has these."""
_MARK = "made by cramhy ros-shims"
_OURS = (_MARK, "cramhy_runtime")  # in the first lines of a program: a shim, or a script that pip has made


def run(folder=None, shell=None):
    """Print the functions, or install programs in ``folder``; the exit status. shell: one of `shells.FUNCTIONS`, or `shells.default`."""
    import shutil

    names = ["roslisp_repl", *TOOLS, "roscd"]
    real = [name for name in names if (found := shutil.which(name)) and not _is_ours(found)]
    if "rospack" in real:
        real += [name for name in _OF_A_REAL_SHELL if name not in real]
    if real:
        verb = "stay as they are" if len(real) > 1 else "stays as it is"
        print(
            f"cramhy: a ROS is installed here, so {', '.join(real)} {verb}. Those of cramhy are called like this: cramhy ros {real[-1]}",
            file=sys.stderr,
        )
    names = ["cramhy", *(name for name in names if name not in real)]
    if folder is None:
        define = shells.FUNCTIONS[shell or shells.default()]
        print("".join(define(name, words_of(name)) for name in names), end="")
        return 0
    return _install(Path(folder), [name for name in names if name != "roscd"])


def words_of(name):
    """The words of the program that the command ``name`` stands for: this Python by its absolute path, and what it shall run.

    ``-P`` keeps the current folder out of the search for modules, as in the script that pip makes.
    """
    words = [os.path.abspath(sys.executable), "-P", "-m", "cramhy_runtime.cli"]
    return words + {"cramhy": [], "roslisp_repl": ["repl", "--serve"]}.get(name, ["ros", name])


def _install(target, names):
    """Write the commands ``names`` as programs into the folder ``target``; the exit status. What others have put there stays."""
    strange = [name for name in names if os.path.lexists(target / name) and not _is_ours(target / name)]
    if strange:
        print(
            f"cramhy: {', '.join(str(target / name) for name in strange)} {'is' if len(strange) == 1 else 'are'} there already, and not "
            "from cramhy. Nothing was written. Choose another folder.",
            file=sys.stderr,
        )
        return 1
    # pip's scripts do the same, and stay
    names = [name for name in names if not os.path.lexists(target / name) or _MARK in _beginning(target / name)]
    try:
        with storage.Tree() as made:
            made.folder(target)
            for name in names:
                made.write(target / name, f'#!/bin/sh\n# {_MARK}\nexec {shlex.join(words_of(name))} "$@"\n', 0o777)
    except OSError as problem:
        print(f"cramhy: the programs cannot be written into {target}: {problem.filename}: {storage.why(problem)}", file=sys.stderr)
        return 1
    print(
        f"Wrote {', '.join(names)} into {target}. roscd changes the shell's folder, so it must be a shell function: "
        f"{shells.line(shlex.join(words_of('cramhy')))}"
    )
    return 0


def _is_ours(path):
    return any(mark in _beginning(path) for mark in _OURS)


def _beginning(path):
    try:
        with open(path, encoding="utf-8", errors="ignore") as file:
            return file.read(2000)
    except OSError:
        return ""


def meant(words):
    """What to say of a command line that begins with a ROS command instead of ``ros``, or ``None``. words: those after ``cramhy``."""
    if not words or words[0] not in (*TOOLS, "roscd", "roslisp_repl"):
        return None
    mine = own_name()
    meant = ["repl", *words[1:]] if words[0] == "roslisp_repl" else ["ros", *words]
    return (
        f"cramhy: {words[0]} is a command of ROS. Type: {mine} {shlex.join(meant)}\n"
        f"Or make it a command of this shell first: {shells.line(mine)}\n"
    )


def own_name():
    """How the user called cramhy, for a command to type: by its bare name where that finds it."""
    import shutil

    called = sys.argv[0]
    if os.path.basename(called) != "cramhy":  # a shell function, python -m
        return "cramhy"
    found = shutil.which("cramhy")
    return "cramhy" if found and os.path.realpath(found) == os.path.realpath(called) else shlex.quote(called)


def tool(name, arguments):
    """Do what the command ``name`` does; the exit status."""
    if name in running.TOOLS:
        return _graph_command([name, *arguments])
    if name not in _HOMES:
        print(f"cramhy: there is no command {name} here; there are {', '.join(TOOLS)} and roscd.", file=sys.stderr)
        return 2
    try:
        return getattr(import_module(f".{_HOMES[name]}", __package__), name)(arguments) or 0
    except OSError as problem:  # a folder that cannot be read, or written to
        if missing(problem):
            raise
        print(f"{name}: {working_folder() or f'{problem.filename}: {storage.why(problem)}'}", file=sys.stderr)
        return 1


def _graph_command(words):
    """A command on the graph of the session that serves on this machine."""
    from cramhy_runtime.ros_tools import remote_graph

    def write(text):
        sys.stdout.write(text)
        sys.stdout.flush()  # line by line, also into a pipe

    return running.run(words, running.Terminal(write, sys.stderr.write, remote_graph.current))
