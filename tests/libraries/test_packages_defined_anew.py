"""A file of the user's that defines a package of a library of ours: a warning with both places, and the user's counts."""

from __future__ import annotations

import pytest
from lisp_text import LispText

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.systems.systems import LIBRARIES
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image

THEIRS = """(defpackage :cram-math (:use :cl) (:nicknames :cma) (:export #:determinant #:own))
(in-package :cram-math)
(defun determinant (m) (list :mine m))
(defun own () 1)
"""


@pytest.fixture
def lisp():
    with Image():
        yield LispText(Session(time="virtual", turtlesim=False), "(in-package :cl-user)")
        kernel.stop()


@pytest.fixture
def theirs(tmp_path):
    path = tmp_path / "theirs.lisp"
    path.write_text(THEIRS)
    return path


def test_a_file_that_is_loaded_after_the_library(lisp, theirs):
    lisp("(asdf:load-system :cram-math)")
    said = " ".join(lisp.warnings(f'(load "{theirs}")').split())
    assert (
        f"WARNING: The package CRAM-MATH of {LIBRARIES}/cram-math/cram-math.lisp is defined anew by {theirs}, whose definitions count from now on."
    ) in said
    assert lisp("(list (cram-math:determinant 3) (cma:own))") == "((:MINE 3) 1)"
    assert "is defined anew" not in lisp.warnings(f'(load "{theirs}")')


@pytest.mark.parametrize("package", ["cram-language", "roslisp", "cram-utilities"])
def test_a_file_that_defines_a_package_of_cramhy_itself(lisp, tmp_path, package):
    path = tmp_path / "own.lisp"
    path.write_text(f"(defpackage :{package} (:use :cl) (:export #:own)) (in-package :{package}) (defun own () 1)")
    said = " ".join(lisp.warnings(f'(load "{path}")').split())
    assert said == (
        f"WARNING: The package {package.upper()} of cramhy itself is defined anew by {path}, whose definitions count from now on."
    )
    assert lisp(f"({package}:own)") == "1" and lisp.warnings(f'(load "{path}")').count("anew") == 0


def test_a_file_that_is_loaded_before_the_library(lisp, theirs):
    assert lisp.warnings(f'(load "{theirs}")') == ""
    said = " ".join(lisp.warnings("(asdf:load-system :cram-math)").split())
    assert said == (
        f"WARNING: The library cram-math of {LIBRARIES}/cram-math is not loaded, because {theirs} has defined its package CRAM-MATH: that counts."
    )
    assert lisp("(list (cram-math:determinant 3) (cma:own))") == "((:MINE 3) 1)"
    assert lisp.warnings("(asdf:load-system :cram-math)") == ""


def test_a_package_of_a_library_that_nobody_defines_anew_is_not_warned_of(lisp):
    assert (
        lisp.warnings('(asdf:load-system :cram-math) (load (asdf:system-relative-pathname :cram-math "cram-math.lisp"))').count("anew") == 0
    )


CORE = "cram-language", "cram-prolog", "cram-designators", "cram-utilities", "cram-process-modules", "cram-projection"
ASD = '(defsystem "{name}" :components ((:file "own")))'


@pytest.fixture
def workspace(tmp_path, monkeypatch):
    """A function: the folder ``src`` of a workspace with the user's own systems of these names, each in a package."""

    def made(*names, below="src"):
        for name in names:
            folder = tmp_path / below / name.replace("-", "_")
            folder.mkdir(parents=True)
            (folder / "package.xml").write_text(f"<package><name>{folder.name}</name></package>")
            (folder / f"{name}.asd").write_text(ASD.format(name=name))
            (folder / "own.lisp").write_text("(defpackage :own-of-it (:use :cl)) (in-package :own-of-it) (defvar *own* t)")
        monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "src"))
        return tmp_path / "src"

    return made


def passed_over(name, ours, theirs):
    return (
        f"WARNING: The system {name} is loaded from {ours}, and not from {theirs}, which has the same name. "
        f'To choose that one, load it first: (asdf:load-asd "{theirs}")'
    )


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("name", ["cram-math", "cl-urdf", "cffi-ros-utils"])
def test_a_system_of_the_workspace_that_is_not_taken_is_told(lisp, workspace, name):
    theirs = workspace(name) / name.replace("-", "_") / f"{name}.asd"
    said = " ".join(lisp.warnings(f"(asdf:load-system :{name})").split())
    assert said == passed_over(name, LIBRARIES / name, theirs)
    assert lisp("(find-package :own-of-it)") == "NIL"
    assert lisp.warnings(f"(asdf:load-system :{name})") == ""


@pytest.mark.soak
def test_a_system_of_the_users_that_depends_on_one_is_told_of_it(lisp, workspace):
    source = workspace("cram-math")
    (source / "my_plans").mkdir()
    (source / "my_plans" / "my-plans.asd").write_text('(defsystem "my-plans" :depends-on (:cram-math :cl-urdf))')
    said = " ".join(lisp.warnings("(asdf:load-system :my-plans)").split())
    assert said == passed_over("cram-math", LIBRARIES / "cram-math", source / "cram_math" / "cram-math.asd")


def test_a_system_that_is_part_of_cramhy_itself_is_told_of(lisp, workspace):
    theirs = workspace("cram-language") / "cram_language" / "cram-language.asd"
    said = " ".join(lisp.warnings("(asdf:load-system :cram-language)").split())
    assert said == passed_over("cram-language", "cramhy itself", theirs)


def test_a_system_that_is_chosen_by_its_file_counts(lisp, workspace):
    theirs = workspace("cram-math") / "cram_math" / "cram-math.asd"
    said = lisp.warnings(f'(asdf:load-asd "{theirs}") (asdf:load-system :cram-math)')
    assert said == f"; The system cram-math is that of {theirs}, not the one that cramhy contains.\n"
    assert lisp("own-of-it::*own*") == "T"


def test_ours_are_taken_without_a_word_in_a_checkout_of_the_original(lisp, workspace):
    """It has them all, and cramhy contains what they are there for."""
    workspace("cram-math", *CORE, below="src/cram")
    assert lisp.warnings("(asdf:load-system :cram-math)") == ""


def test_a_system_beside_a_checkout_of_the_original_is_told_of(lisp, workspace):
    workspace(*CORE, below="src/cram")
    theirs = workspace("cram-math") / "cram_math" / "cram-math.asd"
    said = " ".join(lisp.warnings("(asdf:load-system :cram-math)").split())
    assert said == passed_over("cram-math", LIBRARIES / "cram-math", theirs)


def test_libraries_of_all_lisps_are_taken_without_a_word(lisp, workspace):
    """A folder of foreign systems has them for Lisps that call functions of C or of the system."""
    workspace("bordeaux-threads")
    assert lisp.warnings("(asdf:load-system :bordeaux-threads)") == ""
