"""Objects and messages as text, by the printer that is installed (``ports.py``), and how instances of a class print.

A room says by `define_printer` how its objects look. The function writes to a stream and prints components by `output_object`, so it is
right in every language and under all control variables.

Text about an error must not become another error, and must come to an end: see `shown`. While such a text is made,
``sb-ext:*suppress-print-errors*`` is bound, as in SBCL's debugger, and an object whose printing fails is ``#<error printing a CLASS: why>``
in the midst of the text.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from math import inf
from cramhy_runtime.kernel.typing_names import Any

from cramhy_runtime import kernel
from cramhy_runtime.kernel.images import Cell

from .catching import HandlerExit
from .classes import class_name
from .condition_types import SHOWN, Condition, PythonError, SeriousCondition
from .conditions import BREAK_ON_SIGNALS, guarded, handler_bind
from .data import Symbol
from .dynamic import binding, special
from .packages import ensure_package, sym
from .plain_answers import PlainPrinter, printer_for, printers, printers_found
from .ports import PORTS
from .source_places import describe, error_place

__all__ = [
    "CURRENT_LEVEL",
    "LEVELS_COUNT",
    "attempt_to_print",
    "bounded",
    "class_text",
    "define_printer",
    "format_to_string",
    "guarded",
    "not_ending",
    "output_object",
    "print_suppressed",
    "prin1_to_string",
    "princ_to_string",
    "print_slots",
    "print_unreadable",
    "printer_for",
    "report_of",
    "shown",
    "speak",
    "text_for_python",
    "unprintable",
    "with_numbers_as_spoken",
    "write",
]

CURRENT_LEVEL = special(Symbol("*CURRENT-LEVEL-IN-PRINT*"), 0)
"""How deep what is being printed lies in what was to be printed; counted while ``*print-level*`` or ``LEVELS_COUNT`` asks for it."""
LEVELS_COUNT = special(Symbol("*LEVELS-COUNT*"), None)
"""Whether levels are counted without ``*print-level*``, since a function that prints is told of them."""


LISP_IS_SPOKEN = Cell(False, fresh=True)
"""Whether the user of this image speaks Common Lisp; `speak` changes it.

A session is for users of Lisp, and a prompt or notebook with both languages tells each change. Programs in Python and Hy leave it alone.
"""
NUMBERS_OF_PYTHON = sym("CRAMHY::NUMBERS-OF-PYTHON")
"""The value of ``*read-default-float-format*`` while Python prints: floats look as Python writes them, without a mark of their kind."""
_FLOAT_FORMAT = sym("*READ-DEFAULT-FLOAT-FORMAT*")


def speak(lisp: bool) -> None:
    """Let the texts of the runtime in this image be for users of Common Lisp, or of Python and Hy: see `with_numbers_as_spoken`."""
    LISP_IS_SPOKEN.value = lisp


def with_numbers_as_spoken(text_of: Callable[..., Any], *arguments: Any) -> Any:
    """``text_of(*arguments)``, which makes a text of the runtime; numbers look as in the user's language: ``1.5``, in Lisp ``1.5d0``.

    What functions of Lisp print themselves does not depend on the user's language, so that they read back what they have printed.
    """
    if LISP_IS_SPOKEN.value:
        return text_of(*arguments)
    return _with_numbers_of_python(text_of, *arguments)


def _with_numbers_of_python(text_of: Callable[..., Any], *arguments: Any) -> Any:
    if _FLOAT_FORMAT.value is NUMBERS_OF_PYTHON:
        return text_of(*arguments)
    if kernel.active() is None:  # nobody can come in between
        before, _FLOAT_FORMAT.value = _FLOAT_FORMAT.value, NUMBERS_OF_PYTHON
        try:
            return text_of(*arguments)
        finally:
            _FLOAT_FORMAT.value = before
    if not kernel.on_own_stack():  # a thread of Python has no bindings of its own
        return text_of(*arguments)
    with binding(_FLOAT_FORMAT, NUMBERS_OF_PYTHON):
        return text_of(*arguments)


def prin1_to_string(thing: Any) -> str:
    """``thing`` as ``prin1`` prints it: strings in quotes, so that it can be read back."""
    return with_numbers_as_spoken(PORTS.printer.prin1, thing)


def text_for_python(thing: Any) -> str:
    """`prin1_to_string`, with numbers as Python writes them: what ``repr`` of an object of Lisp shows."""
    return _with_numbers_of_python(PORTS.printer.prin1, thing)


def princ_to_string(thing: Any) -> str:
    """``thing`` as ``princ`` prints it, for people to read."""
    return with_numbers_as_spoken(PORTS.printer.princ, thing)


def format_to_string(control: Any, *arguments: Any) -> str:
    """The text of a format control (a string or a function) with ``arguments``."""
    return with_numbers_as_spoken(PORTS.printer.formatted, control, *arguments)


def define_printer(cls: type, function: Callable[[Any, Any], Any]) -> None:
    """Let ``function(obj, stream)`` print the instances of ``cls``. ``*print-escape*`` tells it whether to escape."""
    printers[cls] = function
    printers_found.clear()


def output_object(thing: Any, stream: Any) -> None:
    """Print ``thing`` to ``stream`` as the object around it is printed."""
    PORTS.printer.output_object(thing, stream)


def write(thing: Any, stream: Any, *, escape: bool = True) -> None:
    """Print ``thing`` to ``stream``, escaped or not."""
    PORTS.printer.write(thing, stream, escape)


def print_unreadable(
    obj: Any, stream: Any, text: str | None = None, type_: bool = False, identity: bool = False, body: Callable[[], Any] | None = None
) -> Any:
    """``print-unreadable-object``: ``#<TYPE text {address}>``.

    text: what to print inside; or ``body``: a function that prints it to ``stream``. type_: print the type of ``obj`` first. identity:
    print its address last.
    """
    return PORTS.printer.print_unreadable(obj, stream, text, type_, identity, body)


def print_slots(name: Any, slots: list, stream: Any) -> None:
    """``#S(NAME :SLOT value)``; slots: pairs of name and value."""
    PORTS.printer.print_slots(name, slots, stream)


