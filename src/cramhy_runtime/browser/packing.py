"""Packs Python's packages for a tab: compiled by the Python that will run them. It runs in Pyodide, while a site is made.

A tab would take ten seconds to compile them. So everything is compiled here, at the place where the tab will unpack it. Sources that are
compiled stay away, since they would be a third of what is fetched. Files keep one fixed time, because kept code of Lisp is stamped with the
times of its sources (`languages.compiler_stamp`), and Hy's bytecode with that of its file.

Pyodide brings Python's own library as sources in a zip file. To compile those that a session needs took most of the time until the first
prompt. `Library` divides them: `boot` has, compiled, what Python needs before it can unpack anything, and the rest goes to the packages.
"""

from __future__ import annotations

import ast
import importlib
import importlib.util
import io
import json
import re
import sys
import zipfile
from importlib import _bootstrap_external
from pathlib import Path

TIME = 1_000_000_000  # s since 1970, of every file
SYSTEMS = ("cram_my_beginner_tutorial", "cram-my-beginner-tutorial")
OURS = ("cramhy", "cramhy_runtime")
"""The packages whose docstrings users read."""
AS_TEXT = "cramhy_runtime/tutorials"
"""A folder whose files in Python users read, or graders run."""
NO_USE = {
    *("_pyrepl", "getpass", "pty", "tty"),  # no terminal
    *("multiprocessing", "socketserver", "webbrowser"),  # no processes, no windows
    *("ftplib", "http", "imaplib", "mailbox", "poplib", "smtplib", "netrc", "wsgiref", "xmlrpc"),  # no sockets
    *("_pydatetime", "_pyio", "ctypes", "pickletools"),  # what is there in C, and what looks into C
    *("__hello__", "__phello__", "antigravity", "modulefinder", "pyclbr", "tabnanny", "zipapp"),
}
"""Modules of Python's library that can do nothing in a tab, or that no program imports."""
ENCODINGS = re.compile(
    r"encodings/(__init__|_|aliases|ascii|charmap|utf|latin|iso8859_1\b|iso8859_(2|15)|cp(437|850|125[0-4])|unicode|raw|undef|idna|puny|.*_codec|rot)"
)
"""The encodings that stay: those of Europe, and those that are none of texts. The tables of the others are a quarter of a megabyte."""


def compile_all(folder: Path, packages: list[str]) -> None:
    """Compile all that Python, Hy and Lisp would compile when a session and the course's system are loaded. The caller has a stack of
    its own (``callPromising``), since a session starts a kernel."""
    for package in packages:
        for file in sorted((folder / package).rglob("*.py")):
            if not file.is_relative_to(folder / AS_TEXT):
                file.with_suffix(".pyc").write_bytes(compiled(file.read_bytes(), str(file), package in OURS))
                file.unlink()
    sys.path_importer_cache.clear()  # the files have other names now
    sys.dont_write_bytecode = False
    importlib.import_module("hy")
    from .. import kernel
    from ..session.session import Session
    from ..storage import kept_files

    for file in sorted((folder / "cramhy").glob("*.hy")):
        importlib.import_module(f"cramhy.{file.stem}")
    kept_files.keep_own_beside()  # as a tab finds it
    session = Session(time="virtual")
    session.evaluate_text('(ros-load:load-system "{}" :{})'.format(*SYSTEMS))
    importlib.import_module("cramhy_runtime.browser.tab")
    kernel.stop()


def compiled(source: bytes, filename: str, documented: bool) -> bytes:
    """The content of a file of bytecode. filename: for tracebacks. documented: whether docstrings stay in it.

    It has lines and no columns. Those would underline words of a source that is not there, and are a sixth of the size.
    """
    tree = ast.parse(source, filename)
    if not documented:
        _without_docstrings(tree)
    for node in ast.walk(tree):
        if hasattr(node, "lineno"):
            node.end_lineno, node.col_offset, node.end_col_offset = node.lineno, -1, -1
    code = compile(tree, filename, "exec", dont_inherit=True)
    return bytes(_bootstrap_external._code_to_hash_pyc(code, importlib.util.source_hash(source), False))  # type: ignore[attr-defined]


def _without_docstrings(tree):
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef)
            and ast.get_docstring(node, False) is not None
        ):
            node.body[:1] = [] if len(node.body) > 1 else [ast.copy_location(ast.Pass(), node.body[0])]


def packed(folder: Path, packages: list[str], library: dict[str, bytes]) -> bytes:
    """The packages with what was compiled, and Python's library, for ``unpacking.mjs``: the same bytes for the same files.

    First come four bytes with the length of a list, the highest first, then the list: pairs of a name and a size, as JSON. Then come the
    contents of the files in that order. (Python takes a second in a tab to unpack a tar file.)

    folder: where the packages are. library: see `Library.rest`. Names begin where Python's library is.
    """
    files = [file for package in packages for file in (folder / package).rglob("*") if file.is_file()]
    content = {f"{folder.name}/{file.relative_to(folder)}": file.read_bytes() for file in files} | library
    names = sorted(content, key=lambda name: (Path(name).suffix, name))  # what is alike stands together, and is packed more tightly
    index = json.dumps([(name, len(content[name])) for name in names]).encode()
    return b"".join([len(index).to_bytes(4, "big"), index, *(content[name] for name in names)])


class Library:
    """Python's library.

    path: the zip file in which Pyodide brings it. begun: the names of the modules that Python has loaded when it begins, and to unpack.
    """

    def __init__(self, path: str, begun: set[str]):
        self.path = path
        with zipfile.ZipFile(path) as source:
            names = [name for name in source.namelist() if not name.endswith("/")]
            self.files = {name: source.read(name) for name in names if _is_of_use(name)}
        self.first = {name.partition("/")[0] for name in self._loaded(begun)}
        """The files and folders at the top that have some of those."""

    def _loaded(self, names):
        """The files of the modules with these names."""
        origins = [str(getattr(getattr(sys.modules.get(name), "__spec__", None), "origin", None)) for name in names]
        return {origin.removeprefix(f"{self.path}/") for origin in origins if origin.startswith(f"{self.path}/")}

    def _compiled(self, chosen):
        """What Python has loaded by now as bytecode, and the others as they are."""
        loaded, made = self._loaded(list(sys.modules)), {}
        for name in sorted(filter(chosen, self.files)):
            if name in loaded and name.endswith(".py"):
                made[f"{name}c"] = compiled(self.files[name], f"{self.path}/{name}", False)
            else:
                made[name] = self.files[name]
        return made

    def boot(self) -> bytes:
        """A zip file, not compressed, with what Python needs to begin."""
        buffer = io.BytesIO()
        with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as target:
            for name, content in self._compiled(lambda name: name.partition("/")[0] in self.first).items():
                target.writestr(zipfile.ZipInfo(name), content)
        return buffer.getvalue()

    def rest(self) -> dict[str, bytes]:
        """The other files, without those of no use, by name."""
        return self._compiled(lambda name: name.partition("/")[0] not in self.first)


def _is_of_use(name):
    if name.startswith("encodings/"):
        return ENCODINGS.match(name) is not None
    return name.partition("/")[0].removesuffix(".py") not in NO_USE
