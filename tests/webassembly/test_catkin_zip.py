"""Packages of catkin as zip files: what is exported is what CRAM expects, and what is imported does no harm."""

from __future__ import annotations

import io
import struct
import xml.etree.ElementTree as ElementTree
import zipfile

import pytest

from cramhy_runtime.browser import catkin_zip
from cramhy_runtime.browser.catkin_zip import AlreadyThere, UnfitPackage, exported, imported
from cramhy_runtime.session.session import Session

BROKEN = "This file is not a zip file, or it is broken or cut short. Fetch it again, and import that."


def write(folder, **files):
    for name, text in files.items():
        path = folder / name.replace("__", "/").replace("_dot_", ".")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def content(data):
    with zipfile.ZipFile(io.BytesIO(data)) as source:
        return {name: source.read(name).decode() for name in source.namelist()}


def zipped(**files):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as target:
        for name, text in files.items():
            target.writestr(name if "/" in name or "." in name else name.replace("_dot_", ".").replace("__", "/"), text)
    return buffer.getvalue()


def files_below(folder):
    return sorted(file.relative_to(folder).as_posix() for file in folder.rglob("*") if file.is_file())


def test_files_in_no_package_get_one_that_loads(tmp_path, monkeypatch):
    write(
        tmp_path,
        walk_dot_lisp="(in-package :walks)\n(defun steps () (* 2 +legs+))\n",
        package_dot_lisp="(defpackage :walks (:use :cl))\n",
        legs_dot_hy="(require cramhy *)\n(in-package :walks)\n(defconstant +legs+ 2)\n",
        notes_dot_txt="none",
    )
    name, data = exported(tmp_path, "walk.lisp", "my_walks")
    found = content(data)
    assert name == "my_walks.zip" and data == exported(tmp_path, "walk.lisp", "my_walks")[1]
    assert sorted(found) == [
        f"my_walks/{file}"
        for file in ("CMakeLists.txt", "my-walks.asd", "package.xml", "src/legs.hy", "src/notes.txt", "src/package.lisp", "src/walk.lisp")
    ]
    package = ElementTree.fromstring(found["my_walks/package.xml"])
    assert package.findtext("name") == "my_walks" and "cram_language" in [each.text for each in package.findall("depend")]
    assert "project(my_walks)\n" in found["my_walks/CMakeLists.txt"]
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    assert imported(data, elsewhere) == sorted(found)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(elsewhere))
    session = Session(time="virtual", turtlesim=False)
    session.evaluate_text('(ros-load:load-system "my_walks" :my-walks)')
    assert session.evaluate_text("(walks::steps)") == [4]
    assert exported(elsewhere, "my_walks/src/walk.lisp", "ignored") == (name, data)  # there and back


def test_systems_that_the_files_load_are_those_that_the_package_depends_on(tmp_path):
    write(
        tmp_path,
        a_dot_lisp='(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)\n(asdf:load-system "alexandria")\n',
    )
    found = content(exported(tmp_path, "a.lisp", "mine")[1])["mine/mine.asd"]
    assert found.endswith(
        '               cram-executive\n               cram-my-beginner-tutorial\n               alexandria)\n  :components\n  ((:module "src"\n'
        '    :serial t\n    :components\n    ((:file "a")))))\n'
    )


def test_the_package_of_the_open_file_is_exported_alone(tmp_path):
    write(
        tmp_path,
        one__package_dot_xml="<package/>",
        one__src__a_dot_lisp="1",
        two__package_dot_xml="<package/>",
        b_dot_lisp="2",
        _dot_hidden="3",
    )
    assert content(exported(tmp_path, "one/src/a.lisp", "mine")[1]) == {"one/package.xml": "<package/>", "one/src/a.lisp": "1"}
    assert "mine/src/b.lisp" in content(exported(tmp_path, "b.lisp", "mine")[1])
    assert not any("hidden" in name or "one" in name for name in content(exported(tmp_path, "b.lisp", "mine")[1]))


def test_who_has_an_asd_file_keeps_it(tmp_path):
    write(tmp_path, mine_dot_asd="(defsystem mine)", lib__a_dot_lisp="1")
    assert sorted(content(exported(tmp_path, "mine.asd", "mine")[1])) == [
        "mine/CMakeLists.txt",
        "mine/lib/a.lisp",
        "mine/mine.asd",
        "mine/package.xml",
    ]


@pytest.mark.parametrize("name", ["", "My_plans", "my plans", "../up", "2nd", "a/b", "a\n"])
def test_what_cannot_be_a_package_name_is_refused(tmp_path, name):
    write(tmp_path, a_dot_lisp="1")
    with pytest.raises(UnfitPackage) as refused:
        exported(tmp_path, "a.lisp", name)
    assert (
        str(refused.value)
        == f'"{name}" cannot be the name of a package: it begins with a lower-case letter, and has letters, digits and _ in it.'
    )


def test_where_there_is_nothing_nothing_is_exported(tmp_path):
    with pytest.raises(UnfitPackage, match="There is no file to export yet. Write one in the editor first."):
        exported(tmp_path, "plans.lisp", "mine")


# ---------------------------------------------------------------------------------------------------------------- import


