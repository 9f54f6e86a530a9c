"""Calling Python from Lisp: the functions of the package PYTHON (nickname PY).

A call hands its arguments over as they are, except that strings that can be changed and characters become Python strings, and
that from the first keyword on the arguments are keyword arguments. What comes back is used as it is: numbers, strings and
``None`` (nil) are the same in both languages, a Python list is a vector, other objects print as ``#<PYTHON ...>``. Turning one
kind of collection into another is always asked for: ``py:list`` makes a Lisp list of anything that Python can iterate over.

An exception is signalled as a condition where it reaches Lisp, before the Lisp stack unwinds; when no handler takes it, Python
code above sees the exception itself.
"""

from __future__ import annotations

import builtins
import importlib

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.hash_tables import HashTable, make_hash_table, set_gethash
from cramhy_runtime.lisp_core.conditions import Condition, error, signal_exception, type_error
from cramhy_runtime.lisp_core.data import TRUE_CLASSES, WRITABLE_STRINGS, Character, Cons, Keyword, Symbol, list_from, plain_truth
from cramhy_runtime.lisp_core.data import values as as_values
from cramhy_runtime.lisp_core.packages import is_symbol, sym, symbol_name
from cramhy_runtime.lisp_core import python_names
from cramhy_runtime.lisp_core.python_exceptions import exception, python_condition  # noqa: F401  exception is one of the names

NAMES = """call call-blocking getattr hasattr item delitem list vector tuple dict set str repr values hash-table eval exec raise
exception object method"""
"""Names of package PYTHON; ``list`` is the function `list_` here."""
MISSING = object()
_builtin = {name: getattr(builtins, name) for name in ("getattr", "hasattr", "list", "tuple", "dict", "set", "str", "repr", "eval", "exec")}


class Watch:
    """``function``: ``None``, or called with a name before Lisp uses Python. Nothing of a Lisp program reaches Python without that."""

    __slots__ = ("function",)

    def __init__(self):
        self.function = None


watch = Watch()


def plain(value):
    """``value`` as Python code wants it: a text as ``str``."""
    if value.__class__ in WRITABLE_STRINGS:
        return str(value)
    if value.__class__ is Character:
        return value.char
    return value


def split(arguments):
    """(positional, keyword arguments) of a call from Lisp."""
    for index, argument in enumerate(arguments):
        if argument.__class__ is Keyword:
            rest = arguments[index:]
            if len(rest) % 2:
                return error("The keyword ~S has no value in a call of Python.", rest[-1])
            keywords = {}
            for key, value in zip(rest[::2], rest[1::2], strict=True):
                if key.__class__ is not Keyword:
                    return error("~S stands where a keyword argument of Python must begin.", key)
                keywords[python_names.keyword_spelling(key.name)] = plain(value)
            return [plain(value) for value in arguments[:index]], keywords
    return [plain(value) for value in arguments], {}


def guarded(function, *arguments, **keywords):
    """Call ``function``, an exception of which is signalled as a condition. Truth values of numpy and its like come back as Lisp's."""
    if watch.function is not None:
        named = function in (_find, importlib.import_module)
        watch.function(arguments[0] if named else getattr(function, "__qualname__", "an object"))
    try:
        result = function(*arguments, **keywords)
        return result if result.__class__ in TRUE_CLASSES else plain_truth(result)
    except (Condition, kernel.KernelError):
        raise
    except Exception as problem:
        if isinstance(problem, TypeError):  # also one about the number of arguments is Python's, here
            problem.__lisp_condition__ = python_condition(problem)
        signal_exception(problem)
        raise


def apply_python(function, arguments, keywords):
    """Call a Python callable with the arguments of a Lisp call; ``keywords``: those that a Python caller gave."""
    positional, named = split(arguments)
    return guarded(function, *positional, **named, **keywords)


# -------------------------------------------------------------------------------------------------------- finding objects


def object_(name):
    """``py:object``: the Python object of a dotted name, ``"math.pi"``; modules are imported. Other things are themselves."""
    name = plain(name)
    if not isinstance(name, str):
        return name
    return guarded(_find, name)


