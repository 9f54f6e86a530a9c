"""The lessons in a tab, as the page lets its worker type them: each button, each block, each task's file, and its check.

The prompt, the desk and the debugger are the tab's own. What JavaScript does between them is done here by `Host`, as ``tab.js`` and
``lesson.js`` do it.
"""

from __future__ import annotations

import contextlib
import functools
import io
import json
import sys
from pathlib import Path

from cramhy_runtime import course, kernel
from cramhy_runtime.browser import tab
from cramhy_runtime.browser.desk import Desk
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.session import requests
from cramhy_runtime.session.session import Session

from .walking import ENDINGS, fails, solution

OF_PAGES = ("my_turtle", "turtlesim_in_hy", "cram_my_beginner_tutorial")
"""The beginnings of the names of modules that pages import: each process of a tab has its own."""
AT_MOST = 10_000
"""Seconds of the turtle for a check."""


@functools.cache
def pages():
    """The pages as the tab gets them, by name."""
    return {page["name"]: page for page in course.as_json()["pages"]}


class Host:
    """JavaScript's half. ``work``: a generator that yields lines for the prompt, and gets the text that was shown since."""

    def __init__(self, out):
        self.out, self.work, self.shown = out, None, 0
        self.prompt, self.place, self.answers = "", "null", {}
        self.lisp_package = "cl-user"

    @property
    def at(self):
        """The prompt that waits."""
        return json.loads(self.prompt)

    @property
    def line(self):
        text = self.out.getvalue()
        before, self.shown = self.shown, len(text)
        if (at := self.at).get("language") == "lisp":
            self.lisp_package = at["package"][0]
        try:
            return self.work.send(text[before:])
        except StopIteration:
            return "(hy.I.sys.exit 0)" if self.at.get("language") == "hy" else "(sb-ext:exit :code 0)"

    def debug(self, text):
        pass

    def wake(self):
        pass


class TabWalk:
    """A walk through a page, in a session that begins in ``folder``, where the files of pages before are. ``wrong``: what came otherwise
    than the page says. ``verdicts``: whether the solution of each task has passed."""

    def __init__(self, name, language, folder):
        self.name, self.language, self.wrong, self.verdicts = name, language, [], {}
        self.text, saved = "", (streams.ERROR_OUTPUT.value, sys.stdin, tab.host, tab.wait_for)
        path = list(sys.path)
        out = io.StringIO()
        out.reconfigure = lambda **more: None
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out), contextlib.chdir(folder):
            self.host = tab.host = Host(out)
            tab.wait_for = lambda line: line
            self.host.work = self._work()
            next_line = self.host.work
            lines = tab.PageLines()

            def make():
                session = Session(time="virtual", time_limit=2000)
                self.desk = lines.desk = Desk(session, self._answered)
                tab.let_import()
                requests.ask_whoever_asked()
                return session

            try:
                next(next_line)  # up to the first line
                self.status = tab.TabConsole(make, lines).run()
            finally:
                streams.ERROR_OUTPUT.value, sys.stdin, tab.host, tab.wait_for = saved
                sys.path[:] = path
                for name in [name for name in sys.modules if name.startswith(OF_PAGES)]:
                    del sys.modules[name]
                conditions.install_debugger(None)
                conditions.install_router(None)
                kernel.stop()
        self.text = out.getvalue()

    def _answered(self, text):
        told = json.loads(text)
        self.host.answers[told["id"]] = told

    def _work(self):
        yield None
        self.ask("page", page=self.name)
        for part in pages()[self.name]["parts"]:
            yield from getattr(self, f"_{part['kind']}")(self.name, part)
        if self.host.at["text"][0].isdigit():
            self.wrong.append(f"{self.name}: the debugger is open at the end")
            yield "q"

    def _text(self, name, part):
        yield from ()

    def _code(self, name, part):
        text = part[self.language]
        if text:
            answer = part["answer_hy" if self.language == "hy" else "answer"]
            shown = yield from self.run(text)
            if fails(shown) != fails(answer):
                self.wrong.append(f"{name}: {text}\n{shown}")

    def _file(self, name, part):
        if (file := part[self.language]) is not None:
            path = Path(file["name"])
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(file["text"])
        yield from ()

    def _task(self, name, part):
        start, task = part["start"][self.language], part["name"]
        file = f"{task}{ENDINGS[self.language]}" if start else None
        for text, passes in (("", False), (start, False), (solution(task, self.language), True)):
            if text and file:
                Path(file).write_text(text)
                yield from self.run(text if self.language == "hy" else f'(load "{file}")')
            elif text:
                shown = yield from self.run(text)
                if fails(shown):
                    self.wrong.append(f"{name}, {task}: {text}\n{shown}")
            if self.host.at["text"][0].isdigit():
                self.wrong.append(f"{name}, {task}: the debugger opened\n{self.host.out.getvalue()[-1500:]}")
                yield "q"
            told = self.check(task)
            self.verdicts[task] = told.get("answer", {}).get("passed")
            if self.verdicts[task] is not passes:
                self.wrong.append(f"{name}, {task}, {'solution' if passes else 'start' if text else 'nothing'}: {told}")

    def run(self, text):
        """Type ``text`` as the page's button does; what is shown then."""
        at, lines = self.host.at, []
        if self.language == "hy" and at.get("language") != "hy":
            lines.append("(in-hy)")
        elif self.language == "lisp" and at.get("language") == "hy":
            lines.append(f"(in-package :{self.host.lisp_package.lower()})")
        shown = ""
        for line in [*lines, text]:
            shown += (yield line) or ""
        return shown

    def check(self, task):
        """The answer of the page's button for a check."""
        return self.ask("check", task=task)

    def ask(self, what, **more):
        """The answer of the desk."""
        self.desk.ask(json.dumps({"id": what, "what": what, "language": self.language, **more}))
        end = kernel.now() + AT_MOST
        while what not in self.host.answers and kernel.now() < end:
            kernel.sleep(1)
        return self.host.answers.pop(what, {})
