"""UIOP's chapters about compiling files and about fatal conditions, as far as no machine code is written and no image saved.

What saves images or joins compiled files (``dump-image``, ``combine-fasls``) is an error that says so, since cramhy keeps code by itself.
Source: UIOP's documentation strings; texts are UIOP's.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import Condition, Error, SimpleCondition, StyleWarning, Warning_
from cramhy_runtime.lisp_core.conditions import error, handler_bind, make_condition, warn
from cramhy_runtime.lisp_core.data import Cons, MultipleValues, lisp_list, list_from, truth
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import keyword, sym
from cramhy_runtime.lisp_core.printing import princ_to_string
from cramhy_runtime.kernel.typing_names import Any, NoReturn

from ..format.format import format_
from ..objects.classes import qualified
from ..systems.program_files import compile_file, load
from ..types.types import define_own_type
from . import utilities

FUNCTIONS = """call-with-fatal-condition-handler handle-fatal-condition print-condition-backtrace raw-print-backtrace print-backtrace
    check-lisp-compile-warnings check-lisp-compile-results check-deferred-warnings reset-deferred-warnings reify-deferred-warnings
    unreify-deferred-warnings save-deferred-warnings warnings-file-p warnings-file-type close-streams deprecated-function-name"""
CONDITIONS = """compile-condition compile-failed-error compile-failed-warning compile-file-error compile-warned-error
    compile-warned-warning deprecated-function-condition deprecated-function-error deprecated-function-should-be-deleted
    deprecated-function-style-warning deprecated-function-warning simple-style-warning fatal-condition"""
NOT_HERE = {
    "create-image": "an image is a process of Lisp in a file, and a session of Python is not",
    "dump-image": "an image is a process of Lisp in a file, and a session of Python is not.",
    "restore-image": "an image is a process of Lisp in a file, and a session of Python is not",
    "combine-fasls": "there are no files of machine code; cramhy keeps the code of each file by itself",
    "load-uiop-debug-utility": "uiop/contrib/debug.lisp is not part of it",
    "parse-file-location-info": "it reads shortcuts of Windows; resolve-symlinks* follows links",
    "parse-windows-shortcut": "it reads shortcuts of Windows; resolve-symlinks* follows links",
}
"""Functions that cannot be had, and why."""
IGNORE, WARN, ERROR = keyword("IGNORE"), keyword("WARN"), keyword("ERROR")
WARNINGS_FILES = {
    "ALLEGRO": "allegro-warnings",
    "CLOZURE": "ccl-warnings",
    "CCL": "ccl-warnings",
    "CLISP": "clisp-warnings",
    "SBCL": "sbcl-warnings",
    "SCL": "scl-warnings",
}


class CompileCondition(Condition):
    """Something about a compiled file. ``context_format`` and ``context_arguments`` tell which one."""

    lisp_name = "UIOP::COMPILE-CONDITION"
    initargs = {"DESCRIPTION": "description", "CONTEXT-FORMAT": "context_format", "CONTEXT-ARGUMENTS": "context_arguments"}
    description: Any = None
    context_format: Any = None
    context_arguments: Any = None

    def report(self) -> str:
        what = self.lisp_name.partition("::")[2] if self.description is None else princ_to_string(self.description)
        return (
            what if self.context_format is None else f"{what} while {format_(None, self.context_format, *(self.context_arguments or ()))}"
        )


class CompileFileError(CompileCondition, Error):
    lisp_name = "UIOP::COMPILE-FILE-ERROR"


class CompileWarnedWarning(CompileCondition, Warning_):
    lisp_name = "UIOP::COMPILE-WARNED-WARNING"


class CompileWarnedError(CompileCondition, Error):
    lisp_name = "UIOP::COMPILE-WARNED-ERROR"


class CompileFailedWarning(CompileCondition, Warning_):
    lisp_name = "UIOP::COMPILE-FAILED-WARNING"


class CompileFailedError(CompileCondition, Error):
    lisp_name = "UIOP::COMPILE-FAILED-ERROR"


class DeprecatedFunction(Condition):
    """A function that should not be called any more."""

    lisp_name = "UIOP::DEPRECATED-FUNCTION-CONDITION"
    initargs = {"NAME": "name"}
    name: Any = None

    def report(self) -> str:
        kind = self.lisp_name.partition("::")[2]
        return f"{kind}: Using deprecated function {qualified(self.name)} -- please update your code to use a newer API."


class DeprecatedFunctionStyleWarning(DeprecatedFunction, StyleWarning):
    lisp_name = "UIOP::DEPRECATED-FUNCTION-STYLE-WARNING"


class DeprecatedFunctionWarning(DeprecatedFunction, Warning_):
    lisp_name = "UIOP::DEPRECATED-FUNCTION-WARNING"


class DeprecatedFunctionError(DeprecatedFunction, Error):
    lisp_name = "UIOP::DEPRECATED-FUNCTION-ERROR"


class DeprecatedFunctionShouldBeDeleted(DeprecatedFunction, Error):
    lisp_name = "UIOP::DEPRECATED-FUNCTION-SHOULD-BE-DELETED"


class SimpleStyleWarning(SimpleCondition, StyleWarning):
    lisp_name = "UIOP::SIMPLE-STYLE-WARNING"


def define_types() -> None:
    """Make ``uiop:fatal-condition`` a type: what a script should end with."""
    define_own_type(sym("UIOP::FATAL-CONDITION"), lambda thing: utilities.fatal_condition_p(thing) is True)


def deprecated_function_name(condition: Any) -> Any:
    """``uiop:deprecated-function-name``: the function that should not be called any more."""
    return condition.name


def not_here(name: str) -> Any:
    """The function called ``name`` of `NOT_HERE`: an error that says why."""

    def refuse(*arguments: Any, **options: Any) -> NoReturn:
        return utilities.not_implemented_error(sym(f"UIOP::{name.upper()}"), "~A", f"{NOT_HERE[name]}.")

    refuse.__name__ = name
    return refuse


# ------------------------------------------------------------------------------------------------------- compiled files


def _complain(behaviour: str, warning: str, problem: str, description: str, context_format: Any, context_arguments: Any) -> None:
    wanted = sym(f"UIOP::*COMPILE-FILE-{behaviour}-BEHAVIOUR*").value
    if wanted is IGNORE:
        return
    given = (
        keyword("DESCRIPTION"),
        description,
        keyword("CONTEXT-FORMAT"),
        context_format,
        keyword("CONTEXT-ARGUMENTS"),
        context_arguments,
    )
    if wanted is WARN:
        warn(make_condition(sym(f"UIOP::{warning}"), given))
    else:
        error(make_condition(sym(f"UIOP::{problem}"), given))


def check_lisp_compile_warnings(warnings_p: Any, failure_p: Any, context_format: Any = None, context_arguments: Any = None) -> None:
    """``uiop:check-lisp-compile-warnings``: signal what the variables say when a file was compiled with warnings, or failed."""
    context = context_format, context_arguments
    if truth(failure_p):
        _complain("FAILURE", "COMPILE-FAILED-WARNING", "COMPILE-FAILED-ERROR", "Lisp compilation failed", *context)
    if truth(warnings_p):
        _complain("WARNINGS", "COMPILE-WARNED-WARNING", "COMPILE-WARNED-ERROR", "Lisp compilation had style-warnings", *context)


def check_lisp_compile_results(
    output: Any, warnings_p: Any, failure_p: Any, context_format: Any = None, context_arguments: Any = None
) -> None:
    """``uiop:check-lisp-compile-results``: as `check_lisp_compile_warnings`; no output is an error."""
    if output is None:
        error(CompileFileError(context_format=context_format, context_arguments=context_arguments))
    check_lisp_compile_warnings(warnings_p, failure_p, context_format, context_arguments)


def compile_file_or_complain(input_file: Any, *, output_file: Any = None, compile_check: Any = None, **others: Any) -> MultipleValues:
    """``uiop:compile-file*``: three values: the compiled file, whether it had warnings, whether it failed.

    Without a file of its own the code is kept where cramhy keeps it; see `program_files.compile_file`.
    """
    del others
    results = compile_file(input_file, output_file=output_file)
    if compile_check is not None and not truth(utilities.call_function(compile_check, input_file)):
        return MultipleValues((None, True, True))
    return results if isinstance(results, MultipleValues) else MultipleValues((results, None, None))


def load_file_or_stream(x: Any, **options: Any) -> Any:
    """``uiop:load*``: ``load`` of a file, a stream, or the text of a string stream."""
    return load(x, **options)


def check_deferred_warnings(files: Any, context_format: Any = None, context_arguments: Any = None) -> None:
    """``uiop:check-deferred-warnings``: nothing, since no warning is put off until other files are compiled."""


def reset_deferred_warnings() -> None:
    """``uiop:reset-deferred-warnings``: nothing, see `check_deferred_warnings`."""


def reify_deferred_warnings() -> None:
    """``uiop:reify-deferred-warnings``: nil: none are put off, see `check_deferred_warnings`."""


def unreify_deferred_warnings(reified_deferred_warnings: Any) -> None:
    """``uiop:unreify-deferred-warnings``: nothing, see `check_deferred_warnings`."""


def save_deferred_warnings(warnings_file: Any) -> None:
    """``uiop:save-deferred-warnings``: a file with none, see `check_deferred_warnings`."""
    from cramhy_runtime.storage.atomic_write import write_whole
    from ..files.files import path_of

    write_whole(path_of(warnings_file), "NIL\n", durable=False)


def warnings_file_type(implementation_type: Any = None) -> Any:
    """``uiop:warnings-file-type``: how the names of files with put-off warnings end in that Lisp; nil where it has none, as here."""
    return None if implementation_type is None else WARNINGS_FILES.get(implementation_type.name)


def warnings_file_p(file: Any, implementation_type: Any = None) -> Any:
    """``uiop:warnings-file-p``: whether a file has the ending of `warnings_file_type`."""
    from ..pathnames.pathnames import pathname

    ending = warnings_file_type(implementation_type)
    return True if ending is not None and pathname(file).type == ending else None


def close_streams(process_info: Any) -> None:
    """``uiop:close-streams``: close the streams to and from a process that ``launch-program`` has started."""
    for name in ("INPUT", "OUTPUT", "ERROR-OUTPUT"):
        stream = sym(f"UIOP::PROCESS-INFO-{name}").function(process_info)
        if stream is not None:
            sym("CLOSE").function(stream)


# ------------------------------------------------------------------------------------------------------ fatal conditions


def raw_print_backtrace(*, stream: Any = None, count: Any = None, condition: Any = None) -> Any:
    """``uiop:raw-print-backtrace``: write the calls that are under way; of at most ``count`` calls."""
    return sym("SB-DEBUG::PRINT-BACKTRACE").function(
        **{key: value for key, value in {"stream": stream, "count": count}.items() if value is not None}
    )


def print_backtrace(*, stream: Any = None, count: Any = None, condition: Any = None) -> Any:
    """``uiop:print-backtrace``: as `raw_print_backtrace`; what goes wrong with that is left out."""
    return raw_print_backtrace(stream=stream, count=count, condition=condition)


def print_condition_backtrace(condition: Any, *, stream: Any = None, count: Any = None) -> None:
    """``uiop:print-condition-backtrace``: write the calls that are under way, and the condition."""
    target = sym("UIOP::*STDERR*").value if stream is None else stream
    print_backtrace(stream=target, count=count, condition=condition)
    sym("FORMAT").function(target, "Above backtrace due to this condition:~%~A~&", condition)


def handle_fatal_condition(condition: Any) -> Any:
    """``uiop:handle-fatal-condition``: the debugger if somebody can answer; else the condition is told, and the process ends with 99."""
    if truth(sym("UIOP::*LISP-INTERACTION*").value):
        return sym("INVOKE-DEBUGGER").function(condition)
    from .processes import die

    print_condition_backtrace(condition)
    return die(99, "~A", condition)


def call_with_fatal_condition_handler(thunk: Any) -> Any:
    """``uiop:call-with-fatal-condition-handler``: the values of ``thunk``; a serious condition goes to `handle_fatal_condition`."""

    def handle(condition: Any) -> None:
        if utilities.fatal_condition_p(condition):
            handle_fatal_condition(condition)

    return handler_bind([(Condition, handle)], function_of(thunk))


# ---------------------------------------------------------------------------------------------------------------- macros


def _defining(operator: str) -> Any:
    def expand(environment: Any, name: Any, formals: Any, *rest: Any) -> Any:
        names = lisp_list(sym("DECLAIM"), lisp_list(sym("NOTINLINE"), name))
        return lisp_list(sym("PROGN"), names, Cons(sym(operator), Cons(name, Cons(formals, list_from(list(rest))))))

    return expand


MACROS = {
    "DEFUN*": _defining("DEFUN"),
    "DEFGENERIC*": _defining("DEFGENERIC"),
    "LOOP*": lambda environment, *rest: Cons(sym("LOOP"), list_from(list(rest))),
}
