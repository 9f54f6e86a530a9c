"""What ``#`` begins: ``#'f``, ``#\\a``, ``#(1 2)``, ``#+feature``, ``#1=`` and the rest of ANSI 2.4.8.

Each function gets the stream, the sub-character and the number written between ``#`` and it, or ``None``. Structures, arrays
and path names are made by the rooms that own them. Labels (``#1=``) are in ``shared_structure.py``.
"""

from __future__ import annotations

import os
import re
import sys
from fractions import Fraction

from cramhy_runtime.kernel.late_patterns import late_pattern
from ..collections.characters import name_char
from ..collections.sequence_types import elements
from ..collections.strings import string
from ..collections.arrays import CONSTANTS
from cramhy_runtime.lisp_core.arrays import Vector, bit_vector
from cramhy_runtime.lisp_core.python_exceptions import condition_for
from cramhy_runtime.lisp_core.conditions import Condition, Error, style_warn
from cramhy_runtime.lisp_core.data import NO_VALUES, Character, Cons, LispString, Symbol, list_from, one, truth
from cramhy_runtime.lisp_core.dynamic import binding, special
from cramhy_runtime.lisp_core.ports import PORTS
from ..numbers.arithmetic import is_real
from ..numbers.random_state import restored_state
from ..objects.structures import structure_named
from cramhy_runtime.storage.dependency_tracing import watched
from cramhy_runtime.lisp_core.packages import KEYWORD, is_symbol, keyword, near_names, sym, symbol_name
from . import tokens
from ..syntax.backquote import COMMA, COMMA_KINDS, Comma
from .reader_errors import fail, place
from .readtables import READTABLE, call
from .shared_structure import sharp_equal, sharp_sharp
from .text_reader import PACKAGE, RADIXES, SUPPRESS, as_reader, read_list, sharp_quote

READ_EVAL = special("*READ-EVAL*", True)
FEATURES = special(
    "*FEATURES*",
    list_from(
        [
            keyword(name)
            for name in (
                "CRAMHY",
                "ANSI-CL",
                "COMMON-LISP",
                "IEEE-FLOATING-POINT",
                "UNICODE",
                *(["UNIX"] if os.name == "posix" else []),
                "WINDOWS" if sys.platform == "win32" else sys.platform.upper(),
                f"{sys.byteorder.upper()}-ENDIAN",
                "64-BIT" if sys.maxsize > 2**32 else "32-BIT",
            )
        ]
    ),
)

IMPLIED_FEATURES = {"SBCL": ("SBCL", "SB-THREAD", "SB-UNICODE")}
"""What a feature brings along: a program that asks for SBCL asks for what every SBCL of today has, too."""


def add_features(names):
    """Add features to ``*features*``: ``names`` are their names in upper case, such as "SBCL"."""
    FEATURES.value = with_features(names)


def with_features(names):
    """The value of ``*features*`` with these features and what they bring along."""
    present = list(FEATURES.value or ())
    wanted = [keyword(each) for name in names for each in IMPLIED_FEATURES.get(name, (name,))]
    return list_from([*(feature for feature in dict.fromkeys(wanted) if feature not in present), *present])


_MAX_ARGUMENT = 1 << 24
"""No array that is read has more elements: a larger number is a mistake and would only eat memory."""


def dispatch(table, stream, character):
    """Read the number and the sub-character and call the function for them."""
    reader = as_reader(stream)
    start = reader.offset - 1
    digits = ""
    while (char := reader.read_char()) and char in "0123456789":
        digits += char
    if not char:
        return reader.ended("inside dispatch character")
    function = table.functions.get(char.upper())
    if function is None:
        if _suppressed() and char not in "<) \t\n\f\r":
            _constituents(reader)
            return None
        if char in "<) \t\n\f\r":
            hint = "What prints as #<...> cannot be read back." if char == "<" else None
            return fail(reader, start, "illegal sharp macro character: ~S", Character(char), hint=hint)
        return fail(
            reader,
            start,
            "no dispatch function defined for ~S",
            Character(char),
            hint=f"{character.char}{char} has no meaning in Common Lisp.",
        )
    argument = tokens.integer(digits) if digits else None
    reader.describe_frame(character.char + digits + char, start)
    return call(function, reader, Character(char), argument)


