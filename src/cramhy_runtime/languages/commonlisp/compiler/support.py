"""What compiled code calls.

The names that generated code uses begin with ``L``: no Lisp name becomes such a Python name, so they cannot clash.
`NAMESPACE` maps them to the functions here; the globals of every piece of compiled code contain it.
"""

from __future__ import annotations

from ..collections.sequences import length
from ..collections.arrays import aref
from ..collections.lists import cars
from ..collections.sequence_types import characters, elements, in_turns, same_kind
import math
from fractions import Fraction
from functools import partial
from itertools import zip_longest
from operator import itemgetter
from types import FunctionType

from cramhy_runtime.lisp_core.arrays import SimpleArray, TypedVector, Vector
from cramhy_runtime.lisp_core.catching import CATCHABLE, Case, caught, catch, throw
from cramhy_runtime.lisp_core.functions import fdefinition, setf_function  # noqa: F401  compiled code calls them
from cramhy_runtime import kernel
from cramhy_runtime.kernel.active import ACTIVE
from cramhy_runtime.kernel.budget import TICKS, budget

from cramhy_runtime.lisp_core.conditions import (
    Condition,
    SimpleControlError,
    error,
    error_in_case,
    offer_late,
    program_error,
    unbound_variable,
    unknown_key,
)
from .frame_exits import FrameExit, ends_here
from cramhy_runtime.lisp_core.data import (
    FreshString,
    KindString,
    Character,
    TEXTS,
    Cons,
    Keyword,
    MultipleValues,
    Symbol,
    UNBOUND,
    UNSUPPLIED,
    UndefinedFunction,
    all_values,
    list_from,
    lisp_list,
    one,
    truth,
)
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.floats import new_single, to_float32
from cramhy_runtime.lisp_core.hash_tables import REMOVED, HashTable, need_table, value_and_presence, value_in_table
from cramhy_runtime.lisp_core.keyword_calls import keyword_calls
from cramhy_runtime.lisp_core.dynamic import Bindings, bind, unbind
from cramhy_runtime.lisp_core.functions import function_of
from ..format.format import write_text
from ..format.format_templates import decimal, piece_of, prin1_atom, princ_atom
from ..numbers import arithmetic
from ..numbers.irrational import complex_
from ..objects.makers import maker
from ..objects.slots import named_slot
from cramhy_runtime.lisp_core.packages import find_package_or_error, intern, keyword, printed
from cramhy_runtime.lisp_core.ports import PORTS
from ..pathnames.pathname_objects import pathname_of_parts
from ..pathnames.pathnames import logical_host
from ..syntax.backquote import Comma
from .declared_types import checked
from .several_values import beside, first_of, values_calls


class Cell:
    """A variable of its own for each turn of a loop."""

    __slots__ = ("v",)

    def __init__(self, v):
        self.v = v


class BlockExit(BaseException):
    """Unwinds to a ``block`` or ``tagbody`` of an outer function. One object per entry of the block, its own token."""

    value = None
    active = True


def counting(start, limit, step, inclusive):
    """What a loop counts through: from ``start`` by the integer ``step`` up or down to ``limit``, in parts.

    Each turn counts as a checkpoint, and between the parts others may get a turn. A limit that is a float, or no number at all, is
    the generic functions' business.
    """
    if start.__class__ is not int or limit.__class__ is not int:
        return (_counting_by_comparison(start, limit, step, inclusive),)
    stop = limit + (1 if step > 0 else -1) if inclusive else limit
    turns = range(start, stop, step)
    return _parts(turns, len(turns))


def _counting_by_comparison(number, limit, step, inclusive):
    past = (arithmetic.gt2 if inclusive else arithmetic.ge2) if step > 0 else (arithmetic.lt2 if inclusive else arithmetic.le2)
    while past(number, limit) is None:
        yield number
        number = arithmetic.add2(number, step)
        kernel.checkpoint()


