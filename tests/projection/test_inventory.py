"""The names of the packages: which are exported, what they name, and their lambda lists (projection-and-events.md A3, B5, C4)."""

import re

import pytest

from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.data import UNBOUND, UndefinedFunction
from cramhy_runtime.languages.commonlisp.evaluation.function_facts import lambda_list_of
from cramhy_runtime.languages.commonlisp.syntax.macros import ensure_loaded
from cramhy_runtime.languages.commonlisp.objects.classes import find_class
from cramhy_runtime.lisp_core.packages import delete_package, find_package, register
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.types.types import is_known_type
from cramhy_runtime.prolog.engine.database import functors

boot()
ensure_loaded()

EXPORTS = {
    "CRAM-PROJECTION": {
        "macro": "define-projection-environment define-special-projection-variable with-projection-environment "
        "with-partially-ordered-clock-disabled",
        "function": "clock-time clock-wait partially-ordered-clock-enabled",
        "class": "linear-clock partially-ordered-clock",
        "variable": "*projection-environment*",
    },
    "CRAM-EXECUTION-TRACE": {
        "macro": "defstore-episode-knowledge-backend defrestore-episode-knowledge-backend with-episode-knowledge "
        "with-last-episode-knowledge with-top-level-episode-knowledge with-offline-episode-knowledge",
        "function": """durable-copy get-top-level-episode-knowledge register-top-level-episode-knowledge episode-knowledge-zero-time
            episode-knowledge-max-time episode-knowledge-task-tree episode-knowledge-task-list episode-knowledge-goal-task-list
            episode-knowledge-traced-fluent-names episode-knowledge-fluent-changes episode-knowledge-fluent-durations
            save-episode-knowledge save-last-episode-knowledge load-episode-knowledge enable-fluent-tracing disable-fluent-tracing
            fluent-tracing-enabled timestamp name traced-value enable-auto-tracing disable-auto-tracing auto-tracing-enabled
            set-auto-tracing-directory setup-auto-tracing""",
        "class": "episode-knowledge live-episode-knowledge offline-episode-knowledge traced-fluent",
        "variable": "*episode-knowledge* *last-episode-knowledge*",
        "term": "throughout",
    },
    "CRAM-OCCASIONS-EVENTS": {
        "function": "clear-belief assert-occasion retract-occasion holds-occasion holds on-event event-timestamp task task-path",
        "macro": "top-level",
        "class": "event fluent task",
        "predicate": """fluent fluent-value task-path top-level task goal-task task-status-fluent task-goal task-outcome task-result
            task-error error-type holds duration-includes task-started-at task-created-at task-ended-at subtask subtask+""",
        "term": "occurs task-status throughout during at",
    },
}
NICKNAMES = {"CRAM-PROJECTION": ["PROJ"], "CRAM-EXECUTION-TRACE": ["CET"], "CRAM-OCCASIONS-EVENTS": ["COE", "OCCASIONS-EVENTS"]}
LAMBDA_LISTS = {
    "proj:clock-time": "(CLOCK)",
    "proj:clock-wait": "(CLOCK DURATION)",
    "proj:partially-ordered-clock-enabled": "(CLOCK)",
    "coe:on-event": "(EVENT)",
    "coe:clear-belief": "NIL",
    "coe:event-timestamp": "(EVENT)",
    "coe:holds": "(OCCASION &OPTIONAL TIME-SPECIFICATION)",
    "coe:assert-occasion": "(OCCASION)",
    "coe:retract-occasion": "(OCCASION)",
    "coe:holds-occasion": "(OCCASION)",
    "cet:get-top-level-episode-knowledge": "(NAME)",
    "cet:register-top-level-episode-knowledge": "(NAME)",
    **{
        f"cet:episode-knowledge-{name}": "(&OPTIONAL EPISODE)"
        for name in ("zero-time", "max-time", "task-tree", "task-list", "goal-task-list", "traced-fluent-names")
    },
    "cet:episode-knowledge-fluent-changes": "(FLUENT-NAME &OPTIONAL EPISODE)",
    "cet:episode-knowledge-fluent-durations": "(FLUENT-NAME &OPTIONAL EPISODE)",
    "cet:save-episode-knowledge": "(DESTINATION &OPTIONAL (EPISODE *EPISODE-KNOWLEDGE*) &REST KEY-ARGS)",
    "cet:save-last-episode-knowledge": "(DESTINATION &KEY IF-EXISTS)",
    "cet:load-episode-knowledge": "(SOURCE)",
    "cet:durable-copy": "(OBJ)",
    "cet:enable-fluent-tracing": "NIL",
    "cet:disable-fluent-tracing": "NIL",
    "cet:fluent-tracing-enabled": "NIL",
    "cet:enable-auto-tracing": "NIL",
    "cet:disable-auto-tracing": "NIL",
    "cet:auto-tracing-enabled": "NIL",
    "cet:set-auto-tracing-directory": "(PATH &KEY ENSURE-DIRECTORY)",
    "cet:setup-auto-tracing": "(DIRECTORY &KEY ENSURE-DIRECTORY)",
}
GENERIC = (
    "proj:clock-time proj:clock-wait proj:partially-ordered-clock-enabled cet:durable-copy coe:on-event "
    "coe:clear-belief coe:holds coe:event-timestamp"
)


