"""Solutions are not tests, whatever their tasks are called. What a learner of Hy has defined in one test is not there in the next."""

import contextlib
import io
import sys

import pytest

from cramhy_runtime.course import learn
from cramhy_runtime.course.progress import Progress
from cramhy_runtime.course.shown import Style
from cramhy_runtime.repl.session import Session

from .walking import Script

collect_ignore = ["solutions"]


@pytest.fixture(autouse=True)
def fresh_console():
    """Forget the module in which Hy's prompt evaluates: all prompts of a process share it."""
    yield
    sys.modules.pop("__console__", None)


@pytest.fixture
def typed(tmp_path):
    """typed(lines, page, language, progress): what the screen shows."""

    def run(lines, page="first-forms", language="lisp", progress=None):
        out = io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
            learn.run(
                lambda closings: Session(time="virtual"),
                language,
                page,
                tmp_path / "files",
                progress or Progress(),
                Style(),
                Script(iter(lines)),
            )
        return out.getvalue()

    return run
