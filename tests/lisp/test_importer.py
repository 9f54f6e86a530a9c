"""``import my_package``: a Lisp package as a Python module."""

from __future__ import annotations

import importlib
import itertools
import re
import sys

import hy
import pytest

from cramhy_runtime.lisp_core.python_exceptions import from_python
from cramhy_runtime.lisp_core.conditions import SimpleProgramError, TypeError_
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.languages.commonlisp.systems import importer

_numbers = itertools.count()


@pytest.fixture
def module(tmp_path, session, monkeypatch):
    """The module of a small Lisp package, imported by Python."""
    monkeypatch.setattr("cramhy_runtime.ros.search_folders.extra_folders", [str(tmp_path)])
    name = f"imported-{next(_numbers)}"
    home = tmp_path / name
    home.mkdir()
    (home / f"{name}.asd").write_text(f'(defsystem {name} :components ((:file "package") (:file "code")))')
    (home / "package.lisp").write_text(
        f'(defpackage {name} (:nicknames {name}-short) (:use :cl) (:documentation "A package.") (:export #:area))'
    )
    (home / "code.lisp").write_text(f"""
(in-package :{name})
(defvar *speed* 1.5)
(defparameter *list* (list 1 2))
(defconstant +limit+ 10)
(defun area (width &key (height 2) (unit-name "m")) "The area." (list (* width height) unit-name))
(defun two-values () (values 1 2))
(defun speed-times (n) (* n *speed*))
(defun is-big? (n) (if (> n +limit+) t nil))
(defun fails () (car 5))
(defun internal () 'hidden)
""")
    importer.install()
    yield importlib.import_module(name.replace("-", "_"))
    sys.modules.pop(name.replace("-", "_"), None)


def test_functions_are_called_with_keywords_of_python_or_of_lisp(module):
    assert list(module.area(3)) == [6, "m"]
    assert list(module.area(3, height=5, unit_name="cm")) == [15, "cm"]
    assert module.area.__doc__ == "The area."


def test_several_values_come_as_a_tuple(module):
    assert tuple(module.two_values()) == (1, 2)


@pytest.mark.soak
def test_variables_are_read_and_set(module, session):
    assert (module.speed, module.limit_plus if hasattr(module, "limit_plus") else 10) == (1.5, 10)
    module.speed = 4
    assert module.speed_times(2) == 8
    assert repr(module.list) == repr(lisp_list(1, 2))


def test_lisp_truth_is_python_truth(module):
    assert module.is_big_p(11) is True
    assert not module.is_big_p(9)


def test_a_redefinition_is_seen_at_once(module, session):
    before = module.area
    session.evaluate_text(f"(in-package :{module.lisp_package.name}) (defun area () 'new)")
    assert module.area is not before
    assert module.area().name == "NEW"


@pytest.mark.soak
def test_internal_names_are_there_and_unknown_ones_say_so(module):
    assert module.internal().name == "HIDDEN"
    with pytest.raises(AttributeError) as caught:
        module.no_such_thing
    assert str(caught.value) == (
        f"the Lisp package {module.lisp_package.name} defines no function or variable for the Python name 'no_such_thing'"
    )
    with pytest.raises(AttributeError, match=r"for the Python name 'two_value'\. Did you mean two_values\?\Z"):
        module.two_value
    assert not hasattr(module, "__path__")


@pytest.mark.soak
def test_dir_and_documentation(module):
    assert {"area", "two_values", "speed", "internal", "is_big_p"} <= set(dir(module))
    assert module.__doc__ == "A package."


@pytest.mark.soak
def test_hy_may_write_the_name_of_lisp_itself(module):
    hy.eval(hy.read("(setv speed module.*speed*  limit module.+limit+  big (module.is-big? 11))"), locals=(names := {"module": module}))
    assert (names["speed"], names["limit"], names["big"]) == (1.5, 10, True)
    with pytest.raises(AttributeError, match=re.escape("for the Python name '*speet*'")):
        hy.eval(hy.read("module.*speet*"), locals=names)


def test_an_error_in_lisp_is_an_exception_in_python(module):
    with pytest.raises(TypeError_) as caught:
        module.fails()
    assert str(caught.value).split() == "The value 5 is not of type LIST when binding LIST".split()
    assert isinstance(caught.value, Exception)


def test_a_wrong_number_of_arguments(module):
    with pytest.raises(TypeError) as caught:
        module.internal(1)
    condition = from_python(caught.value)
    assert isinstance(condition, SimpleProgramError)
    assert condition.report() == "invalid number of arguments: 1"
    assert condition.hint.endswith("INTERNAL takes 0 arguments.")


def test_an_unknown_module_stays_unknown(session):
    importer.install()
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("no_such_lisp_system_at_all")


def test_a_system_without_a_package_of_its_name(tmp_path, session, monkeypatch):
    monkeypatch.setattr("cramhy_runtime.ros.search_folders.extra_folders", [str(tmp_path)])
    (tmp_path / "packageless-system.asd").write_text("(defsystem packageless-system)")
    importer.install()
    with pytest.raises(ImportError) as caught:
        importlib.import_module("packageless_system")
    assert str(caught.value) == "the system packageless-system defines no Lisp package called packageless_system"


@pytest.fixture
def folder_of_a_system(tmp_path, session, monkeypatch):
    """The name of a system whose folder has that name, in a folder of Python's path which is the current one."""
    name = f"here{next(_numbers)}"
    (tmp_path / name).mkdir()
    (tmp_path / name / f"{name}.asd").write_text(f'(defsystem {name} :components ((:file "code")))')
    (tmp_path / name / "code.lisp").write_text(f"(defpackage {name} (:use :cl)) (in-package {name}) (defun answer () 42)")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    importer.install()
    yield name
    sys.modules.pop(name, None)


def test_a_system_is_found_where_its_folder_lies_on_the_path(folder_of_a_system):
    assert importlib.import_module(folder_of_a_system).answer() == 42


def test_a_package_of_python_goes_before_the_system_in_its_folder(folder_of_a_system, tmp_path):
    (tmp_path / folder_of_a_system / "__init__.py").write_text("answer = 'Python'")
    importlib.invalidate_caches()
    assert importlib.import_module(folder_of_a_system).answer == "Python"


def test_a_folder_without_a_system_stays_a_package_without_init(folder_of_a_system, tmp_path):
    (tmp_path / folder_of_a_system / f"{folder_of_a_system}.asd").unlink()
    assert importlib.import_module(folder_of_a_system).__path__
