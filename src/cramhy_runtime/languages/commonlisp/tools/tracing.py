"""``trace``, ``untrace``, ``time`` and ``step``: watching forms as they run.

A traced function is wrapped in the cell of its name, so that all who call it by name are seen; a generic function goes on being
the same object and calls its watcher. Defining the function again keeps it traced. Each task counts its own depth. Compiled
code calls the functions of Common Lisp directly, so of these only calls by ``funcall`` and its relatives are seen. Source: ANSI
25.1 (TRACE, TIME, STEP); the layout is that of SBCL 2.2.9.
"""

from __future__ import annotations

import functools
import time as python_time

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.conditions import CompileError, break_, error, warn
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, UndefinedFunction, all_values, list_from, one, truth
from cramhy_runtime.lisp_core.dynamic import binding, special
from ..evaluation.evaluator import evaluate
from ..evaluation.process_usage import processor_time
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from cramhy_runtime.lisp_core.packages import find_package_or_error, sym
from ..printer.print_names import symbol_with_prefix
from ..printer.printer import prin1_to_string
from cramhy_runtime.lisp_core.printing import not_ending
from ..streams.streams import TRACE_OUTPUT, output_stream

SETF = sym("SETF")
_depth = special(Symbol("*TRACE-DEPTH*"), 0)
_traced: dict = per_image({})
"""Traced names, by `_key`: `Trace` objects, in order."""


class Trace:
    """What ``trace`` was told about one function: its name and options (forms by option name)."""

    prints = True

    def __init__(self, name, options):
        self.name, self.options = name, options

    def watch(self, function, arguments, keywords):
        """Call ``function`` and print the call and what came of it."""
        option = self.options.get
        if "CONDITION" in self.options and not truth(one(evaluate(option("CONDITION")))):
            return function(*arguments, **keywords)
        depth, report = _depth.value, "REPORT" not in self.options or option("REPORT") is not None
        if report:
            with not_ending():
                self.write(depth, prin1_to_string(Cons(self.name, list_from(arguments))))
        self.print("PRINT", depth)
        self.stop("BREAK")
        ended = False
        try:
            with binding(_depth, depth + 1):
                result = function(*arguments, **keywords)
            ended = True
        finally:
            if not ended and report:
                self.write(depth, f"{prin1_to_string(self.name)} exited non-locally")
        if report:
            with not_ending():
                shown = "".join(" " + prin1_to_string(value) for value in all_values(result))
            self.write(depth, f"{prin1_to_string(self.name)} returned{shown}")
        self.print("PRINT-AFTER", depth)
        self.stop("BREAK-AFTER")
        return result

    def print(self, option, depth):
        if option in self.options:
            form = self.options[option]
            self.write(depth, f"{prin1_to_string(form)} = {prin1_to_string(one(evaluate(form)))}")

    def stop(self, option):
        if option in self.options and truth(one(evaluate(self.options[option]))):
            break_("breaking ~A traced call to ~S:", "before" if option == "BREAK" else "after", self.name)

    @staticmethod
    def write(depth, text):
        stream = output_stream(TRACE_OUTPUT.value)
        stream.fresh_line()
        stream.write(f"{'  ' * (depth % 20)}  {depth}: {text}\n")

    def around(self, function):
        """``function`` as it stands in the cell of its name while it is traced."""

        @functools.wraps(function)
        def traced(*arguments, **keywords):
            return self.watch(function, arguments, keywords)

        traced.traced, traced.retrace = function, self.around
        return traced


def _key(name):
    return ("SETF", name.cdr.car) if isinstance(name, Cons) else name


def _cell(name):
    """(symbol, attribute) of the function cell of a name; an error for what is no function name."""
    if isinstance(name, Cons) and name.car is SETF and isinstance(name.cdr, Cons) and isinstance(name.cdr.car, Symbol):
        return name.cdr.car, "setf_function"
    if not isinstance(name, Symbol):
        return error(
            CompileError(
                "TRACE cannot use ~S: what is traced is named by a symbol, by (SETF symbol), or by a string, the name of "
                "a package all of whose functions are meant.",
                name,
            )
        )
    return name, "function"


def _qualified(name):
    return symbol_with_prefix(name) if isinstance(name, Symbol) else prin1_to_string(name)


OPTIONS = ("REPORT", "CONDITION", "BREAK", "BREAK-AFTER", "PRINT", "PRINT-AFTER")


