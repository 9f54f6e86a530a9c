"""Function designators, and what functions of users return.

Where Common Lisp takes a function it takes a *designator*: a function, or a symbol whose global function is meant. Functions
that are given to ``mapcar``, ``find`` or ``sort`` may return several values, of which the first counts, and anything but
``nil`` is true. This module is the one place that knows this: `function_of` finds the function, `holds` reads an answer.

Law: a thing that is no function is a ``type-error`` before anything is called. Source: ANSI glossary "function designator";
texts are SBCL's.
"""

from __future__ import annotations


from types import FunctionType

from .condition_types import SimpleProgramError, SimpleTypeError
from .condition_types import UndefinedFunction as UndefinedFunctionError
from .conditions import error, type_error
from .data import Cons, MultipleValues, Symbol, UndefinedFunction, conses, is_ratio, lisp_list, list_parts, one, values
from .equality import eql
from .packages import is_symbol, sym
from .ports import PORTS

CONSTANTS = VARIABLES = dict.fromkeys(("CALL-ARGUMENTS-LIMIT", "LAMBDA-PARAMETERS-LIMIT", "MULTIPLE-VALUES-LIMIT"), 2**62 - 1)
LISP_NAMES = "identity constantly complement funcall apply functionp values values-list not"


def function_of(designator, context=""):
    """The callable that ``designator`` (a function or a symbol) stands for.

    ``context`` ends the text of the type-error, such as ``"\\nwhen binding SB-IMPL::PRED"``. A symbol without a function gives
    a callable whose call is the undefined-function error.
    """
    if isinstance(designator, Symbol):
        return designator.function
    if designator is None or designator is True or designator is False:
        return UndefinedFunction(True if designator is True else None)
    if callable(designator):
        return designator
    return type_error(designator, "(OR FUNCTION SYMBOL)", context)


def holds(answer):
    """Whether the answer of a predicate is true: its first value is not ``nil``."""
    if answer is None or answer is False:
        return False
    if answer.__class__ is MultipleValues:
        return bool(answer) and answer[0] is not None and answer[0] is not False
    return True


def key_of(key):
    """The function for a ``:key`` argument, giving exactly one value; ``None`` when there is nothing to do."""
    if key is None or key is False:
        return None
    function = function_of(key, "\nwhen binding SB-IMPL::KEY")
    if function is identity:
        return None
    return primary(function)


def primary(function):
    """``function``, made to return its first value only."""
    if (
        function.__class__ is FunctionType
        and function.__dict__
        and ("single_valued" in function.__dict__ or "slot_of" in function.__dict__)
    ):
        return function

    def first_value(*arguments):
        value = function(*arguments)
        if value.__class__ is MultipleValues:
            return value[0] if len(value) else None
        return value

    return first_value


def directly(function):
    """``function``, or the Python function behind it if it is a standard one with keywords: for calls that give it none."""
    return function.__dict__.get("python", function) if function.__class__ is FunctionType else function


def values_of(function, items):
    """The first values that ``function``, for one argument, gives for each of ``items``: a Python list."""
    return [value if (value := function(item)).__class__ is not MultipleValues else one(value) for item in items]


def accepted(predicate, items, wanted=True):
    """Those of ``items`` that the Lisp function ``predicate`` accepts, or with ``wanted=False`` rejects: a Python list."""
    if wanted:
        return [item for item in items if (answer := predicate(item)) is not None and (answer is True or holds(answer))]
    return [item for item in items if (answer := predicate(item)) is None or answer is not True and not holds(answer)]


def equal_to(item):
    """A Python predicate: is its argument ``eql`` to ``item``? Objects are compared by identity, numbers by type and value."""
    if item.__class__ is int:
        return lambda element: element.__class__ is int and element == item
    if item is None or item is False:
        return lambda element: element is None or element is False
    if isinstance(item, (float, complex)) or is_ratio(item):
        return lambda element: eql(item, element) is not None
    return lambda element: element is item


def test_of(test, test_not, both="can't specify both :TEST and :TEST-NOT"):
    """A Python predicate of two arguments for the keywords ``:test`` and ``:test-not``; ``None`` means ``eql``."""
    if test is None or test is False:
        if test_not is None or test_not is False:
            return None
        function = function_of(test_not, "\nwhen binding SB-IMPL::TEST-NOT")
        return lambda first, second: not holds(function(first, second))
    if test_not is not None and test_not is not False:
        return error(both)
    function = function_of(test, "\nwhen binding SB-IMPL::TEST")
    if function is eql:
        return None
    function = directly(function)
    return lambda first, second: (answer := function(first, second)) is not None and (answer is True or holds(answer))


