"""What is not in a tab, and what somebody is told who asks for it there.

Some rooms and modules of cramhy need what WebAssembly does not have: processes, sockets, or packages that exist compiled for other machines
only. Other packages, such as numpy, are not in the site. `install` makes an import of one of them an error that says so, in place of "No
module named ...".
"""

from __future__ import annotations

import sys
from importlib.machinery import ModuleSpec

_PROGRAMS = "it talks with other programs, and there are none in a tab"
_MUJOCO = "it needs MuJoCo or numpy, which WebAssembly does not have here"
_PROCESSES = "it needs processes"

WHY = {
    "cli.browser_command": _PROCESSES,
    "cli.grading_commands": _PROCESSES,
    "cli.jupyter_command": _PROCESSES,
    "cli.keyboard": _PROCESSES,
    "cli.launch": _PROCESSES,
    "cli.lsp_command": _PROCESSES,
    "cli.options": _PROCESSES,
    "cli.programs": _PROCESSES,
    "cli.robot_address": _PROCESSES,
    "cli.servers": _PROCESSES,
    "cli.shells": _PROCESSES,
    "cli.shims": _PROCESSES,
    "cli.standalone_commands": _PROCESSES,
    "cli.swank_command": _PROCESSES,
    "cli.workspace": _PROCESSES,
    "coverage_plugin": _PROCESSES,
    "grading.fork_server": _PROCESSES,
    "grading.sandbox": _PROCESSES,
    "grading.watcher": _PROCESSES,
    "jupyter": _PROGRAMS,
    "lsp": _PROGRAMS,
    "robot_world.costmaps": _MUJOCO,
    "robot_world.physical": _MUJOCO,
    "rosbridge.attachment": _PROGRAMS,
    "rosbridge.connection": _PROGRAMS,
    "rosbridge.http": _PROGRAMS,
    "rosbridge.outbound_queue": _PROGRAMS,
    "rosbridge.processes": _PROGRAMS,
    "rosbridge.server": _PROGRAMS,
    "rosbridge.service_proxies": _PROGRAMS,
    "rosbridge.uplink": _PROGRAMS,
    "swank": _PROGRAMS,
}
"""For each room or module below `cramhy_runtime` why it is left out."""
ADVICE = 'Install cramhy on a computer for that; the page "Install" of its documentation says how.'
FILES = ("browser/static", "browser/editor", "view/static", "py.typed")
"""What stands beside the archive, or is of no use in it."""


def is_left_out(path: str) -> bool:
    """Whether a file is left out. path: below the folder of `cramhy_runtime`, with strokes."""
    places = [*FILES, *(name.replace(".", "/") for name in WHY)]
    return any(path == place or path == f"{place}.py" or path.startswith(f"{place}/") for place in places)


class _Absent:
    """Finds no module, and says why where it is one of `WHY`."""

    @staticmethod
    def find_spec(name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        room = name.removeprefix("cramhy_runtime.")
        if room != name and room in WHY:
            raise ImportError(f"{name} is not there in a browser's tab: {WHY[room]}. {ADVICE}", name=name)
        return None


class _Unknown:
    """Is asked last, for what nobody has found. Who only asks whether there is such a module (`importlib.util.find_spec`) is told none."""

    @staticmethod
    def find_spec(name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        if path is None and sys._getframe(2).f_code.co_name == "_find_and_load_unlocked":
            problem = ModuleNotFoundError(f"No module named '{name}': it is not part of this page.", name=name)
            problem.hint = ADVICE  # type: ignore[attr-defined]  # for Lisp
            problem.add_note(ADVICE)  # for Hy and Python
            raise problem
        return None


def install() -> None:
    """Tell of what is not there, from now on."""
    sys.meta_path.insert(0, _Absent)  # type: ignore[arg-type]
    sys.meta_path.append(_Unknown)  # type: ignore[arg-type]
