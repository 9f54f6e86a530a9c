"""What of cramhy is not in a tab, and what somebody is told who asks for it there.

These rooms and modules need what WebAssembly does not have: processes, sockets, or packages that exist compiled for other machines only.
`install` makes an import of one of them an error that says so, in place of "No module named ...".
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
    "grading.cage": _PROCESSES,
    "jupyter": _PROGRAMS,
    "lsp": _PROGRAMS,
    "robot_world.costmaps": _MUJOCO,
    "robot_world.physical": _MUJOCO,
    "rosbridge.attachment": _PROGRAMS,
    "rosbridge.connection": _PROGRAMS,
    "rosbridge.http": _PROGRAMS,
    "rosbridge.outbound_queue": _PROGRAMS,
    "rosbridge.processes": _PROGRAMS,
    "rosbridge.remote_types": _PROGRAMS,
    "rosbridge.server": _PROGRAMS,
    "rosbridge.service_proxies": _PROGRAMS,
    "rosbridge.uplink": _PROGRAMS,
    "swank": _PROGRAMS,
}
"""For each room or module below `cramhy_runtime` why it is left out."""
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
            raise ImportError(f"{name} is not there in a browser's tab: {WHY[room]}. Install cramhy on a computer for that.", name=name)
        return None


def install() -> None:
    """Tell of what is not there, from now on."""
    sys.meta_path.insert(0, _Absent)  # type: ignore[arg-type]