def match_of(item, key, test, test_not, both="can't specify both :TEST and :TEST-NOT"):
    """A Python predicate: does an element match ``item`` under ``:key``, ``:test`` and ``:test-not``?"""
    compare = test_of(test, test_not, both)
    key = key_of(key)
    if compare is None:
        same = equal_to(item)
        return same if key is None else lambda element: same(key(element))
    if key is None:
        return lambda element: compare(item, element)
    return lambda element: compare(item, key(element))


def predicate_of(predicate, key=None, wanted=True):
    """A Python predicate of one element for the ``-if`` (``wanted``) and ``-if-not`` functions."""
    function = function_of(predicate, "\nwhen binding SB-IMPL::PREDICATE")
    key = key_of(key)
    if wanted:
        if key is None:
            return lambda element: (answer := function(element)) is not None and (answer is True or holds(answer))
        return lambda element: holds(function(key(element)))
    if key is None:
        return lambda element: (answer := function(element)) is None or answer is not True and not holds(answer)
    return lambda element: not holds(function(key(element)))


def identity(thing):
    """``identity``: the argument itself."""
    return thing


def constantly(value):
    """``constantly``: a function that takes anything and returns ``value``."""
    return lambda *arguments, **keywords: value


def complement(function):
    """``complement``: a function that is true where ``function`` is false."""
    function = function_of(function, "\nwhen binding FUNCTION")
    return lambda *arguments: None if holds(function(*arguments)) else True


def funcall(function, *arguments):
    """``funcall``: the values of ``function`` on ``arguments``."""
    return function_of(function, "\nwhen binding FUNCTION")(*arguments)


def apply(function, argument, *arguments):
    """``apply``: as `funcall`, but the last argument is the list of the remaining arguments."""
    function = function_of(function, "\nwhen binding FUNCTION")
    if not arguments:
        return function(*_spread(argument))
    *more, last = arguments
    return function(argument, *more, *_spread(last))


def _spread(lst):
    if isinstance(lst, Cons):
        items, end = list_parts(lst)
        if end is None:
            return items
        lst = end  # what should have been a list
    elif lst is None or lst is False:
        return ()
    return type_error(lst, "LIST")


def functionp(thing):
    """``functionp``: whether ``thing`` is a function; a symbol is none."""
    return True if callable(thing) and not isinstance(thing, (Symbol, type)) else None


def values_list(lst):
    """``values-list``: the elements of ``lst`` as values."""
    return values(*_spread(lst))


def not_(thing):
    """``not``: t for nil, else nil."""
    return True if thing is None or thing is False else None


def fdefinition(symbol):
    """``#'symbol``: its global function; an undefined one is an error here, not when it is called."""
    if isinstance(symbol, Symbol):
        function = symbol.function
        if not isinstance(function, UndefinedFunction):
            return function
        if symbol.macro is None:
            return function()
    return error(UndefinedFunctionError(symbol))


def setf_function(symbol):
    """``#'(setf symbol)``."""
    function = symbol.setf_function if isinstance(symbol, Symbol) else None
    if function is None:
        return error(UndefinedFunctionError(lisp_list(sym("SETF"), symbol)))
    return function


def invalid_function_name(name):
    """The error that ``name`` names no function."""
    return SimpleTypeError("Invalid function name: ~S", name, datum=name, expected_type="SB-IMPL::FUNCTION-NAME")


def function_named(name):
    """``fdefinition``: the global function of a symbol or of ``(setf symbol)``; other names are errors."""
    if not isinstance(name, Cons) and not is_symbol(name):
        return error(invalid_function_name(name))
    return setf_function(name.cdr.car) if isinstance(name, Cons) else fdefinition(name)


def check_shape(lst, least, most, what, lambda_list):
    """Check that ``lst`` has ``least`` to ``most`` elements (no upper bound: nil), as a destructuring lambda list wants; returns it."""
    count, cell = 0, lst
    for each in conses(lst):
        count, cell = count + 1, each.cdr
    improper = cell is not None and not (most is None and count >= least)
    if improper or count < least or (most is not None and count > most):
        wanted = f"exactly {least}" if least == most else f"at least {least}" if most is None else f"between {least} and {most}"
        kind = "invalid number of" if improper else "too few" if count < least else "too many"
        condition = SimpleProgramError(
            "Error while parsing arguments to ~A:~%  ~A elements in~%    ~:S~%  to satisfy lambda list~%    "
            "~:S:~%  ~A expected, but got ~A",
            what,
            kind,
            lst,
            lambda_list,
            wanted,
            "a non-list" if improper else count,
        )
        if what.startswith(("DEFMACRO", "MACROLET")):
            condition.position = PORTS.definitions.expansion_place()  # the call is wrong, not the macro
        return error(condition)
    return lst