def _needs_small(reader, sub, argument):
    """Signal that an array would have more elements than there is memory for."""
    if argument is not None and argument > _MAX_ARGUMENT:
        fail(reader, _start(reader), "The number after # is too large: ~D", argument)


def _start(reader):
    return reader.frame_start()


def _suppressed():
    return SUPPRESS.value is not None


def _ignore_argument(sub, argument):
    if argument is not None and not _suppressed():
        style_warn("A numeric argument was ignored in #~D~A.", argument, sub.char)


# ------------------------------------------------------------------------------------------------- functions, data, comments


def sharp_backslash(stream, sub, argument):
    """``#\\a``: a character, by itself or by name."""
    reader = as_reader(stream)
    start = _start(reader)
    _ignore_argument(sub, argument)
    first = reader.read_char()
    if not first:
        return reader.ended("after escape")
    name = first + _constituents(reader)
    if _suppressed():
        return None
    if len(name) == 1:
        return Character(name)
    found = _named_character(name)
    if found is None:
        return fail(reader, start, "unrecognized character name: ~S", name, hint=_character_hint(name))
    return found


def _constituents(reader):
    """The characters up to the end of the token; a single escape is left out and its character taken."""
    table, taken = READTABLE.value, []
    while (char := reader.peek_char()) and not table.terminates(char):
        reader.read_char()
        if char in table.single_escapes:
            char = reader.read_char() or reader.ended("after escape")
        taken.append(char)
    return "".join(taken)


def _named_character(name):
    found = name_char(name)
    if found is not None:
        return found
    code = re.fullmatch(r"[uUxX]\+?([0-9a-fA-F]{1,6})", name)
    if code and int(code[1], 16) < 0x110000:
        return Character(chr(int(code[1], 16)))
    return None


def _character_hint(name):
    near = near_names(name.title(), ["Space", "Newline", "Tab", "Return", "Page", "Backspace", "Rubout", "Linefeed", "Nul"], 1)
    if near:
        return f"Did you mean #\\{near[0]}?"
    return f"A single character is written #\\{name[0]}; a string is written in double quotes."


def sharp_left_paren(stream, sub, argument):
    """``#(a b)``: a vector; ``#5(a b)`` has five elements, the last one repeated."""
    reader = as_reader(stream)
    start = _start(reader)
    contents = _list_after(reader)
    if _suppressed():
        return None
    items = _proper(contents)
    if items is None:
        return fail(reader, start, "Improper list in #(): ~S.", contents)
    _needs_small(reader, sub, argument)
    if argument is not None:
        if len(items) > argument:
            return fail(reader, start, "Vector longer than the specified length: #~D~S.", argument, contents)
        if argument and not items:
            return fail(reader, start, "Vector of length ~D can't be initialized from ()", argument)
        items += items[-1:] * (argument - len(items))
    return items


def _list_after(reader):
    return read_list(reader, Character("("))


def _proper(lst):
    """The elements of a proper list, or ``None`` of anything else."""
    items = []
    while isinstance(lst, Cons):
        items.append(lst.car)
        lst = lst.cdr
    return items if lst is None else None


def sharp_star(stream, sub, argument):
    """``#*101``: a bit vector."""
    reader = as_reader(stream)
    start = _start(reader)
    digits = _constituents(reader)
    if _suppressed():
        return None
    for digit in digits:
        if digit not in "01":
            return fail(reader, start, "illegal element given for bit-vector: ~S", Character(digit), hint="Its elements are 0 and 1.")
    _needs_small(reader, sub, argument)
    if argument is not None:
        if len(digits) > argument:
            return fail(reader, start, "Too many bits in ~S: expected ~D or fewer", digits, argument)
        if argument and not digits:
            return fail(reader, start, "#~D* requires at least 1 bit of input.", argument)
        digits += digits[-1:] * (argument - len(digits))
    return bit_vector([int(digit) for digit in digits])


