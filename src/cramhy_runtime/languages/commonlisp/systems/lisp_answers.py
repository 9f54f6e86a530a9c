"""What Lisp's world answers to what a compilation asked of it: the kinds of questions that Lisp adds to `storage.dependencies`.

An answer is a digest, so the file of kept code stays small. Kept code that has asked needs this module before it is used. Who asks is in
`lisp_questions`, which only a compilation needs.
"""

from __future__ import annotations

import types
from typing import Any

from cramhy_runtime.lisp_core.data import UNBOUND, Cons, Symbol
from cramhy_runtime.lisp_core.hash_tables import HashTable
from cramhy_runtime.lisp_core.packages import Package, all_packages, find_package, sym
from cramhy_runtime.storage.dependencies import KINDS, Kind, Unanswerable

from ..evaluation.definitions import take_as_keyword
from ..objects.classes import symbol_class
from ..streams.streams import Stream
from ..types.types import type_expander
from .code_dependencies import code_digest, meanings

_MOST = 50_000
"""Parts of a value that are looked at. A larger one would make each load slow, and is not compared."""
_ATOMS = (str, bytes, int, float, complex, bool, type(None), type(...))
_COUNTERS = {sym("*RANDOM-STATE*"): "it depends on chance", sym("*GENSYM-COUNTER*"): "it depends on how many symbols were made before"}
_PRINTING = """*PRINT-ARRAY* *PRINT-BASE* *PRINT-CASE* *PRINT-CIRCLE* *PRINT-ESCAPE* *PRINT-GENSYM* *PRINT-LENGTH* *PRINT-LEVEL*
*PRINT-LINES* *PRINT-MISER-WIDTH* *PRINT-PRETTY* *PRINT-RADIX* *PRINT-READABLY* *PRINT-RIGHT-MARGIN* *READ-BASE* *READ-DEFAULT-FLOAT-FORMAT*
*READ-EVAL* *READ-SUPPRESS* *DEFAULT-PATHNAME-DEFAULTS*""".split()
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


def _is_bound(key: tuple[str, str, Any]) -> bool:
    symbol = _symbol(key[:2])
    return symbol is not None and symbol.value is not UNBOUND


def _still_bound(key: tuple[str, str, Any], answer: bool) -> bool:
    """Whether a symbol in a designator, of which the compiler asked, is bound as it was. One that is not is a keyword in the kept code."""
    if _is_bound(key) is not answer:
        return False
    package = find_package(key[0])
    if not answer and package is not None:  # whose symbol nobody may have read yet
        take_as_keyword(package.intern(key[1]), key[2] or None)
    return True


def _properties(name: Name) -> str:
    symbol = _symbol(name)
    return "" if symbol is None or symbol.plist is None else value_digest(symbol.plist)


def expanders(symbol: Symbol) -> tuple[Any, ...]:
    """What the compiler calls for the name: its macro, compiler macro, setf expander and the expander of its type, each or ``None``."""
    notes = symbol.compiler_data or {}
    return symbol.macro, notes.get("compiler-macro"), notes.get("setf-expander"), type_expander(symbol)


def _function(name: Name) -> str:
    """What the name does when it is called, as a function or as a macro, with what its closure holds."""
    symbol = _symbol(name)
    if symbol is None:
        return ""
    data: list[object] = []
    for function in (*(getattr(each, "source", each) for each in expanders(symbol)), symbol.function, symbol.setf_function):
        if isinstance(function, types.FunctionType):
            data += [cell.cell_contents for cell in function.__closure__ or () if _holds_data(cell)]
    digests = meanings.of(symbol), code_digest(symbol.function), code_digest(symbol.setf_function), value_digest(data) if data else ""
    return " ".join(digests).strip()  # a symbol that means nothing is as good as none


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


_KINDS = {
    "variable": Kind(_variable, lambda name: f"the value of {_printed(name)}"),
    "bound": Kind(_is_bound, lambda key: f"whether {_printed(key[:2])} has a value", _still_bound),
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
    "features": Kind(lambda _: value_digest(sym("*FEATURES*").value), lambda _: "the features"),
}
KINDS.update(_KINDS)

__all__ = ["expanders", "value_digest"]
