"""What the guide says of a slip: a line as Python writes it, parentheses for brackets, a form that needs another one which was passed over.

Beginners come from Python, and they skip forms with ``:next``. The guide says one sentence below the answer of the prompt. It has the words
of the student: after ``def area(x, y):`` a Hy learner reads ``(defn area [x y] ...)``.
"""

from __future__ import annotations

import re
import sys

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, NamedTuple

from . import plan_places

if TYPE_CHECKING:
    from collections.abc import Iterable

NAMED = {"lisp": "Lisp", "hy": "Hy"}
EXAMPLE = "({} 7 9)"
"""A call of an operator, where the student's own would be the answer of a task."""
_OPERATORS = r"[-+*/]"
_OPERAND = r"[\w.]+"
_INFIX = re.compile(rf"{_OPERAND}(?:\s*({_OPERATORS})\s*{_OPERAND})(?:\s*\1\s*{_OPERAND})*")
_INFIX_CALL = re.compile(rf"\(({_OPERAND})\s+({_OPERATORS})\s+({_OPERAND})((?:\s+\2\s+{_OPERAND})*)\)")
_GLUED = re.compile(rf"(?<!')\(({_OPERATORS})(\d[\d.]*)(?:((?:\s+{_OPERAND})*)\)|\s)")
_NUMBER_FIRST = re.compile(rf"\(\d[\d.]*\s+({_OPERATORS})\s")
_INFIX_INSIDE = re.compile(
    rf"\((?P<head>{_OPERATORS})(?P<before>(?:\s+{_OPERAND})+)\s+(?P<operator>{_OPERATORS})(?P<behind>(?:\s+{_OPERAND})+)\)"
)
_NOT_CLOSED = re.compile(r"(?:defun|defn|defvar|defparameter|setf|setq|setv|def-fact-group|top-level|sleep)\s+\S.*", re.S)
_ROUND = re.compile(r"\((?P<head>defn\s+\S+|for|let|lfor)\s+\((?P<inside>[^()]*(?:\([^()]*\)[^()]*)*)\)", re.S)


def _arguments(text):
    return " ".join(part.strip() for part in text.split(",") if part.strip())


def _variable(name, language):
    return f"*{name.strip('*')}*" if language == "lisp" else name


def _import(found, language):
    if language == "lisp":
        return "It loads no modules of Python; the functions that a page needs are loaded by its forms."
    modules, names = found["modules"], found["names"]
    return f"(import {_arguments(modules)}{f' [{_arguments(names)}]' if names else ''})"


def _def(found, language):
    head, around = ("defun", "()") if language == "lisp" else ("defn", "[]")
    return f"({head} {found['name']} {around[0]}{_arguments(found['arguments'])}{around[1]} ...)"


def _for(found, language):
    each, of = found["each"], found["of"].strip()
    times = re.fullmatch(r"range\s*\(([^,()]*)\)", of)
    if language == "hy":
        return f"(for [{each} {f'(range {times[1].strip()})' if times else of}] ...)"
    return f"(dotimes ({each} {times[1].strip()}) ...)" if times else f"(dolist ({each} {of}) ...)"


def _condition(text):
    found = re.fullmatch(r"(\S+)\s*(<=|>=|==|<|>)\s*(\S+)", text.strip())
    return f"({'=' if found[2] == '==' else found[2]} {found[1]} {found[3]})" if found else text.strip()


def _while(found, language):
    condition = _condition(found["condition"])
    return f"(loop while {condition} do ...)" if language == "lisp" else f"(while {condition} ...)"


def _assignment(found, language):
    name, value = _variable(found["name"], language), found["value"].strip()
    if language == "hy":
        return f"(setv {name} {value})"
    return f"(defvar {name} {value}), and if the variable is there already, (setf {name} {value})"


def _element(found, language):
    return f"({'get' if language == 'hy' else 'elt'} {found['name']} {found['place']})"


