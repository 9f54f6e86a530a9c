"""UIOP's functions of lists, texts, functions, times, versions and conditions (UIOP's manual, "Utilities" and "Version")."""

from __future__ import annotations

import functools

from cramhy_runtime.lisp_core.condition_types import Condition, Error, SeriousCondition, SimpleCondition
from cramhy_runtime.lisp_core.conditions import error, style_warn as signal_style_warning, warn
from cramhy_runtime.lisp_core.data import Cons, FreshString, Keyword, LispString, MultipleValues, boolean, list_from, one, truth
from cramhy_runtime.lisp_core.functions import function_of, key_of
from cramhy_runtime.lisp_core.hash_tables import gethash, make_hash_table, set_gethash
from cramhy_runtime.lisp_core.packages import find_package_or_error, is_symbol, string_designator, sym
from cramhy_runtime.kernel.typing_names import Any

from ..collections.list_search import getf
from ..collections.sequences import elt
from ..evaluation.evaluator import evaluate
from ..objects.classes import find_class
from ..reader.reader_functions import read_from_string
from ..types.types import typep

FUNCTIONS = """remove-plist-key remove-plist-keys first-char last-char reduce/strcat string-enclosed-p stripln frob-substrings
    ensure-function call-function call-functions access-at access-at-count ensure-gethash list-to-hash-set earlier-timestamp
    earliest-timestamp later-timestamp latest-timestamp timestamps-earliest timestamps-latest parse-version unparse-version next-version
    version-compatible-p parameter-error not-implemented-error style-warn match-condition-p match-any-condition-p fatal-condition-p
    parse-body coerce-class standard-eval-thunk eval-thunk"""
TEXT = (str, LispString)


class ParameterError(SimpleCondition, Error):
    lisp_name = "UIOP::PARAMETER-ERROR"


class NotImplementedHere(SimpleCondition, Error):
    lisp_name = "UIOP::NOT-IMPLEMENTED-ERROR"


# -------------------------------------------------------------------------------------------------------- lists and texts


def remove_plist_keys(keys: Any, plist: Any) -> Any:
    """``uiop:remove-plist-keys``: the property list without these keys and their values."""
    items, unwanted = list(plist or ()), list(keys or ())
    return list_from([item for key, value in zip(items[::2], items[1::2]) if key not in unwanted for item in (key, value)])


def remove_plist_key(key: Any, plist: Any) -> Any:
    """``uiop:remove-plist-key``: the property list without this key and its value."""
    return remove_plist_keys([key], plist)


def length_is(lst: Any, number: int) -> bool | None:
    """``uiop:length=n-p``: whether the list has so many elements."""
    return boolean(len(list(lst or ())) == number)


def first_char(string: Any) -> Any:
    """``uiop:first-char``: the first character of a string, nil of an empty one and of what is no string."""
    return elt(string, 0) if typep(string, sym("STRING")) and len(string) else None


def last_char(string: Any) -> Any:
    """``uiop:last-char``: the last character of a string, nil of an empty one and of what is no string."""
    return elt(string, len(string) - 1) if typep(string, sym("STRING")) and len(string) else None


def text_of(thing: Any) -> str:
    """The text of a string or character; nil has none."""
    return "" if thing is None else str(getattr(thing, "char", thing))


def reduce_strcat(strings: Any, *, key: Any = None, start: int = 0, end: Any = None) -> str:
    """``uiop:reduce/strcat``: the strings and characters of a list, of which ``key`` makes the text, one after the other."""
    return FreshString("".join(text_of(item if key is None else one(key_of(key)(item))) for item in list(strings or ())[start:end]))


def string_enclosed_p(prefix: Any, string: Any, suffix: Any) -> bool | None:
    """``uiop:string-enclosed-p``: whether the string begins and ends so."""
    text = string_designator(string)
    return boolean(text.startswith(text_of(prefix)) and text.endswith(text_of(suffix)))


def stripln(text: Any) -> MultipleValues:
    """``uiop:stripln``: two values, the text without the end of line at its end, and that end of line or nil."""
    given = str(text)
    ending = next((ending for ending in ("\r\n", "\n", "\r") if given.endswith(ending)), None)
    return MultipleValues((given if ending is None else FreshString(given[: -len(ending)]), ending))


def frob_substrings(string: Any, substrings: Any, frob: Any = None) -> str:
    """``uiop:frob-substrings``: the string with a text, or what ``frob(substring, write)`` writes, for each of the substrings."""
    text = str(string)
    for each in list(substrings or ()):
        parts, rest = [], text
        while (place := rest.find(str(each))) >= 0:
            parts.append(rest[:place])
            if frob is not None and not isinstance(frob, TEXT):
                function_of(frob)(each, lambda piece: parts.append(text_of(piece)))
            else:
                parts.append(frob or "")
            rest = rest[place + len(str(each)) :]
        text = "".join([*parts, rest])
    return FreshString(text)


