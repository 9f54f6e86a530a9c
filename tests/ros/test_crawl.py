"""Packages and systems are found below each entry of ROS_PACKAGE_PATH as rospack finds them.

`RECORDED` was recorded from rospack 2.6.2 of Debian 12, in a tree that had no links; those follow in tests of their own.
"""

from __future__ import annotations

import os

import pytest
from systems import posix

from cramhy_runtime.cli import workspace
from cramhy_runtime.languages.commonlisp.systems import systems
from cramhy_runtime.ros import definition_files, search_folders
from cramhy_runtime.session import Image

RECORDED = [
    ("a/b/c/d/e/f/g/deep", "", True),
    ("broken_name", "", True),
    ("build/in_build", "", True),
    ("tests/in_tests", "", True),
    ("node_modules/in_modules", "", True),
    (".hidden/in_hidden", "", False),
    ("ignored/inside", "ignored/CATKIN_IGNORE", False),
    ("ignored_itself", "ignored_itself/CATKIN_IGNORE", False),
    ("ignore_is_a_folder/inside_folder", "ignore_is_a_folder/CATKIN_IGNORE/", True),
    ("ament/in_ament", "ament/AMENT_IGNORE", True),
    ("colcon/in_colcon", "colcon/COLCON_IGNORE", True),
    ("no_sub/below_no_sub", "no_sub/rospack_nosubdirs", False),
    ("roslisp/in_roslisp", "roslisp/roslisp_ignore", True),
    ("a_stack/of_stack", "a_stack/stack.xml", True),
    ("outer/inner", "outer/package.xml", False),
    ("old/inside_old", "old/manifest.xml", False),
]
"""Folder of a package, a file or a folder that is there, too, and whether rospack finds the package."""


@pytest.fixture
def tree(tmp_path, monkeypatch):
    """A folder on ROS_PACKAGE_PATH, far from the current one; the function ``tree(path, text)`` makes a file in it."""
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "tree"))

    def make(path, text=""):
        path = tmp_path / "tree" / path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    make.root = tmp_path / "tree"
    make.package = lambda folder, name=None: make(
        f"{folder}/package.xml", f"<package><name>{name or folder.split('/')[-1]}</name></package>"
    )
    return make


def found(root):
    """The names of the packages below ROOT that the search finds, and their folders."""
    return {name: folder.relative_to(root).as_posix() for name, folder in definition_files.packages() if folder.is_relative_to(root)}


class TestPackages:
    def test_those_that_rospack_finds(self, tree):
        for folder, other, _ in RECORDED:
            tree.package(folder)
            if other.endswith("/"):
                (tree.root / other).mkdir()
            elif other and other != "outer/package.xml":
                tree(other)
        tree.package("outer")
        expected = {folder.split("/")[-1] for folder, _, is_found in RECORDED if is_found}
        assert set(found(tree.root)) == {*expected, "outer", "old"}

    @pytest.mark.parametrize("folder, other, is_found", RECORDED)
    def test_one_by_its_name(self, tree, folder, other, is_found):
        tree.package(folder)
        if other.endswith("/"):
            (tree.root / other).mkdir()
        elif other == "outer/package.xml":
            tree.package("outer")
        elif other:
            tree(other)
        for found_folder in (systems.find_package_folder(folder.split("/")[-1]), workspace.folder_of(folder.split("/")[-1])):
            assert found_folder == (tree.root / folder if is_found else None)

    def test_the_manifest_gives_the_name(self, tree):
        tree.package("renamed", "other_name")
        assert systems.find_package_folder("other_name") == tree.root / "renamed"
        assert systems.find_package_folder("renamed") is None

    def test_the_first_of_two(self, tree, monkeypatch):
        tree.package("one/same")
        tree.package("two/same")
        assert found(tree.root)["same"] == "two/same" or systems.find_package_folder("same") == tree.root / "one" / "same"
        monkeypatch.setenv("ROS_PACKAGE_PATH", os.pathsep.join([str(tree.root / "two"), str(tree.root)]))
        assert systems.find_package_folder("same") == tree.root / "two" / "same"

    def test_an_entry_that_is_a_package_itself(self, tree, monkeypatch):
        tree.package("alone")
        monkeypatch.setenv("ROS_PACKAGE_PATH", str(tree.root / "alone"))
        assert systems.find_package_folder("alone") == tree.root / "alone"

    def test_definitions_of_messages_at_any_depth(self, tree, lisp):
        tree.package("a/b/c/d/e/f/deep_msgs")
        tree("a/b/c/d/e/f/deep_msgs/msg/Thing.msg", "string name\n")
        assert lisp("(deep_msgs-msg:name (make-instance 'deep_msgs-msg:thing))") == '""'

    def test_the_current_folder_is_not_crawled_that_deep(self, tree, monkeypatch):
        tree.package("a/b/c/d/e/f/deep")
        monkeypatch.setenv("ROS_PACKAGE_PATH", "")
        monkeypatch.chdir(tree.root)
        assert systems.find_package_folder("deep") is None


