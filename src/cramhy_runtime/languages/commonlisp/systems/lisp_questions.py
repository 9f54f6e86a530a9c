"""What code of the user's may ask of Lisp's world while a file is compiled, for `storage.dependency_tracing`.

A macro, a reader macro or the form behind ``#.`` may look at the value of a variable, at a property of a symbol, at whether there is such
a package, function or class, at how numbers are printed. `install` makes each of these a kind of question (`storage.dependencies`):
functions that ask are in `_ASK`, variables are found in the code that runs. An answer is a digest, so the file of kept code stays small.

``gentemp``, ``*random-state*`` and the like have no answer that could be compared: code that asks for them is not kept.
"""

from __future__ import annotations

import functools
import types
from collections.abc import Callable, Iterator
from typing import Any

from cramhy_runtime.ground.data import UNBOUND, Cons, Symbol
from cramhy_runtime.ground.hash_tables import HashTable
from cramhy_runtime.ground.packages import Package, all_packages, find_package, sym
from cramhy_runtime.storage import dependency_tracing
from cramhy_runtime.storage.dependencies import KINDS, Kind, Unanswerable
from cramhy_runtime.storage.dependency_tracing import Trace, questions

from ..objects.classes import symbol_class
from ..streams.streams import Stream
from .code_dependencies import Meanings, code_digest, globals_of

_MOST = 50_000
"""Parts of a value that are looked at. A larger one would make each load slow, and is not compared."""
_ATOMS = (str, bytes, int, float, complex, bool, type(None), type(...))
_COUNTERS = {sym("*RANDOM-STATE*"): "it depends on chance", sym("*GENSYM-COUNTER*"): "it depends on how many symbols were made before"}
_PRINTING = """*PRINT-ARRAY* *PRINT-BASE* *PRINT-CASE* *PRINT-CIRCLE* *PRINT-ESCAPE* *PRINT-GENSYM* *PRINT-LENGTH* *PRINT-LEVEL*
*PRINT-LINES* *PRINT-MISER-WIDTH* *PRINT-PRETTY* *PRINT-RADIX* *PRINT-READABLY* *PRINT-RIGHT-MARGIN* *READ-BASE* *READ-DEFAULT-FLOAT-FORMAT*
*READ-EVAL* *READ-SUPPRESS* *DEFAULT-PATHNAME-DEFAULTS* *FEATURES*""".split()
"""Variables that functions of Common Lisp look at, so that the code which calls them need not name them."""

Name = tuple[str, str]
"""The home package and the name of a symbol."""


def value_digest(value: object) -> str:
    """A digest of ``value`` with all that is in it. Errors: `Unanswerable`, when that is too much."""
    from cramhy_runtime.storage.digests import sha256

    words: list[str] = []
    numbers: dict[int, int] = {}
    alive: list[object] = []  # ids are keys
    stack = [value]
    while stack:
        item = stack.pop()
        if isinstance(item, _ATOMS):
            words.append(f"{item.__class__.__name__} {item!r}")
            continue
        if isinstance(item, Symbol):
            words.append(f"{item.package.name}::{item.name}" if item.package else f"#:{item.name}")
            continue
        if id(item) in numbers:
            words.append(f"#{numbers[id(item)]}")
            continue
        numbers[id(item)] = len(numbers)
        alive.append(item)
        if len(words) > _MOST:
            raise Unanswerable("a value that it looks at is too large to be compared")
        if isinstance(item, Cons):
            words.append("(")
            stack += item.cdr, item.car
        elif isinstance(item, types.FunctionType):
            words.append(code_digest(item))
            stack += [cell.cell_contents for cell in item.__closure__ or () if _holds_data(cell)]
        else:
            words.append(f"{item.__class__.__module__} {item.__class__.__qualname__} {getattr(item, '__name__', '')}")
            stack += _parts(item)
    return sha256("\n".join(words).encode(errors="surrogatepass")).hexdigest()[:32]


def _holds_data(cell: types.CellType) -> bool:
    """Whether the cell of a closure has something that is no function: of functions, the code tells."""
    try:
        return not isinstance(cell.cell_contents, types.FunctionType)
    except ValueError:
        return False


def _parts(item: Any) -> list[object]:
    """What is in an object."""
    if isinstance(item, (Package, Stream, type, types.ModuleType, types.BuiltinFunctionType)):
        return [item.name] if isinstance(item, Package) else []
    if isinstance(item, HashTable):
        return [part for pair in item.items() for part in pair]
    if isinstance(item, dict):
        return [part for pair in item.items() for part in pair]
    if isinstance(item, (list, tuple)):
        return list(item)
    if isinstance(item, (set, frozenset)):
        return sorted(map(repr, item))  # type: ignore[arg-type]
    slots = [name for kind in type(item).__mro__ for name in _names(kind.__dict__.get("__slots__", ())) if not name.startswith("__")]
    found = [getattr(item, name, None) for name in slots] + list(getattr(item, "__dict__", {}).values())
    return found or ([repr(item)] if type(item).__repr__ is not object.__repr__ else [])


