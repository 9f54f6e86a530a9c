"""Those who learn in one language never meet the other one: in texts, samples, hints, and in what a check says.

Words that both languages have (``let``, ``fn`` behind a bracket, names of CRAM such as ``lisp-fun``) are in no list.
"""

from __future__ import annotations

import re

import pytest

from cramhy_runtime.course import contents, reading
from cramhy_runtime.course.steps import steps
from cramhy_runtime.course.parts import Code, File, text_in
from cramhy_runtime.course.shown import Style, text

OF_LISP = {
    r"\bLisp\b": "the name of the other language",
    r"(?i)debugger|restarts": "Hy has no debugger of Lisp's",
    r"^(?:[A-Z-]+> |\d+\] )": "a prompt of Lisp or of its debugger",
    r"\*[a-z]+(?:-[a-z]+)*\*(?!\*)": "stars around a name",
    r"\bNIL\b|\bnil\b": "None",
    r"(?<![\w-])T(?![\w'-])": "True",
    r"\((?:defun|defvar|defparameter|setf|let\* \(|let \(\(|dotimes|dolist|loop|lambda|progn|declare|destructuring-bind|define-condition)\b": "a form of Lisp",
    r"\b(?:defun|defvar|defparameter|setf|dotimes|dolist|defstruct|destructuring-bind|unwind-protect|ecase|format nil|format t)\b": "an operator of Lisp",
    r"#'|~%|&optional|&rest|&key": "a mark of Lisp",
    r"#<(?!3D-VECTOR)": "a value as Lisp shows it",
    r"\(lisp[ )]": "data of Lisp, where a string of Hy does",
    r"\.lisp\b|\.asd\b|\bsrc/": "a file of the package in Lisp",
    r"\bUNBOUND-VARIABLE|UNDEFINED-FUNCTION|-ERROR:": "a condition of Lisp",
    r"\d[de]0\b|\bd0\b": "a number as Lisp writes it",
    r"\bhyrule\b": "a library that the course does not speak of",
    r"roslisp_repl|CL-USER|lisp-unit|in-package|:use\b|in Hy\b": "of the other language",
    r"Ctrl(?:-D| and D)": "it leaves the course",
}
"""What a Hy learner does not meet: pattern, and why."""
OF_HY = {
    r"\bHy\b(?!\.)": "the name of the other language",
    r"\bPython\b": "not needed for Lisp",
    r"^ *=> ": "the prompt of Hy",
    r"\((?:defn|setv|lfor|gfor|defclass|require|import)\b": "a form of Hy",
    r"\b(?:defn|setv|hyrule|dataclass)\b": "an operator of Hy",
    r"\bNone\b(?! of)|\bTrue\b|\bFalse\b": "a constant of Python",
    r"\btut\.[a-z]|\.value\b": "an attribute of Python",
    r"NameError|Traceback|\bpytest\b": "of Python",
}
"""What a Lisp learner does not meet."""
OTHERS = {"hy": OF_LISP, "lisp": OF_HY}
MEANT = {("hy", "(lisp-package"): "explained where it comes first"}
"""What is of the other language, and has to be there: language and text, and why."""
OF_THE_ROBOT = re.compile(r"\[\(.*\) (?:INFO|WARN)\].*|^WARNING:\n.*\n|.*#<[A-Z](?:.|\n)*?>'\.$|^cramhy: [A-Z:-]+\n(?: .*\n|\n)*", re.M)
"""The robot's log, and the reports of CRAM about rules that failed: they look the same in both languages."""


def plain(markdown):
    """Markdown as a terminal shows it, where stars around a word are gone, and those of a name stay."""
    return text(markdown, Style(10_000))


def shown(name, language):
    """(where, text) of all that the page ``name`` shows to those who learn in ``language``."""
    page = reading.page(name)
    for number, step in enumerate(steps(page, language), 1):
        for markdown in step.texts:
            yield f"step {number}", plain(markdown)
        part = step.part
        if isinstance(part, Code):
            yield (
                f"step {number}",
                "".join(f"{typed.prompt}{typed.form}\n{OF_THE_ROBOT.sub('', typed.answer)}" for typed in getattr(part, language)),
            )
        elif isinstance(part, File):
            yield f"step {number}", "\n".join(getattr(part, language))
    for task in page.tasks:
        yield f"task {task.name}", plain(text_in(task.markdown, language))
        yield f"task {task.name}", task.start.get(language, "")
        for number, hint in enumerate(task.hints, 1):
            yield f"hint {number} of {task.name}", plain(text_in(hint, language))
        for check in task.checks:
            for key in ("say", "hint"):
                yield f"{key} of {task.name}", str(check.get(f"{key}-hy" if language == "hy" and f"{key}-hy" in check else key, ""))


def strangers(said, language):
    """(what was found, why it should not be there) of the words of the other language in a text."""
    for meant in (each for other, each in MEANT if other == language):
        said = said.replace(meant, "")
    for pattern, why in OTHERS[language].items():
        for match in re.finditer(pattern, said, re.M):
            line = said[said.rfind("\n", 0, match.start()) + 1 :].split("\n", 1)[0]
            yield f"{match[0]!r} ({why}) in: {line}"


@pytest.mark.soak(all_but=8)
@pytest.mark.parametrize("language", OTHERS)
@pytest.mark.parametrize("name", contents.NAMES)
def test_a_page_speaks_the_language_that_is_learnt(name, language):
    found = [f"{where}: {each}" for where, said in shown(name, language) for each in strangers(said, language)]
    assert not found, "\n".join(["", *found])


@pytest.mark.parametrize("language", OTHERS)
def test_the_patterns_find_the_other_language(language):
    """Each pattern finds something in what the pages show to those who learn the other language, or it looks for nothing."""
    other = "lisp" if language == "hy" else "hy"
    whole = "\n".join(said for name in contents.NAMES for _, said in shown(name, other))
    never_shown = (r"\(lisp[ )]", r"\bhyrule\b", r"Ctrl(?:-D| and D)", r"\bHy\b(?!\.)", r"\bPython\b")
    assert [pattern for pattern in OTHERS[language] if not re.search(pattern, whole, re.M) and pattern not in never_shown] == []