_LIKE_PYTHON = [
    (re.compile(r"(?P<name>[A-Za-z][\w.-]*)\[(?P<place>[^\[\]]+)\]"), _element),
    (re.compile(r"(?:from\s+(?P<modules>[\w.]+)\s+)import\s+(?P<names>.+)"), _import),
    (re.compile(r"import\s+(?P<modules>[\w., ]+)(?P<names>)"), _import),
    (re.compile(r"def\s+(?P<name>[\w-]+)\s*\((?P<arguments>[^()]*)\)\s*:?.*"), _def),
    (re.compile(r"for\s+(?P<each>\w+)\s+in\s+(?P<of>[^:]*[^:\s])\s*:?.*"), _for),
    (re.compile(r"while\s+(?P<condition>[^:]+):.*"), _while),
    (re.compile(r"(?:if|elif)\s+(?P<condition>[^:]+):.*"), lambda found, language: f"(if {_condition(found['condition'])} this that)"),
    (re.compile(r"(?P<name>[A-Za-z_*][\w*-]*)\s*=\s*(?P<value>[^=\s].*)"), _assignment),
    (
        re.compile(r"(?P<name>[A-Za-z][\w.-]*)\((?P<arguments>[^()]*)\)"),
        lambda found, language: f"({' '.join([found['name'], *found['arguments'].replace(',', ' ').split()])})",
    ),
]
"""How a line of Python looks, and what stands for it."""


def of_line(text: str, language: str, in_task: bool = False) -> str | None:
    """What to say of a line that is written as in Python, or lacks parentheses, or has an operator among arguments; else ``None``.

    in_task: whether a task is shown. Then the sentence has other numbers and names than the line, which may be all but the answer.
    """
    line = text.strip()
    found = _INFIX_INSIDE.search(line)
    if found and in_task:
        operator = found["operator"]
        return f"; Each {operator} has parentheses of its own, as in ({found['head']} 5 {EXAMPLE.format(operator)})"
    if found:
        inside = f"({found['operator']}{' '.join(['', *found['behind'].split()])})"
        return f"; Each {found['operator']} has parentheses of its own: ({found['head']} {' '.join(found['before'].split())} {inside})"
    if not line or line.startswith(("(", ";", ":", "[", '"', "'")):
        return None
    name = NAMED[language]
    if re.fullmatch(r"return\b.*", line):
        return f"; {name} needs no return here: the last form of a function is its value."
    if re.fullmatch(r"else\s*:.*", line):
        return f"; In {name} the other case stands in the form, too: (if condition this that)"
    infix = _INFIX.fullmatch(line)
    if infix and not re.fullmatch(_OPERAND, line) and not re.fullmatch(r"[A-Za-z][\w.]*(?:-[\w.]+)+", line):
        if in_task:
            return _comes_first(infix[1])
        operands = re.split(rf"\s*{re.escape(infix[1])}\s*", line)
        return f"; The name of a function comes first, in parentheses: ({infix[1]} {' '.join(operands)})"
    for pattern, wording in _LIKE_PYTHON:
        found = pattern.fullmatch(line)
        if found:
            found = pattern.fullmatch("name = 7") if in_task and wording is _assignment else found
            written = wording(found, language)
            return f"; In {name} this is written {written}" if written.startswith("(") else f"; This is not {name}. {written}"
    if _NOT_CLOSED.fullmatch(line):
        return f"; A form has parentheses around it: ({line})"
    return None


def _comes_first(operator):
    return f"; The name of a function comes first, in parentheses: 7 {operator} 9 is written {EXAMPLE.format(operator)}"


def of_failed_form(text: str, language: str, in_task: bool = False) -> str | None:
    """What to say of a form in parentheses that has failed, if it is written as in another language; else ``None``.

    in_task: as of `of_line`.
    """
    if glued := _GLUED.search(text):
        written = (
            f"({glued[1]} {glued[2]}{' ...' if glued[3] is None else glued[3]})"
            if not in_task
            else f"behind the {glued[1]}, as in {EXAMPLE.format(glued[1])}"
        )
        return f"; A space is missing{': ' if not in_task else ' '}{written}"
    if language != "hy":
        return None
    found = _INFIX_CALL.search(text)
    if found and in_task:
        return _comes_first(found[2])
    if not found and (other := _NUMBER_FIRST.search(text)):
        return _comes_first(other[1])
    if found:
        more = "".join(re.findall(rf"\s{_OPERAND}", found[4]))
        return f"; The name of the function comes first: ({found[2]} {found[1]} {found[3]}{more})"
    found = _ROUND.search(text)
    if found:
        head, inside = " ".join(found["head"].split()), " ".join(found["inside"].split())
        return f"; {'The arguments' if head.startswith('defn') else 'The names and values'} stand in brackets: ({head} [{inside}] ...)"
    return None


_NAMED = re.compile(r"unexpected keyword argument '(\w+)'")


