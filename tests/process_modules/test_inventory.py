"""The names of CRAM-PROCESS-MODULES and CRAM-EXECUTIVE: exported, of which kind, with which lambda list (process-modules.md 1, 2, 9)."""

import re

import pytest

from cramhy_runtime.lisp_core.data import UNBOUND, UndefinedFunction
from cramhy_runtime.languages.commonlisp.evaluation.function_facts import lambda_list_of
from cramhy_runtime.languages.commonlisp.syntax.macros import ensure_loaded
from cramhy_runtime.languages.commonlisp.objects.classes import find_class
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from cramhy_runtime.lisp_core.packages import find_package
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

CPM = {
    "class": "process-module abstract-process-module asynchronous-process-module",
    "macro": """def-process-module def-asynchronous-process-module with-process-modules-running with-process-module-aliases
        with-process-module-registered-running""",
    "generic": """pm-run pm-execute pm-cancel pm-status running-fluent finished-fluent monitor-process-module on-input on-cancel on-run
        synchronization-fluent finish-process-module fail-process-module on-process-module-started on-process-module-finished
        status result""",
    "function": """pm-execute-matching register-process-module process-module-alias get-running-process-module
        get-running-process-module-name get-process-module-names get-running-process-module-names wait-for-process-module-running
        matching-process-module-names matching-available-process-modules name input cancel caller""",
    "variable": "*process-module-debugger-hook*",
    "mark": "matching-process-module available-process-module projection-running terminate-pm continue-pm feedback priority",
}
EXE = {
    "class": "designator-reference-failure designator-goal-parsing-failure",
    "generic": "generic-perform",
    "function": "perform try-reference-designator call-plan-with-designator-properties",
}
EVERY = [
    (package, kind, name) for package, table in (("CPM", CPM), ("EXE", EXE)) for kind, names in table.items() for name in names.split()
]

LAMBDA_LISTS = {
    "pm-run": "(PROCESS-MODULE &OPTIONAL NAME)",
    "pm-execute": "(PROCESS-MODULE INPUT &KEY TASK)",
    "pm-cancel": "(PROCESS-MODULE)",
    "pm-status": "(PROCESS-MODULE)",
    "running-fluent": "(PROCESS-MODULE)",
    "finished-fluent": "(PROCESS-MODULE)",
    "monitor-process-module": "(PROCESS-MODULE &KEY DESIGNATORS)",
    "on-input": "(PROCESS-MODULE INPUT-DESIGNATOR)",
    "on-cancel": "(PROCESS-MODULE INPUT-DESIGNATOR)",
    "on-run": "(PROCESS-MODULE)",
    "synchronization-fluent": "(PROCESS-MODULE DESIGNATOR)",
    "finish-process-module": "(PROCESS-MODULE &KEY DESIGNATOR)",
    "fail-process-module": "(PROCESS-MODULE ERROR &KEY DESIGNATOR)",
    "on-process-module-started": "(MODULE INPUT)",
    "on-process-module-finished": "(MODULE INPUT RESULT)",
    "get-running-process-module": "(NAME)",
    "get-running-process-module-name": "(MODULE)",
    "get-running-process-module-names": "(MODULE)",
    "get-process-module-names": "NIL",
    "register-process-module": "(NAME)",
    "process-module-alias": "(ALIAS NAME)",
    "wait-for-process-module-running": "(PROCESS-MODULE &KEY TIMEOUT)",
    "matching-process-module-names": "(ACTION-DESIGNATOR)",
    "matching-available-process-modules": "(ACTION-DESIGNATOR &KEY FAIL-IF-NONE)",
    "pm-execute-matching": "(ACTION-DESIGNATOR)",
    "perform": "(DESIGNATOR)",
    "generic-perform": "(DESIGNATOR)",
    "try-reference-designator": '(DESIGNATOR &OPTIONAL (ERROR-MESSAGE ""))',
}


def exported(package, name):
    symbol = find_package(package).external.get(name.upper())
    assert symbol is not None, f"{package} does not export {name}"
    return symbol


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("package, kind, name", EVERY, ids=lambda value: value)
def test_every_name_is_exported_and_is_what_the_page_says(package, kind, name):
    symbol = exported(package, name)
    if kind == "class":
        assert find_class(symbol, None) is not None
    elif kind == "macro":
        ensure_loaded()
        assert symbol.macro is not None
    elif kind == "generic":
        assert isinstance(symbol.function, GenericFunction)
    elif kind == "function":
        assert not isinstance(symbol.function, UndefinedFunction)
    elif kind == "variable":
        assert symbol.special and symbol.value is not UNBOUND
    else:
        assert isinstance(symbol.function, UndefinedFunction) and symbol.value is UNBOUND


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("name", LAMBDA_LISTS)
def test_the_lambda_lists_are_those_of_the_page(name):
    package = next(package for package, _, known in EVERY if known == name)
    function = exported(package, name).function
    shown = re.sub(r"(#|[A-Z-]+:?):", "", prin1_to_string(lambda_list_of(function)))
    assert shown == LAMBDA_LISTS[name]


def test_nothing_else_is_exported():
    for package, table in (("CPM", CPM), ("EXE", EXE)):
        names = {name.upper() for kind in table.values() for name in kind.split()}
        assert set(find_package(package).external) == names


def test_what_other_texts_mention_but_the_page_says_is_missing_is_missing():
    for name in ("TRY-PERFORM", "ON-RUN-PROCESS-MODULE"):
        for package in ("CPM", "EXE"):
            assert name not in find_package(package).external


def test_the_packages_and_their_nicknames(text):
    assert text("(list (package-name :cpm) (package-name :exe))") == '("CRAM-PROCESS-MODULES" "CRAM-EXECUTIVE")'
    assert text("(mapcar #'package-name (package-use-list :cpm))") != "NIL"
    assert text("(eq 'cpm:status 'cpl:status)") == "T" and text("(eq 'cpm::fail 'prolog:fail)") == "T"


def test_the_conditions_are_simple_errors_that_are_not_exported(text):
    assert (
        text("""(mapcar (lambda (name) (list (subtypep name 'simple-error) (nth-value 1 (find-symbol (string name) :cpm))))
                           '(cpm::unknown-process-module cpm::process-module-running cpm::process-module-not-running))""")
        == "((T :INTERNAL) (T :INTERNAL) (T :INTERNAL))"
    )


def test_fluents_are_named_after_the_module_and_modules_print_as_ordinary_objects(text):
    text("(def-process-module pm1 (m) m)")
    assert (
        text("""(let ((pm (make-instance 'pm1 :name 'base)))
                     (mapcar (lambda (reader) (symbol-name (cpl-impl::name (funcall reader pm))))
                             '(input status result cancel caller)))""")
        == '("BASE-INPUT" "BASE-STATUS" "BASE-RESULT" "BASE-CANCEL" "BASE-CALLER")'
    )
    assert text("(eq (symbol-package (cpl-impl::name (status (make-instance 'pm1 :name 'base)))) *package*)") == "T"
    assert text("(princ-to-string (make-instance 'pm1 :name 'base))").startswith('"#<PM1 {')
    assert text("(def-process-module pm2 (m) m)").startswith("(PM2 PM1")
