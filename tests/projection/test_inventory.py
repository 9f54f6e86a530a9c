"""The names of the packages: which are exported, what they name, and their lambda lists (projection-and-events.md A3, B5, C4)."""

import pytest

from cramhy_runtime import image
from cramhy_runtime.lisp.data import UNBOUND, UndefinedFunction
from cramhy_runtime.lisp.evaluation.function_facts import lambda_list_of
from cramhy_runtime.lisp.evaluation.macros import ensure_loaded
from cramhy_runtime.lisp.objects.classes import find_class
from cramhy_runtime.lisp.packages import find_package
from cramhy_runtime.lisp.printer.printer import prin1_to_string
from cramhy_runtime.lisp.types.types import is_known_type

image.boot()
ensure_loaded()

EXPORTS = {
    "CRAM-PROJECTION": {
        "macro": "define-projection-environment define-special-projection-variable with-projection-environment "
                 "with-partially-ordered-clock-disabled",
        "function": "clock-time clock-wait partially-ordered-clock-enabled",
        "class": "linear-clock partially-ordered-clock",
        "variable": "*projection-environment*",
    },
}
NICKNAMES = {"CRAM-PROJECTION": ["PROJ"]}
LAMBDA_LISTS = {
    "proj:clock-time": "(CLOCK)", "proj:clock-wait": "(CLOCK DURATION)", "proj:partially-ordered-clock-enabled": "(CLOCK)",
}
GENERIC = "proj:clock-time proj:clock-wait proj:partially-ordered-clock-enabled"


def names(*packages):
    return [(package, kind, name) for package in packages for kind, listed in EXPORTS[package].items() for name in listed.upper().split()]


def exported(designator):
    package, name = designator.upper().split(":")
    symbol, status = find_package(package).lookup(name)
    assert status == "external"
    return symbol


@pytest.mark.parametrize("package, kind, name", names(*EXPORTS))
def test_a_name_is_exported_and_has_its_meaning(package, kind, name):
    symbol = exported(f"{package}:{name}")
    if kind == "macro":
        assert symbol.macro is not None
    elif kind == "function":
        assert not isinstance(symbol.function, UndefinedFunction)
    elif kind == "variable":
        assert symbol.special and symbol.value is not UNBOUND
    elif kind == "class":
        assert is_known_type(symbol) and find_class(symbol) is not None


@pytest.mark.parametrize("package", EXPORTS)
def test_nothing_else_is_exported_and_the_nicknames_are_known(package):
    assert set(find_package(package).external) == {name for _, _, name in names(package)}
    for nickname in NICKNAMES[package]:
        assert find_package(nickname) is find_package(package)


@pytest.mark.parametrize("designator, lambda_list", LAMBDA_LISTS.items())
def test_functions_have_the_lambda_lists_of_the_original(designator, lambda_list):
    assert prin1_to_string(lambda_list_of(exported(designator).function)).replace("#:", "").replace("CRAM-PROJECTION::", "") == lambda_list


@pytest.mark.parametrize("designator", GENERIC.split())
def test_what_users_add_methods_to_is_a_generic_function(designator):
    assert exported(designator).function.methods is not None


@pytest.mark.parametrize("system", ["cram-projection"])
def test_the_systems_are_there_for_those_that_depend_on_them(system, tmp_path, monkeypatch):
    from cramhy_runtime.repl.session import Session

    folder = tmp_path / "my_robot"
    folder.mkdir()
    (folder / "my-robot.asd").write_text(f'(defsystem my-robot :depends-on ({system}) :components ((:file "package")))')
    (folder / "package.lisp").write_text(f"(defpackage my-robot-{system} (:use :common-lisp :{system}))")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    session = Session(time="virtual", turtlesim=False)
    session.evaluate_text('(asdf:load-system "my-robot")')
    assert find_package(system.upper()) in find_package(f"MY-ROBOT-{system}".upper()).use