def report_text(condition: Any) -> str:
    """The text of ``condition`` for the user, with long objects in their short form."""
    return with_numbers_as_spoken(PORTS.printer.report, condition)


def address(thing: Any) -> str:
    """The address that ``#<... {1001000003}>`` shows for ``thing``: hexadecimal digits, the same as long as it lives."""
    return PORTS.printer.address(thing)


# ------------------------------------------------------------------------------------------------------- texts about errors

SUPPRESS = special(ensure_package("SB-EXT").intern("*SUPPRESS-PRINT-ERRORS*"))
"""The type of the errors that printing an object may signal without ending what is printed around it; nil: none (SBCL's variable)."""
SUPPRESS.package.export(SUPPRESS)
MAKING = special(Symbol("*TEXT-ABOUT-AN-ERROR*"), None)
"""The `Making` of the text about an error that is made now, or ``None``."""

LONGEST = 20_000  # characters of a text about an error
LONGEST_REASON = 300  # characters of why an object cannot be printed
DEEPEST = 50  # objects around an object that is printed
AGAIN = 3  # times that an object is met while it is printed itself
SECONDS, SLICES = 10, 100  # for which a text about an error may wait, and compute
SHORTER = ("*PRINT-CIRCLE*", True, "*PRINT-LENGTH*", 50, "*PRINT-LEVEL*", 10)


class TextTooLong(BaseException):
    """A string that is being written in a text about an error has become longer than `LONGEST`. It is no error that code handles."""

    def __init__(self, number: int, text: str):
        self.number, self.text = number, text


