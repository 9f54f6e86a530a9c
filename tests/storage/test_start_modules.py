"""The bytecode of the modules that a session starts with is kept in one file, and used only while it is what Python would read."""

from __future__ import annotations

import importlib
import json
import marshal
import os
import shutil
import subprocess
import sys
import zlib
from importlib.machinery import PathFinder
from pathlib import Path

import pytest

import cramhy_runtime
from cramhy_runtime.cli import start_modules
from cramhy_runtime.storage.kept_files import kept_path

ROOT = Path(__file__).parents[2]


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package ``cramhy_runtime.trial`` of two modules, and the modules of a start that is over: those two."""
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    folder = tmp_path / "trial"
    folder.mkdir()
    folder.chmod(0o755)
    (folder / "__init__.py").write_text("from . import part\n")
    (folder / "part.py").write_text("value = 1\n\ndef fail():\n    raise ValueError\n")
    monkeypatch.setattr(cramhy_runtime, "__path__", [str(tmp_path)])
    monkeypatch.setattr(cramhy_runtime, "__file__", str(tmp_path / "__init__.py"))
    monkeypatch.setattr(start_modules, "_Start", type("Start", (), {"finder": None, "wanted": None}))
    monkeypatch.setattr(cramhy_runtime, "__spec__", PathFinder.find_spec("cramhy_runtime", [str(ROOT / "src")]))
    meta_path = list(sys.meta_path)
    sys.meta_path[:] = [found for found in meta_path if "pytest" not in type(found).__module__]  # it would load modules of plugins its way
    yield folder
    sys.meta_path[:] = meta_path
    forget()


def forget():
    for name in [name for name in sys.modules if name.startswith("cramhy_runtime.trial")]:
        del sys.modules[name]
    cramhy_runtime.__dict__.pop("trial", None)
    importlib.invalidate_caches()


def started():
    """Import the package as a process does that starts; the module ``part``."""
    forget()
    start_modules._Start.finder = start_modules._Start.wanted = None
    start_modules.install()
    importlib.import_module("cramhy_runtime.trial")
    start_modules.note()
    start_modules._Start.wanted = [name for name in start_modules._Start.wanted if name.startswith("cramhy_runtime.trial")]
    start_modules.keep()
    return sys.modules["cramhy_runtime.trial.part"]


def kept():
    return kept_path(start_modules._source())


def from_the_file(module):
    return type(module.__spec__.loader) is start_modules._Loader


def test_the_second_start_finds_the_modules_in_the_file(package):
    assert not from_the_file(started())
    assert kept() == package.parent / "__pycache__" / f"start.{sys.implementation.cache_tag}.cramhy" and kept().is_file()
    before = kept().stat().st_mtime_ns
    again = started()
    assert from_the_file(again) and again.value == 1
    assert (again.__file__, again.__cached__) == (str(package / "part.py"), again.__spec__.cached)
    assert sys.modules["cramhy_runtime.trial"].__path__ == [str(package)]
    assert again.__loader__.get_source("cramhy_runtime.trial.part").startswith("value = 1")
    with pytest.raises(ValueError) as caught:
        again.fail()
    assert caught.traceback[-1].path == package / "part.py" and "raise" in str(caught.traceback[-1].statement)
    assert kept().stat().st_mtime_ns == before, "nothing has changed, so nothing is written"


@pytest.mark.parametrize("change", ["value = 22\n", "value = 2\n\ndef fail():\n    raise ValueError\n"])
def test_a_source_that_has_changed_is_compiled(package, change):
    """By its date, too, where the size is the same."""
    started()
    (package / "part.py").write_text(change)
    os.utime(package / "part.py", (1e9, 1e9))
    changed = started()
    assert not from_the_file(changed) and changed.value in (2, 22)
    again = started()
    assert from_the_file(again) and again.value == changed.value


def test_a_source_that_is_gone_is_no_module(package):
    started()
    (package / "part.py").unlink()
    with pytest.raises(ImportError, match="part"):
        started()


def cut_off(length):
    return lambda data: data[:length] if length >= 0 else data[: len(data) // 2]


def content(change):
    """The file with what ``change`` makes of its index."""

    def spoil(data):
        begin = len(start_modules.FIRST_LINE) + start_modules.SIZES.size
        rest = change(marshal.loads(data[begin:]))
        return start_modules.FIRST_LINE + start_modules.SIZES.pack(len(rest), len(rest), zlib.crc32(rest)) + rest

    return spoil


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    "spoil",
    [
        *map(cut_off, (0, 5, 25, 33, -1)),
        lambda data: data + b"x",
        lambda data: b"# another file of bytecode\n" + data,
        content(lambda found: marshal.dumps(("3.9.0 of another machine", found[1]))),
        content(lambda found: marshal.dumps([1, 2, 3])),
        content(lambda found: b"this is not marshal"),
        content(lambda found: b""),
    ],
)
def test_a_file_that_is_damaged_or_of_another_python_is_made_anew(package, spoil):
    started()
    good = kept().read_bytes()
    kept().write_bytes(spoil(good))
    assert not from_the_file(started())
    assert kept().read_bytes() == good and from_the_file(started())


@pytest.mark.soak
def test_no_flipped_bit_is_run(package):
    """Wherever it is: the start is as ever, and the file is as it was after it."""
    started()
    good = kept().read_bytes()
    for place in range(0, len(good), 7):
        kept().write_bytes(good[:place] + bytes([good[place] ^ 1 << place % 8]) + good[place + 1 :])
        assert started().value == 1
        assert kept().read_bytes() == good, place


def test_a_file_that_others_may_have_written_is_not_read(package):
    started()
    kept().chmod(0o666)
    assert not from_the_file(started())


def test_where_nothing_can_be_written_python_reads_its_own_bytecode(package, monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", "/dev/null/nowhere")
    real = os.access
    monkeypatch.setattr(os, "access", lambda path, mode: mode != os.W_OK and real(path, mode))
    assert not from_the_file(started()) and started().value == 1


def test_python_that_shall_write_no_bytecode_writes_none(package, monkeypatch):
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    started()
    assert not kept().exists()


@pytest.mark.soak
def test_the_command_line_keeps_what_it_starts_with(tmp_path):
    for folder in ("src/cramhy_runtime", "hy_src/cramhy"):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=shutil.ignore_patterns("*.cramhy", "tutorials"))
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment["PYTHONPATH"] = os.pathsep.join([str(tmp_path / "src"), str(tmp_path / "hy_src")])
    environment["XDG_CACHE_HOME"] = str(tmp_path / "cache")
    program = (
        "import atexit, sys\n"
        "from cramhy_runtime import cli\n"
        "loaders = lambda: [type(module.__spec__.loader).__module__ for name, module in sys.modules.items() if '_runtime.' in name]\n"
        "atexit.register(lambda: print(loaders().count('cramhy_runtime.cli.start_modules') > 400))\n"
        "sys.exit(cli.main(['eval']))"
    )
    for found in ("False", "True"):
        done = subprocess.run(
            [sys.executable, "-c", program], cwd=tmp_path, env=environment, capture_output=True, text=True, input='{"form": "(+ 1 2)"}\n'
        )
        answer, kept_ones = done.stdout.splitlines()
        assert (json.loads(answer)["values"], kept_ones, done.stderr, done.returncode) == (["3"], found, "", 0)
    assert not list((tmp_path / "src").rglob("*.cramhy")), "what cramhy keeps of itself is in the user's cache folder"
    assert list((tmp_path / "cache" / "cramhy").glob("*-start.*.cramhy"))
