"""The classes of conditions of Common Lisp, as Python exceptions.

``lisp_name`` is the symbol that names the class (``PACKAGE::NAME``, COMMON-LISP by default); ``initargs`` maps the names of
``make-condition`` arguments and slots to attributes; `Condition.report` is the text that ``~a`` prints. Source: ANSI 9.2; the
texts are those of SBCL 2.2.9, on which the course runs. SBCL's own classes keep their names, because users see them.
"""

from __future__ import annotations

import re

from cramhy_runtime import kernel

from .data import UNBOUND, Cons
from .dynamic import binding
from .late import late
from .packages import Package, all_packages, find_package, is_symbol, printed, sym, symbol_name

__all__ = []


def public(cls):
    __all__.append(cls.__name__)
    return cls


def formatted(control, arguments):
    """The text of a format control (string or function) with ``arguments``."""
    if not arguments and isinstance(control, str) and "~" not in control:
        return control

    return late.format_to_string(control, *arguments)


def shown(obj):
    """``obj`` as ``prin1`` prints it, for messages."""
    return late.prin1_to_string(obj)


def shown_with(obj, package):
    """``obj`` as ``prin1`` prints it while ``package`` is current."""
    with binding(sym("*PACKAGE*"), find_package(package)):
        return shown(obj)


@public
class Condition(BaseException):
    """The root of all conditions."""

    lisp_name = "CONDITION"
    initargs: dict = {}
    restarts = ()
    signalled = False  # whether handlers were asked; one that Python code just raised is offered to those that it passes
    context = ""
    hint = None  # what to try: a text, or a function that finds it out when it is shown

    def __init__(self, *arguments: object, **slots: object) -> None:
        super().__init__(*arguments)
        for name, value in slots.items():
            setattr(self, name, value)

    def report(self):
        """The text for the user."""
        return f"Condition {shown_with(late.class_name(type(self)), 'COMMON-LISP')} was signalled."

    def __str__(self):
        try:
            with kernel.at_hand():  # Python prints what nobody caught when the kernel is gone
                return self.report()
        except Exception as problem:  # a broken :report must not hide the condition itself
            control = getattr(self, "format_control", None)
            told = f"{control!s}" if isinstance(control, str) else f"A condition of type {shown(late.class_name(type(self)))} was signalled"
            return f"{told}\n(Its report could not be made: {' '.join(str(problem).split()) or type(problem).__name__})"


@public
class SeriousCondition(Condition):
    lisp_name = "SERIOUS-CONDITION"


@public
class Error(SeriousCondition, Exception):
    lisp_name = "ERROR"


@public
class Warning_(Condition):
    lisp_name = "WARNING"


@public
class StyleWarning(Warning_):
    lisp_name = "STYLE-WARNING"


@public
class SimpleCondition(Condition):
    """A condition whose report is a format control with arguments."""

    lisp_name = "SIMPLE-CONDITION"
    initargs = {"FORMAT-CONTROL": "format_control", "FORMAT-ARGUMENTS": "format_arguments"}
    format_control = UNBOUND
    format_arguments = None

    def __init__(self, format_control=UNBOUND, *arguments, **slots):
        super().__init__(**slots)
        self.format_control = format_control
        self.format_arguments = arguments

    def report(self):
        if self.format_control is UNBOUND or self.format_control is None:
            return Condition.report(self)
        return formatted(self.format_control, tuple(self.format_arguments or ()))


@public
class SimpleError(SimpleCondition, Error):
    lisp_name = "SIMPLE-ERROR"


@public
class SimpleWarning(SimpleCondition, Warning_):
    lisp_name = "SIMPLE-WARNING"


@public
class SimpleStyleWarning(SimpleCondition, StyleWarning):
    lisp_name = "SB-INT::SIMPLE-STYLE-WARNING"


@public
class TypeError_(Error):
    """``datum`` is not of the type ``expected_type``."""

    lisp_name = "TYPE-ERROR"
    initargs = {"DATUM": "datum", "EXPECTED-TYPE": "expected_type"}

    def __init__(self, datum=None, expected_type=None, **slots):
        super().__init__(**slots)
        self.datum, self.expected_type = datum, expected_type

    def report(self):
        expected = self.expected_type if isinstance(self.expected_type, str) else shown_with(self.expected_type, "COMMON-LISP")
        return f"The value\n  {shown(self.datum)}\nis not of type\n  {expected}{self.context}"


