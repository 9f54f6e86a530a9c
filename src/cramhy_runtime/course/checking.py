"""Checks whether a task of the course is solved, in the session in which the student has typed. The judges are those of exercises."""

from __future__ import annotations

import functools
import re
import sys

from cramhy_runtime.grading import in_session
from cramhy_runtime.lisp_core import restarts
from cramhy_runtime.lisp_core.conditions import handler_bind
from cramhy_runtime.lisp_core.condition_types import Warning_
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import near_names, sym
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.ros import graph, rosout

from . import bodies, contents, plan_places, rules, slips
from .parts import Task
from .reading import PageError, page, pages
from .typed_forms import TypedForms

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from types import FrameType

    from cramhy_runtime.session.session import Session

NOT_TAKEN = (
    "Your last definition of {} was not taken: it led to an error, and an older one still counts. "
    "Type the definition again, without the mistake."
)
PRINTED = "Printing is not answering: the answer of a function is the value of its last form."
_NO_ANSWER = re.compile(r"\((?P<function>[^\s()]+)[^\n]* should give [^\n]+, and gave (?:NIL|None)\.")
_ASKED = re.compile(r"\(prolog '\(([a-z][\w-]*)")
_PRINTS = re.compile(r"\((?:print|princ|prin1|format)\s", re.I)
NOTHING_WAITS = "Nothing waits in {} after send-vel-cmd. The turtle needs a second for what it is told."
PASSED = "Well done: this task is solved."


def task(name: str) -> Task:
    """The task of that name. Raises `PageError`."""
    tasks = {each.name: each for one in pages() for each in one.tasks}
    if name not in tasks:
        near = near_names(name, tasks)
        raise PageError(f"There is no task {name}. " + (f"Did you mean {near[0]}?" if near else f"There are {', '.join(tasks)}."))
    return tasks[name]


def check(
    name: str,
    session: Session | None = None,
    language: str = "lisp",
    evaluate: Callable[[str], list[Any]] | None = None,
    caller: FrameType | None = None,
) -> dict[str, Any]:
    """Whether the task ``name`` is solved: ``{"passed": bool, "told": [str, ...]}``. It is called by the session's main task.

    session: the student's; ``None``: the current one. language: "lisp" or "hy", in which the solution is written. evaluate: gives the
    values of a text in that language, for Hy in the module where the student types; by default the session evaluates Lisp in its package,
    and Hy in the module of ``caller``, or of the prompt. caller: a frame of the program that asks, if one does. Raises `PageError` for an
    unknown name, and `Interruption` after Ctrl-C.
    """
    wanted = task(name)
    if evaluate is None:
        evaluate = _hy_evaluator(caller) if language == "hy" else _lisp_evaluator(session)
    typed = TypedForms.of_session(language, caller)
    if (name_of := typed.refused()) is not None:
        return {"passed": False, "told": [NOT_TAKEN.format(name_of)]}
    tables = [in_language(table, language) for table in wanted.checks]
    forbidden = [table.pop("without") for table in tables if "without" in table]
    wrong = _quietly(lambda: in_session.faults(wanted.title, tables, evaluate, language, typed.form))
    for each in forbidden if not wrong else ():
        calls = re.compile(rf"\((?:[\w-]+[:.])?{each['form']}[\s)]", re.I)
        if any(calls.search(form) for table in tables for form in typed.concerned(table["do"])):
            wrong = [each["say"]]
    if wrong and "ended with an error" not in wrong[0] and (told := _helper(wanted, evaluate, language, typed)) is not None:
        wrong = [told]
    if wrong and (match := _NO_ANSWER.match(wrong[0])) is not None and _PRINTS.search(typed.definition(match["function"]) or ""):
        wrong.append(PRINTED)
    wrong = [plan_places.in_check(sentence, typed.definition) for sentence in wrong]
    if wrong and wanted.name in _beginners() and in_session.missing_name(wrong) is None:
        forms = " ".join(table.get("do", "") for table in tables)
        wrong[:0] = [NOTHING_WAITS.format(function) for function in [typed.driving_without_waiting(forms)] if function is not None]
    if wrong and (told := _slip(typed, tables, language)) is not None:
        wrong.append(told)
    worded = slips.in_words_of_hy if language == "hy" else slips.in_words_of_lisp
    return {"passed": not wrong, "told": list(map(worded, wrong)) or [PASSED]}


