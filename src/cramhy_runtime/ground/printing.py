"""Objects and messages as text, by the printer that is installed (``ports.py``), and how instances of a class print.

A room says by `define_printer` how its objects look. The function writes to a stream and prints components by `output_object`, so it is
right in every language and under all control variables.
"""

from __future__ import annotations

from collections.abc import Callable
from cramhy_runtime.kernel.typing_names import Any

from .classes import class_name
from .condition_types import SeriousCondition
from .conditions import handler_case
from .data import Symbol
from .dynamic import special
from .plain_answers import printer_for, printers, printers_found
from .ports import PORTS

__all__ = [
    "CURRENT_LEVEL",
    "LEVELS_COUNT",
    "attempt_to_print",
    "define_printer",
    "format_to_string",
    "guarded",
    "output_object",
    "prin1_to_string",
    "princ_to_string",
    "print_slots",
    "print_unreadable",
    "printer_for",
    "unprintable",
    "write",
]

CURRENT_LEVEL = special(Symbol("*CURRENT-LEVEL-IN-PRINT*"), 0)
"""How deep what is being printed lies in what was to be printed; counted while ``*print-level*`` or ``LEVELS_COUNT`` asks for it."""
LEVELS_COUNT = special(Symbol("*LEVELS-COUNT*"), None)
"""Whether levels are counted without ``*print-level*``, since a function that prints is told of them."""


def prin1_to_string(thing: Any) -> str:
    """``thing`` as ``prin1`` prints it: strings in quotes, so that it can be read back."""
    return PORTS.printer.prin1(thing)


def princ_to_string(thing: Any) -> str:
    """``thing`` as ``princ`` prints it, for people to read."""
    return PORTS.printer.princ(thing)


def format_to_string(control: Any, *arguments: Any) -> str:
    """The text of a format control (a string or a function) with ``arguments``."""
    return PORTS.printer.formatted(control, *arguments)


def attempt_to_print(text_of: Callable[[Any], str], thing: Any) -> str:
    """``text_of(thing)``; if that fails, ``#<error printing a CLASS: why>``. For texts about an error, which must not become another error.

    The handlers around the caller are not asked about the failure of the printer.
    """
    return guarded(lambda: text_of(thing), lambda problem: unprintable(thing, problem))


def unprintable(thing: Any, problem: Any) -> str:
    """What stands for ``thing``, whose printer failed with the condition ``problem``."""
    why = guarded(lambda: princ_to_string(problem), lambda _: "")
    return f"#<error printing a {class_name(type(thing)).name}{': ' + ' '.join(why.split()) if why else ''}>"


def guarded(thunk: Callable[[], Any], otherwise: Callable[[Any], Any]) -> Any:
    """The value of ``thunk()``; if it signals a serious condition, ``otherwise(condition)``."""
    return handler_case([(SeriousCondition, otherwise)], thunk)


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
    return PORTS.printer.report(condition)


def address(thing: Any) -> str:
    """The address that ``#<... {1001000003}>`` shows for ``thing``: hexadecimal digits, the same as long as it lives."""
    return PORTS.printer.address(thing)
