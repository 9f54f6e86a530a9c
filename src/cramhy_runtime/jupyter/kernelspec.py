"""How Jupyter finds the kernel: a folder ``kernels/cramhy`` with the file ``kernel.json``.

The wheel brings this file for the environment that it is installed in. ``cramhy jupyter install`` writes it for other places.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
from pathlib import Path

from cramhy_runtime import storage

NAME = "cramhy"
SHOWN = "CRAM (Common Lisp, Hy)"


def described(python="python", time=None):
    """What ``kernel.json`` says.

    python: the Python that runs the kernel; ``"python"`` is that of Jupyter. time: what ``--time`` is given, or ``None``.
    """
    words = [python, "-m", "cramhy_runtime.cli", "jupyter", "kernel"]
    return {
        "argv": [*words, *(["--time", time] if time else []), "-f", "{connection_file}"],
        "display_name": SHOWN if time is None else f"{SHOWN}, {time} time",
        "language": "common-lisp",
        "interrupt_mode": "signal",
        "metadata": {"debugger": False},
    }


def folder(prefix=None, user=False):
    """The folder of the kernel below ``prefix``, or of this user, or of this environment."""
    if prefix is None and user:
        from jupyter_core.paths import jupyter_data_dir

        return Path(jupyter_data_dir()) / "kernels" / NAME
    return Path(prefix or sys.prefix) / "share" / "jupyter" / "kernels" / NAME


def install(prefix=None, user=False, time=None):
    """Write the kernel's description, and return the path of its file. Errors: `OSError`."""
    place = folder(prefix, user)
    place.mkdir(parents=True, exist_ok=True)
    storage.write_whole(str(place / "kernel.json"), json.dumps(described(sys.executable, time), indent=1).encode() + b"\n")
    return place / "kernel.json"


def uninstall(prefix=None, user=False):
    """Remove the kernel's folder; whether there was one. A folder that holds no description of ours is left. Errors: `OSError`."""
    place = folder(prefix, user)
    try:
        ours = "cramhy_runtime.cli" in json.loads((place / "kernel.json").read_text(encoding="utf-8"))["argv"]
    except (FileNotFoundError, NotADirectoryError):
        return False
    except (ValueError, KeyError, TypeError):
        ours = False
    if not ours:
        raise FileExistsError(17, "it is not cramhy's kernel", os.fspath(place))
    shutil.rmtree(place)
    return True
