"""What the page of a tab asks beside the prompt: completions, how a call is written, packages as zip files, the check of a task.

Each question is a text of JSON, ``{"id": number, "what": name, ...}``. Its answer is ``{"id": number, "answer": value}``, or
``{"id": number, "refused": text}`` where the text is for the user. JavaScript asks between two turns of the tasks, so an answer comes while
a plan runs, and in the debugger. A check runs plans, so it is a `Request`, and its answer comes later.
"""

from __future__ import annotations

import base64
import json
import os
import re
import textwrap

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER, find_package
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.languages.commonlisp.tools.advice import explanation
from cramhy_runtime.languages.commonlisp.tools.error_reports import condition_of
from cramhy_runtime.repl.file_names import begun_string, file_names
from cramhy_runtime.session import fuzzy, requests
from cramhy_runtime.session.arglists import call_being_typed
from cramhy_runtime.session.completion import completions
from cramhy_runtime.session.requests import Request

from . import catkin_zip

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import ModuleType

    from cramhy_runtime.session.session import Session

MOST = 200
"""Completions that are sent."""
HEAD = re.compile(r"""([^\s()\[\]{}"';]+)(?=\s)""")
DELIMITERS = " \t\n()[]{}'`\",;~"


class Desk:
    """Answers the questions of the page.

    session: of the tab. say: sends the text of an answer to the page. ``package``: the one of the prompt. ``hy_module``: a function that
    returns the Python module in which Hy is typed, or ``None`` while no Hy has been typed. The prompt keeps both up to date.
    """

    def __init__(self, session: Session, say: Callable[[str], object]):
        self.session, self._say = session, say
        self.package = COMMON_LISP_USER
        self.hy_module: Callable[[], ModuleType | None] = lambda: None
        self._answers = {
            "complete": self._complete,
            "arglist": self._arglist,
            "export": self._export,
            "import": self._import,
            "check": self._check,
            "page": self._page,
        }

    def ask(self, text: str) -> None:
        """Answer a question. What is wrong with it, or goes wrong, is told to the page."""
        question = json.loads(text)
        number = question.pop("id")
        try:
            answer = self._answers[question.pop("what")](number, **question)
        except catkin_zip.UnfitPackage as problem:
            self._refuse(number, str(problem))
        except OSError as problem:
            self._refuse(number, f"The files cannot be read or written: {problem.strerror or problem}.")
        except Exception as problem:  # of a name that somebody defined oddly: the page goes on
            self._refuse(number, f"{type(problem).__name__}: {problem}")
        else:
            if answer is not LATER:
                self._answer(number, answer)

    def _answer(self, number: int, answer: Any) -> None:
        self._say(json.dumps({"id": number, "answer": answer}))

    def _refuse(self, number: int, why: str) -> None:
        self._say(json.dumps({"id": number, "refused": why}))

    def _package_named(self, name: str | None):
        return (find_package(name.upper()) if name else None) or self.package

    # ---------------------------------------------------------------------------------------------------------------- names

    def _complete(self, number, text, language="lisp", package=None):
        """{"length": how many characters of ``text`` the names take the place of, "options": [[name, what is known of it], ...]}."""
        typed = begun_string(text, hy=language == "hy")
        if typed is not None:
            names = [(name, "") for name in file_names(typed, os.getcwd())]
            length = len(typed)
        elif language == "hy":
            names, length = self._names_of_hy(text)
        else:
            home = self._package_named(package)
            names, length = completions(text, home)
            word = text[len(text) - length :]
            if not names and word and not word.startswith(":"):
                names = [(match.name.lower(), "") for match in fuzzy.completions(word, home, MOST)]
        return {"length": length, "options": names[:MOST]}

    def _names_of_hy(self, text):
        from cramhy_runtime.session.hy_completion import completions_in_hy

        module = self.hy_module()
        begin = max(map(text.rfind, DELIMITERS)) + 1
        word = text[begin:]
        return ([(name, "") for name in completions_in_hy(text, word, module)] if word and module is not None else []), len(word)

    def _arglist(self, number, text, language="lisp", package=None):
        """{"name": text, "items": [texts], "place": number of the item that is typed or null} of the call ``text`` ends in, or null."""
        if language == "hy":
            return self._shape_in_hy(text)
        found = call_being_typed(text, self._package_named(package))
        if found is None:
            return None
        name, items, place = found
        return {"name": name.lower(), "items": [item.lower() for item in items], "place": place}

    def _shape_in_hy(self, text):
        from cramhy_runtime.languages.hy.brackets import open_brackets

        lines = text.split("\n")
        for bracket, line, column in reversed(open_brackets(text)):
            head = HEAD.match(lines[line - 1][column:]) if bracket == "(" else None
            shape = self._shape_of(head[1]) if head else None
            if shape:
                return {"name": "", "items": [shape], "place": None}
        return None

    def _shape_of(self, name):
        """How a call of ``name`` is written in Hy, or ``None``."""
        import inspect

        import hy

        from cramhy_runtime.languages.hy.shapes import HY

        module = self.hy_module()
        space = {} if module is None else vars(module)
        operator = getattr(space.get("_hy_macros", {}).get(hy.mangle(name)), "operator", None)
        if operator is not None:
            return operator.shape
        function = space.get(hy.mangle(name))
        if name in HY or not callable(function):
            return HY.get(name)
        try:
            parameters = [hy.unmangle(each) for each in inspect.signature(function).parameters]
        except (TypeError, ValueError):
            return None
        return f"({' '.join([name, *parameters])})"

    # ---------------------------------------------------------------------------------------------------------------- packages

    def _export(self, number, path, name):
        """{"name": of the file, "data": the zip in base64} for the package that ``path`` belongs to, or for all files in no package."""
        file, data = catkin_zip.exported(os.getcwd(), path, name)
        return {"name": file, "data": base64.b64encode(data).decode()}

    def _import(self, number, data, replace=False):
        """{"files": the paths of what was unpacked}, or {"there": the name of a folder that would have to give way}."""
        try:
            return {"files": catkin_zip.imported(base64.b64decode(data), os.getcwd(), replace)}
        except catkin_zip.AlreadyThere as problem:
            return {"there": problem.args[0]}

    # ---------------------------------------------------------------------------------------------------------------- tasks

    def _page(self, number, page, language="lisp"):
        """The user has turned to the page of that name, for this language: what it needs of the pages before is there."""
        from cramhy_runtime.course import files
        from cramhy_runtime.course.reading import page as page_of

        files.settle(page_of(page), language)

    def _check(self, number, task, language="lisp"):
        """{"passed": bool, "told": [texts]} of the lesson's task of that name, solved in that language."""
        module = self.hy_module()
        if language == "hy" and module is None:
            return {"passed": False, "told": ["Nothing was typed in Hy yet. The form (in-hy) leads there."]}

        def work():
            from cramhy_runtime.course import checking

            evaluate = checking.hy_evaluator(module) if language == "hy" else None
            return checking.check(task, self.session, language, evaluate)

        def finished(request):
            if request.outcome == requests.DONE:
                self._answer(number, {"passed": bool(request.result["passed"]), "told": list(request.result["told"])})
            elif request.outcome == requests.INTERRUPTED:
                self._refuse(number, "The check was interrupted.")
            else:
                self._refuse(number, textwrap.dedent(explanation(condition_of(request.failure))).strip())

        kernel.active().post(lambda: Request(work, finished, debugger=lambda condition: None, name="the check of a task"))
        return LATER


LATER = object()
"""What is returned for a question whose answer comes later."""