def _parse(specs):
    """(name, options) pairs of the arguments of ``trace``. Options before all names are for all, others for the name before."""
    general, entries, items = {}, [], list(specs or ())
    while items:
        item = items.pop(0)
        if isinstance(item, Keyword):
            if item.name not in OPTIONS or not items:
                return error(
                    CompileError("TRACE knows no option ~S here; there are ~{:~A~^, ~}, each followed by a form.", item, list_from(OPTIONS))
                )
            (entries[-1][1] if entries else general)[item.name] = items.pop(0)
        elif isinstance(item, str):
            package = find_package_or_error(item)
            entries += [
                (symbol, {})
                for table in (package.external, package.internal)
                for symbol in table.values()
                if isinstance(symbol, Symbol) and symbol.package is package and _is_function(symbol.function)
            ]
        else:
            entries.append((item, {}))
    return [(name, {**general, **options}) for name, options in entries]


def _is_function(function):
    return function is not None and not isinstance(function, UndefinedFunction)


def trace(specs):
    """``trace``: watch the functions named; returns the list of the names, without arguments that of all traced functions."""
    if specs is None:
        return list_from([entry.name for entry in _traced.values() if entry.prints])
    return list_from([name for name, options in _parse(specs) if install(Trace(name, options))])


def install(entry):
    """Let ``entry``, a `Trace`, watch the calls of the function that it names; whether that can be. Otherwise a warning says why."""
    name = entry.name
    symbol, cell = _cell(name)
    if _key(name) in _traced:
        warn("~A is already TRACE'd, untracing it first.", name)
        _untrace(name)
    function = getattr(symbol, cell)
    if cell == "function" and symbol.macro is not None:
        warn("~A is a macro, not tracing: it is expanded before anything runs.", _qualified(name))
        return False
    if not _is_function(function):
        warn("~A is undefined, not tracing.", _qualified(name))
        return False
    _traced[_key(name)] = entry
    if isinstance(function, GenericFunction):
        function.watch(entry.watch)
    else:
        setattr(symbol, cell, entry.around(function))
        symbol.function_changed()
    return True


def entry_of(name):
    """The `Trace` that watches the function called ``name``, or ``None``."""
    return _traced.get(_key(name))


def watching():
    """The `Trace` of each function that is watched, in the order in which that began."""
    return list(_traced.values())


def _untrace(name):
    symbol, cell = _cell(name)
    entry = _traced.pop(_key(name), None)
    function = getattr(symbol, cell)
    if entry is None:
        warn(
            "~A is undefined, not tracing." if not _is_function(function) else "Function is not TRACEd: ~A",
            name if _is_function(function) else _qualified(name),
        )
    elif isinstance(function, GenericFunction):
        function.watch(None)
    elif hasattr(function, "traced"):
        setattr(symbol, cell, function.traced)
        symbol.function_changed()


def untrace(specs):
    """``untrace``: stop watching the functions named, or all; t."""
    names = [name for name, _ in _parse(specs)] if specs is not None else [entry.name for entry in _traced.values()]
    for name in names:
        _untrace(name)
    return True


def timed(thunk):
    """``time``: run ``thunk`` and print to ``*trace-output*`` how long it took; its values.

    Real time is the wall's and run time the processor's. In virtual time a line more says how long the plan took.
    """
    began, used, planned = python_time.perf_counter(), processor_time(), kernel.now()
    try:
        return thunk()
    finally:
        real, now = python_time.perf_counter() - began, processor_time()
        user, system = now.user - used.user, now.system - used.system
        share = min(100.0, 100 * (user + system) / real) if real else 100.0
        lines = [
            "Evaluation took:",
            f"  {real:.3f} seconds of real time",
            f"  {user + system:.6f} seconds of total run time ({user:.6f} user, {system:.6f} system)",
            f"  {share:.2f}% CPU",
        ]
        if isinstance(kernel.active().clock, kernel.VirtualClock):
            lines.append(f"  {kernel.now() - planned:.3f} seconds of plan time")
        stream = output_stream(TRACE_OUTPUT.value)
        stream.fresh_line()
        stream.write("\n".join(lines) + "\n")


def step(form, thunk):
    """``step``: evaluate a form with the calls that it makes traced; its values.

    Compiled code cannot be stopped between its forms, so every function of the user's that the form names is watched instead.
    """
    names = [name for name in dict.fromkeys(_called(form)) if _key(name) not in _traced]
    watched = list(trace(list_from(names)) or ()) if names else []
    try:
        return thunk()
    finally:
        for name in watched:
            _untrace(name)


def _called(form):
    """The symbols at the head of list forms in ``form`` that have functions and do not belong to Common Lisp."""
    if not isinstance(form, Cons):
        return
    head = form.car
    if isinstance(head, Symbol) and head.package is not sym("CAR").package and head.macro is None and _is_function(head.function):
        yield head
    cell = form
    while isinstance(cell, Cons):
        yield from _called(cell.car)
        cell = cell.cdr
