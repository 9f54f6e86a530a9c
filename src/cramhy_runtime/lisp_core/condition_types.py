"""The classes of conditions of Common Lisp, as Python exceptions.

``lisp_name`` is the symbol that names the class (``PACKAGE::NAME``, COMMON-LISP by default); ``initargs`` maps the names of
``make-condition`` arguments and slots to attributes; `Condition.report` is the text that ``~a`` prints. Source: ANSI 9.2; the
texts are those of SBCL 2.2.9, on which the course runs. SBCL's own classes keep their names, because users see them.
"""

from __future__ import annotations


from cramhy_runtime.kernel.images import part
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from .data import UNBOUND, Cons, Symbol
from .dynamic import binding
from .classes import class_name, find_class, when_classes_change
from .pickling import reduced_condition
from .ports import PORTS
from .packages import Package, find_package, is_symbol, printed, sym, symbol_name

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = [
    "ArithmeticError_",
    "CaseFailure",
    "CellError",
    "ClosedStreamError",
    "CompileError",
    "Condition",
    "ControlError_",
    "Deadlock",
    "DivisionByZero",
    "EndOfFile",
    "Error",
    "FileError",
    "FloatingPointInexact",
    "FloatingPointInvalidOperation",
    "FloatingPointOverflow",
    "FloatingPointUnderflow",
    "MissingSlot",
    "PackageDoesNotExist",
    "PackageError",
    "ParseError",
    "PrintNotReadable",
    "ProgramError",
    "PythonError",
    "ReaderError",
    "ReaderPackageError",
    "RunEnded",
    "SeriousCondition",
    "SimpleCondition",
    "SimpleControlError",
    "SimpleError",
    "SimpleFileError",
    "SimpleParseError",
    "SimpleProgramError",
    "SimpleStyleWarning",
    "SimpleTypeError",
    "SimpleWarning",
    "StorageCondition",
    "StreamError",
    "StyleWarning",
    "TimeLimit",
    "TypeError_",
    "UnboundSlot",
    "UnboundVariable",
    "UndefinedFunction",
    "Warning_",
    "matches",
]


def formatted(control, arguments):
    """The text of a format control (string or function) with ``arguments``."""
    if not arguments and isinstance(control, str) and "~" not in control:
        return control

    return PORTS.printer.formatted(control, *arguments)


def shown(obj):
    """``obj`` as ``prin1`` prints it, for messages."""
    return PORTS.printer.prin1(obj)


def shown_with(obj, package):
    """``obj`` as ``prin1`` prints it while ``package`` is current."""
    with binding(sym("*PACKAGE*"), find_package(package)):
        return shown(obj)


DECIDED: dict[tuple[Any, type], bool] = {}
"""For the name of a condition class and the class of a condition whether this is of that type: it depends on nothing else."""

DECIDED_ELSEWHERE: list[dict[type, int]] = []
"""Tables of what follows from entries of `DECIDED`: they are emptied when it is."""


def matches(condition: Condition, specifier: Any) -> bool:
    """Whether ``condition`` is of the type ``specifier``: a Python class, a class name, or any Lisp type specifier."""
    if isinstance(specifier, type):
        return isinstance(condition, specifier)
    if specifier is True:
        return True
    if specifier is None:
        return False
    if specifier.__class__ is Symbol:
        decided = DECIDED.get((specifier, condition.__class__))
        if decided is not None:
            return decided

    # what names no type fits nothing: an error about it here would come to the same handler again, without end
    test = PORTS.types.test(specifier)
    fits = test is not None and bool(test(condition))
    if is_symbol(specifier):
        cls = find_class(specifier)
        if isinstance(cls, type) and issubclass(cls, Condition):
            DECIDED[specifier, type(condition)] = fits
    return fits


@when_classes_change
def _forget_decided() -> None:
    DECIDED.clear()
    for table in DECIDED_ELSEWHERE:
        table.clear()
    DECIDED_ELSEWHERE.clear()


@part
class _OfImage:
    """What names of classes mean differs from image to image."""

    @staticmethod
    def take() -> None:
        return None

    @staticmethod
    def put(state: None) -> None:
        _forget_decided()

    @staticmethod
    def copy(state: None) -> None:
        return None