class Making:
    """A text about an error while it is made: the objects that are being printed, those that failed, how many strings were begun."""

    __slots__ = ("printing", "failed", "strings", "explaining", "too_long")

    def __init__(self) -> None:
        self.printing: list[int] = []
        self.failed: dict[int, tuple[Any, str | None]] = {}  # with the object, so that its id stays its own
        self.strings = 0
        self.explaining = False
        self.too_long = False

    def appender(self, parts: list[str]) -> Callable[[str], None]:
        """What adds text to ``parts``, a string that is begun now, until it is too long."""
        self.strings += 1
        number, room = self.strings, LONGEST

        def append(text: str) -> None:
            nonlocal room
            parts.append(text)
            room -= len(text)
            if room < 0:
                self.too_long = True
                raise TextTooLong(number, "".join(parts))

        return append

    def stands_for(self, thing: Any) -> str | None:
        """What is shown in the place of ``thing`` without asking its printer, which failed before or would never end; else ``None``."""
        found = self.failed.get(id(thing))
        if found is not None:
            return found[1] or _brief(thing)
        if len(self.printing) >= DEEPEST or self.printing.count(id(thing)) >= AGAIN:
            return _brief(thing)
        return None

    def attempt(self, thing: Any, thunk: Callable[[], Any], begun: float = inf) -> Any:
        """The value of ``thunk()``, which prints ``thing``, as a tuple; the text that stands for it if that fails.

        begun: so many strings were begun before; if one of the later ones becomes too long, that is a failure of this object.
        """
        self.printing.append(id(thing))
        try:
            return suppressed(lambda: (thunk(),), lambda problem: self.fail(thing, problem))
        except TextTooLong as exit_:
            if exit_.number <= begun:  # it is the text around this object that is too long
                raise
            return self.keep(thing, f"#<error printing a {class_text(thing)}: its text is longer than {LONGEST} characters>")
        except kernel.WorkLimit:
            return self.keep(thing, f"#<error printing a {class_text(thing)}: it took too long>")
        finally:
            self.printing.pop()

    def fail(self, thing: Any, problem: Any) -> str:
        """The text that stands for ``thing`` from now on, as its printer failed with ``problem``."""
        self.failed[id(thing)] = thing, None
        return self.keep(thing, unprintable(thing, problem))

    def keep(self, thing: Any, text: str) -> str:
        """``text``, which stands for ``thing`` from now on."""
        self.failed[id(thing)] = thing, text
        return text


def suppressed(thunk: Callable[[], Any], otherwise: Callable[[Any], Any], kind: Any = SeriousCondition) -> Any:
    """The value of ``thunk()``; if it signals a condition of type ``kind``, ``otherwise(condition)``. The condition knows its place."""
    token = object()

    def leave(condition: Any) -> None:
        if getattr(condition, "position", None) is None:
            condition.position = error_place(condition)
        raise HandlerExit(token, 0, condition)

    try:
        return handler_bind([(kind, leave)], thunk)
    except HandlerExit as exit_:
        if exit_.token is not token:
            raise
        condition, exit_.__traceback__ = exit_.condition, None
    except BaseException as exception:  # a printer in Python may raise SystemExit or a class of its own
        if isinstance(exception, (KeyboardInterrupt, Condition)) or type(exception).__module__.startswith(_EXITS):
            raise
        condition = PythonError(exception)
        condition.position = error_place(condition)
    return otherwise(condition)


_EXITS = ("cramhy_runtime.", "greenlet", "_pytest.")
"""Where the exceptions are from that ask a task to end, or leave a form of Lisp, a stack or a test."""


def shown(thing: Any, text_of: Callable[[], str]) -> str:
    """``text_of()``, a text for somebody who is told of an error. It never fails, and it ends.

    thing: what it is about. Where an object in the text cannot be printed, ``#<error printing a CLASS: why>`` stands; if the text as a
    whole cannot be made, that is all of it. A text of more than `LONGEST` characters is made again with its lists cut short, and then cut.
    Printing that computes or waits for longer than it may is broken off. Nothing ends a function of Python that never returns, but Ctrl-C.
    The handlers around the caller are not asked about what printers signal.
    """
    making = MAKING.value
    if making is not None:
        return _text(making, thing, text_of)
    return with_numbers_as_spoken(_shown, thing, text_of)


def _shown(thing: Any, text_of: Callable[[], str]) -> str:
    alone = kernel.active() is None  # then nothing that is waited for takes time
    with kernel.at_hand():
        if not kernel.on_own_stack():  # a thread of Python has no bindings of its own
            return _shown_outside(thing, text_of)
        with nullcontext() if alone else kernel.time_limited(SECONDS), kernel.work_limited(SLICES):
            making = Making()
            with binding(SUPPRESS, sym("SERIOUS-CONDITION"), MAKING, making, BREAK_ON_SIGNALS, None):
                text = _text(making, thing, text_of)
            if making.too_long:
                making = Making()
                shorter = [sym(item) if isinstance(item, str) else item for item in SHORTER]
                with binding(SUPPRESS, sym("SERIOUS-CONDITION"), MAKING, making, BREAK_ON_SIGNALS, None, *shorter):
                    text = _text(making, thing, text_of)
    return _cut(text)


