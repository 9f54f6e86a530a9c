"""Each test has its own virtual time. The laws, in their own folder, run on both back ends in `make test`."""

import io
import itertools

import pytest
from systems import ONE_BACKEND

from cramhy_runtime import kernel
from cramhy_runtime.session import Image, boot
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

boot()


@pytest.fixture(params=ONE_BACKEND, autouse=True)
def fresh_kernel(request):
    with Image(as_now=True):
        yield kernel.start(clock="virtual", backend=request.param, time_limit=3600)


class PlanText:
    """Lisp as a user writes it, in a package of the test's own that uses CPL. ``(note x)`` adds to the list ``*notes*``."""

    numbers = itertools.count(1)
    beginning = """
        (defpackage {0} (:use :cpl)
          (:import-from :cpl-impl #:name #:child-tasks #:named-top-level #:with-task #:with-parallel-childs #:replace-task-code
                        #:register-task-code #:remove-top-level-task-tree #:code-sexp))
        (in-package {0})
        (defvar *notes* nil)
        (defun note (thing) (setf *notes* (append *notes* (list thing))) thing)"""

    def __init__(self, session, folder):
        self.session, self.folder = session, folder
        session.evaluate_text(self.beginning.format(f"PLAN-TEXT-{next(self.numbers)}"))

    def __call__(self, text):
        """The values of the last form of ``text`` as they are printed, separated by `` ; ``."""
        return " ; ".join(" ".join(prin1_to_string(value).split()) for value in self.session.evaluate_text(text, "<repl>"))

    def error(self, text):
        """What is shown of the error that ``text`` ends with; its package's name is cut out."""
        from cramhy_runtime.repl.session import condition_of

        with pytest.raises(BaseException) as problem:
            self.session.evaluate_text(text, "<repl>")
        return self._shown(condition_of(problem.value))

    def run(self, text):
        """What ``cramhy run plan.lisp`` prints of the error that ``text`` ends with."""
        from cramhy_runtime.repl.session import condition_of

        file = self.folder / "plan.lisp"
        file.write_text(text)
        with pytest.raises(BaseException) as problem:
            self.session.load(str(file))
        return self._shown(condition_of(problem.value))

    def _shown(self, condition):
        from cramhy_runtime.repl.console import report

        written = io.StringIO()
        report(condition, file=written)
        return written.getvalue().replace(self.session.package.name + "::", "")


@pytest.fixture
def plan_text(request, fresh_kernel, tmp_path, monkeypatch):
    """A `PlanText` in a session of its own, on the back end of `fresh_kernel`, which it replaces; in a folder of its own."""
    from cramhy_runtime.repl.session import Session

    monkeypatch.chdir(tmp_path)
    session = Session(time="virtual", backend=request.node.callspec.params["fresh_kernel"], time_limit=3600, turtlesim=False)
    yield PlanText(session, tmp_path)
    PACKAGE.value = COMMON_LISP_USER
