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

from cramhy_runtime import kernel
from cramhy_runtime.kernel.images import Cell
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.python import python_calls
from cramhy_runtime.languages.commonlisp.systems import asdf, systems, unit_tests
from cramhy_runtime.languages.commonlisp.tools.error_reports import condition_of  # noqa: F401  for those who have a session
from cramhy_runtime.languages.commonlisp.compiler.compilation_unit import signalling_position
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import all_values, list_from
from cramhy_runtime.lisp_core.printing import class_text, prin1_to_string, speak
from cramhy_runtime.languages import answered_texts
from cramhy_runtime.languages.which_language import goes_on_in_lisp
from cramhy_runtime.languages.commonlisp.packages.face_definition import define_face
from cramhy_runtime.languages.commonlisp.pathnames.namestrings import parse_native
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER, find_package_or_error, near_names, on_demand, registered, sym
from cramhy_runtime.ros.search_folders import entries, is_file
from cramhy_runtime.languages.commonlisp.pathnames.pathnames import DEFAULTS
from cramhy_runtime.lisp_core.source_places import circumstance, locate
from .boot import fresh_start
from cramhy_runtime.robot_world.al5d.demand import start_when_asked_for
from cramhy_runtime.turtlesim.node import start_with_first_node

from . import typed_texts
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cramhy_runtime.kernel.signatures import BackendName, ClockName


HISTORY = [sym(name) for name in ("*", "**", "***")]
LAST_VALUES = [sym(name) for name in ("/", "//", "///")]
LAST_FORMS = [sym(name) for name in ("+", "++", "+++")]
THIS_FORM = sym("-")


def leave(*, code=0, unix_status=0, abort=None, timeout=None, recklessly_p=None):
    """``(quit)``, ``(exit :code 3)``: end the program, through the cleanup of its plans."""
    raise SystemExit(code or unix_status)


@functools.cache
def leaving():
    """The package SB-EXT with ``exit`` and ``quit`` in it."""
    return define_face("SB-EXT", functions={"exit": leave, "quit": leave})


def define_leaving():
    """``exit`` and ``quit`` of SB-EXT, present in CL-USER as in SBCL."""
    package = leaving()
    for name in ("EXIT", "QUIT"):
        COMMON_LISP_USER.import_symbol(package.intern(name))


packages_above: dict = {}
"""Names of packages of rooms above, and functions that make them when a program names one. Each session offers them."""


_current = Cell(None, fresh=True)


def current():
    """The `Session` that began last in this image, or ``None``."""
    return _current.value


class Interruption(Exception):
    """A form was ended by Ctrl-C; the plan below it has been cleaned up."""


@functools.cache
def quiet_collector():
    """Let the garbage collector leave the image alone, which lives as long as the process, and come less often: Lisp makes conses."""
    gc.freeze()
    gc.set_threshold(30_000, 20, 20)