def sharp_bar(stream, sub, argument):
    """``#| ... |#``: a comment, which may contain others."""
    reader = as_reader(stream)
    reader.describe_frame("#|")
    _ignore_argument(sub, argument)
    depth, index = 1, reader.offset
    while depth:
        match = _COMMENT_EDGE.search(reader.text, index)
        if match is None:
            index = max(index, len(reader.text) - 1)
            if not reader.grow():
                reader.offset = len(reader.text)
                return reader.ended()
            continue
        depth += 1 if match[0] == "#|" else -1
        index = match.end()
    reader.offset = index
    return NO_VALUES


_COMMENT_EDGE = late_pattern(r"#\||\|#")


# ---------------------------------------------------------------------------------------------------------- numbers, symbols


def _radix_reader(fixed):
    def function(stream, sub, argument):
        """``#b101 #o17 #xFF #36rZZ``: a rational number in a radix."""
        reader = as_reader(stream)
        start = _start(reader)
        base = fixed or argument
        if fixed:
            _ignore_argument(sub, argument)
        token_start = reader.offset
        token = _constituents(reader)
        apart = not token and (reader.peek_char() or "x") in READTABLE.value.whitespace
        if _suppressed():
            return None
        if base is None:
            return fail(reader, start, "radix missing in #R", hint="Base 3 is written #3r120.")
        if not 2 <= base <= 36:
            return fail(reader, start, "illegal radix for #R: ~D.", base, hint="A radix is between 2 and 36.")
        if not token and not reader.peek_char():
            return reader.ended()
        if apart or token.startswith("#"):  # #x#b101, #x 10: what is read counts, as long as it is rational
            reader.offset = token_start
            with binding(tokens.READ_BASE, base):
                inner = reader.required()
            if isinstance(inner, (int, Fraction)):
                return inner
            return fail(reader, start, "#~A (base ~D.) value is not a rational: ~S.", sub.char, base, inner)
        try:
            number = tokens.rational(token, base) if "\\" not in reader.text[token_start : reader.offset] else None
            if number is None and token.endswith("."):
                number = tokens.number(token)
        except tokens.NumberError as problem:
            return fail(reader, start, str(problem), hint=problem.hint)
        if number is None:
            return fail(
                reader,
                start,
                "#~A (base ~D.) value is not a rational: ~A.",
                sub.char,
                base,
                token.upper(),
                hint=f"The digits of base {base} are 0 to {tokens.DIGITS[base - 1].upper()}.",
            )
        return number

    if fixed:
        RADIXES[function] = fixed
    return function


def sharp_c(stream, sub, argument):
    """``#c(1 2)``: a complex number."""
    reader = as_reader(stream)
    start = _start(reader)
    _ignore_argument(sub, argument)
    parts = reader.required()
    if _suppressed():
        return None
    items = _proper(parts)
    if not items or len(items) != 2 or not all(map(is_real, items)):
        return fail(reader, start, "illegal complex number format: #C~S", parts, hint="It is written #c(real imaginary).")
    return _call(reader, start, sym("COMPLEX"), *items)


def sharp_colon(stream, sub, argument):
    """``#:name``: a new symbol without a package."""
    reader = as_reader(stream)
    start = _start(reader)
    _ignore_argument(sub, argument)
    parts, escaped, word = reader.token_parts()
    if _suppressed():
        return None
    if len(parts) > 1:
        return fail(reader, start, "The symbol following #: contains a package marker: ~S", word.upper())
    if not escaped and tokens.looks_numeric(parts[0]):
        return fail(reader, start, "The symbol following #: has numeric syntax: ~S", word)
    return Symbol(parts[0])


# ---------------------------------------------------------------------------------------------------- evaluation and features


