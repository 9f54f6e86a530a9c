"""What a tab fetches: packages without sources that are compiled, a part of Python's library, and nothing that no tab can use."""

from __future__ import annotations

import importlib
import importlib.util
import json
import marshal
import sys
import zipfile
from pathlib import Path

import pytest

import cramhy_runtime
from cramhy_runtime.browser import left_out, packing

HOUSE = Path(cramhy_runtime.__file__).parent
SOURCE = b'''"""The module."""
class Thing:
    """A class."""
    def method(self):
        """A method."""
async def function(): "A function."
def fail(): "Fails."; assert False, "it fails"
'''


def run(data):
    """The names of a module whose bytecode is ``data``."""
    names = {"__name__": "module"}
    exec(marshal.loads(data[16:]), names)
    return names


def test_bytecode_of_others_has_no_docstrings_and_ours_has_them():
    for documented in (True, False):
        names = run(packing.compiled(SOURCE, "/lib/module.py", documented))
        texts = [each.__doc__ for each in (names["Thing"], names["Thing"].method, names["function"], names["fail"])]
        assert (texts == ["A class.", "A method.", "A function.", "Fails."]) is documented and (not any(texts)) is not documented
        with pytest.raises(AssertionError, match="it fails") as failed:
            names["fail"]()
        place = failed.traceback[-1]
        assert (str(place.path), place.lineno + 1) == ("/lib/module.py", 7)


def test_bytecode_has_no_columns_and_is_taken_without_a_source(tmp_path, monkeypatch):
    data = packing.compiled(SOURCE, str(tmp_path / "packed_module.py"), True)
    assert {place[2:] for place in marshal.loads(data[16:]).co_positions()} <= {(None, None), (0, 0)}  # RESUME has zeros
    (tmp_path / "packed_module.pyc").write_bytes(data)
    monkeypatch.syspath_prepend(str(tmp_path))
    try:
        assert importlib.import_module("packed_module").Thing.__doc__ == "A class."
    finally:
        sys.modules.pop("packed_module", None)


def test_the_archive_has_its_list_first(tmp_path):
    folder = tmp_path / "site-packages"
    for name, text in (("a/b.pyc", "code"), ("a/c.hy", "(hy)"), ("other/d.py", "no")):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    data = packing.packed(folder, ["a"], {"random.py": b"library"})
    length = int.from_bytes(data[:4], "big")
    assert json.loads(data[4 : 4 + length]) == [["site-packages/a/c.hy", 4], ["random.py", 7], ["site-packages/a/b.pyc", 4]]
    assert data[4 + length :] == b"(hy)librarycode"
    assert packing.packed(folder, ["a"], {"random.py": b"library"}) == data


def test_pythons_library_is_divided_into_what_begins_and_the_rest(tmp_path, monkeypatch):
    path = tmp_path / "library.zip"
    names = ("first_/__init__.py", "first_/part.py", "used_.py", "plain_.py", "smtplib.py", "http/client.py", "encodings/cp1252.py")
    with zipfile.ZipFile(path, "w") as target:
        for name in (*names, "encodings/cp037.py", "first_/data.txt"):
            target.writestr(name, "NUMBER = 1\n")
    monkeypatch.syspath_prepend(str(path))
    try:
        importlib.import_module("first_")
        library = packing.Library(str(path), set(sys.modules))
        importlib.import_module("used_")
        assert sorted(library.rest()) == ["encodings/cp1252.py", "plain_.py", "used_.pyc"]
        (tmp_path / "boot.zip").write_bytes(library.boot())
        with zipfile.ZipFile(tmp_path / "boot.zip") as boot:
            assert boot.namelist() == ["first_/__init__.pyc", "first_/data.txt", "first_/part.py"]
            assert run(boot.read("first_/__init__.pyc"))["NUMBER"] == 1
    finally:
        for name in ("first_", "used_"):
            sys.modules.pop(name, None)


# ---------------------------------------------------------------------------------------------------------------- what is left out


@pytest.mark.parametrize("name", left_out.WHY)
def test_what_is_left_out_is_there_on_a_computer(name):
    place = HOUSE / name.replace(".", "/")
    (path,) = [each for each in (place.with_suffix(".py"), place / "__init__.py") if each.exists()]
    assert left_out.is_left_out(path.relative_to(HOUSE).as_posix())


def test_what_a_tab_uses_is_not_left_out():
    needed = ("__init__", "cli/__init__", "cli/live_page", "browser/tab", "rosbridge/protocol", "robot_world/shown", "swanky")
    assert [name for name in needed if left_out.is_left_out(f"{name}.py")] == []


def test_an_import_of_what_is_left_out_says_why(monkeypatch):
    monkeypatch.setattr(sys, "meta_path", list(sys.meta_path))
    for name in [name for name in sys.modules if name.startswith("cramhy_runtime.swank")]:
        monkeypatch.delitem(sys.modules, name)
    left_out.install()
    with pytest.raises(ImportError) as refused:
        importlib.import_module("cramhy_runtime.swank.connection")
    assert str(refused.value) == (
        "cramhy_runtime.swank is not there in a browser's tab: it talks with other programs, and there are none in a tab. "
        'Install cramhy on a computer for that; the page "Install" of its documentation says how.'
    )
    assert importlib.util.find_spec("cramhy_runtime.cpl") and importlib.util.find_spec("cramhy_runtime.no_such_room") is None