def _names(slots: object) -> tuple[str, ...]:
    return (slots,) if isinstance(slots, str) else tuple(slots)  # type: ignore[arg-type]


# ------------------------------------------------------------------------------------------------------------- the answers


def _symbol(name: Name) -> Symbol | None:
    package = find_package(name[0])
    found = package.lookup(name[1])[0] if package is not None else None
    return found if isinstance(found, Symbol) else None


def _variable(name: Name) -> str:
    symbol = _symbol(name)
    if symbol is None or symbol.value is UNBOUND:
        return "unbound"
    if symbol in _COUNTERS:
        raise Unanswerable(_COUNTERS[symbol])
    return value_digest(symbol.value)


def _properties(name: Name) -> str:
    symbol = _symbol(name)
    return "" if symbol is None or symbol.plist is None else value_digest(symbol.plist)


def _function(name: Name) -> str:
    """What the name does when it is called, as a function or as a macro, with what its closure holds."""
    symbol = _symbol(name)
    if symbol is None:
        return ""
    data: list[object] = []
    for function in (getattr(symbol.macro, "source", None), symbol.function, symbol.setf_function):
        if isinstance(function, types.FunctionType):
            data += [cell.cell_contents for cell in function.__closure__ or () if _holds_data(cell)]
    return (
        f"{Meanings().of(symbol)} {code_digest(symbol.function)} {code_digest(symbol.setf_function)} {value_digest(data) if data else ''}"
    )


def _class(name: Name) -> str:
    """The class of that name: its superclasses and what its slots are called."""
    symbol = _symbol(name)
    found = symbol_class(symbol) if symbol is not None else None
    if not isinstance(found, type):
        return "" if found is None else type(found).__name__
    slots = [
        [each.name, str(getattr(each, "type", "")), [str(word) for word in getattr(each, "initargs", ())]]
        for kind in found.__mro__
        for each in kind.__dict__.get("lisp_direct_slots", ())
    ]
    structure = [str(each) for each in _names(found.__dict__.get("__slots__", ()))]
    return value_digest([[kind.__qualname__ for kind in found.__mro__], slots, structure])


def _package(name: str) -> str:
    """The package of that name and those that it uses; empty if there is none."""
    package = find_package(name)
    if package is None:
        return ""
    return value_digest([package.name, list(package.nicknames), [used.name for used in package.use]])


def _symbols(name: str) -> str:
    """The symbols that are present in the package."""
    package = find_package(name)
    return "" if package is None else value_digest([sorted(package.internal), sorted(package.external)])


def _status(key: tuple[str, str]) -> str:
    """What a name means in a package."""
    package = find_package(key[0])
    if package is None:
        return ""
    symbol, status = package.lookup(key[1])
    return str(status) if not isinstance(symbol, Symbol) else f"{status} {symbol.package.name if symbol.package else ''}"


def _printed(name: Name) -> str:
    return f"{name[0]}::{name[1]}"


# ------------------------------------------------------------------------------------------------------------ the questions


def _ask_symbol(kind: str, trace: Trace, symbol: object) -> None:
    if isinstance(symbol, Cons) and isinstance(symbol.cdr, Cons):  # (setf name)
        symbol = symbol.cdr.car
    if isinstance(symbol, Symbol) and symbol.package is not None:
        trace.ask(kind, (symbol.package.name, symbol.name))


def _of_symbol(kind: str, argument: str) -> Callable[[Trace, Any], None]:
    return lambda trace, arguments: _ask_symbol(kind, trace, arguments[argument])


def _of_call(trace: Trace, arguments: Any) -> None:
    form = arguments["form"]
    _ask_symbol("function", trace, form.car if isinstance(form, Cons) else form)


def _name_of(package: object) -> str | None:
    if isinstance(package, Package):
        return package.name
    return str(getattr(package, "name", package)) if package is not None else None


def _of_package(kind: str, argument: str) -> Callable[[Trace, Any], None]:
    def note(trace: Trace, arguments: Any) -> None:
        name = _name_of(arguments[argument])
        if name is not None:
            trace.ask(kind, name)

    return note


def _of_name(trace: Trace, arguments: Any) -> None:
    from ..evaluation.evaluator import PACKAGE

    package = arguments.get("package")
    name = PACKAGE.value.name if not isinstance(package, (Package, str, Symbol)) else _name_of(package)
    if name is not None:
        trace.ask("name", (name, str(arguments["name"])))


def _of_everything(trace: Trace, arguments: Any) -> None:
    trace.ask("packages", "")


def _refused(reason: str) -> Callable[[Trace, Any], None]:
    return lambda trace, arguments: trace.refuse(reason)