class Shown:
    """How the text of a condition is made for Python: ``printing.py`` puts `printing.shown` here, which stands above conditions."""

    __slots__ = ("text",)

    def __init__(self) -> None:
        self.text: Callable[[Any, Callable[[], str]], str] = lambda condition, report: report()


SHOWN = Shown()


class Condition(BaseException):
    """The root of all conditions."""

    lisp_name = "CONDITION"
    initargs: dict[str, str] = {}
    restarts: Any = ()
    signalled = False  # whether handlers were asked; one that Python code just raised is offered to those that it passes
    context = ""
    position: Any  # where in the user's text it was signalled, if that is known (``source_places.py``)
    hint: str | Callable[[], str] | None = None  # what to try: a text, or a function that finds it out when it is shown

    def __init__(self, *arguments: object, **slots: object) -> None:
        super().__init__(*arguments)
        for name, value in slots.items():
            setattr(self, name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        return reduced_condition(self)

    def __copy__(self) -> Condition:
        made = self.__class__.__new__(self.__class__, *self.args)
        made.__dict__.update(self.__dict__)
        return made

    def report(self) -> str:
        """The text for the user."""
        return f"Condition {shown_with(class_name(type(self)), 'COMMON-LISP')} was signalled."

    def __str__(self) -> str:
        return SHOWN.text(self, self.report)


class SeriousCondition(Condition):
    lisp_name = "SERIOUS-CONDITION"


class Error(SeriousCondition, Exception):
    lisp_name = "ERROR"


class Warning_(Condition):
    lisp_name = "WARNING"


class StyleWarning(Warning_):
    lisp_name = "STYLE-WARNING"


class SimpleCondition(Condition):
    """A condition whose report is a format control with arguments."""

    lisp_name = "SIMPLE-CONDITION"
    initargs = {"FORMAT-CONTROL": "format_control", "FORMAT-ARGUMENTS": "format_arguments"}
    format_control = UNBOUND
    format_arguments = None

    def __init__(self, format_control: object = UNBOUND, *arguments: object, **slots: object) -> None:
        if slots:
            super().__init__(**slots)
        else:
            self.args = ()
        self.format_control = format_control
        self.format_arguments = arguments

    def report(self) -> str:
        if self.format_control is UNBOUND or self.format_control is None:
            return Condition.report(self)
        return formatted(self.format_control, tuple(self.format_arguments or ()))


class SimpleError(SimpleCondition, Error):
    lisp_name = "SIMPLE-ERROR"


class SimpleWarning(SimpleCondition, Warning_):
    lisp_name = "SIMPLE-WARNING"


class SimpleStyleWarning(SimpleCondition, StyleWarning):
    lisp_name = "SB-INT::SIMPLE-STYLE-WARNING"


class TypeError_(Error):
    """``datum`` is not of the type ``expected_type``."""

    lisp_name = "TYPE-ERROR"
    initargs = {"DATUM": "datum", "EXPECTED-TYPE": "expected_type"}

    def __init__(self, datum=None, expected_type=None, **slots):
        super().__init__(**slots)
        self.datum, self.expected_type = datum, expected_type

    def report(self) -> str:
        expected = self.expected_type if isinstance(self.expected_type, str) else shown_with(self.expected_type, "COMMON-LISP")
        return f"The value\n  {shown(self.datum)}\nis not of type\n  {expected}{self.context}"


class SimpleTypeError(SimpleCondition, TypeError_):
    lisp_name = "SIMPLE-TYPE-ERROR"

    def __init__(self, format_control=UNBOUND, *arguments, datum=None, expected_type=None, **slots):
        SimpleCondition.__init__(self, format_control, *arguments, **slots)
        self.datum, self.expected_type = datum, expected_type


class ProgramError(Error):
    lisp_name = "PROGRAM-ERROR"


class SimpleProgramError(SimpleCondition, ProgramError):
    lisp_name = "SB-INT::SIMPLE-PROGRAM-ERROR"


class ControlError_(Error):
    lisp_name = "CONTROL-ERROR"


class SimpleControlError(SimpleCondition, ControlError_):
    lisp_name = "SB-INT::SIMPLE-CONTROL-ERROR"


class CellError(Error):
    lisp_name = "CELL-ERROR"
    initargs = {"NAME": "name"}

    def __init__(self, name=None, **slots):
        super().__init__(**slots)
        self.name = name


class UnboundVariable(CellError):
    lisp_name = "UNBOUND-VARIABLE"

    def report(self) -> str:
        return f"The variable {shown(self.name)} is unbound."


class MissingSlot(CellError, TypeError_):
    """The object has no slot of that name."""

    lisp_name = "SB-PCL::MISSING-SLOT"
    initargs = {"NAME": "name", "INSTANCE": "instance"}
    what = "read the slot's value (slot-value)"

    def __init__(self, name=None, instance=None, what=what, **slots):
        super().__init__(name, **slots)
        self.instance, self.what = instance, what
        self.datum = instance

    def report(self) -> str:
        return formatted("~@<When attempting to ~A, the slot ~S is missing from the object ~S.~@:>", (self.what, self.name, self.instance))


class UndefinedFunction(CellError):
    lisp_name = "UNDEFINED-FUNCTION"

    def report(self) -> str:
        if getattr(self.name, "macro", None) is not None:
            return f"{printed(self.name)} is a macro, not a function."
        if is_symbol(self.name):
            return f"The function {printed(self.name)} is undefined."
        return f"The function {shown_with(self.name, 'KEYWORD')} is undefined."  # SBCL hides no package in (SETF NAME)


class UnboundSlot(CellError):
    lisp_name = "UNBOUND-SLOT"
    initargs = {"NAME": "name", "INSTANCE": "instance"}

    def __init__(self, name=None, instance=None, **slots):
        super().__init__(name, **slots)
        self.instance = instance

    def report(self) -> str:
        return f"The slot {printed(self.name)} is unbound in the object {shown(self.instance)}."


class ArithmeticError_(Error, ArithmeticError):
    lisp_name = "ARITHMETIC-ERROR"
    initargs = {"OPERATION": "operation", "OPERANDS": "operands"}

    def __init__(self, operation=None, operands=None, **slots):
        super().__init__(**slots)
        self.operation, self.operands = operation, operands

    def report(self) -> str:
        head = f"arithmetic error {symbol_name(class_name(type(self)))} signalled"
        if self.operation is None:
            return head
        operator = shown(self.operation) if is_symbol(self.operation) else printed(self.operation)
        call = " ".join([operator, *(shown(operand) for operand in self.operands or ())])
        return f"{head}\nOperation was ({call})."


class DivisionByZero(ArithmeticError_, ZeroDivisionError):
    lisp_name = "DIVISION-BY-ZERO"


class FloatingPointOverflow(ArithmeticError_, OverflowError):
    lisp_name = "FLOATING-POINT-OVERFLOW"


class FloatingPointUnderflow(ArithmeticError_):
    lisp_name = "FLOATING-POINT-UNDERFLOW"


class FloatingPointInexact(ArithmeticError_):
    lisp_name = "FLOATING-POINT-INEXACT"


class FloatingPointInvalidOperation(ArithmeticError_):
    lisp_name = "FLOATING-POINT-INVALID-OPERATION"


class PackageError(SimpleCondition, Error):
    lisp_name = "PACKAGE-ERROR"
    initargs = {"PACKAGE": "package"}

    def __init__(self, package=None, text=UNBOUND, *arguments, **slots):
        SimpleCondition.__init__(self, text, *arguments, **slots)
        self.package = package


class PackageDoesNotExist(PackageError):
    """A name that designates no package; the report names packages with a similar name."""

    lisp_name = "SB-EXT::PACKAGE-DOES-NOT-EXIST"

    def report(self) -> str:
        if isinstance(self.package, Package):
            return f"The package {shown(self.package)} has been deleted."
        return f"The name {shown(self.package)} does not designate any package."


class StreamError(Error):
    lisp_name = "STREAM-ERROR"
    initargs = {"STREAM": "stream"}

    def __init__(self, stream=None, **slots):
        super().__init__(**slots)
        self.stream = stream


class ClosedStreamError(StreamError):
    lisp_name = "SB-INT::CLOSED-STREAM-ERROR"

    def report(self) -> str:
        return f"{shown(self.stream)} is closed"


class EndOfFile(StreamError):
    lisp_name = "END-OF-FILE"

    def report(self) -> str:
        return f"end of file on {shown(self.stream)}"


class ParseError(Error):
    lisp_name = "PARSE-ERROR"


class SimpleParseError(SimpleCondition, ParseError):
    lisp_name = "SB-INT::SIMPLE-PARSE-ERROR"


class ReaderError(SimpleCondition, ParseError, StreamError):
    """Text that is not Lisp: ``position`` is (file, line, column), of the user's text."""

    lisp_name = "READER-ERROR"
    position = None

    def __init__(self, text=UNBOUND, *arguments, position=None, stream=None, **slots):
        SimpleCondition.__init__(self, text, *arguments, **slots)
        self.position, self.stream = position, stream


class ReaderPackageError(ReaderError, PackageError):
    lisp_name = "SB-INT::SIMPLE-READER-PACKAGE-ERROR"
    package: Any = None


class FileError(SimpleCondition, Error):
    lisp_name = "FILE-ERROR"
    initargs = {"PATHNAME": "pathname"}

    def __init__(self, pathname=None, text=UNBOUND, *arguments, **slots):
        SimpleCondition.__init__(self, text, *arguments, **slots)
        self.pathname = pathname

    def report(self) -> str:
        if self.format_control is UNBOUND:
            return f"error on file {shown(self.pathname)}"
        return super().report()


class SimpleFileError(FileError):
    lisp_name = "SB-INT::SIMPLE-FILE-ERROR"


class PrintNotReadable(Error):
    lisp_name = "PRINT-NOT-READABLE"
    initargs = {"OBJECT": "object"}

    def report(self) -> str:
        return f"{shown(self.object)} cannot be printed readably."


class StorageCondition(SimpleCondition, SeriousCondition):
    lisp_name = "STORAGE-CONDITION"


class CaseFailure(TypeError_):
    """No clause of ``ecase`` or ``etypecase`` fits."""

    lisp_name = "SB-KERNEL::CASE-FAILURE"

    def __init__(self, datum=None, operator="ECASE", possibilities=None, **slots):
        super().__init__(datum, Cons(sym("OR" if operator.endswith("TYPECASE") else "MEMBER"), possibilities), **slots)
        self.operator, self.possibilities = operator, possibilities

    def report(self) -> str:
        return f"{shown(self.datum)} fell through {self.operator} expression.\nWanted one of {shown(self.possibilities)}."


class CompileError(SimpleCondition, ProgramError):
    """A form that cannot be compiled: ``position`` is (file, line, column)."""

    lisp_name = "CRAMHY::COMPILE-ERROR"
    position = None

    def __init__(self, text=UNBOUND, *arguments, position=None, **slots):
        super().__init__(text, *arguments, **slots)
        self.position = position


class PythonError(Error):
    """An exception of Python code that is not a condition; ``exception`` is the original. See ``python_exceptions.py``."""

    lisp_name = "CRAMHY::PYTHON-ERROR"
    initargs = {"EXCEPTION": "exception"}

    def __init__(self, exception=None, **slots):
        super().__init__(**slots)
        self.exception = exception
        self.__cause__ = exception

    def report(self) -> str:
        if self.exception is None:
            return super().report()
        text = str(self.exception)
        if isinstance(self.exception, KeyError):  # whose text is only the key
            return f"There is no key {text}."
        return text or type(self.exception).__name__


class RunEnded(PythonError):
    """What ends a run as a whole. The kernel's text says what each task waits for."""

    lisp_name = "CRAMHY::RUN-ENDED"

    def report(self) -> str:
        return str(self.exception)


class Deadlock(RunEnded):
    """Every task waits, and nothing can wake one."""

    lisp_name = "CRAMHY::DEADLOCK"


class TimeLimit(RunEnded):
    """The time limit of the run is reached."""

    lisp_name = "CRAMHY::TIME-LIMIT"