def names(*packages):
    return [(package, kind, name) for package in packages for kind, listed in EXPORTS[package].items() for name in listed.upper().split()]


def exported(designator):
    package, name = designator.upper().split(":")
    symbol, status = find_package(package).lookup(name)
    assert status == "external"
    return symbol


@pytest.mark.soak(all_but=16)
@pytest.mark.parametrize("package, kind, name", names(*EXPORTS))
def test_a_name_is_exported_and_has_its_meaning(package, kind, name):
    symbol = exported(f"{package}:{name}")
    if kind == "macro":
        assert symbol.macro is not None
    elif kind == "function":
        assert not isinstance(symbol.function, UndefinedFunction)
    elif kind == "variable":
        assert symbol.special and symbol.value is not UNBOUND
    elif kind == "predicate":
        assert functors[symbol].defined
    elif kind == "class":
        assert is_known_type(symbol) and find_class(symbol) is not None


@pytest.mark.parametrize("package", EXPORTS)
def test_nothing_else_is_exported_and_the_nicknames_are_known(package):
    assert set(find_package(package).external) == {name for _, _, name in names(package)}
    for nickname in NICKNAMES[package]:
        assert find_package(nickname) is find_package(package)


@pytest.mark.parametrize("designator, lambda_list", LAMBDA_LISTS.items())
def test_functions_have_the_lambda_lists_of_the_original(designator, lambda_list):
    shown = prin1_to_string(lambda_list_of(exported(designator).function))
    assert re.sub(r"#:|CRAM-[A-Z-]*::?", "", " ".join(shown.split())) == lambda_list


@pytest.mark.parametrize("designator", GENERIC.split())
def test_what_users_add_methods_to_is_a_generic_function(designator):
    assert exported(designator).function.methods is not None


@pytest.mark.parametrize("system", ["cram-projection", "cram-execution-trace", "cram-occasions-events"])
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


def test_the_fact_groups_have_the_names_of_the_original_and_three_of_them_extend_holds():
    from cramhy_runtime.prolog.engine.fact_groups import fact_group_names

    groups = {f"{group.package.name}::{group.name}" for group in fact_group_names()}
    assert {*(f"CRAM-OCCASIONS-EVENTS::{name}" for name in ("OCCASIONS", "FLUENTS", "TASKS")), "COMMON-LISP::TIME"} <= groups
    assert [group.name for group in functors[exported("coe:holds")].groups()][:3] == ["OCCASIONS", "FLUENTS", "TASKS"]


def test_packages_of_users_may_use_them_together_with_the_plan_language():
    from cramhy_runtime.repl.session import Session

    session = Session(time="virtual", turtlesim=False)
    session.evaluate_text("(defpackage together (:use :cpl :cram-projection :cram-execution-trace :cram-occasions-events :cram-executive))")
    assert find_package("TOGETHER").lookup("HOLDS")[0] is exported("coe:holds")


def test_a_program_may_have_packages_that_are_called_like_the_nicknames(lisp):
    # In the original these packages are there only if a program asks for them; PROJ is a likely name for a project.
    package = find_package("CRAM-PROJECTION")
    try:
        assert lisp("(package-name (defpackage :proj (:use :cl) (:nicknames :coe)))") == '"PROJ"'
        assert lisp("(list (package-name :proj) (package-name :coe) (package-name :occasions-events))") == (
            '("PROJ" "PROJ" "CRAM-OCCASIONS-EVENTS")'
        )
        assert lisp("(fboundp 'cram-projection:clock-time)") != "NIL"
        assert find_package("CRAM-PROJECTION") is package
    finally:
        delete_package(find_package("PROJ"))
        for full, nickname in (("CRAM-PROJECTION", "PROJ"), ("CRAM-OCCASIONS-EVENTS", "COE")):
            find_package(full).nicknames.append(nickname)
            register(find_package(full))