def _parts(sequence, size):
    """``sequence`` in parts."""
    if size <= TICKS:
        budget.left -= size
        if budget.left < 0:
            kernel.slice_over()
        return (sequence,)
    return _ticking(sequence, size)


def _ticking(sequence, size):
    for start in range(0, size, TICKS):
        yield sequence[start : start + TICKS]
        budget.left -= TICKS
        if budget.left < 0:
            kernel.slice_over()


def items(vector):
    """What a loop over the elements of ``vector`` goes through, in parts. The loop does not change the vector."""
    if vector.__class__ is list:
        return _parts(vector, len(vector))
    if vector.__class__ in TEXTS:
        return _parts(characters(vector), len(vector))
    if vector.__class__ is Vector:
        return _parts(vector.active(), len(vector))
    return (_items(vector),)


def _items(vector):
    index = 0
    while index < length(vector):
        yield aref(vector, index)
        index += 1
        kernel.checkpoint()


def each(sequence, context=""):
    """The elements of a sequence, one after the other. Where a list does not end as it should is found at its end."""
    return cars(sequence) if sequence.__class__ is Cons else in_turns(elements(sequence, context))


def each_of_all(sequence):
    """The elements of a sequence, which is looked at as a whole before."""
    return in_turns(elements(sequence))


def each_entry(table):
    """The pairs of key and value of a hash table, with ``REMOVED`` for what was removed meanwhile."""
    return need_table(table).walk()


def block_value(exit_, token):
    """The values that ``token`` was left with; any other exit goes on."""
    if exit_ is not token:
        raise exit_
    exit_.__traceback__ = None  # it leads to frames that hold the token: a circle that only the garbage collector would find
    return exit_.value


def return_from(token, value):
    """Leave the block of ``token`` with ``value``."""
    if not token.active:
        nothing_to_leave()
    token.value = value
    raise token


def nothing_to_leave():
    """Signal that the block or tagbody of an exit is over."""
    error(SimpleControlError("attempt to RETURN-FROM a block or GO to a tag that no longer exists"))


def end_block(token):
    token.active = False


def progv(symbols, values, thunk):
    """``progv``: bind specials computed at run time; symbols without a value become unbound."""
    symbols, values, bound = list(symbols or ()), list(values or ()), 0
    try:
        for symbol, value in zip_longest(symbols, values[: len(symbols)], fillvalue=UNBOUND):
            if not isinstance(symbol, Symbol) or symbol.constant:
                program_error("PROGV cannot bind ~S: a variable must be a symbol that is not a constant.", symbol)
            bind(symbol, value)
            bound += 1
        return thunk()
    finally:
        if bound:
            unbind(bound)


def value_of(symbol):
    """The value of a special variable; unbound is an error with restarts."""
    value = symbol.value
    return unbound_variable(symbol) if value is UNBOUND else value


def called_function(designator):
    """The function that ``funcall`` calls."""
    if isinstance(designator, Symbol):
        return designator.function
    if callable(designator) and designator is not True:
        return designator
    return function_of(designator, "\nwhen binding FUNCTION")


def undefined(symbol, *arguments):
    return UndefinedFunction(symbol)(*arguments)


def spread(value, count):
    """The first ``count`` values, with nil for missing ones."""
    if value.__class__ is not MultipleValues:
        return (value,) + (None,) * (count - 1) if count else ()
    if len(value) >= count:
        return value[:count]
    return value + (None,) * (count - len(value))


KEYS_OF_ARGUMENTS = slice(None, None, 2)
KEPT_GETTERS = 32
"""For how many sequences of keywords a function with &key keeps a getter."""