@posix
class TestLinks:
    def test_a_link_out_of_the_tree_is_followed(self, tree, tmp_path):
        tree("../outside/far/package.xml", "<package><name>far</name></package>")
        (tree.root / "x").mkdir(parents=True)
        (tree.root / "x" / "link").symlink_to(tmp_path / "outside")
        assert found(tree.root) == {"far": "x/link/far"}

    def test_a_circle_of_links_is_left(self, tree):
        tree.package("a/mine")
        (tree.root / "a" / "back").symlink_to(tree.root)
        (tree.root / "a" / "self").symlink_to("self")
        (tree.root / "a" / "nowhere").symlink_to("not-there")
        (tree.root / "b").symlink_to("c")
        (tree.root / "c").symlink_to("b")
        assert [name for name, folder in definition_files.packages() if folder.is_relative_to(tree.root)] == ["mine"]

    def test_each_folder_counts_once_and_before_links_to_it(self, tree):
        tree.package("z/mine")
        (tree.root / "a").symlink_to("z")
        (tree.root / "b").symlink_to("z/mine")
        assert [(name, folder) for name, folder in definition_files.packages() if name == "mine"] == [("mine", tree.root / "z" / "mine")]

    def test_a_link_leads_to_no_folder_that_is_ignored(self, tree):
        tree.package("z/mine")
        tree("z/CATKIN_IGNORE")
        (tree.root / "a").symlink_to("z")
        assert found(tree.root) == {}


class TestSystems:
    @pytest.mark.parametrize(
        "file",
        ["mine/wanted.asd", "a/b/c/d/e/f/g/mine/wanted.asd", "mine/asdf/wanted.asd", "mine/lisp/a/b/c/d/wanted.asd", "no_package/wanted.asd"],
    )  # fmt: skip
    def test_where_their_files_may_be(self, tree, file):
        if "mine" in file:
            tree.package(file.partition("mine")[0] + "mine")
        path = tree(file, "(defsystem wanted)")
        assert systems.find_asd("wanted") == path
        assert "wanted" in systems.known_systems()

    @pytest.mark.parametrize(
        "marker", ["mine/CATKIN_IGNORE", "mine/lisp/CATKIN_IGNORE", "CATKIN_IGNORE", "mine/lisp/roslisp_ignore", "mine/rospack_nosubdirs"]
    )
    def test_where_they_are_not_seen(self, tree, marker):
        tree.package("mine")
        tree("mine/lisp/wanted.asd", "(defsystem wanted)")
        tree(marker)
        assert systems.find_asd("wanted") is None

    def test_the_inside_of_a_package_waits_for_all_others(self, tree):
        tree.package("a")
        tree("a/deep/wanted.asd", "")
        tree.package("b")
        path = tree("b/wanted.asd", "")
        assert systems.find_asd("wanted") == path

    def test_one_that_a_file_of_the_system_before_has_made(self, tree, lisp):
        tree("mine/mine.asd", '(defsystem mine :components ((:file "f")))')
        later = tree.root / "mine" / "later"
        tree(
            "mine/f.lisp",
            f"""(ensure-directories-exist "{later.as_posix()}/")
            (with-open-file (out "{later.as_posix()}/made-later.asd" :direction :output) (write-line "(defsystem made-later)" out))
            (asdf:load-system "made-later")""",
        )
        lisp('(asdf:load-system "mine")')
        assert "made-later" in systems.loaded


