"""Makes one file of the editor and of CodeMirror, which it stands on: ``editor.js`` of the site. esbuild does that, at the time of making.

Both are packages of npm. `PACKAGES` says in which versions; ``webassembly/package-lock.json`` of a clone has their checksums, and
``make pyodide`` fetches them. Nothing here uses the network.
"""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

SOURCE = Path(__file__).with_name("editor") / "editor.js"
PACKAGES = {
    "@codemirror/autocomplete": "6.20.4",
    "@codemirror/commands": "6.11.1",
    "@codemirror/language": "6.13.1",
    "@codemirror/legacy-modes": "6.5.5",
    "@codemirror/state": "6.7.6",
    "@codemirror/view": "6.43.15",
    "@lezer/highlight": "1.2.5",
    "esbuild": "0.28.2",
}
"""Names of packages of npm and their versions."""


AUTHORS = ("@codemirror", "@lezer", "@marijn", "crelt", "style-mod", "w3c-keyname")
"""The packages, and folders of packages, of which something is in the file."""


class NoBundle(Exception):
    """The file cannot be made. The text says why and what to try."""


def check(folder: str | os.PathLike[str]) -> Path:
    """``folder`` as a path, if it has the `PACKAGES` in it, as a folder ``node_modules`` has. Errors: `NoBundle`."""
    folder = Path(folder)
    found = {name: _version(folder / name) for name in PACKAGES}
    unfit = [f"{name} {version}" for name, version in PACKAGES.items() if found[name] != version]
    if unfit:
        wanted = " ".join(f"{name}@{version}" for name, version in PACKAGES.items())
        raise NoBundle(
            f"The page's editor is made of packages of npm, and {folder} lacks {', '.join(unfit)}. In a clone of cramhy, type: make "
            f"pyodide. Elsewhere type, beside the package pyodide: npm install {wanted}"
        )
    return folder


def _version(package):
    try:
        return json.loads((package / "package.json").read_text(encoding="utf-8"))["version"]
    except (OSError, ValueError, KeyError, TypeError):
        return None


def bundle(node: str, folder: str | os.PathLike[str]) -> bytes:
    """The text of ``editor.js``. node: the path of a Node. folder: as for `check`. Errors: `NoBundle`."""
    folder = check(folder)
    done = subprocess.run(
        [node, str(folder / "esbuild" / "bin" / "esbuild"), str(SOURCE), "--bundle", "--minify", "--format=esm", "--target=es2022"],
        env={**os.environ, "NODE_PATH": str(folder.absolute())},
        capture_output=True,
    )
    if done.returncode:
        raise NoBundle(f"esbuild did not make the page's editor. It said:\n{done.stderr.decode(errors='replace')[-3000:]}")
    return done.stdout


def licenses(folder: str | os.PathLike[str]) -> str:
    """The licenses of the packages in the file, as their authors want them passed on. folder: as for `check`. Errors: `NoBundle`."""
    found = sorted(file for name in AUTHORS for file in (check(folder) / name).rglob("LICENSE"))
    return (
        "\n\n".join(f"{file.parent.relative_to(folder).as_posix()}\n\n{file.read_text(encoding='utf-8').strip()}" for file in found) + "\n"
    )
