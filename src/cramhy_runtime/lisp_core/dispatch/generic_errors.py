"""The errors of generic functions, with SBCL's texts."""

from __future__ import annotations

from ..condition_types import shown, shown_with
from ..conditions import Error, SimpleProgramError, error, restart_case
from ..data import list_from
from ..packages import sym


class NoMethodError(Error):
    """``generic_function`` was called with ``arguments`` for which it has no (primary, next) method."""

    initargs = {"GENERIC-FUNCTION": "generic_function", "ARGS": "arguments"}
    what, section = "applicable method", "7.6.6"

    def __init__(self, generic_function=None, arguments=None, **slots):
        super().__init__(**slots)
        self.generic_function, self.arguments = generic_function, arguments

    def report(self):
        return (
            f"There is no {self.what} for the generic function\n  {shown(self.generic_function)}\nwhen called with arguments\n"
            f"  {shown(self.arguments)}.\nSee also:\nThe ANSI Standard, Section {self.section}"
        )


class NoApplicableMethodError(NoMethodError):
    lisp_name = "SB-PCL::NO-APPLICABLE-METHOD-ERROR"


class NoPrimaryMethodError(NoMethodError):
    lisp_name = "SB-PCL::NO-PRIMARY-METHOD-ERROR"
    what, section = "primary method", "7.6.6.2"


class NoNextMethodError(NoMethodError):
    """``call-next-method`` was called and there is none."""

    lisp_name = "SB-PCL::NO-NEXT-METHOD-ERROR"
    initargs = {"METHOD": "method"}
    method = None

    def report(self):
        return (
            f"There is no next method for the generic function\n  {shown(self.generic_function)}\nwhen called from method\n"
            f"  {shown(self.method)}\nwith arguments\n  {shown(self.arguments)}.\nSee also:\nThe ANSI Standard, Section 7.6.6.2"
        )


def no_applicable_method_error(generic_function, arguments):
    return _no_method(NoApplicableMethodError, generic_function, arguments)


def no_primary_method_error(generic_function, arguments):
    return _no_method(NoPrimaryMethodError, generic_function, arguments)


def _no_method(kind, generic_function, arguments):
    return error(kind(generic_function, list_from(arguments)), hint=getattr(generic_function, "advice", None))


def no_next_method_error(generic_function, method, arguments):
    return error(NoNextMethodError(generic_function, list_from(arguments), method=method))


class ShownAsGeneric:
    """What errors show for a function that is generic in the original and a plain one here: its name, how many
    methods it has (``None``: nobody knows), and what to try."""

    __slots__ = ("name", "methods", "advice")

    def __init__(self, name, methods, advice=None):
        self.name, self.methods, self.advice = name, methods, advice


def no_applicable_method(name, methods, *arguments, advice=None):
    """Signal what the generic function ``name`` (as printed) of the original, with ``methods`` methods, signals for ``arguments``."""
    return no_applicable_method_error(ShownAsGeneric(name, methods, advice), arguments)


def no_primary_method(name, methods, *arguments, advice=None):
    """The same for a function whose only methods for ``arguments`` are auxiliary ones."""
    return no_primary_method_error(ShownAsGeneric(name, methods, advice), arguments)


def incongruent(generic_function, method):
    """Signal that the lambda list of ``method`` does not fit that of ``generic_function``, and say in what."""
    ours, theirs = generic_function.shape, method.shape
    if ours.required != theirs.required or len(method.specializers) != ours.required:
        more = "fewer" if theirs.required < ours.required else "more"
        difference = f"the method has {more} required arguments than the generic function."
    elif ours.optional != theirs.optional:
        more = "fewer" if theirs.optional < ours.optional else "more"
        difference = f"the method has {more} optional arguments than the generic function."
    elif (ours.rest or ours.has_keys) != (theirs.rest or theirs.has_keys):
        difference = "the method and generic function differ in whether they accept~%&REST or &KEY arguments."
    else:
        difference = "the method does not accept each of the &KEY arguments~%~S."
    text = f"attempt to add the method~%  ~S~%to the generic function~%  ~S;~%but {difference}"
    return error(SimpleProgramError(text, method, generic_function, list_from(ours.keys_unknown_to(theirs))))


class FunctionInTheWay(SimpleProgramError):
    """A generic function is defined where there is an ordinary one."""


def refuse_ordinary(symbol):
    """Signal that ``symbol`` names an ordinary function or a macro, with a restart that replaces it unless it is Common Lisp's."""
    condition = FunctionInTheWay("~A already names an ordinary function or a macro.", shown_with(symbol, "KEYWORD"))
    if symbol.package is not None and symbol.package.name == "COMMON-LISP":
        return error(condition)
    return restart_case([(sym("CONTINUE"), lambda: None, "Replace the function binding.")], lambda: error(condition))