@public
class SimpleTypeError(SimpleCondition, TypeError_):
    lisp_name = "SIMPLE-TYPE-ERROR"

    def __init__(self, format_control=UNBOUND, *arguments, datum=None, expected_type=None, **slots):
        SimpleCondition.__init__(self, format_control, *arguments, **slots)
        self.datum, self.expected_type = datum, expected_type


@public
class ProgramError(Error):
    lisp_name = "PROGRAM-ERROR"


@public
class SimpleProgramError(SimpleCondition, ProgramError):
    lisp_name = "SB-INT::SIMPLE-PROGRAM-ERROR"


@public
class ControlError_(Error):
    lisp_name = "CONTROL-ERROR"


@public
class SimpleControlError(SimpleCondition, ControlError_):
    lisp_name = "SB-INT::SIMPLE-CONTROL-ERROR"


@public
class CellError(Error):
    lisp_name = "CELL-ERROR"
    initargs = {"NAME": "name"}

    def __init__(self, name=None, **slots):
        super().__init__(**slots)
        self.name = name


@public
class UnboundVariable(CellError):
    lisp_name = "UNBOUND-VARIABLE"

    def report(self):
        return f"The variable {shown(self.name)} is unbound."


@public
class UndefinedFunction(CellError):
    lisp_name = "UNDEFINED-FUNCTION"

    def report(self):
        if is_symbol(self.name):
            return f"The function {printed(self.name)} is undefined."
        return f"The function {shown_with(self.name, 'KEYWORD')} is undefined."  # SBCL hides no package in (SETF NAME)


@public
class UnboundSlot(CellError):
    lisp_name = "UNBOUND-SLOT"
    initargs = {"NAME": "name", "INSTANCE": "instance"}

    def __init__(self, name=None, instance=None, **slots):
        super().__init__(name, **slots)
        self.instance = instance

    def report(self):
        return f"The slot {printed(self.name)} is unbound in the object {shown(self.instance)}."


@public
class ArithmeticError_(Error, ArithmeticError):
    lisp_name = "ARITHMETIC-ERROR"
    initargs = {"OPERATION": "operation", "OPERANDS": "operands"}

    def __init__(self, operation=None, operands=None, **slots):
        super().__init__(**slots)
        self.operation, self.operands = operation, operands

    def report(self):
        head = f"arithmetic error {symbol_name(late.class_name(type(self)))} signalled"
        if self.operation is None:
            return head
        operator = shown(self.operation) if is_symbol(self.operation) else printed(self.operation)
        call = " ".join([operator, *(shown(operand) for operand in self.operands or ())])
        return f"{head}\nOperation was ({call})."


@public
class DivisionByZero(ArithmeticError_, ZeroDivisionError):
    lisp_name = "DIVISION-BY-ZERO"


@public
class FloatingPointOverflow(ArithmeticError_, OverflowError):
    lisp_name = "FLOATING-POINT-OVERFLOW"


@public
class FloatingPointUnderflow(ArithmeticError_):
    lisp_name = "FLOATING-POINT-UNDERFLOW"


@public
class FloatingPointInexact(ArithmeticError_):
    lisp_name = "FLOATING-POINT-INEXACT"


@public
class FloatingPointInvalidOperation(ArithmeticError_):
    lisp_name = "FLOATING-POINT-INVALID-OPERATION"


@public
class PackageError(SimpleCondition, Error):
    lisp_name = "PACKAGE-ERROR"
    initargs = {"PACKAGE": "package"}

    def __init__(self, package=None, text=UNBOUND, *arguments, **slots):
        SimpleCondition.__init__(self, text, *arguments, **slots)
        self.package = package


@public
class PackageDoesNotExist(PackageError):
    """A name that designates no package; the report names packages with a similar name."""

    lisp_name = "SB-EXT::PACKAGE-DOES-NOT-EXIST"

    def report(self):
        if isinstance(self.package, Package):
            return f"The package {shown(self.package)} has been deleted."
        return f"The name {shown(self.package)} does not designate any package."


