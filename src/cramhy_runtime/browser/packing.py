"""Packs Python's packages for a tab: compiled by the Python that will run them. It runs in Pyodide, while a site is made.

A tab would take ten seconds to compile them. So everything is compiled here, at the place where the tab will unpack it. Files keep one
fixed time, because kept code of Lisp is stamped with the times of its sources (`systems.loader.stamp`), and Hy's bytecode with that of
its file.
"""

from __future__ import annotations

import importlib
import io
import py_compile
import sys
import tarfile
from pathlib import Path

TIME = 1_000_000_000  # s since 1970, of every file
SYSTEMS = ("cram_my_beginner_tutorial", "cram-my-beginner-tutorial")


def compile_all(folder: Path, packages: list[str]) -> None:
    """Compile all that Python, Hy and Lisp would compile when a session and the course's system are loaded. The caller has a stack of
    its own (``callPromising``), since a session starts a kernel."""
    sys.dont_write_bytecode = False
    for package in packages:
        for file in sorted((folder / package).rglob("*.py")):
            py_compile.compile(str(file), doraise=True, invalidation_mode=py_compile.PycInvalidationMode.UNCHECKED_HASH)
    importlib.import_module("hy")
    from .. import kernel
    from ..session.session import Session

    for file in sorted((folder / "cramhy").glob("*.hy")):
        importlib.import_module(f"cramhy.{file.stem}")
    session = Session(time="virtual")
    session.evaluate_text('(ros-load:load-system "{}" :{})'.format(*SYSTEMS))
    importlib.import_module("cramhy_runtime.browser.tab")
    kernel.stop()


def packed(folder: Path, packages: list[str]) -> bytes:
    """The packages with what was compiled, as a tar file: the same bytes for the same files."""
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode="w", format=tarfile.PAX_FORMAT) as target:
        files = [file for package in packages for file in (folder / package).rglob("*") if file.is_file()]
        for file in sorted(files, key=lambda file: (file.suffix, str(file))):  # what is alike stands together, and is packed more tightly
            entry = tarfile.TarInfo(str(file.relative_to(folder)))
            entry.size, entry.mtime = file.stat().st_size, TIME
            with file.open("rb") as content:
                target.addfile(entry, content)
    return buffer.getvalue()
