"""A session: one kernel, one image, forms evaluated one after the other.

All surfaces share it: the console, ``cramhy run``, ``cramhy eval``, and the tests. In virtual time the clock moves only while
a form is evaluated; after each form the other tasks run until nothing is left to do at that instant (`kernel.settle`), so a
callback whose message has arrived has run before the next prompt.
"""

from __future__ import annotations

import functools
import gc
import os
from pathlib import Path

from cramhy_runtime import image, kernel
from cramhy_runtime.lisp import conditions
from cramhy_runtime.lisp.evaluation import evaluator
from cramhy_runtime.lisp.systems import asdf, systems, unit_tests
from cramhy_runtime.lisp.evaluation.compilation_unit import signalling_position
from cramhy_runtime.lisp.conditions import Condition, from_python
from cramhy_runtime.lisp.data import all_values, list_from
from cramhy_runtime.lisp.faces import define_face
from cramhy_runtime.lisp.files.namestrings import parse_native
from cramhy_runtime.lisp.packages import COMMON_LISP_USER, find_package_or_error, sym
from cramhy_runtime.lisp.files.pathnames import DEFAULTS
from cramhy_runtime.lisp.evaluation.places_in_source import circumstance, locate

from . import typed_texts

HISTORY = [sym(name) for name in ("*", "**", "***")]
LAST_VALUES = [sym(name) for name in ("/", "//", "///")]
LAST_FORMS = [sym(name) for name in ("+", "++", "+++")]
THIS_FORM = sym("-")


def leave(*, code=0, unix_status=0, abort=None, timeout=None, recklessly_p=None):
    """``(quit)``, ``(exit :code 3)``: end the program, through the cleanup of its plans."""
    raise SystemExit(code or unix_status)


def define_leaving():
    """``exit`` and ``quit`` of SB-EXT, present in CL-USER as in SBCL."""
    package = define_face("SB-EXT", functions={"exit": leave, "quit": leave})
    for name in ("EXIT", "QUIT"):
        COMMON_LISP_USER.import_symbol(package.intern(name))


class Interruption(Exception):
    """A form was ended by Ctrl-C; the plan below it has been cleaned up."""


@functools.cache
def quiet_collector():
    """Let the garbage collector leave the image alone, which lives as long as the process, and come less often: Lisp makes conses."""
    gc.freeze()
    gc.set_threshold(20_000, 20, 20)


