"""The two Lisps that answer questions: SBCL in a process of its own, and ours in this one. ``answer.lisp`` tells how both answer."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

from form_grammar import lisp_string

from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import one
from cramhy_runtime.lisp_core.packages import find_package
from cramhy_runtime.repl.session import Session

ANSWER = Path(__file__).parent / "answer.lisp"
SBCL = shutil.which("sbcl")


class TheirLisp:
    """SBCL, which answers one question after the other until it is closed."""

    def __init__(self):
        self.process = None

    def _start(self):
        options = "--noinform --no-sysinit --no-userinit --disable-debugger --eval".split()
        begin = "(setf sb-impl::*default-external-format* :utf-8 sb-impl::*stdin* (sb-sys:make-fd-stream 0 :external-format :utf-8 :buffering :full) sb-impl::*stdout* (sb-sys:make-fd-stream 1 :output t :input nil :external-format :utf-8 :buffering :full))"
        self.process = subprocess.Popen(
            [SBCL, *options, begin, "--load", str(ANSWER), "--eval", "(differ:serve)"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            encoding="utf-8",
        )

    def answer(self, question):
        """What SBCL answers, and what it answers to the end of a line alone when the question kills it."""
        if self.process is None or self.process.poll() is not None:
            self._start()
        try:
            self.process.stdin.write(lisp_string(question) + "\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            return "!! the process died"
        text = ""
        while line := self.process.stdout.readline():
            text += line
            if len(re.findall(r'(?<!\\)(?:\\\\)*"', text)) == 2:
                return re.sub(r"\\(.)", r"\1", text[1 : text.rindex('"')], flags=re.DOTALL)
        return "!! the process died"

    def close(self):
        """End the process."""
        if self.process is not None:
            self.process.kill()
            self.process.communicate()
            self.process = None


class OurLisp:
    """This runtime, in this process."""

    def __init__(self):
        self.session = Session(time="virtual", turtlesim=False)
        self.session.load(str(ANSWER))
        self.symbol = find_package("DIFFER").external["ANSWER"]

    def answer(self, question):
        """What we answer, or the exception of Python that came out."""
        try:
            return str(one(self.symbol.function(question)))
        except (Exception, Condition) as problem:
            return f"!! {type(problem).__name__} left the handler: {problem}"