# -------------------------------------------------------------------------------------------------------------- functions


def ensure_function(fun: Any, *, package: Any = "CL") -> Any:
    """``uiop:ensure-function``: a function, from a function or its name, an index or key to look up, a lambda expression or a text."""
    if isinstance(fun, (bool, int, Keyword)) or fun is None or type(fun).__name__ == "Character":
        return lambda *arguments: fun
    if is_symbol(fun) or callable(fun):
        return function_of(fun)
    if isinstance(fun, Cons):
        if fun.car is sym("LAMBDA") or fun.car is sym("FUNCTION"):
            return evaluate(fun)
        inner, count = function_of(fun.car), list(fun.cdr or ())
        return functools.partial(inner, *count)
    return ensure_function(evaluate_text(f"(cl:function {fun})", package))


def evaluate_text(text: Any, package: Any = "CL") -> Any:
    """The value of the form that ``text`` is in ``package``."""
    from cramhy_runtime.lisp_core.dynamic import binding

    from ..evaluation.evaluator import PACKAGE

    with binding(PACKAGE, find_package_or_error(package)):
        return evaluate(one(read_from_string(str(text))))


def call_function(function_spec: Any, *arguments: Any) -> Any:
    """``uiop:call-function``: the values of what `ensure_function` makes of it, called with the arguments."""
    return ensure_function(function_spec)(*arguments)


def call_functions(function_specs: Any) -> None:
    """``uiop:call-functions``: call each of them, one after the other."""
    for each in list(function_specs or ()):
        call_function(each)


def standard_eval_thunk(thunk: Any, *, package: Any = "CL") -> Any:
    """``uiop:standard-eval-thunk``: the values of a function, of a form, or of the form in a text."""
    if thunk is None or isinstance(thunk, (int, float)):
        return thunk
    if isinstance(thunk, Cons) or is_symbol(thunk):
        return evaluate(thunk)
    return evaluate_text(thunk, package) if isinstance(thunk, TEXT) else function_of(thunk)()


eval_thunk = standard_eval_thunk


def access_at(object: Any, at: Any) -> Any:
    """``uiop:access-at``: the part of an object along a path: indices, keys of property lists, functions."""
    for step in [at] if not isinstance(at, Cons) else at:
        if isinstance(step, int):
            object = elt(object, step)
        elif isinstance(step, Keyword):
            object = getf(object, step)
        elif step is not None:
            object = one(call_function(step, object))
    return object


def access_at_count(at: Any) -> int | None:
    """``uiop:access-at-count``: how many elements must be there so that `access_at` finds what ``at`` says; nil if that is not known."""
    first = at.car if isinstance(at, Cons) else at
    return first + 1 if isinstance(first, int) else None


def ensure_gethash(key: Any, table: Any, default: Any = None) -> Any:
    """``uiop:ensure-gethash``: the value of the key; what ``default`` makes is entered without one. Second value: whether there was one."""
    value, found = gethash(key, table)
    if found is None:
        value = one(call_function(default))
        set_gethash(value, key, table)
    return MultipleValues((value, found))


def list_to_hash_set(elements: Any, table: Any = None) -> Any:
    """``uiop:list-to-hash-set``: a table (of EQUAL) in which each element has the value T."""
    table = make_hash_table(test=sym("EQUAL")) if table is None else table
    for each in list(elements or ()):
        set_gethash(True, each, table)
    return table


# --------------------------------------------------------------------------------------------------------- times, versions


def timestamp_less(first: Any, second: Any) -> bool | None:
    """``uiop:timestamp<``: whether a time is before another: T is before all, nil behind all."""
    if first is None or second is True:
        return None
    return boolean(first is True or second is None or first < second)


def timestamp_not_more(first: Any, second: Any) -> bool | None:
    """``uiop:timestamp<=``"""
    return boolean(timestamp_less(second, first) is None)


def timestamps_rise(times: Any) -> bool | None:
    """``uiop:timestamps<``: whether each time is before the next."""
    listed = list(times or ())
    return boolean(all(timestamp_less(*pair) for pair in zip(listed, listed[1:])))


def earlier_timestamp(first: Any, second: Any) -> Any:
    """``uiop:earlier-timestamp``"""
    return first if timestamp_less(first, second) else second


def later_timestamp(first: Any, second: Any) -> Any:
    """``uiop:later-timestamp``"""
    return second if timestamp_less(first, second) else first


def timestamps_earliest(times: Any) -> Any:
    """``uiop:timestamps-earliest``: nil of no times."""
    listed = list(times or ())
    return functools.reduce(earlier_timestamp, listed) if listed else None


def timestamps_latest(times: Any) -> Any:
    """``uiop:timestamps-latest``: T of no times."""
    listed = list(times or ())
    return functools.reduce(later_timestamp, listed) if listed else True


def earliest_timestamp(*times: Any) -> Any:
    """``uiop:earliest-timestamp``"""
    return timestamps_earliest(times)


