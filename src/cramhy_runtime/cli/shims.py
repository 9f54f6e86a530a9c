"""The ROS commands of the slides, for machines without ROS.

``cramhy ros-shims`` prints shell functions (``eval "$(cramhy ros-shims)"``), ``cramhy ros-shims --install FOLDER`` writes them as
programs; both call ``cramhy ros TOOL ...``, which is carried out here. A real ROS on the PATH is left alone.
"""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path

from cramhy_runtime.ros_tools import running

from .surroundings import missing, working_folder

_HOMES = {
    **dict.fromkeys(("catkin_create_pkg", "catkin_make", "rosls", "rospack", "rosversion", "roscd"), "workspace"),
    **dict.fromkeys(("roscore", "rosrun"), "programs"),
    "roslaunch": "launch",
}
TOOLS = (*(name for name in _HOMES if name != "roscd"), *running.TOOLS)
_MARK = "made by cramhy ros-shims"


def run(folder=None):
    """Print the shell functions, or install programs in ``folder``."""
    import shutil

    real = [tool for tool in TOOLS if (found := shutil.which(tool)) and not _is_ours(found)]
    tools = [tool for tool in TOOLS if tool not in real]
    if real:
        print(f"cramhy: a ROS is installed here, so {', '.join(real)} stay as they are.", file=sys.stderr)
    if folder is None:
        for tool in tools:
            print(f'{tool}() {{ cramhy ros {tool} "$@"; }}')
        print('roslisp_repl() { command roslisp_repl --serve "$@"; }')
        if shutil.which("roscd") is None:
            print('roscd() { local to; to="$(cramhy ros roscd "$@")" && cd "$to"; }')
        return 0
    target = Path(folder)
    try:
        target.mkdir(parents=True, exist_ok=True)
        for tool in tools:
            program = target / tool
            program.write_text(f'#!/bin/sh\n# {_MARK}\nexec "{sys.executable}" -m cramhy_runtime.cli ros {tool} "$@"\n')
            program.chmod(0o755)
    except OSError as problem:
        print(f"cramhy: the programs cannot be written into {target}: {problem.filename}: {problem.strerror}. Choose another folder.",
              file=sys.stderr)
        return 1
    print(f"Wrote {', '.join(tools)} into {target}. roscd changes the shell's folder, so it must be a shell function: "
          'eval "$(cramhy ros-shims)"')
    return 0


def _is_ours(path):
    try:
        return _MARK in Path(path).read_text(errors="ignore")[:200]
    except OSError:
        return False


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
        print(f"{name}: {working_folder() or f'{problem.filename}: {problem.strerror}'}", file=sys.stderr)
        return 1


def _graph_command(words):
    """A command on the graph of the session that serves on this machine."""
    from cramhy_runtime.ros_tools import there

    def write(text):
        sys.stdout.write(text)
        sys.stdout.flush()  # line by line, also into a pipe

    return running.run(words, running.Terminal(write, sys.stderr.write, there.current))
