"""The files of Pyodide: which of them a session needs, in which version, and what is mended in them.

The back end "jspi" of the kernel depends on how Pyodide suspends stacks, so the version is pinned. Pyodide is published on npm, as the
package ``pyodide``. Nothing here uses the network: `copied` takes the folder into which npm, or a person, has unpacked the package.

One thing is mended. The collector of Python 3.14 walks the frames of all thread states, and Pyodide gives each suspended stack one. These
frames lie partly in C's part of the stack, which is other code's while the stack is suspended, so the collector killed Python within
seconds (pyodide#6464). Pyodide's pull request #6466 mends it, in no version on npm yet. Until then a suspended state shows no frames:
saving a state takes `current_frame` out of it, and restoring puts it back.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

VERSION = "314.0.7"
FETCHED = Path(__file__).parents[3] / "webassembly" / "node_modules"
"""Where ``make pyodide`` puts Pyodide and Node, in a clone of cramhy."""
FILES = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json")
"""What a browser or Node loads: Pyodide, its Python, and the library of that. The lock file says that no other package is there."""
LARGE = ("pyodide.asm.wasm", "python_stdlib.zip")
"""Those that the worker of a page unpacks by itself."""
CURRENT_FRAME = 52
"""Where `current_frame` lies in Python 3.14's `PyThreadState` of 32 bit, in bytes."""

_FRAME = f"threadState+{CURRENT_FRAME}>>>2"
MENDED = (
    (
        "const stackState=new StackState;return{threadState,stackState,suspender:suspenderGlobal.value}}",
        f"const stackState=new StackState;const frame=HEAPU32[{_FRAME}];HEAPU32[{_FRAME}]=0;"
        "return{threadState,stackState,frame,suspender:suspenderGlobal.value}}",
    ),
    (
        "state.stackState.restore();_restoreThreadState(state.threadState);",
        f"state.stackState.restore();HEAPU32[state.{_FRAME}]=state.frame;_restoreThreadState(state.threadState);",
    ),
)
"""Texts of ``pyodide.asm.mjs``, each of which occurs in it once, and what takes their place."""


class UnfitPyodide(Exception):
    """The folder does not hold the Pyodide that this version of cramhy is made for. The text says what to do."""


def mended(text: str) -> str:
    """The text of ``pyodide.asm.mjs`` with suspended stacks hidden from the collector. Errors: `UnfitPyodide`."""
    for before, after in MENDED:
        if text.count(before) != 1:
            raise UnfitPyodide(
                f"pyodide.asm.mjs is not that of Pyodide {VERSION}: a passage that has to be changed occurs {text.count(before)} times and "
                f"not once. Take the package pyodide {VERSION} of npm, as it is."
            )
        text = text.replace(before, after)
    return text


def version(folder: Path) -> str | None:
    """The version of the package in ``folder``, or None if there is no package ``pyodide``."""
    try:
        said = json.loads((folder / "package.json").read_text(encoding="utf-8"))
        return said["version"] if said["name"] == "pyodide" else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def check(folder: str | os.PathLike[str]) -> Path:
    """``folder`` as a path, if it holds the package ``pyodide`` of npm in `VERSION`. Errors: `UnfitPyodide`."""
    folder = Path(folder)
    advice = f"Fetch it with: npm pack pyodide@{VERSION}, and unpack that; or in a clone of cramhy: make pyodide."
    found = version(folder)
    if found is None:
        raise UnfitPyodide(f"There is no Pyodide in {folder}: its package.json is missing, or is not that of the package pyodide. {advice}")
    if found != VERSION:
        raise UnfitPyodide(f"{folder} holds Pyodide {found}, and cramhy needs {VERSION}. {advice}")
    missing = [name for name in FILES if not (folder / name).is_file()]
    if missing:
        raise UnfitPyodide(f"{folder} lacks {', '.join(missing)} of Pyodide {VERSION}. {advice}")
    return folder


def copied(folder: str | os.PathLike[str], target: str | os.PathLike[str]) -> Path:
    """Copy the Pyodide of ``folder`` into the folder ``target``, which is made, with `mended` applied. Returns ``target`` as a path.

    Errors: `UnfitPyodide` if ``folder`` does not hold it; `OSError`.
    """
    source, target = check(folder), Path(target)
    target.mkdir(parents=True, exist_ok=True)
    for name in FILES:
        content = (source / name).read_bytes()
        if name == "pyodide.asm.mjs":
            content = mended(content.decode()).encode()
        elif name == "pyodide-lock.json":
            content = json.dumps({**json.loads(content), "packages": {}}).encode()  # what else could be loaded is not there
        (target / name).write_bytes(content)
    return target