def sharp_dot(stream, sub, argument):
    """``#.form``: the value of ``form``, computed while reading."""
    reader = as_reader(stream)
    start = _start(reader)
    _ignore_argument(sub, argument)
    backquotes, reader.backquotes = reader.backquotes, 0
    form = reader.required()
    reader.backquotes = backquotes
    if _suppressed():
        return None
    if not truth(READ_EVAL.value):
        return fail(reader, start, "can't read #. while *READ-EVAL* is NIL", hint="Evaluation while reading has been switched off.")
    try:
        with watched():
            return one(PORTS.user.evaluate(form))
    except RecursionError as problem:
        condition = condition_for(problem)
    except Condition as problem:
        if getattr(problem, "position", None) is not None:
            raise
        condition = problem
    raise place(condition, reader, start)


def sharp_plus(stream, sub, argument):
    """``#+feature form``: ``form`` only where the feature expression is true."""
    return _conditional(as_reader(stream), sub, argument, True)


def sharp_minus(stream, sub, argument):
    """``#-feature form``: ``form`` only where the feature expression is false."""
    return _conditional(as_reader(stream), sub, argument, False)


def _conditional(reader, sub, argument, wanted):
    start = _start(reader)
    _ignore_argument(sub, argument)
    package, suppress = PACKAGE.value, SUPPRESS.value
    PACKAGE.value, SUPPRESS.value = KEYWORD, None
    try:
        expression = reader.required()
    finally:
        PACKAGE.value, SUPPRESS.value = package, suppress
    if feature(expression, reader, start) is wanted:
        return reader.required()
    SUPPRESS.value = True
    try:
        reader.required()
    finally:
        SUPPRESS.value = suppress
    return NO_VALUES


def feature(expression, reader, start):
    """Whether the feature expression holds: a feature, or ``(and ...)``, ``(or ...)``, ``(not x)`` of such."""
    if is_symbol(expression):
        return any(present is expression for present in FEATURES.value or ())
    items = _proper(expression) if isinstance(expression, Cons) else None
    if items and is_symbol(items[0]):
        operator, operands = symbol_name(items[0]), items[1:]
        if operator == "AND":
            return all(feature(operand, reader, start) for operand in operands)
        if operator == "OR":
            return any(feature(operand, reader, start) for operand in operands)
        if operator == "NOT" and len(operands) == 1:
            return not feature(operands[0], reader, start)
        return fail(
            reader,
            start,
            "unknown operator in feature expression: ~S.",
            expression,
            hint="Feature expressions are made with and, or and not.",
        )
    return fail(reader, start, "invalid feature expression: ~S", expression, hint="A feature is a symbol, such as :sbcl.")


# ------------------------------------------------------------------------------------------- arrays, structures, path names


def sharp_a(stream, sub, argument):
    """``#2A((1 2) (3 4))``: an array of the given rank."""
    reader = as_reader(stream)
    start = _start(reader)
    contents = reader.required()
    if _suppressed():
        return None
    if argument is None and isinstance(contents, Cons) and isinstance(contents.cdr, Cons):  # SBCL's #A(dimensions type . contents)
        return _array(reader, start, contents.car, contents.cdr.cdr, contents.cdr.car)
    if argument is None:
        return fail(
            reader,
            start,
            "Array literal is neither of the standard form #<rank>A<contents> nor the "
            "SBCL-specific form #A(dimensions element-type . contents).",
            hint="A matrix is written #2A((1 2) (3 4)).",
        )
    if argument >= CONSTANTS["ARRAY-RANK-LIMIT"]:
        return fail(reader, start, "The rank ~D is too large.", argument)
    dimensions, level = [], contents
    for axis in range(argument):
        items = _sequence_items(level)
        if items is None:
            return fail(reader, start, "#~DA axis ~D is not a sequence:~%  ~S", argument, axis, level)
        dimensions.append(len(items))
        level = items[0] if items else None
    return _array(reader, start, list_from(dimensions), contents)