def _helper(wanted, evaluate, language, typed):
    """What to say of a function of an earlier step that is wrong, so that a solution which calls it cannot be right; else ``None``."""
    for table in wanted.helpers:
        own = in_language({key: value for key, value in table.items() if key != "name"}, language)
        if typed.definition(table["name"]) is None:
            continue
        wrong = _quietly(lambda own=own: in_session.faults(wanted.title, [own], evaluate, language, typed.form))
        if wrong and in_session.missing_name(wrong) is None:
            return table["say"]
    return None


def predicates(tables: Iterable[dict[str, Any]]) -> list[str]:
    """The predicates that the checks of a task ask for by their names."""
    return list(dict.fromkeys(name for table in tables for form, _ in table.get("ask", ()) for name in _ASKED.findall(form)))


def _slip(typed, tables, language):
    """What is written otherwise than it was meant in the solution that does not pass; ``None`` if nothing is known to be."""
    called = " ".join([*(table.get("do", "") for table in tables), *(form for table in tables for form, _ in table.get("ask", ()))])
    for form in typed.concerned(called):
        told = rules.of_predicates(form, predicates(tables)) if "<-" in form else None
        told = told or rules.of_form(form, language, checked=True) or bodies.of_form(form, language, typed.functions(), in_task=True)
        if told is not None:
            return told.removeprefix("; ")
    return None


@functools.cache
def _beginners():
    """The names of the tasks on the pages on which a student sends the turtle each command by itself."""
    return {each.name for name in contents.NAMES[:2] for each in page(name).tasks}


def _quietly(look: Callable[[], list[str]]) -> list[str]:
    """What ``look`` returns. Meanwhile no log of the robot and no warning is shown: a check calls the student's functions often."""
    levels = graph.active().debug_levels
    before = dict(levels)
    levels.clear()
    levels[()] = rosout.WARN
    try:
        return handler_bind([(Warning_, restarts.muffle_warning)], look)
    finally:
        levels.clear()
        levels.update(before)


def in_language(table: dict[str, Any], language: str) -> dict[str, Any]:
    """The table of a check with what counts in ``language``: the key ``do-hy`` replaces ``do`` in Hy."""
    common = {key: value for key, value in table.items() if not key.endswith("-hy")}
    own = {key.removesuffix("-hy"): value for key, value in table.items() if key.endswith("-hy")}
    return {**common, **own} if language == "hy" else common


def _lisp_evaluator(session):
    from cramhy_runtime.session.session import current

    chosen = session or current()
    if chosen is None:
        raise PageError("There is no session in which something could have been typed.")
    return lisp_evaluator(chosen)


def lisp_evaluator(session: Session) -> Callable[[str], list[Any]]:
    """A function that evaluates texts of Lisp in ``session``, without the compiler's warnings: a check's text is not the student's."""
    from cramhy_runtime.languages.commonlisp.compiler.compilation_unit import MUFFLED

    def evaluate(text):
        with binding(MUFFLED, (sym("WARNING"),)):
            return session.evaluate_text(text, typed=False)

    return evaluate


def _hy_evaluator(caller=None):
    home = sys.modules.get(caller.f_globals.get("__name__")) if caller is not None else None
    if home is not None and vars(home) is caller.f_globals:  # and not a form of Lisp
        return hy_evaluator(home)
    cells = sys.modules.get("cramhy_runtime.jupyter.cells")  # if this is a notebook; a tab of a browser is without that room
    for name in (*([cells.MODULE] if cells else []), "__console__", "__main__"):
        module = sys.modules.get(name)
        if module is not None and ((cells and name == cells.MODULE) or hasattr(module, "_hy_repl")):
            return hy_evaluator(module)
    raise PageError("Nothing was typed in Hy: there is no prompt of Hy, and no cell.")


def hy_evaluator(module: Any) -> Callable[[str], list[Any]]:
    """A function that evaluates texts of Hy in ``module``, and gives the value of the last form in a list."""

    def evaluate(text):
        import hy

        value = None
        for model in hy.read_many(text):
            value = hy.eval(model, module=module)
        return [value]

    return evaluate