class Session:
    """Evaluates forms in an image. The calling thread becomes the kernel's main task.

    time: "virtual" or "wall". seed: of the scheduler's order, ``None`` for first come, first served. backend: "auto",
    "threads" or "greenlet" (see `kernel.start`). time_limit: seconds of plan time after which a form is ended. turtlesim: whether the
    simulator starts with the first node. cleanup_limit: seconds that plans get for their cleanup when the session ends, or ``None``.
    whole: see `fresh_start`. lisp: whether its user speaks Common Lisp (`printing.speak`). options: more of `kernel.start`.
    """

    def __init__(
        self,
        time: ClockName = "wall",
        seed: int | None = None,
        backend: BackendName = "auto",
        time_limit: float | None = None,
        turtlesim: bool = True,
        cleanup_limit: float | None = kernel.CLEANUP_LIMIT,
        whole: bool = True,
        lisp: bool = True,
        **options: Any,
    ):
        fresh_start(time, backend, seed, time_limit, turtlesim, whole, cleanup_limit=cleanup_limit, **options)
        speak(lisp)
        self._begin()

    @classmethod
    def at_hand(cls, time):
        """A session in the kernel that is active, with all that goes on there. If nothing has happened yet, a new one in ``time``.

        It is for prompts in programs of Python and Hy, which tell by `printing.speak` when they go on in Lisp.
        """
        active = kernel.active()
        if active is None or active.untouched:
            return cls(time, lisp=False)
        joined = cls.__new__(cls)
        start_with_first_node()
        start_when_asked_for()
        joined._begin()
        return joined

    def _begin(self):
        _current.value = self
        evaluator.PACKAGE.value = COMMON_LISP_USER
        define_leaving()
        on_demand.update({name: define for name, define in packages_above.items() if registered(name) is None})
        for variables in (HISTORY, LAST_VALUES, LAST_FORMS, [THIS_FORM]):
            for variable in variables:
                variable.value = None
        DEFAULTS.value = parse_native(os.getcwd() + "/")
        self.texts = 0
        answered_texts.forget()
        quiet_collector()

    @property
    def virtual(self) -> bool:
        """Whether time is virtual: then it stands still at the prompt."""
        return kernel.active().clock.virtual

    @property
    def package(self):
        return evaluator.PACKAGE.value

    @package.setter
    def package(self, designator):
        evaluator.PACKAGE.value = find_package_or_error(designator)

    def prompt(self) -> str:
        """``TUT> ``: the shortest name of the current package."""
        return f"{min(self.package.names, key=len)}> "

    @staticmethod
    def prefer(system: str) -> None:
        """Take the system called ``system`` from ROS_PACKAGE_PATH though cramhy contains one; it is an error if it is not there."""
        systems.prefer(system)

    def load(self, system: str) -> None:
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
        from cramhy_runtime.languages.commonlisp.systems import loader

        if self._is_missing_file(system):
            self._no_file(system)
        elif system.endswith((".lisp", ".hy")):
            if system.endswith(".hy"):
                speak(lisp=goes_on_in_lisp(Path(system)))
            loader.load_file(system, as_source=True)
        elif system.endswith(".asd"):
            systems.load_asd(system)
            systems.load_system(Path(system).stem)
        elif Path(system).is_file():
            conditions.error(
                conditions.types.FileError(
                    system, "Cannot load ~A: what is loaded is a .lisp, .hy or .asd file, or a system by its name.", system
                )
            )
        else:

            def also_no_file(problem):
                if problem.hint and f'"{system}"' in problem.report() and "required by" not in problem.report():
                    problem.hint = f"There is no file {system} in {Path.cwd()}, and no system of that name: {problem.hint}"

            conditions.handler_bind([(systems.MissingComponent, also_no_file)], lambda: systems.load_system(system))

    @staticmethod
    def _is_missing_file(name):
        """Whether ``name`` is meant for a file that is not there, and not for a system."""
        path = Path(name)
        if path.is_file():
            return False
        if path.suffix in (".lisp", ".hy", ".asd"):
            return True
        beside = any(os.path.isfile(f"{name}{suffix}") for suffix in (".lisp", ".hy"))
        if not (beside or path.is_dir() or path.suffix[1:].isalpha() or path.is_absolute() or name.startswith(".")):
            return False
        system = name.lower()
        return not systems.is_provided(system) and system not in systems.systems and systems.find_asd(system) is None

    @staticmethod
    def _no_file(name):
        """Signal that the file ``name`` is missing; what stands beside its place is suggested."""
        path = Path(name)
        beside = [entry.name for entry in entries(path.parent) if entry.name.endswith((".lisp", ".hy", ".asd")) and is_file(entry)]
        near = [other for other in beside if Path(other).stem == path.stem] or near_names(path.name, beside)
        what = "Is a directory" if path.is_dir() else "No such file or directory"
        hint = None if path.suffix in (".lisp", ".hy", ".asd") else "What is loaded is a .lisp, .hy or .asd file, or a system by its name."
        conditions.error(
            conditions.types.FileError(name, "Cannot load ~A: ~A.", str(path.absolute()), what),
            hint=f"Did you mean {' or '.join(near)}?" if near else hint,
        )

    def test(self, path: str, junit: str | None = None, only: list[str] | None = None) -> bool:
        """Run the tests of a system by name, a file, or the test files below a folder; whether there were some and all passed.

        junit: a file for the results, too, in JUnit's XML, or ``None``. only: the names of the tests to run, ``None``: all.
        """
        try:
            return self._test(path, junit, only)
        except kernel.Terminated:
            raise
        except (kernel.Interrupted, kernel.Abandoned):
            raise Interruption from None
        finally:
            kernel.interrupt_over()

    def _test(self, path, junit, only=None):
        from cramhy_runtime.languages.commonlisp.systems import test_reports
        from cramhy_runtime.languages.commonlisp.tools.advice import explanation

        try:
            wanted = None if only is None else {name.rpartition(":")[2].upper() for name in only}
            tests = [each for each in self._tests(path) if wanted is None or each.name.upper() in wanted]
            if wanted and (missing := sorted(wanted - {each.name.upper() for each in tests})):
                conditions.error("~a", f"There is no test called {' or '.join(missing)} in {path}. No test was run.")
            results = [test_reports.Result(*result) for result in unit_tests.run_all(tests)]
            system = (
                None if results or Path(path).suffix in (".lisp", ".hy") or Path(path).is_dir() else systems.find_system(Path(path).stem)
            )
            if system is not None and system.methods:  # it says itself what its tests are
                good = asdf.test_system(system)
                if junit is not None:
                    test_reports.write_junit_of_one(junit, path)
                return good
            if not results:
                conditions.error(f"There are no tests of lisp-unit or FiveAM in {path}.".replace("~", "~~"))
        except (Exception, Condition) as problem:
            if junit is not None:
                test_reports.write_junit_of_one(junit, path, error=explanation(condition_of(problem)))
            raise
        streams.STANDARD_OUTPUT.value.write(test_reports.summary(results))
        if junit is not None:
            test_reports.write_junit(junit, results)
        return not any(result.kind == "failed" for result in results)

    def _tests(self, path):
        if not Path(path).is_dir() and self._is_missing_file(path):
            self._no_file(path)
        if Path(path).is_dir():
            return unit_tests.tests_of_folder(path)
        if path.endswith((".lisp", ".hy")):
            return unit_tests.load_tests(path)
        if path.endswith(".asd"):
            return unit_tests.load_asd_tests(path)
        return unit_tests.load_system_tests(path)

    def reader(self, text, name=None, typed=True):
        """A reader of a text typed at the prompt. It knows the places of its forms. typed: whether the user has typed it."""
        from cramhy_runtime.languages.commonlisp.reader.reader import Reader

        self.texts += 1
        name = name or f"<repl {self.texts}>"
        typed_texts.keep(name, text)
        return self._noted(Reader(text, filename=name)) if typed else Reader(text, filename=name)

    @staticmethod
    def _noted(reader):
        reader.noted = answered_texts.note(reader.text)
        return reader

    @classmethod
    def reader_in_file(cls, text, path, line, column):
        """A reader of a text that an editor has sent from the file ``path``, where it begins in that line and column, counted from 1."""
        import linecache  # it imports the tokenizer

        from cramhy_runtime.languages.commonlisp.reader.reader import Reader

        linecache.checkcache(path)  # errors show the lines of now
        return cls._noted(Reader(text, filename=path, line=line, column=column))

    @staticmethod
    def forms(reader):
        """The forms that ``reader`` reads."""
        end = object()
        while (form := Session._read(reader, end)) is not end:
            yield form

    @staticmethod
    def _read(reader, end):
        try:
            return reader.read(eof_error=False, eof_value=end)
        except BaseException:
            if reader.noted is not None:
                reader.noted.end(good=False)
            raise

    def evaluate(self, form: object, reader: Any = None, top: bool | None = None) -> list[Any]:
        """The values of ``form`` as a list. Conditions that nobody handles are raised, with their place if it is known.

        top: whether the other tasks shall finish this instant before it returns. ``None``: if the main task asks, and not the debugger of a
        plan's task.
        """
        THIS_FORM.value = form
        answered = False
        try:
            if reader is None:
                values = all_values(evaluator.evaluate(form))
            else:
                values = all_values(evaluator.evaluate(form, reader.filename, reader.positions))
            if top if top is not None else kernel.current() is kernel.active().main:
                kernel.settle()
            answered = True
        except kernel.Terminated:
            raise
        except (kernel.Interrupted, kernel.Abandoned):
            raise Interruption from None
        except Condition as condition:
            locate(condition, condition)
            raise
        finally:
            kernel.interrupt_over()
            if reader is not None and reader.noted is not None:
                reader.noted.upto, reader.noted.failed = (reader.offset, False) if answered else (reader.noted.upto, True)
            LAST_FORMS[0].value, LAST_FORMS[1].value, LAST_FORMS[2].value = form, LAST_FORMS[0].value, LAST_FORMS[1].value
        if values:
            HISTORY[0].value, HISTORY[1].value, HISTORY[2].value = values[0], HISTORY[0].value, HISTORY[1].value
        LAST_VALUES[0].value, LAST_VALUES[1].value, LAST_VALUES[2].value = list_from(values), LAST_VALUES[0].value, LAST_VALUES[1].value
        return list(values)

    def evaluate_text(self, text: str, name: str | None = None, top: bool | None = None, typed: bool = True) -> list[Any]:
        """The values of the last form of ``text``. top: see `evaluate`. typed: see `reader`."""
        values, reader = [], self.reader(text, name, typed)
        for form in self.forms(reader):
            values = self.evaluate(form, reader, top)
        return values

    def with_abort(self, thunk, report="Exit debugger, returning to top level."):
        """Call ``thunk`` with a restart ABORT; (True, its result), or (False, None) when it was aborted."""
        return conditions.restart_case([(sym("ABORT"), lambda: (False, None), report)], lambda: (True, thunk()))


@circumstance(lambda variables: f"while a value of class {class_text(variables['value'])} was printed")
def value_text(value):
    """A value as ``prin1`` prints it, for a prompt. If its printer fails, that is an error, which says so."""
    return python_calls.guarded(prin1_to_string, value)


def signalled_here(condition):
    """Note the place of a condition while its stack is still there; for debuggers."""
    if getattr(condition, "position", None) is None:
        condition.position = signalling_position()
    circumstance.note(condition)