def latest_timestamp(*times: Any) -> Any:
    """``uiop:latest-timestamp``"""
    return timestamps_latest(times)


def lexicographic_less(element_less: Any, first: Any, second: Any) -> bool | None:
    """``uiop:lexicographic<``: whether a list is before another, as words in a dictionary."""
    less, one_list, other = function_of(element_less), list(first or ()), list(second or ())
    for left, right in zip(one_list, other):
        if truth(one(less(left, right))):
            return True
        if truth(one(less(right, left))):
            return None
    return boolean(len(one_list) < len(other))


def lexicographic_not_more(element_less: Any, first: Any, second: Any) -> bool | None:
    """``uiop:lexicographic<=``"""
    return boolean(lexicographic_less(element_less, second, first) is None)


def numbers_of(version: Any) -> list[int] | None:
    """The numbers of a version such as "1.2"; ``None`` of anything else."""
    if not isinstance(version, TEXT):
        return None
    parts = version.split(".")
    return [int(part) for part in parts] if all(part.isascii() and part.isdigit() for part in parts) else None


def parse_version(version: Any, on_error: Any = None) -> Any:
    """``uiop:parse-version``: the list of a version's numbers; for anything else ``on_error`` is called, and it is nil."""
    numbers = numbers_of(version)
    if numbers is None:
        if on_error is not None:
            call_function(on_error, "~S is not a valid version string", version)
        return None
    return list_from(numbers)


def unparse_version(numbers: Any) -> str:
    """``uiop:unparse-version``: the text of a list of numbers."""
    return FreshString(".".join(map(str, numbers)))


def next_version(version: Any) -> Any:
    """``uiop:next-version``: the version whose last number is one more."""
    numbers = numbers_of(version)
    return None if numbers is None else unparse_version([*numbers[:-1], numbers[-1] + 1])


def version_compatible_p(provided: Any, required: Any) -> bool | None:
    """``uiop:version-compatible-p``: whether a version has the first number of another and is no earlier."""
    have, need = numbers_of(provided), numbers_of(required)
    return boolean(have is not None and need is not None and have[0] == need[0] and have >= need)


# -------------------------------------------------------------------------------------------------------------- conditions


def parameter_error(control: Any, function_name: Any, *arguments: Any) -> Any:
    """``uiop:parameter-error``: signal that a function got what it cannot take."""
    return error(ParameterError(control, function_name, *arguments))


def not_implemented_error(functionality: Any, control: Any = None, *arguments: Any) -> Any:
    """``uiop:not-implemented-error``: signal that something is not to be had here."""
    text = "Not (currently) implemented on cramhy: ~S" + ("" if control is None else "~%" + control)
    return error(NotImplementedHere(text, functionality, *arguments))


def style_warn(datum: Any, *arguments: Any) -> None:
    """``uiop:style-warn``: signal a style warning."""
    return signal_style_warning(datum, *arguments) if isinstance(datum, TEXT) else warn(datum, *arguments)


def match_condition_p(pattern: Any, condition: Any) -> bool | None:
    """``uiop:match-condition-p``: whether a condition is of a type, holds for a function, or has this control string."""
    if isinstance(pattern, TEXT):
        return boolean(getattr(condition, "format_control", None) == pattern)
    if callable(pattern):
        return boolean(truth(one(pattern(condition))))
    return boolean(truth(typep(condition, pattern)))


def match_any_condition_p(condition: Any, patterns: Any) -> bool | None:
    """``uiop:match-any-condition-p``: whether one of the patterns of `match_condition_p` fits."""
    return boolean(any(match_condition_p(pattern, condition) for pattern in patterns or ()))


def fatal_condition_p(condition: Any) -> bool | None:
    """``uiop:fatal-condition-p``: whether a script should end with it."""
    return boolean(isinstance(condition, Condition) and isinstance(condition, SeriousCondition))


def parse_body(body: Any, *, documentation: Any = None, whole: Any = None) -> MultipleValues:
    """``uiop:parse-body``: three values: the forms of a body, its declarations, its documentation or nil."""
    forms, declarations, text = list(body or ()), [], None
    while forms:
        if documentation is not None and text is None and isinstance(forms[0], TEXT) and forms[1:]:
            text = forms.pop(0)
        elif isinstance(forms[0], Cons) and forms[0].car is sym("DECLARE"):
            declarations.append(forms.pop(0))
        else:
            break
    return MultipleValues((list_from(forms), list_from(declarations), text))


def coerce_class(cls: Any, *, package: Any = "CL", super: Any = True, error: Any = None) -> Any:
    """``uiop:coerce-class``: the class of that name, in ``package`` if the name is no symbol."""
    if not is_symbol(cls) and not isinstance(cls, TEXT):
        return cls
    symbol = cls if is_symbol(cls) and not isinstance(cls, Keyword) else find_package_or_error(package).intern(string_designator(cls))
    return find_class(symbol, error if error is None else True)