def test_a_zip_without_a_folder_around_gets_the_name_of_its_package(tmp_path):
    data = zipped(
        **{"package.xml": "<package><name>walks</name></package>", "src/a.lisp": "1", "__MACOSX/x": "2", "src/__pycache__/a": "3"}
    )
    assert imported(data, tmp_path) == ["walks/package.xml", "walks/src/a.lisp"]
    assert imported(zipped(a_dot_lisp="1"), tmp_path) == ["imported/a.lisp"]


def test_a_folder_that_is_there_gives_way_only_when_the_user_agrees(tmp_path):
    write(tmp_path, mine__old_dot_lisp="old")
    with pytest.raises(AlreadyThere) as there:
        imported(zipped(mine__a_dot_lisp="new"), tmp_path)
    assert there.value.args == ("mine",) and files_below(tmp_path) == ["mine/old.lisp"]
    imported(zipped(mine__a_dot_lisp="new"), tmp_path, replace=True)
    assert files_below(tmp_path) == ["mine/a.lisp"]


def test_what_cannot_be_written_leaves_what_was_there(tmp_path):
    write(tmp_path, mine__old_dot_lisp="old")
    with pytest.raises(OSError):
        imported(zipped(mine__a_dot_lisp="1", mine__a_dot_lisp__b_dot_lisp="a file and a folder of one name"), tmp_path, replace=True)
    assert files_below(tmp_path) == ["mine/old.lisp"]


@pytest.mark.parametrize("name", ["../a.lisp", "/a.lisp", "mine/../../a.lisp", "..\\a.lisp", "C:/a.lisp", "mine/..", "\\\\host\\a.lisp"])
def test_a_zip_that_would_write_elsewhere_writes_nothing(tmp_path, name):
    folder = tmp_path / "home"
    folder.mkdir()
    with pytest.raises(UnfitPackage) as refused:
        imported(zipped(**{"mine/good.lisp": "1", name: "2"}), folder)
    assert str(refused.value) == f"This file would write outside of its own folder: {name!r}. Nothing of it was unpacked."
    assert files_below(tmp_path) == []


def test_a_link_in_a_zip_is_refused(tmp_path):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as target:
        link = zipfile.ZipInfo("mine/a.lisp")
        link.external_attr = 0o120777 << 16
        target.writestr(link, "/etc/passwd")
    with pytest.raises(UnfitPackage, match="would write outside of its own folder"):
        imported(buffer.getvalue(), tmp_path)


def test_a_zip_that_is_cut_at_any_place_is_told_and_changes_nothing(tmp_path):
    data = zipped(mine__package_dot_xml="<package/>" * 9, mine__a_dot_lisp="(a)" * 99)
    for length in range(0, len(data), 7):
        with pytest.raises(UnfitPackage, match="cut short"):
            imported(data[:length], tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_zip_with_a_wrong_byte_at_any_place_is_told_or_read_as_it_was(tmp_path):
    data = zipped(mine__package_dot_xml="<package/>", mine__a_dot_lisp="(a)" * 99)
    right = catkin_zip._unpacked(data)
    for place in range(len(data)):
        changed = data[:place] + bytes([data[place] ^ 0xFF]) + data[place + 1 :]
        try:
            found = catkin_zip._unpacked(changed)
        except UnfitPackage:
            continue
        assert set(found.values()) <= set(right.values())  # what was changed says nothing of the content


def test_a_zip_that_is_too_large_is_refused_before_it_is_unpacked(tmp_path, monkeypatch):
    monkeypatch.setattr(catkin_zip, "MOST_BYTES", 1_000_000)
    monkeypatch.setattr(catkin_zip, "MOST_FILES", 10)
    told = "This file is too large: a package may have 10 files with 1 MB in all."
    bomb = zipped(mine__a_dot_lisp="0" * 5_000_000)
    for data in (bomb, zipped(**{f"mine/{number}.lisp": "1" for number in range(11)})):
        with pytest.raises(UnfitPackage) as refused:
            imported(data, tmp_path)
        assert str(refused.value) == told
    size = struct.pack("<I", 5_000_000)
    with pytest.raises(UnfitPackage):  # it says that it is small
        imported(bomb.replace(size, struct.pack("<I", 1000)), tmp_path)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("data", [b"", b"PK", b"not a zip" * 99, b"\x1f\x8b" + bytes(99)])
def test_what_is_no_zip_is_told(tmp_path, data):
    with pytest.raises(UnfitPackage) as refused:
        imported(data, tmp_path)
    assert str(refused.value) == BROKEN


def test_a_zip_without_a_program_is_no_package(tmp_path):
    with pytest.raises(UnfitPackage, match="There is no package in this file: it has neither a package.xml nor a file of Lisp or Hy."):
        imported(zipped(mine__thesis_dot_tex="1"), tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_locked_zip_is_told(tmp_path):
    data = bytearray(zipped(mine__a_dot_lisp="1"))
    data[6] |= 1
    data[data.index(b"PK\x01\x02") + 8] |= 1
    with pytest.raises(UnfitPackage, match="This zip file is locked with a password."):
        imported(bytes(data), tmp_path)