def of_error(told: str, text: str, language: str) -> str | None:
    """What to say of an error with the text ``told``, for the form ``text``: a keyword of Lisp where Hy wants a text; else ``None``."""
    found = _NAMED.search(told) if language == "hy" else None
    word = found and found[1].replace("_", "-")
    if word and re.search(rf":{re.escape(word)}(?=[\s)])", text):
        return f'; In Hy a word behind a colon says which argument comes next. Write a text if it is a value: "{word}"'
    return None


_OF_HY = re.compile(r"(\S+) is Hy\. In Common Lisp it is (?:written )?(.+)\. In a \.hy file .*")
_BRACKET = re.compile(r"(\S) is a bracket of Hy\. Common Lisp writes (.+)\. In a \.hy file .*")


_OF_LISP = re.compile(r"(\S+) is Common Lisp\. In Hy it is written (.+)\. Common Lisp begins after .*")
_TAKES = re.compile(r"^(\s*)(?:The function )?(?:[A-Z][A-Z0-9-]*::?)?([A-Z][A-Z0-9-]*) takes ", re.M)
"""How a message names a function, as Lisp prints its name."""
_RUNNING = re.compile(r"\((?:cpm:)?with-process-modules-running \(([^()]*)\) \.\.\.\)")
_NESTED = "leave TOP-LEVEL away here, or make what is called a plan function with DEF-CRAM-FUNCTION."
_ARGUMENTS = {
    "The lambda list": "The list of arguments",
    "in the lambda list": "in the list of arguments",
    "the parameters stand": "the names of the arguments stand",
    "a parameter must be": "an argument has to be",
    "(parameter": "(argument",
    "[parameter": "[argument",
}
"""What messages call arguments, and what the pages do."""


def in_words_of_lisp(told: str) -> str:
    """The text of an error for those who learn Lisp: in the pages' words, and where it speaks of Hy, only how Lisp writes the same."""
    told = _BRACKET.sub(r"Lisp has no \1 here. It writes \2.", _OF_HY.sub(r"In Lisp, \1 is written \2.", told))
    return _in_words_of_pages(_OF_COURSE.sub(r"\1", told))


def in_words_of_hy(told: str) -> str:
    """The text of an error for those who learn Hy, as `in_words_of_lisp`."""
    told = _RUNNING.sub(r"(with-process-modules-running [\1] ...)", told)
    told = _OF_COURSE.sub(r"\1.hy", _OWN.sub("", told))
    told = re.sub(r"The Lisp function (?:[\w-]+::?)?(\S+) signalled", r"The function \1 signalled", told)
    told = re.sub(r"\bSB-PCL::NO-(?:PRIMARY|APPLICABLE)-METHOD-ERROR", "NO-METHOD-FOR-THESE-ARGUMENTS", told)
    told = told.replace(_NESTED, "leave top-level away here.")
    told = _TAKES.sub(lambda found: f"{found[1]}{found[2].lower()} takes ", told)
    return _in_words_of_pages(_OF_LISP.sub(r"In Hy, \1 is written \2.", told))


_OF_COURSE = re.compile(r"(?<=at )\S*?(cram_my_beginner_tutorial/src/[\w-]+)\.hy(?=:\d)")
"""A place in the course's own package. It is Lisp, though its files are ones of Hy."""
_OWN = re.compile(r"\b(?:my-turtle|turtlesim-in-hy|hy-user)::", re.I)
"""Where Lisp says of which package a name of the student's own files is."""
_STANDARD = re.compile(r"^ *See also:\n *The ANSI Standard, [^\n]*\n?", re.M)
_NET = re.compile(r"while the net \S+( over the fluents? [^\n:]*?)? was (made|computed)(: its first value is computed at once)?")


def _of_net(found):
    of = found[1].replace(" over ", " of ") if found[1] else ""
    return f"while a fluent{of} was {found[2]}"


def _in_words_of_pages(told):
    told = _NET.sub(_of_net, _STANDARD.sub("", told))
    told = plan_places.at_prompt(told)
    for word, wanted in _ARGUMENTS.items():
        told = told.replace(word, wanted)
    return told


# ---------------------------------------------------------------------------------------------------------- what was passed over