@public
class StreamError(Error):
    lisp_name = "STREAM-ERROR"
    initargs = {"STREAM": "stream"}

    def __init__(self, stream=None, **slots):
        super().__init__(**slots)
        self.stream = stream


@public
class ClosedStreamError(StreamError):
    lisp_name = "SB-INT::CLOSED-STREAM-ERROR"

    def report(self):
        return f"{shown(self.stream)} is closed"


@public
class EndOfFile(StreamError):
    lisp_name = "END-OF-FILE"

    def report(self):
        return f"end of file on {shown(self.stream)}"


@public
class ParseError(Error):
    lisp_name = "PARSE-ERROR"


@public
class SimpleParseError(SimpleCondition, ParseError):
    lisp_name = "SB-INT::SIMPLE-PARSE-ERROR"


@public
class ReaderError(SimpleCondition, ParseError, StreamError):
    """Text that is not Lisp: ``position`` is (file, line, column), of the user's text."""

    lisp_name = "READER-ERROR"
    position = None

    def __init__(self, text=UNBOUND, *arguments, position=None, stream=None, **slots):
        SimpleCondition.__init__(self, text, *arguments, **slots)
        self.position, self.stream = position, stream


@public
class ReaderPackageError(ReaderError):
    lisp_name = "SB-INT::SIMPLE-READER-PACKAGE-ERROR"


@public
class FileError(SimpleCondition, Error):
    lisp_name = "FILE-ERROR"
    initargs = {"PATHNAME": "pathname"}

    def __init__(self, pathname=None, text=UNBOUND, *arguments, **slots):
        SimpleCondition.__init__(self, text, *arguments, **slots)
        self.pathname = pathname

    def report(self):
        if self.format_control is UNBOUND:
            return f"error on file {shown(self.pathname)}"
        return super().report()


@public
class SimpleFileError(FileError):
    lisp_name = "SB-INT::SIMPLE-FILE-ERROR"


@public
class PrintNotReadable(Error):
    lisp_name = "PRINT-NOT-READABLE"
    initargs = {"OBJECT": "object"}

    def report(self):
        return f"{shown(self.object)} cannot be printed readably."


@public
class StorageCondition(SimpleCondition, SeriousCondition):
    lisp_name = "STORAGE-CONDITION"


@public
class CaseFailure(TypeError_):
    """No clause of ``ecase`` or ``etypecase`` fits."""

    lisp_name = "SB-KERNEL::CASE-FAILURE"

    def __init__(self, datum=None, operator="ECASE", possibilities=None, **slots):
        super().__init__(datum, Cons(sym("OR" if operator.endswith("TYPECASE") else "MEMBER"), possibilities), **slots)
        self.operator, self.possibilities = operator, possibilities

    def report(self):
        return f"{shown(self.datum)} fell through {self.operator} expression.\nWanted one of {shown(self.possibilities)}."


@public
class CompileError(SimpleCondition, ProgramError):
    """A form that cannot be compiled: ``position`` is (file, line, column)."""

    lisp_name = "CRAMHY::COMPILE-ERROR"
    position = None

    def __init__(self, text=UNBOUND, *arguments, position=None, **slots):
        super().__init__(text, *arguments, **slots)
        self.position = position


@public
class PythonError(Error):
    """An exception of Python code that is not a condition; ``exception`` is the original. See ``python/python_exceptions.py``."""

    lisp_name = "CRAMHY::PYTHON-ERROR"
    initargs = {"EXCEPTION": "exception"}

    def __init__(self, exception=None, **slots):
        super().__init__(**slots)
        self.exception = exception
        self.__cause__ = exception

    def report(self):
        if self.exception is None:
            return super().report()
        text = str(self.exception)
        if isinstance(self.exception, KeyError):  # whose text is only the key
            return f"There is no key {text}."
        return text or type(self.exception).__name__


@public
class RunEnded(PythonError):
    """What ends a run as a whole. The kernel's text says what each task waits for."""

    lisp_name = "CRAMHY::RUN-ENDED"

    def report(self):
        return str(self.exception)


@public
class Deadlock(RunEnded):
    """Every task waits, and nothing can wake one."""

    lisp_name = "CRAMHY::DEADLOCK"