def key_parser(table, allow_others):
    """The function that sorts the &key arguments of a call; made once for each function with &key.

    table: pairs of (keyword, value when missing). It takes the arguments after the positional ones, keyword objects and values,
    and the keyword arguments of a Python caller, and gives the values in the order of ``table``; of equal keys the first counts.
    ``known``: the values of those that are not among these arguments.
    """
    slots = {key: index for index, (key, _) in enumerate(table)}
    missing = tuple(value for _, value in table)
    slot_of = slots.get
    allow = keyword("ALLOW-OTHER-KEYS")
    getters: dict = {}
    getter_for = getters.get

    def parse(rest, python, known=missing):
        if not python and not len(rest) & 1:
            try:
                getter = getter_for(rest[KEYS_OF_ARGUMENTS])
            except TypeError:  # something that is no keyword and has no hash
                getter = None
            if getter is not None:
                return getter(rest + known)
        values = list(known)
        for name, value in python.items():
            rest = (*rest, keyword(name.upper().replace("_", "-")), value)
        unknown = None
        for index in range(len(rest) - 2, -1, -2):
            try:
                slot = slot_of(rest[index])
            except TypeError:  # something that is no keyword and has no hash
                slot = None
            if slot is not None:
                values[slot] = rest[index + 1]
            elif rest[index] is not allow:
                unknown = index
        if len(rest) % 2:
            return program_error("odd number of &KEY arguments")
        if unknown is not None and not allow_others:
            allowed = next((value for key, value in zip(rest[::2], rest[1::2]) if key is allow), None)
            if not truth(allowed):
                return unknown_key(rest[unknown], [key for key, _ in table])
        keys = rest[::2]
        if len(slots) > 1 and len(getters) < KEPT_GETTERS and all(key in slots for key in keys):
            getters[keys] = itemgetter(*(2 * keys.index(key) + 1 if key in keys else len(rest) + index for key, index in slots.items()))
        return values

    return parse


def dotted(*items):
    """The list of all but the last of ``items``, ending in the last."""
    return list_from(items[:-1], items[-1])


def next_method_exists(following):
    """``next-method-p`` in the body of a method: whether ``following`` is another method."""
    return getattr(following, "exists", True)


def value_list(value):
    return list_from(all_values(value))


def wrapped(value):
    """What a raw value is for Lisp: a float is a single, anything else is itself (see ``kinds.py``)."""
    return new_single(value) if value.__class__ is float else value


def unwrapped(value):
    """The raw value that stands for ``value``, which is no double-float."""
    return float(value) if value.__class__ is SingleFloat else value


def in_single(number):
    """The single-float nearest to the integer ``number``, raw; what is a float is one already."""
    return float(arithmetic.single_of(number)) if number.__class__ is int and number.bit_length() > 24 else number


def rounded(exact):
    """The single-float nearest to ``exact``, the result in doubles of an operation with singles, raw; an overflow where singles end."""
    result = to_float32(exact)
    if result - result != 0.0 and exact - exact == 0.0:
        return float(arithmetic.too_large_for(exact, "SINGLE-FLOAT"))
    return result


def not_(value):
    return None if truth(value) else True


def python_function(symbol):
    """The Python function behind the standard function ``symbol``.

    A program may have made the standard function generic since its call was compiled and stored, as CLOSE for streams of its own. Then it
    is a function that hands on keywords as Lisp's.
    """
    function = symbol.function
    python = getattr(function, "python", None)
    return partial(_with_lisp_keywords, function) if python is None else python


def _with_lisp_keywords(function, *arguments, **keywords):
    pairs = [each for name, value in keywords.items() for each in (keyword(name.strip("_").replace("_", "-").upper()), value)]
    return function(*arguments, *pairs)


