"""The bytecode of the modules that a session starts with, in one file, which Python reads faster than five hundred.

Python looks for each module in the folders of its package, asks when the source was changed, and opens the file with its bytecode. That is
half of the time that a session takes to start. `install` lets Python find the modules of cramhy in one file instead. What it finds there is
the bytecode that Python itself would have read, and is used under the same condition: the source has still the date and the size that
stand in it. All else is as ever: each module has its own file, loader and text.

`note` says that the start is over, or how far it is: those modules are kept that are there by then. `keep` writes them, when the session
ends, if the file lacks one of them. A file that is cut off, or was made by another Python, is as good as none.
"""

from __future__ import annotations

import importlib.util
import marshal
import os
import struct
import sys
import zlib
from importlib.machinery import ModuleSpec, SourceFileLoader
from pathlib import Path

import cramhy_runtime
from cramhy_runtime.storage.checksummed_code import Unusable, trusted_bytes
from cramhy_runtime.storage.kept_files import keep as keep_file
from cramhy_runtime.storage.kept_files import drop_old, kept_path

FIRST_LINE = b"# cramhy start modules 4\n"
SIZES = struct.Struct("<QII")
"""What follows the first line: how long the rest is, how long the index is with which it begins, and the checksum of the index."""
_PACKAGE = cramhy_runtime.__name__
_HEADER = 16  # bytes before the code in a file of bytecode


class _Loader(SourceFileLoader):
    """Loads a module whose bytecode is at hand."""

    def __init__(self, name, path, bytecode):
        super().__init__(name, path)
        self._bytecode = bytecode

    def get_code(self, fullname):
        code, self._bytecode = marshal.loads(self._bytecode[_HEADER:]), None
        return code


class Finder:
    """Finds the modules of cramhy that are kept. Python asks it first, as one of ``sys.meta_path``.

    root: the folder of cramhy's package. modules: name → (path of the source below ``root``, where Python keeps its bytecode, the bytes
    that are there, their checksum). A flipped bit in bytecode can end Python itself, so what does not fit its checksum is made anew.
    """

    def __init__(self, root, modules):
        self.root, self.modules = root, modules
        self.outdated = False

    def find_spec(self, name, path=None, target=None):
        kept = self.modules.get(name)
        if kept is None:
            return None
        place, cached, bytecode, checksum = kept
        origin = f"{self.root}{os.sep}{place}"
        try:
            if bytecode[:_HEADER] != _header(os.stat(origin)) or zlib.crc32(bytecode) != checksum:
                raise FileNotFoundError
        except OSError:
            self.outdated = True
            return None
        spec = ModuleSpec(name, _Loader(name, origin, bytecode), origin=origin)
        spec.has_location, spec.cached = True, cached  # Python would put the second together anew
        if place.endswith("__init__.py"):
            spec.submodule_search_locations = [os.path.dirname(origin)]
        return spec


def _header(status):
    """How a file of bytecode begins that belongs to the source with that status, unless it was made by a hash of the source."""
    return importlib.util.MAGIC_NUMBER + struct.pack("<3I", 0, int(status.st_mtime) & 0xFFFFFFFF, status.st_size & 0xFFFFFFFF)


class _Start:
    """What is known of the start of this process."""

    finder = None
    wanted: list | None = None
    """The names of the modules that were there when the start was over."""


def _source():
    """The file by which the kept one is named."""
    return Path(cramhy_runtime.__file__).parent / "start"


def _maker(root):
    return f"{sys.version} {sys.flags.optimize} {sys.pycache_prefix} {root}"


def install():
    """Let Python find modules in the kept file, if there is one that can be used."""
    root = os.path.dirname(cramhy_runtime.__file__)
    if _Start.finder is not None or not isinstance(cramhy_runtime.__spec__.loader, SourceFileLoader):
        return
    _Start.finder = Finder(root, _read(root))
    sys.meta_path.insert(0, _Start.finder)


def _read(root):
    try:
        data = memoryview(trusted_bytes(kept_path(_source()), mapped=True))
        begin, end = len(FIRST_LINE) + SIZES.size, len(data)
        length, of_index, checksum = SIZES.unpack(data[begin - SIZES.size : begin])
        found = data[begin : begin + of_index]
        if data[: len(FIRST_LINE)] == FIRST_LINE and end - begin == length and zlib.crc32(found) == checksum:
            maker, index = marshal.loads(found)
            if maker == _maker(root):
                return {
                    name: (place, cached, data[end - start : end - stop], crc) for name, (place, cached, start, stop, crc) in index.items()
                }
    except (Unusable, OSError, ValueError, EOFError, TypeError, struct.error):
        pass
    return {}


def note(over=True):
    """The session has started. over: whether it has all that it starts with."""
    if _Start.finder in sys.meta_path:
        if over:
            sys.meta_path.remove(_Start.finder)  # what comes later is not in the file
        _Start.wanted = [name for name in sys.modules if name.startswith(f"{_PACKAGE}.")]


def keep():
    """Write the modules that `note` has noted, if the file lacks any, or has one that has changed."""
    finder, wanted = _Start.finder, _Start.wanted
    if finder is None or wanted is None or not finder.outdated and finder.modules.keys() >= set(wanted):
        return
    _Start.wanted = None
    names = sorted({*wanted, *finder.modules})
    keep_file(_source(), lambda: _written(finder.root, {name: kept for name in names if (kept := _bytecode(finder, name))}))
    drop_old(".cramhy")  # of a cramhy that is gone


def _bytecode(finder, name):
    """What is kept of the module ``name`` (see `Finder`), with its bytecode as Python has written it; ``None`` if there is none."""
    module = sys.modules.get(name)
    if module is None:
        return finder.modules.get(name)  # of another command
    spec = getattr(module, "__spec__", None)
    try:
        bytecode = Path(spec.cached).read_bytes()
        if isinstance(spec.loader, SourceFileLoader) and bytecode[:_HEADER] == _header(os.stat(spec.origin)):
            return os.path.relpath(spec.origin, finder.root), spec.cached, bytecode, zlib.crc32(bytecode)
    except (OSError, TypeError, ValueError, AttributeError):
        pass
    return None


def _written(root, modules):
    """The file. An index tells of each module where its bytecode begins and ends, counted from the end of the file."""
    left, index = sum(len(bytecode) for _, _, bytecode, _ in modules.values()), {}
    for name, (place, cached, bytecode, checksum) in modules.items():
        index[name] = place, cached, left, left - len(bytecode), checksum
        left -= len(bytecode)
    head = marshal.dumps((_maker(root), index))
    rest = b"".join([head, *(bytecode for _, _, bytecode, _ in modules.values())])
    return FIRST_LINE + SIZES.pack(len(rest), len(head), zlib.crc32(head)) + rest


__all__ = ["install", "keep", "note"]