def _find(name):
    parts = name.split(".")
    if len(parts) == 1:
        if hasattr_(builtins, name) is not None:
            return getattr(builtins, name)
        return importlib.import_module(name)
    for count in range(len(parts) - 1, 0, -1):
        module_name = ".".join(parts[:count])
        try:
            found = importlib.import_module(module_name)
        except ModuleNotFoundError as problem:
            if problem.name is None or not (module_name + ".").startswith(problem.name + "."):
                raise
            continue
        for part in parts[count:]:
            found = getattr(found, part)
        return found
    if hasattr_(builtins, parts[0]) is not None:
        found = builtins
        for part in parts:
            found = getattr(found, part)
        return found
    return importlib.import_module(parts[0])


def _callable(designator):
    function = designator.function if isinstance(designator, Symbol) else object_(designator)
    return function if callable(function) else type_error(function, "FUNCTION")


def call(function, *arguments):
    """``py:call``: call a Python callable, or the one of a dotted name; ``:key value`` pairs are keyword arguments."""
    return apply_python(_callable(function), arguments, {})


def call_blocking(function, *arguments):
    """``py:call-blocking``: as `call`, for a call that takes long: the other tasks of the plan run meanwhile."""
    positional, named = split(arguments)
    return guarded(kernel.run_blocking, lambda: _callable(function)(*positional, **named))


def method(obj, name, *arguments):
    """``py:method``: call the method ``name`` (a string or a symbol) of ``obj``."""
    return apply_python(getattr_(obj, name), arguments, {})


# ---------------------------------------------------------------------------------------------------- attributes and items


def getattr_(obj, name, default=MISSING):
    """``py:getattr``: an attribute; its name is a string or a symbol. ``default`` stands in for one that is missing."""
    spelled = python_names.attribute_name(obj, name)
    if spelled is None:
        if default is not MISSING:
            return default
        spelled = python_names.keyword_spelling(symbol_name(name))  # for Python's own complaint
    return guarded(getattr, obj, spelled, *(() if default is MISSING else (default,)))


def set_getattr(value, obj, name, default=None):
    """``(setf py:getattr)``: set the attribute; one that is not there yet gets the name with underscores."""
    spelled = python_names.attribute_name(obj, name) or python_names.keyword_spelling(symbol_name(name))
    guarded(setattr, obj, spelled, plain(value))
    return value


def hasattr_(obj, name):
    """``py:hasattr``: whether there is such an attribute."""
    spelled = python_names.attribute_name(obj, name)
    return True if spelled is not None and hasattr(obj, spelled) else None


def item(obj, *keys):
    """``py:item``: ``obj[key]``; several keys are a tuple, as for arrays of numpy."""
    return guarded(lambda: obj[_key(keys)])


def set_item(value, obj, *keys):
    """``(setf py:item)``: ``obj[key] = value``."""

    def assign():
        obj[_key(keys)] = plain(value)

    guarded(assign)
    return value


def delitem(obj, *keys):
    """``py:delitem``: ``del obj[key]``."""

    def delete():
        del obj[_key(keys)]

    guarded(delete)
    return None


def _key(keys):
    return plain(keys[0]) if len(keys) == 1 else tuple(map(plain, keys))


# ------------------------------------------------------------------------------------------------------------- collections


def elements(iterable):
    """The elements of a Lisp list or vector or of a Python iterable, as a Python list."""
    if iterable is None or iterable is False:
        return []
    return [plain(value) for value in guarded(_builtin["list"], iterable)]


def list_(iterable=None):
    """``py:list``: the Lisp list of what a Python iterable gives: a list, a tuple, the keys of a dict, a generator."""
    return list_from(guarded(_builtin["list"], iterable)) if iterable is not None and iterable is not False else None


def vector(iterable=None):
    """``py:vector``: a Python list, which is a Lisp vector, of the elements of a Lisp list or of a Python iterable."""
    return elements(iterable)


