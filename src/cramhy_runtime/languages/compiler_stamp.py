"""A fingerprint of what compiles: cramhy, its passes, its macros, and Python. Code that others have compiled is not used."""

from __future__ import annotations

import contextlib
import functools
import importlib.util
import os
import sys
from pathlib import Path

from cramhy_runtime.storage import kept_code
from cramhy_runtime.storage.checksummed_code import Unusable


@functools.cache
def stamp():
    """The fingerprint, 64 characters. It is the same wherever cramhy stands, so that the wheel can bring kept files along.

    What is read for it is kept, too.
    """
    from cramhy_runtime.storage.digests import sha256  # a prompt that loads nothing does without it

    files = [(folder.name, entry) for folder in _compiling_folders() for entry in sorted(os.scandir(folder), key=lambda entry: entry.name)]
    files = [(folder, entry) for folder, entry in files if entry.name.endswith((".py", ".pyc", ".hy", ".lisp"))]  # .pyc: in a tab
    passes = os.environ.get("CRAMHY_PASSES", "")
    python = f"{sys.implementation.cache_tag} {importlib.util.MAGIC_NUMBER.hex()}{passes and f' {passes}.'}"
    states = [(entry.path, entry.stat()) for _, entry in files]
    text = "".join([python, *(f"{path} {status.st_mtime_ns} {status.st_size} " for path, status in states)])
    state = sha256(text.encode(errors="surrogatepass")).hexdigest()
    place = Path(__file__).with_name("stamp")
    with contextlib.suppress(Unusable):
        return kept_code.find(place, state)
    digest = sha256(python.encode())
    for folder, entry in files:
        data = Path(entry.path).read_bytes()
        digest.update(f"{folder}/{entry.name} {len(data)} ".encode(errors="surrogatepass") + data)
    made = digest.hexdigest()
    kept_code.keep(place, state, made)
    return made


def _compiling_folders():
    """The folders with what compiles, in an order that depends on their names only."""
    languages = Path(__file__).parent
    lisp, libraries, lisp_core = languages / "commonlisp", languages.parent / "libraries", languages.parent / "lisp_core"
    inside = [
        Path(entry)
        for room in (lisp, lisp / "compiler", lisp / "faces", libraries, lisp_core)
        for entry in os.scandir(room)
        if entry.is_dir() and entry.name != "__pycache__"
    ]
    folders = [lisp, lisp_core, languages / "operators", languages / "hy", *sorted(inside, key=lambda folder: folder.parts)]
    language = importlib.util.find_spec("cramhy")
    return folders + [Path(folder) for folder in (language and language.submodule_search_locations or ())]


__all__ = ["stamp"]