def test_a_load_crawls_a_folder_once(tree, lisp, monkeypatch):
    for number in range(12):
        tree.package(f"stack{number % 3}/p{number}")
        needed = f":depends-on (s{number + 1})" if number < 11 else ""
        tree(f"stack{number % 3}/p{number}/s{number}.asd", f"(defsystem s{number} {needed})")
    looked = []
    monkeypatch.setattr(
        search_folders, "entries", lambda folder, entries=search_folders.entries: looked.append(str(folder)) or entries(folder)
    )
    lisp('(asdf:load-system "s0")')
    below = [folder for folder in looked if folder.startswith(str(tree.root))]
    assert sorted(below) == sorted(set(below))
    assert len(below) == 1 + 3 + 12


class TestPreferred:
    """``--prefer-path SYSTEM``: one on ROS_PACKAGE_PATH takes the place of cramhy's own."""

    @pytest.fixture(autouse=True)
    def image(self, session):
        with Image():
            yield

    def test_a_library(self, tree, lisp):
        tree("my_alexandria/alexandria.asd", '(defsystem alexandria :components ((:file "a")))')
        tree("my_alexandria/a.lisp", "(defpackage alexandria (:use :cl) (:export #:flatten))\n(in-package :alexandria)\n"
                                     "(defun flatten (list) (cons :mine list))")  # fmt: skip
        systems.prefer("alexandria")
        assert lisp("(alexandria:flatten '(1 (2)))") == "(:MINE 1 (2))"
        assert systems.find_asd("alexandria") == tree.root / "my_alexandria" / "alexandria.asd"

    def test_a_part_of_cram_and_what_it_does_not_define_stays(self, tree, lisp, capsys):
        tree("my_utilities/cram-utilities.asd", '(defsystem cram-utilities :components ((:file "u")))')
        tree("my_utilities/u.lisp", """(defpackage :cram-utilities (:use :cl) (:nicknames :cut) (:export #:var-value #:own))
            (in-package :cram-utilities)
            (defgeneric var-value (variable bindings) (:method (variable bindings) (list :mine variable bindings)))
            (defun lazy-list-p (it) (list :list it))
            (defun own () 1)""")  # fmt: skip
        assert lisp("(cut:var-value '?x '((?x . 2)))") == "2"
        systems.prefer("cram-utilities")
        lisp('(asdf:load-system "cram-utilities")')
        assert lisp("(list (cut:var-value '?x nil) (cut:own) (cut:is-var '?x) (cut::lazy-list-p 1))") == "((:MINE ?X NIL) 1 T (:LIST 1))"
        assert "redefin" not in capsys.readouterr().err

    def test_nothing_else_is_preferred(self, tree, lisp):
        tree("my_alexandria/alexandria.asd", "(defsystem alexandria)")
        tree("my_utilities/cram-utilities.asd", '(error "read")')
        assert systems.is_provided("cram-utilities")
        assert systems.LIBRARIES in systems.find_asd("alexandria").parents
        assert lisp('(asdf:load-system "cram-utilities")') == "T"

    def test_one_that_is_not_there(self, tree, lisp, fails):
        tree("nothing")
        condition = fails(systems.prefer, "cram-utilties")
        assert condition.report() == 'There is no system "cram-utilties" on ROS_PACKAGE_PATH that could be preferred'
        assert condition.hint == (
            f"ROS_PACKAGE_PATH: {tree.root}. The system is a file cram-utilties.asd in one of these folders, or below."
        )