def _array(reader, start, dimensions, contents, element_type=True):
    if _has_comma(contents, sum(1 for _ in dimensions or ())):
        return fail(reader, start, "A comma in an array that is not a vector.", hint="Make such an array by a call of make-array.")
    options = keyword("ELEMENT-TYPE"), element_type, keyword("INITIAL-CONTENTS"), contents
    return _call(reader, start, sym("MAKE-ARRAY"), dimensions, *options)


def _has_comma(contents, rank):
    """Whether an element of the array is a form of a backquote; ``contents`` are nested as deeply as ``rank`` says."""
    if rank == 0:
        return contents.__class__ is Comma
    return any(_has_comma(item, rank - 1) for item in _sequence_items(contents) or ())


def _sequence_items(obj):
    if obj is None or isinstance(obj, Cons):
        return _proper(obj)
    return elements(obj) if isinstance(obj, (str, LispString, list, Vector)) else None


def sharp_s(stream, sub, argument):
    """``#s(point :x 1)``: a structure, made by its keyword constructor."""
    reader = as_reader(stream)
    start = _start(reader)
    _ignore_argument(sub, argument)
    if not reader.peek_char() and not _suppressed():
        return reader.ended()
    if reader.peek_char() != "(":
        return None if _suppressed() else fail(reader, start, "non-list following #S", hint="It is written #s(type :slot value).")
    reader.read_char()
    body = _list_after(reader)
    if _suppressed():
        return None
    items = _proper(body)
    if items is None:
        return fail(reader, start, "improper list for #S: ~S.", body)
    if items and not is_symbol(items[0]):
        return fail(reader, start, "Structure type is not a symbol: ~S", items[0])
    if items and len(items) % 2 == 0:
        return fail(
            reader,
            start,
            "the arglist for the ~S constructor in #S has an odd length: ~S.",
            items[0],
            body.cdr,
            hint="Each slot name needs a value.",
        )
    if items and items[0] is COMMA and len(items) == 5 and items[4] in (0, 1, 2):
        return Comma(COMMA_KINDS[items[4]], items[2])
    name = items[0] if items else None
    construct = restored_state if name is sym("RANDOM-STATE") else getattr(structure_named(name), "construct", None)
    if construct is None:
        return fail(reader, start, "~S is not a defined structure type.", name)
    arguments = [_slot_keyword(item) if index % 2 == 0 else item for index, item in enumerate(items[1:])]
    return _guarded(reader, start, construct, *arguments)


def _slot_keyword(designator):
    """The keyword for a slot that a symbol, a string or a character names."""
    if is_symbol(designator):
        return KEYWORD.intern(symbol_name(designator))
    return KEYWORD.intern(str(string(designator))) if isinstance(designator, (str, LispString, Character)) else designator


def sharp_p(stream, sub, argument):
    """``#p"name"``: a path name."""
    reader = as_reader(stream)
    start = _start(reader)
    _ignore_argument(sub, argument)
    name = reader.required()
    if _suppressed():
        return None
    return _call(reader, start, sym("PARSE-NAMESTRING"), name)


def _call(reader, start, symbol, *arguments):
    return _guarded(reader, start, symbol.function, *arguments)


def _guarded(reader, start, function, *arguments):
    """Call a constructor; what it objects to is a reader error at this place of the text."""
    try:
        return one(function(*arguments))
    except Error as problem:
        return fail(reader, start, "~A", problem.report())


STANDARD_FUNCTIONS = {
    "'": sharp_quote,
    "\\": sharp_backslash,
    "(": sharp_left_paren,
    "*": sharp_star,
    "|": sharp_bar,
    ":": sharp_colon,
    ".": sharp_dot,
    "+": sharp_plus,
    "-": sharp_minus,
    "=": sharp_equal,
    "#": sharp_sharp,
    "A": sharp_a,
    "S": sharp_s,
    "P": sharp_p,
    "C": sharp_c,
    "B": _radix_reader(2),
    "O": _radix_reader(8),
    "X": _radix_reader(16),
    "R": _radix_reader(None),
}