_CLOCK = _refused("it looks at the clock")
_SOMEBODY = _refused("it asks somebody at the terminal")
_ASK: dict[str, Callable[[Trace, Any], None]] = {
    **{name: _of_symbol("function", "name") for name in ("FBOUNDP", "FDEFINITION", "COMPILER-MACRO-FUNCTION")},
    **{name: _of_symbol("function", "symbol") for name in ("SYMBOL-FUNCTION", "MACRO-FUNCTION", "SPECIAL-OPERATOR-P")},
    **{name: _of_symbol("variable", "symbol") for name in ("BOUNDP", "SYMBOL-VALUE")},
    **{name: _of_symbol("properties", "symbol") for name in ("GET", "SYMBOL-PLIST")},
    **{name: _of_call for name in ("MACROEXPAND", "MACROEXPAND-1", "CONSTANTP")},
    "FIND-CLASS": _of_symbol("class", "symbol"),
    "TYPEP": _of_symbol("class", "type_specifier"),
    "SUBTYPEP": _of_symbol("class", "type_1"),
    "FIND-PACKAGE": _of_package("package", "designator"),
    **{
        name: _of_package("package", "designator")
        for name in ("PACKAGE-USE-LIST", "PACKAGE-NICKNAMES", "PACKAGE-SHADOWING-SYMBOLS", "PACKAGE-NAME")
    },
    "FIND-SYMBOL": _of_name,
    "CRAMHY::PACKAGE-SYMBOLS": _of_package("symbols", "package"),
    "CRAMHY::PACKAGE-ITERATOR": _of_everything,
    **{name: _of_everything for name in ("LIST-ALL-PACKAGES", "PACKAGE-USED-BY-LIST", "FIND-ALL-SYMBOLS", "APROPOS", "APROPOS-LIST")},
    **{
        name: _CLOCK
        for name in ("GET-UNIVERSAL-TIME", "GET-DECODED-TIME", "GET-INTERNAL-REAL-TIME", "GET-INTERNAL-RUN-TIME", "SB-EXT:GET-TIME-OF-DAY")
    },
    **{name: _refused("it depends on chance") for name in ("RANDOM", "MAKE-RANDOM-STATE")},
    "GENTEMP": _refused("it depends on how many symbols were made before"),
    **{name: _SOMEBODY for name in ("Y-OR-N-P", "YES-OR-NO-P")},
    **{name: _refused("it looks at the machine") for name in ("MACHINE-INSTANCE", "ROOM")},
}

_KINDS = {
    "variable": Kind(_variable, lambda name: f"the value of {_printed(name)}"),
    "properties": Kind(_properties, lambda name: f"the properties of {_printed(name)}"),
    "function": Kind(_function, lambda name: f"the function or macro {_printed(name)}"),
    "class": Kind(_class, lambda name: f"the class {_printed(name)}"),
    "package": Kind(_package, lambda name: f"the package {name}"),
    "symbols": Kind(_symbols, lambda name: f"the symbols of the package {name}"),
    "name": Kind(_status, lambda key: f"whether {key[1]} is a symbol of {key[0]}"),
    "packages": Kind(
        lambda _: value_digest([[each.name, sorted(each.internal), sorted(each.external)] for each in all_packages() if not each.built_in]),
        lambda _: "the packages that there are",
    ),
    "settings": Kind(lambda _: value_digest([sym(name).value for name in _PRINTING]), lambda _: "how Lisp reads and prints"),
}


def _variables(code: types.CodeType, names: dict[str, Any]) -> Iterator[tuple[str, Symbol]]:
    for name, used in globals_of(code):
        symbol = names.get(name)
        if isinstance(symbol, Symbol) and symbol.package is not None and not symbol.constant:
            if "value" in used:
                yield "variable", symbol
            if "function" in used or "setf_function" in used:
                yield "function", symbol
            if symbol_class(symbol) is not None and not symbol.package.built_in:
                yield "class", symbol


def _observe(trace: Trace, code: types.CodeType, names: dict[str, Any]) -> None:
    """A function in compiled Lisp runs: it reads variables and calls functions."""
    if names.get("__name__") != "cramhy_code":
        return
    trace.ask("settings", "")
    for kind, symbol in _variables(code, names):
        if symbol.package.built_in and kind == "function":
            continue
        if kind == "variable" and isinstance(symbol.value, Stream):
            continue
        _ask_symbol(kind, trace, symbol)


@functools.cache
def install() -> None:
    """Let traces know the questions of Lisp."""
    KINDS.update(_KINDS)
    for name, note in _ASK.items():
        package, _, short = name.rpartition(":")
        symbol = sym(f"{package.rstrip(':')}::{short}") if package else sym(name)
        questions(symbol.function, note)
    dependency_tracing.OBSERVERS.append(_observe)


__all__ = ["install", "value_digest"]