_DEFINES = re.compile(
    r"\((?:defn|defun|defvar|defparameter|def-process-module|def-cram-function|define-condition|define-test|defclass(?:\s+\[[^\]]*\])?)"
    r"\s+([^\s()\[\]]+)"
)
_LOADS = re.compile(r"\s*\((?:import|require|in-package|lisp-package|ros-load:load-system|load|defpackage)\s")
_OF_NAMES = re.compile(r"\s*\(import\s[^*]*\)\s*$", re.S)
"""An import that makes only the names known that stand in it."""
_STARTS = re.compile(r"\s*\((?:[\w-]+\.)?(?:init|start-ros-node|init-ros-turtle)[\s)]")
_SETS = re.compile(r"\s*\((?:set[fqv]|def[\w-]*)\s")
_LEADS_TO = re.compile(r"\s*\((?:lisp-package|in-package)\s+:([^\s()]+)\s*\)")


class Form(NamedTuple):
    """A form of a page: its text, and the number of its step."""

    text: str
    step: int


def names(form: str) -> set[str]:
    """The names, in lower case, that a form of a page defines."""
    found = set(_DEFINES.findall(form))
    if re.match(r"\(setv\s", form):
        found.update(re.findall(r"\(setv\s+(\S+)", form))
    if re.match(r"\(import\s", form):
        found.update(re.findall(r":as\s+([^\s()]+)", form))
        for group in re.findall(r"\[([^\]]*)\]", form):
            found.update(group.split())
    return {name.lower().replace("_", "-") for name in found}


def of_missing(name: str, forms: Iterable[Form], here: int, page: int, known: Iterable[str]) -> str | None:
    """What to say when ``name`` is not defined, and ``forms`` of the page were not typed; ``None`` if they have nothing to do with it.

    here: the number of the step that is shown. page: the number of the page. known: the names that the page uses; what it loads may have
    one of these, but none that the student has made up.
    """
    forms = list(forms)
    wanted = name.lower().replace("_", "-")
    for form in forms:
        if wanted in names(form.text):
            return _lack(form, here, page, f"{wanted} is defined by")
    for form in forms if wanted in {word.lower().replace("_", "-") for word in known} else ():
        if _LOADS.match(form.text) and not _OF_NAMES.match(form.text):
            return _lack(form, here, page, "What this page needs is loaded by")
    return None


def _is_pythons(text):
    """Whether a form imports a module that comes with Python."""
    found = re.match(r"\s*\(import\s+([\w-]+)", text)
    return found is not None and found[1].replace("-", "_") in sys.stdlib_module_names


def of_unready(forms: Iterable[Form], here: int, page: int, told: str = "") -> str | None:
    """What to say of an error in a file, if one of ``forms``, which were not typed, starts the robot; else ``None``.

    told: the text of an error at any place, instead. Then it is about a form that leads to the package of a name that the text guesses.
    here, page: as of `of_missing`.
    """
    for form in forms:
        package = _LEADS_TO.match(form.text)
        if package and f"did you mean {package[1]}::" in told.lower():
            return _lack(form, here, page, f"The names of {package[1]} are there after")
        if not told and _STARTS.match(form.text):
            return _lack(form, here, page, "The robot is started by")
    return None


def of_unprepared(forms: Iterable[Form], here: int, page: int) -> str | None:
    """What to say of a task that is not solved, where one of ``forms``, which were not typed, loads or starts something."""
    for form in forms:
        loads = _LOADS.match(form.text) and not _is_pythons(form.text)
        if loads or _STARTS.match(form.text) or _LEADS_TO.match(form.text):
            return _lack(form, here, page, "This page begins with")
    return None


def is_needed(text: str) -> bool:
    """Whether a form of a page defines, loads, starts or sets something."""
    return bool(names(text) or _LOADS.match(text) or _STARTS.match(text) or _LEADS_TO.match(text) or _SETS.match(text))


def first_line(text: str) -> str:
    """The first line of a form, with points if there are more."""
    first, *others = text.splitlines()
    if not others:
        return first
    return f"{first} ..." if " " in first else f"{first} ...)"


def _lack(form, here, page, what):
    shown = first_line(form.text)
    if form.step == here:
        return f"; {what} a form of this step that you have not typed yet: {shown}"
    return (
        f"; {what} a form that you have not typed: {shown}{'' if '...' in shown[-4:] else '.'} :page {page} {form.step} leads back to it."
    )


__all__ = [
    "Form",
    "first_line",
    "in_words_of_hy",
    "in_words_of_lisp",
    "is_needed",
    "names",
    "of_error",
    "of_failed_form",
    "of_line",
    "of_missing",
    "of_unprepared",
    "of_unready",
]
