"""A plugin for ``coverage``, which measures which lines of a plan have run: it knows the lines of ``.hy`` and ``.lisp`` files.

    [run]
    core = ctrace
    plugins = cramhy_runtime.coverage_plugin

in ``.coveragerc``, then ``coverage run -m hy FILE.hy`` (or ``-m cramhy_runtime.cli run FILE``, or ``-m pytest``), and
``coverage report -m``. The code that runs carries the places of the text. What coverage lacks without us is the list of the lines that
could have run.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path

from coverage import CoveragePlugin, FileReporter, FileTracer

_ENDINGS = (".hy", ".lisp")


class LispText(FileTracer):
    """Measures one file: what runs is what the code's own places say."""

    def __init__(self, filename):
        self.filename = filename

    def source_filename(self):
        return self.filename

    def line_number_range(self, frame):
        line = frame.f_lineno or -1  # some instructions belong to no line
        return line, line


class LispLines(FileReporter):
    """The lines of a file that could have run: those on which its code begins something."""

    def lines(self):
        path = Path(self.filename)
        return {line for code in _codes(path) for line in _lines(code)} & set(_lines_with_text(path))


class HyPlugin(CoveragePlugin):
    """Measures and reports the files with our endings, without those of cramhy itself."""

    def file_tracer(self, filename):
        return LispText(filename) if filename.endswith(_ENDINGS) and not _is_ours(filename) else None

    def file_reporter(self, filename):
        return LispLines(filename)

    def find_executable_files(self, src_dir):
        return (str(path) for ending in _ENDINGS for path in Path(src_dir).rglob(f"*{ending}") if not _is_ours(str(path)))


def _is_ours(filename):
    folders = [
        Path(__file__).parent / "libraries",
        *map(Path, getattr(importlib.util.find_spec("cramhy"), "submodule_search_locations", ())),
    ]
    return any(Path(filename).is_relative_to(folder) for folder in folders)


def _codes(path):
    """The code objects of a file: those that were kept when it ran, or what Hy makes of it."""
    from cramhy_runtime.session import boot

    boot()
    from cramhy_runtime.languages.commonlisp.systems import loader

    kept = loader.kept_codes(path)
    if kept is not None:
        return kept
    if path.suffix != ".hy":
        return []
    from cramhy_runtime.languages.kept_hy import Loader

    return [Loader(path.stem, str(path)).get_code(path.stem)]


def _lines(code):
    """The lines of a code object and of those in it."""
    yield from (line for _, _, line in code.co_lines() if line)
    for constant in code.co_consts:
        if isinstance(constant, type(code)):
            yield from _lines(constant)


def _lines_with_text(path):
    for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
        if line.strip() and not line.lstrip().startswith(";"):
            yield number


def coverage_init(registry, options):
    """Called by coverage, which was told of this module."""
    registry.add_file_tracer(HyPlugin())


__all__ = ["coverage_init"]