def tuple_(iterable=None):
    """``py:tuple``: a Python tuple."""
    return tuple(elements(iterable))


def set_(iterable=None):
    """``py:set``: a Python set."""
    return guarded(_builtin["set"], elements(iterable))


def dict_(*arguments):
    """``py:dict``: a Python dict: of keys and values in turn, of a hash table, or of an association list."""
    if len(arguments) == 1:
        table = arguments[0]
        if isinstance(table, HashTable):
            pairs = table.items()
        elif isinstance(table, Cons) or table is None:
            pairs = [(pair.car, pair.cdr) for pair in table or ()]
        else:
            return guarded(_builtin["dict"], table)
    elif len(arguments) % 2:
        return error("PY:DICT takes keys and values in turn, one hash table, or one association list, not ~D arguments.", len(arguments))
    else:
        pairs = zip(arguments[::2], arguments[1::2], strict=True)
    return {_dict_key(key): plain(value) for key, value in pairs}


def _dict_key(key):
    return python_names.keyword_spelling(key.name) if isinstance(key, Keyword) else plain(key)


def hash_table(mapping):
    """``py:hash-table``: an EQUAL hash table with what is in a Python dict."""
    table = make_hash_table(test=sym("EQUAL"))
    for key, value in guarded(mapping.items):
        set_gethash(value, key, table)
    return table


def values_(iterable):
    """``py:values``: the elements of a tuple or another iterable as values."""
    return as_values(*guarded(tuple, iterable))


def str_(obj=""):
    """``py:str``: Python's ``str(obj)``; of a symbol its name in small letters."""
    if is_symbol(obj) and obj is not None and obj is not True:
        return symbol_name(obj).lower()
    return guarded(str, plain(obj))


def repr_(obj):
    """``py:repr``: Python's ``repr(obj)``."""
    return guarded(repr, plain(obj))


# ---------------------------------------------------------------------------------------------------------- Python as text

_namespace = {"__name__": "python_of_lisp"}
"""The globals of ``py:eval`` and ``py:exec``."""


def eval_(text, *variables):
    """``py:eval``: the value of a Python expression; ``:name value`` pairs are variables in it."""
    _, names = split(variables)
    return guarded(_builtin["eval"], plain(text), _namespace, names)


def exec_(text, *variables):
    """``py:exec``: run Python statements; what they define is there for the next ``py:eval``."""
    _, names = split(variables)
    _namespace.update(names)
    guarded(_builtin["exec"], plain(text), _namespace)
    return None


def raise_(kind, *arguments):
    """``py:raise``: raise a Python exception: an object, a class, or the dotted name of one, with its arguments."""
    found = object_(kind)
    if isinstance(found, type) and issubclass(found, Exception):
        found = apply_python(found, arguments, {})
    if isinstance(found, Condition) or not isinstance(found, Exception):
        return error("PY:RAISE cannot raise ~S, which is not an exception of Python; conditions are signalled with ERROR.", found)

    def throw():
        raise found

    return guarded(throw)


# ---------------------------------------------------------------------------------------------------- what macros expand to


def iterate(function, iterable):
    """``(py:for (variable iterable) ...)``: call ``function`` with each element, one after the other; nil."""
    iterator = guarded(iter, () if iterable is None else iterable)
    while (element := guarded(next, iterator, MISSING)) is not MISSING:
        kernel.checkpoint()
        function(element)
    return None


def with_context(function, manager):
    """``(py:with (variable manager) ...)``: Python's ``with`` statement; the values of ``function``."""
    entered = (
        guarded(type(manager).__enter__, manager)
        if hasattr(type(manager), "__enter__")
        else type_error(manager, "(SATISFIES CONTEXT-MANAGER)")
    )
    try:
        result = function(entered)
    except BaseException as problem:
        if not guarded(type(manager).__exit__, manager, type(problem), problem, problem.__traceback__):
            raise
        return None
    guarded(type(manager).__exit__, manager, None, None, None)
    return result