@public
class TimeLimit(RunEnded):
    """The time limit of the run is reached."""

    lisp_name = "CRAMHY::TIME-LIMIT"


_ARITY = re.compile(r"^(?P<name>.*)\(\) (?:takes (?:from )?\d+(?: to \d+)? positional arguments? but (?P<given>\d+) (?:was|were) given"
                    r"|missing \d+ required positional arguments?: '(?P<missing>[^']*)'.*)$")


def _wrong_argument_count(exception):
    """The program-error for Python's complaint about the number of arguments of a call, or ``None`` if it is another one.

    Python says what is missing, not what was given, so the called function is looked up by its name.
    """
    match = _ARITY.match(str(exception))
    if not match:
        return None
    name, function = _called(match["name"], match["missing"])
    code = getattr(function, "__code__", None)
    if not _takes(code, match["missing"]):  # another function of that name
        function, code = None, _code_of(match["name"], exception)
        if not _takes(code, match["missing"]):
            code = None
    if match["given"]:
        condition = SimpleProgramError("invalid number of arguments: ~S", int(match["given"]))
    elif code is None:
        condition = SimpleProgramError("invalid number of arguments")
    else:  # the arguments that were given are those before the first missing one
        condition = SimpleProgramError("invalid number of arguments: ~S", code.co_varnames.index(match["missing"]))
    if function is not None and code is not None:
        wanted = code.co_argcount
        optional = len(function.__defaults__ or ())
        count = f"{wanted - optional} to {wanted}" if optional else str(wanted)
        if code.co_flags & 0x04:
            count = f"at least {wanted - optional}"
        condition.hint = f"{name} takes {count} argument{'' if count.split()[-1] == '1' else 's'}."
    return condition


def _code_of(name, exception):
    """The code called ``name`` among that of the functions which ``exception`` passed, for a function that is gone already."""
    trace, codes = exception.__traceback__, []
    while trace is not None:
        codes.append(trace.tb_frame.f_code)
        trace = trace.tb_next
    while codes:
        code = codes.pop()
        if getattr(code, "co_qualname", None) == name:
            return code
        codes += [constant for constant in code.co_consts if isinstance(constant, type(code))]
    return None


def _takes(code, missing):
    """Whether a function of that code can be the one that misses its parameter ``missing`` (``None``: was given too many)."""
    return code is not None and (missing is None or missing in code.co_varnames)


def _called(name, missing):
    """(how the user calls it, function) for Python's qualified name of a function that misses its parameter ``missing``."""
    import gc
    from types import FunctionType

    if "<locals>" not in name:
        for package in all_packages():
            for table in (package.external, package.internal):
                for symbol in table.values():
                    function = getattr(symbol, "function", None)
                    if getattr(function, "__qualname__", None) == name:
                        return shown(symbol), getattr(function, "python", function)
    # A local function or a lambda expression: only the collector knows it. It knows weak proxies, too, and isinstance would ask
    # what they stand for, which may have gone.
    found = next((each for each in gc.get_objects()
                  if type(each) is FunctionType and each.__qualname__ == name and _takes(each.__code__, missing)), None)
    short = name.rpartition(".")[2]
    if short.startswith(("<lambda>", "Lfunction")):
        return "The function", found
    return f"The function {short.replace('_', '-').upper()}", found


def condition_for(exception):
    """The condition that says in Lisp what the Python ``exception`` says."""
    if isinstance(exception, ZeroDivisionError):
        return DivisionByZero()
    if isinstance(exception, OverflowError):
        return FloatingPointOverflow()
    if isinstance(exception, RecursionError):
        return StorageCondition("Control stack exhausted: a function calls itself too deeply, perhaps without end.")
    if isinstance(exception, MemoryError):
        return StorageCondition("Heap exhausted: there is no memory for this object.")
    if isinstance(exception, kernel.Deadlock):
        return Deadlock(exception)
    if isinstance(exception, kernel.TimeLimit):
        return TimeLimit(exception)
    if isinstance(exception, TypeError):
        wrong = _wrong_argument_count(exception)
        if wrong is not None:
            return wrong
    return late.python_condition(exception)