def bounded(thunk: Callable[[], str]) -> str:
    """``thunk()``, which writes a string and returns it; what it has written when the string becomes too long for a text about an error."""
    making = MAKING.value
    if making is None:
        return thunk()
    number = making.strings + 1
    try:
        return thunk()
    except TextTooLong as exit_:
        if exit_.number != number:
            raise
        return exit_.text


def _text(making: Making, thing: Any, text_of: Callable[[], str]) -> str:
    if (known := making.stands_for(thing)) is not None:
        return known
    try:
        found = making.attempt(thing, text_of)
    except TextTooLong as exit_:
        found = (exit_.text,)
    text = found if isinstance(found, str) else str(found[0])
    if len(text) > LONGEST:
        making.too_long = True
    return text


def _shown_outside(thing: Any, text_of: Callable[[], str]) -> str:
    try:
        return _cut(text_of())
    except Exception as problem:
        return f"#<error printing a {class_text(thing)}: {type(problem).__name__}>"


def _cut(text: str) -> str:
    return text if len(text) <= LONGEST else f"{text[:LONGEST]} ... ({len(text) - LONGEST} more characters)"


def class_text(thing: Any) -> str:
    """The name of the class of ``thing``."""
    try:
        return str(class_name(type(thing)).name)
    except Exception:
        return type(thing).__name__.upper()


def _brief(thing: Any) -> str:
    return f"#<{class_text(thing)}>"


def attempt_to_print(text_of: Callable[[Any], str], thing: Any) -> str:
    """``text_of(thing)`` for a text about an error: see `shown`."""
    return shown(thing, lambda: text_of(thing))


def report_of(restart: Any) -> str:
    """The text of ``restart`` for a debugger: see `shown`."""
    return shown(restart, lambda: str(restart.report()))


def unprintable(thing: Any, problem: Any) -> str:
    """What stands for ``thing``, whose printer failed with the condition ``problem``: a line with its class, why, and where."""
    making = MAKING.value
    if making is None:
        return shown(thing, lambda: MAKING.value.fail(thing, problem))
    control = getattr(thing, "format_control", None)
    begun = f"#<error printing a {class_text(thing)}" + (f' "{control[:LONGEST_REASON]}"' if isinstance(control, str) else "")
    if making.explaining:  # why another object cannot be printed
        return f"{begun}: {class_text(problem)}>"
    making.explaining = True
    try:
        why = " ".join(str(problem).split())
    finally:
        making.explaining = False
    if len(why) > LONGEST_REASON:
        why = why[:LONGEST_REASON] + " ..."
    place = describe(getattr(problem, "position", None))
    return f"{begun}{f': {why}' if why else ''}{f' (at {place})' if place else ''}>"


def not_ending() -> binding:
    """``with not_ending():`` An object whose printing fails does not end what is printed around it, as where SBCL describes and traces."""
    return binding(SUPPRESS, sym("SERIOUS-CONDITION"))


def print_suppressed(thing: Any, stream: Any, output: Callable[[Any, Any], Any]) -> None:
    """``output(thing, stream)``, where ``*suppress-print-errors*`` is not nil: what stands for ``thing`` is written if that fails."""
    making = MAKING.value
    if making is None:  # the user has bound it
        suppressed(lambda: output(thing, stream), lambda problem: stream.write(unprintable(thing, problem)), SUPPRESS.value)
        return
    found: Any = making.stands_for(thing)
    if found is None:
        found = making.attempt(thing, lambda: output(thing, stream), making.strings)
    if isinstance(found, str):
        stream.write(found)


def _guarded_text(thing: Any, text_of: Callable[[], str]) -> str:
    making = MAKING.value
    return text_of() if making is None else _text(making, thing, text_of)


SHOWN.text = shown
PlainPrinter.guard = staticmethod(_guarded_text)
