"""Strings: comparison, case, trimming, characters by index.

A string is a Python ``str``: a plain one where it is a literal, a `FreshString` where a function has made it, into which a program
may store. `LispString` stands for one whose length may change (fill pointers). Where a function takes a string it also takes a
symbol or a character, whose name or self is meant.

Law: results are fresh, except those of functions named destructive, which return their argument. Source: ANSI chapter 16; texts are SBCL's.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import SimpleTypeError
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import CHARACTERS, TEXTS, UNSUPPLIED, WRITABLE_STRINGS, Character, FreshString, KindString, LispString
from cramhy_runtime.lisp_core.equality import folded
from cramhy_runtime.lisp_core.packages import is_symbol, symbol_name
from cramhy_runtime.lisp_core.heap import check_room
from cramhy_runtime.lisp_core.arrays import BASE_CHAR
from .arrays import InvalidArrayIndex
from .element_types import check_element, upgraded_element_type
from .characters import downcased, is_alphanumeric, upcased
from .sequence_types import DIMENSION_LIMIT, INDEX_TYPE, bounds, constant_changed, elements, in_turns

LISP_NAMES = """
string string= string/= string< string> string<= string>= string-equal string-not-equal string-lessp string-greaterp
string-not-greaterp string-not-lessp string-upcase string-downcase string-capitalize nstring-upcase nstring-downcase
nstring-capitalize string-trim string-left-trim string-right-trim make-string char schar stringp simple-string-p
"""


def stringp(thing):
    """``stringp``: whether ``thing`` is a string."""
    return True if isinstance(thing, (str, LispString)) else None


def simple_string_p(thing):
    """``simple-string-p``: whether ``thing`` is a string without fill pointer that is not adjustable."""
    if isinstance(thing, LispString):
        return True if thing.fill_pointer is None and not thing.adjustable else None
    return True if isinstance(thing, str) else None


def string(designator):
    """``string``: the string that a string, symbol or character stands for."""
    if isinstance(designator, (str, LispString)):
        return designator
    if designator.__class__ is Character:
        return FreshString(designator.char)
    if is_symbol(designator):
        return symbol_name(designator)
    return error(
        SimpleTypeError("~S is not a string designator.", designator, datum=designator, expected_type="(OR STRING SYMBOL CHARACTER)")
    )


def _text(designator, context=None):
    # The Python string of a string designator.
    if designator.__class__ is str or designator.__class__ is FreshString:
        return designator
    if context is not None and not isinstance(designator, (str, LispString, Character)) and not is_symbol(designator):
        return type_error(designator, "(OR STRING SYMBOL CHARACTER)", context)
    return str(string(designator))


def make_string(size, *, initial_element=UNSUPPLIED, element_type=None):
    """``make-string``: a string of ``size`` characters that can be changed in place."""
    if size.__class__ is not int or not 0 <= size < DIMENSION_LIMIT:
        type_error(size, INDEX_TYPE, "\nwhen binding COUNT")
    check_room(size, 1)
    if initial_element is UNSUPPLIED:
        made = FreshString("\0" * size)
    elif initial_element.__class__ is not Character:
        return type_error(initial_element, "CHARACTER")
    else:
        made = FreshString(initial_element.char * size)
    if element_type is not None and upgraded_element_type(element_type) is BASE_CHAR:
        if initial_element is not UNSUPPLIED:
            check_element(initial_element, BASE_CHAR)
        return KindString(made, BASE_CHAR)
    return made


# ---------------------------------------------------------------------------------------------------------- single characters


def _at(string_, index):
    # What holds character number ``index``, which is looked at: the string itself, or all characters of one with a fill pointer.
    if not isinstance(string_, (str, LispString)):
        type_error(string_, "STRING", "\nwhen binding STRING")
    if index.__class__ is not int or index < 0:
        type_error(index, INDEX_TYPE, "\nwhen binding SB-INT:INDEX")
    chars = string_.chars if string_.__class__ is LispString else string_
    if index >= len(chars):
        error(InvalidArrayIndex(index, string_, None, len(chars)))
    return chars


def char(string, index):
    """``char``: character number ``index``."""
    if string.__class__ in TEXTS and index.__class__ is int and 0 <= index < len(string):
        return CHARACTERS[string[index]]
    return Character(_at(string, index)[index])


def set_char(value, string, index):
    """``(setf char)``: only of a string that can be changed; a constant string is an error that tells the way out."""
    _at(string, index)
    if value.__class__ is not Character:
        type_error(value, "CHARACTER", "\nwhen binding SB-IMPL::NEW-EL")
    if string.__class__ not in WRITABLE_STRINGS:
        constant_changed(string)
    string.writable()[index] = value.char
    return value


schar, set_schar = char, set_char


# ----------------------------------------------------------------------------------------------------------------- comparison


def _parts(string1, string2, start1, end1, start2, end2):
    if string1.__class__ in TEXTS and string2.__class__ in TEXTS and start1 == start2 == 0 and end1 is None is end2:
        return string1, string2, 0
    first = _text(string1, "\nwhen binding SB-IMPL::STRING1")
    second = _text(string2, "\nwhen binding SB-IMPL::STRING2")
    if start1 == 0 and end1 is None and start2 == 0 and end2 is None:
        return first, second, 0
    start1, end1 = bounds(start1, end1, len(first))
    start2, end2 = bounds(start2, end2, len(second))
    return first[start1:end1], second[start2:end2], start1


def _fold(text):
    return text.lower() if text.isascii() else "".join(map(folded, text))


def _equality(name, fold, wanted):
    def compared(string1, string2, *, start1=0, end1=None, start2=0, end2=None):
        if not fold and wanted and string1.__class__ in TEXTS and string2.__class__ in TEXTS and start1 == start2 == 0:
            if end1 is None is end2:  # as it mostly is: then no other function is needed
                return True if string1 == string2 else None
        first, second, offset = _parts(string1, string2, start1, end1, start2, end2)
        if fold:
            first, second = _fold(first), _fold(second)
        if wanted:
            return True if first == second else None
        return None if first == second else offset + _common(first, second)

    return _named(compared, name, "whether the strings are equal" if wanted else "the index of the first difference, or nil")


def _order(name, fold, before, equal_too):
    """A function that gives the index of the first difference if the strings are in the order, else nil."""

    def compared(string1, string2, *, start1=0, end1=None, start2=0, end2=None):
        first, second, offset = _parts(string1, string2, start1, end1, start2, end2)
        if fold:
            first, second = _fold(first), _fold(second)
        if first == second:
            return offset + len(first) if equal_too else None
        return offset + _common(first, second) if (first < second) is before else None

    return _named(compared, name, "the index of the first difference if the strings are in this order, or nil")


def _common(first, second):
    for index, (x, y) in enumerate(zip(first, second)):
        if x != y:
            return index
    return min(len(first), len(second))


def _named(function, name, what):
    function.__name__ = function.__qualname__ = name
    function.__doc__ = f"``{name}``: {what}."
    return function


string_eq = _equality("string_eq", False, True)
string_ne = _equality("string_ne", False, False)
string_equal = _equality("string_equal", True, True)
string_not_equal = _equality("string_not_equal", True, False)
string_lt = _order("string_lt", False, True, False)
string_gt = _order("string_gt", False, False, False)
string_le = _order("string_le", False, True, True)
string_ge = _order("string_ge", False, False, True)
string_lessp = _order("string_lessp", True, True, False)
string_greaterp = _order("string_greaterp", True, False, False)
string_not_greaterp = _order("string_not_greaterp", True, True, True)
string_not_lessp = _order("string_not_lessp", True, False, True)


# ----------------------------------------------------------------------------------------------------------------------- case


def _upper(text):
    return text.upper() if text.isascii() else "".join(map(upcased, in_turns(text)))


def _lower(text):
    return text.lower() if text.isascii() else "".join(map(downcased, in_turns(text)))


def _capital(text):
    result, inside = [], False
    for one in in_turns(text):
        word = is_alphanumeric(one)
        result.append((downcased(one) if inside else upcased(one)) if word else one)
        inside = word
    return "".join(result)


def _changed(text, start, end, change):
    if start == 0 and end is None and start.__class__ is int:
        return change(text)
    start, end = bounds(start, end, len(text))
    return text[:start] + change(text[start:end]) + text[end:]


def string_upcase(string, *, start=0, end=None):
    """``string-upcase``: the string in uppercase."""
    return FreshString(_changed(_text(string), start, end, _upper))


def string_downcase(string, *, start=0, end=None):
    """``string-downcase``: the string in lowercase."""
    return FreshString(_changed(_text(string), start, end, _lower))


def string_capitalize(string, *, start=0, end=None):
    """``string-capitalize``: every word with a capital and the rest in lowercase; words are letters and digits."""
    return FreshString(_changed(_text(string, ""), start, end, _capital))


def _in_place(string_, start, end, change):
    if not isinstance(string_, (str, LispString)):
        type_error(string_, "STRING", "\nwhen binding STRING")
    changed = _changed(str(string_), start, end, change)
    if string_.__class__ not in WRITABLE_STRINGS:
        return FreshString(changed)
    string_.writable()[: len(changed)] = changed
    return string_


def nstring_upcase(string, *, start=0, end=None):
    """``nstring-upcase``: as `string_upcase`, in place where the string can be changed."""
    return _in_place(string, start, end, _upper)


def nstring_downcase(string, *, start=0, end=None):
    """``nstring-downcase``: as `string_downcase`, in place where the string can be changed."""
    return _in_place(string, start, end, _lower)


def nstring_capitalize(string, *, start=0, end=None):
    """``nstring-capitalize``: as `string_capitalize`, in place where the string can be changed."""
    return _in_place(string, start, end, _capital)


# ------------------------------------------------------------------------------------------------------------------- trimming


def _bag(characters, text):
    """The characters to be trimmed from ``text`` as a string; they are looked at only when there is a text."""
    if isinstance(characters, (str, LispString)):
        return str(characters)
    bag = elements(characters, "\nwhen binding SB-IMPL::CHAR-BAG")
    return "".join(one.char if one.__class__ is Character else type_error(one, "CHARACTER") for one in bag) if text else ""


def string_trim(characters, string):
    """``string-trim``: the string without the given characters at both ends."""
    text = _text(string, "")
    bag = _bag(characters, text)
    return FreshString(text.strip(bag) if bag else text)


def string_left_trim(characters, string):
    """``string-left-trim``: the string without the given characters at its beginning."""
    text = _text(string, "")
    bag = _bag(characters, text)
    return FreshString(text.lstrip(bag) if bag else text)


def string_right_trim(characters, string):
    """``string-right-trim``: the string without the given characters at its end."""
    text = _text(string, "")
    bag = _bag(characters, text)
    return FreshString(text.rstrip(bag) if bag else text)


SETTERS = {"CHAR": set_char, "SCHAR": set_schar}