class Session:
    """Evaluates forms in an image. The calling thread becomes the kernel's main task.

    time: "virtual" or "wall". seed: of the scheduler's order, ``None`` for first come, first served. backend: "threads" or
    "greenlet". time_limit: seconds of plan time after which a form is ended. turtlesim: whether the simulator starts with the
    first node. cleanup_limit: seconds that plans get for their cleanup when the session ends, or ``None``.
    """

    def __init__(self, time="wall", seed=None, backend="threads", time_limit=None, turtlesim=True, cleanup_limit=kernel.CLEANUP_LIMIT):
        image.fresh_start(time, backend, seed, time_limit, turtlesim, cleanup_limit=cleanup_limit)
        evaluator.PACKAGE.value = COMMON_LISP_USER
        define_leaving()
        for variables in (HISTORY, LAST_VALUES, LAST_FORMS, [THIS_FORM]):
            for variable in variables:
                variable.value = None
        DEFAULTS.value = parse_native(os.getcwd() + "/")
        self.virtual = time == "virtual"
        self.texts = 0
        quiet_collector()

    @property
    def package(self):
        return evaluator.PACKAGE.value

    @package.setter
    def package(self, designator):
        evaluator.PACKAGE.value = find_package_or_error(designator)

    def prompt(self):
        """``TUT> ``: the shortest name of the current package."""
        return f"{min(self.package.names, key=len)}> "

    def load(self, system):
        """Load a system by name, or a file by its path."""
        try:
            self._load(system)
        except kernel.Terminated:
            raise
        except (kernel.Interrupted, kernel.Abandoned):
            raise Interruption from None
        finally:
            kernel.interrupt_over()

    def _load(self, system):
        from cramhy_runtime.lisp.systems import loader

        if system.endswith((".lisp", ".hy")):
            loader.load_file(system)
        elif system.endswith(".asd"):
            systems.load_asd(system)
            systems.load_system(Path(system).stem)
        elif Path(system).is_file():
            conditions.error(conditions.types.FileError(system, "Cannot load ~A: what is loaded is a .lisp, .hy or .asd file, or a system "
                                                        "by its name.", system))
        else:
            systems.load_system(system)

    def test(self, path):
        """Run the tests of a system by name, a file, or the test files below a folder; whether there were some and all passed."""
        try:
            return self._test(path)
        except kernel.Terminated:
            raise
        except (kernel.Interrupted, kernel.Abandoned):
            raise Interruption from None
        finally:
            kernel.interrupt_over()

    def _test(self, path):
        tests = self._tests(path)
        if tests:
            return unit_tests.report(tests)
        system = None if Path(path).suffix in (".lisp", ".hy") or Path(path).is_dir() else systems.find_system(Path(path).stem)
        if system is not None and system.methods:  # it says itself what its tests are
            return asdf.test_system(system)
        return conditions.error(f"There are no tests of lisp-unit or FiveAM in {path}.".replace("~", "~~"))

    def _tests(self, path):
        if Path(path).is_dir():
            files = sorted(file for file in Path(path).rglob("*") if unit_tests.looks_like_tests(file))
            return [test for file in files for test in unit_tests.load_tests(file)]
        if path.endswith((".lisp", ".hy")):
            return unit_tests.load_tests(path)
        if path.endswith(".asd"):
            return unit_tests.load_asd_tests(path)
        return unit_tests.load_system_tests(path)

    def forms(self, text, name=None):
        """The forms of a text typed at the prompt, each with the reader that knows its places."""
        from cramhy_runtime.lisp.reader.reader import Reader

        self.texts += 1
        name = name or f"<repl {self.texts}>"
        typed_texts.keep(name, text)
        reader = Reader(text, filename=name)
        end = object()
        while (form := reader.read(eof_error=False, eof_value=end)) is not end:
            yield form, reader

    def evaluate(self, form, reader=None):
        """The values of ``form`` as a list. Conditions that nobody handles are raised, with their place if it is known."""
        THIS_FORM.value = form
        try:
            if reader is None:
                values = all_values(evaluator.evaluate(form))
            else:
                values = all_values(evaluator.evaluate(form, reader.filename, reader.positions))
            if kernel.current() is kernel.active().main:  # and not the debugger of a plan's task
                kernel.settle()
        except kernel.Terminated:
            raise
        except (kernel.Interrupted, kernel.Abandoned):
            raise Interruption from None
        except Condition as condition:
            locate(condition, condition)
            raise
        finally:
            kernel.interrupt_over()
            LAST_FORMS[0].value, LAST_FORMS[1].value, LAST_FORMS[2].value = form, LAST_FORMS[0].value, LAST_FORMS[1].value
        if values:
            HISTORY[0].value, HISTORY[1].value, HISTORY[2].value = values[0], HISTORY[0].value, HISTORY[1].value
        LAST_VALUES[0].value, LAST_VALUES[1].value, LAST_VALUES[2].value = list_from(values), LAST_VALUES[0].value, LAST_VALUES[1].value
        return list(values)

    def evaluate_text(self, text, name=None):
        """The values of the last form of ``text``."""
        values = []
        for form, reader in self.forms(text, name):
            values = self.evaluate(form, reader)
        return values

    def with_abort(self, thunk, report="Exit debugger, returning to top level."):
        """Call ``thunk`` with a restart ABORT; (True, its result), or (False, None) when it was aborted."""
        return conditions.restart_case([(sym("ABORT"), lambda: (False, None), report)], lambda: (True, thunk()))


def signalled_here(condition):
    """Note the place of a condition while its stack is still there; for debuggers."""
    if getattr(condition, "position", None) is None:
        condition.position = signalling_position()
    circumstance.note(condition)


def condition_of(exception):
    """The condition for any exception that left a form."""
    condition = from_python(exception)
    locate(condition, exception)
    return condition