NAMESPACE = {
    "LFrameExit": FrameExit,
    "Lends_here": ends_here,
    "Lone": one,
    "Ltruth": truth,
    "Lnot": not_,
    "Lvalue": value_of,
    "Lfdefinition": fdefinition,
    "Lsetf_function": setf_function,
    "Lpython_function": python_function,
    "Lundefined": undefined,
    "Lcallable": called_function,
    "Lall_values": all_values,
    "Lspread": spread,
    "Lcell": Cell,
    "Lbind": bind,
    "Lunbind": unbind,
    "Lblock": BlockExit,
    "Lactive": ACTIVE,
    "Lno_kernel": kernel.current,
    "Lcase": Case,
    "Lerror_in_case": error_in_case,
    "Lcaught": caught,
    "Lcatchable": CATCHABLE,
    "Lexceptions": (Exception, Condition),
    "Loffer_late": offer_late,
    "Lhandler": function_of,
    "Lcheckpoint": kernel.checkpoint,
    "LBlockExit": BlockExit,
    "Lnothing_to_leave": nothing_to_leave,
    "Lrefill": kernel.refill,
    "Lcounting": counting,
    "Litems": items,
    "LMultipleValues": MultipleValues,
    "LCons": Cons,
    "Lnew_object": object.__new__,
    "Lstr": str,
    "Lfresh": FreshString,
    "Lwrite_text": write_text,
    "Lpiece": piece_of,
    "LtextA": princ_atom,
    "LtextS": prin1_atom,
    "LtextD": decimal,
    "LFunction": FunctionType,
    "Lcleanup": kernel.cleanup,
    "Llist_from": list_from,
    "Lunsupplied": UNSUPPLIED,
    "Lcatch": catch,
    "Lthrow": throw,
    "Lprogv": progv,
    "Lvalue_list": value_list,
    "Lunbound": UNBOUND,
    "Lchecked": checked,
    "Lint": int,
    "Lbudget": budget,
    "Lnext_method_exists": next_method_exists,
    "Lmaker": maker,
    "Lvalues_calls": values_calls,
    "Lbeside": beside,
    "Lfirst_of": first_of,
    "Lnamed_slot": named_slot,
    "Lkey_parser": key_parser,
    "Lkeyword_calls": keyword_calls,
    "Lintern": intern,
    "Lgensym": Symbol,
    "Llist": lisp_list,
    "Ldotted": dotted,
    "Lsingle": SingleFloat,
    "Lnew_single": new_single,
    "Lin_single": in_single,
    "Lrounded": rounded,
    "Labs": abs,
    "Latan2": math.atan2,
    "Lceil": math.ceil,
    "Lfloor": math.floor,
    "Lround": round,
    "Lvector": list,
    "Leach": each,
    "Leach_of_all": each_of_all,
    "Leach_entry": each_entry,
    "Lremoved": REMOVED,
    "Lkeep": list.append,
    "Lsame_kind": same_kind,
    "Lany_vector": Vector,
    **{f"L{name}": getattr(math, name) for name in "sin cos tan atan exp sqrt log asin acos".split()},
    "Lwrapped": wrapped,
    "Lunwrapped": unwrapped,
    "Lratio": Fraction,
    "Lcomplex": complex_,
    "Lhash_table": HashTable,
    "Lgethash": value_in_table,
    "Lgethash_values": value_and_presence,
    "Ldivmod": divmod,
    "Llen": len,
    "Lcharacter": Character,
    "Larray": SimpleArray,
    "Lkind_string": KindString,
    "Lpathname": lambda *parts: pathname_of_parts(logical_host, *parts),
    "Lpackage": find_package_or_error,
    "Levaluate": lambda form: one(PORTS.user.evaluate(form)),
    "Ltyped_vector": TypedVector,
    "Lfloat": float,
    "Lcomma": Comma,
    "Ladd2": arithmetic.add2,
    "Lsub2": arithmetic.sub2,
    "Lmul2": arithmetic.mul2,
    "Ldiv2": arithmetic.div2,
    "Llt2": arithmetic.lt2,
    "Lgt2": arithmetic.gt2,
    "Lle2": arithmetic.le2,
    "Lge2": arithmetic.ge2,
    "Lnum_eq2": arithmetic.num_eq2,
}

__all__ = ["NAMESPACE", "Bindings", "Cons", "Keyword", "printed"]
