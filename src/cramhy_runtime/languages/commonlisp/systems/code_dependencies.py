"""What compiled code depends on beside the text that it was made from: what its symbols meant to the compiler.

A form is compiled with the macros, symbol macros, constants, types, places and declarations of the moment, whoever has made them: another
file, the prompt, a function. `Notes` writes down, while a file is compiled, what each symbol of a form meant (`Meanings`); `Expectations`
tells, before code that was kept is run, whether all of that is still so.

A meaning is told by a digest of the code that the compiler would run: of a macro's expander, of the functions that it calls, of the macros
that its templates name, and so on. Code that comes with cramhy is left out, since the fingerprint of a kept file covers it. What a macro
asks of the world when it is expanded, such as the value of a variable or a file, is told by `lisp_questions`.
"""

from __future__ import annotations

import functools
import importlib.util
import os
import types
from collections.abc import Callable, Iterator
from operator import attrgetter, is_

from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime.kernel.typing_names import Any
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, UndefinedFunction
from cramhy_runtime.kernel.reports import of_the_library
from cramhy_runtime.lisp_core.packages import common, named_package, registered, sym, was_redefined
from ..evaluation.evaluator import PACKAGE
from ..reader.readtables import READTABLE, STANDARD, DispatchTable, Readtable
from ..syntax.backquote import Comma
from ..types.types import type_expander

Wanted = dict[tuple[str, str, str], tuple[bool, str]]
"""(package and name of a symbol, the current package) -> (whether that name means it there, the digest of its meaning)"""

_NUMBERED = late_pattern(r"\bK\d+\b")
"""Names of constants. They are numbered in the order of the text, and what they hold is looked at."""
_AROUND = set(map(sym, ("PROGN", "EVAL-WHEN", "LOCALLY")))
_NOT_COMPILED = {sym("DECLAIM"), sym("DEFINE-SYMBOL-MACRO")}
"""What stands in these forms is kept as it is."""
_WITH_PARTS = frozenset((Cons, Comma, list))
_CELLS = 500
"""Of so many cells of a list one is noted as seen. A circle comes to a noted one sooner or later; its symbols may count more than once."""
_CALLS = frozenset(("function", "setf_function"))
_ABOUT_USERS = ("documentation", "advice")
"""Parts of the names of a compiler's notes that tell people something, and the compiler nothing."""
_state = attrgetter("macro", "function", "setf_function", "special", "constant")


def symbols_in(form: object) -> list[Symbol]:
    """The symbols on whose meaning the code of ``form`` may depend, each once.

    Left out are keywords, symbols without a package, and a name that ``form`` defines or declares and does not use: what it meant before
    does not matter, and when the file is loaded again, it means what the file made it mean.
    """
    times: dict[Symbol, int] = {}
    seen: set[int] = set()
    stack = [form]
    while stack:
        item = stack.pop()
        cells = 0
        while item.__class__ is Cons:
            if cells % _CELLS == 0:  # Python tells a hook of each `id`, and of a circle one cell is enough
                number = id(item)
                if number in seen:
                    break
                seen.add(number)
            cells += 1
            first, item = item.car, item.cdr
            kind = first.__class__
            if kind is Symbol:  # most items are, so it is counted here and does not go through the stack
                times[first] = times.get(first, 0) + 1
            elif kind in _WITH_PARTS:
                stack.append(first)
        kind = item.__class__
        if kind is Symbol:
            times[item] = times.get(item, 0) + 1
        elif kind is Comma:
            stack.append(item.form)
        elif kind is list and id(item) not in seen:
            seen.add(id(item))
            stack += item
    for name in _given_names(form):
        if times.get(name) == 1:
            del times[name]
    return [symbol for symbol in times if symbol.package is not None]


def _given_names(form: object) -> Iterator[Symbol]:
    """The names that a top-level form gives a meaning: those of its definitions, and of its declarations."""
    if form.__class__ is Cons and isinstance(form.car, Symbol) and form.cdr.__class__ is Cons:
        if form.car in _AROUND:
            for part in form.cdr:
                yield from _given_names(part)
        elif form.car in _NOT_COMPILED:
            yield from symbols_in(form.cdr)
        elif form.car.name.startswith("DEF"):
            name = form.cdr.car
            yield name.car if name.__class__ is Cons else name


def reading_state(text: str) -> str:
    """What ``text`` is read with: the current package, readtable and number formats, and the features among those that it asks for."""
    words = [PACKAGE.value.name, str(sym("*READ-BASE*").value), str(sym("*READ-DEFAULT-FLOAT-FORMAT*").value)]
    if "#+" in text or "#-" in text:
        asked = features_asked(text)
        present = list(sym("*FEATURES*").value or ())
        words += sorted(str(each) for each in present if asked is None or getattr(each, "name", "").upper() in asked)
    table = READTABLE.value
    if not _standard(table):
        sets = table.whitespace, table.macros, table.non_terminating, table.single_escapes, table.multiple_escapes
        functions = [table.macros[char] for char in sorted(table.macros)]
        facts = [table.case, *("".join(sorted(each)) for each in sets)]
        for function in functions:
            facts += [function] if function.__class__ is not DispatchTable else [list(pair) for pair in sorted(function.functions.items())]
        words.append(_digest(facts)[0])
    return " ".join(words)


_CONDITIONAL = late_pattern(r"#[+-]\s*")
_EXPRESSION = late_pattern(r"[^()]*[()]")
_NAME = late_pattern(r"[^\s()]*")
_ODD = late_pattern(r"""[#'`,;"|\\]""")
_WORD = late_pattern(r"[^\s():]+")


def features_asked(text: str) -> set[str] | None:
    """The names in the feature expressions of ``text``, in upper case; ``None`` if one of them is made of more than names and parentheses.

    What looks like a feature expression in a string or a comment counts, too: a name too many costs no more than a compilation.
    """
    expressions: set[str] = set()
    for match in _CONDITIONAL.finditer(text):
        end = match.end()
        if not text.startswith("(", end):
            expressions.add(_NAME.match(text, end)[0])
            continue
        depth = 0
        for part in _EXPRESSION.finditer(text, end):
            depth += 1 if part[0].endswith("(") else -1
            if depth == 0:
                expressions.add(text[end : part.end()])
                break
    if any(_ODD.search(expression) for expression in expressions):
        return None
    return {word.upper() for expression in expressions for word in _WORD.findall(expression)}


def _standard(table: Readtable) -> bool:
    def parts(each: Readtable) -> tuple[Any, ...]:
        macros = {char: value.functions if value.__class__ is DispatchTable else value for char, value in each.macros.items()}
        return each.case, macros, each.whitespace, each.non_terminating, each.single_escapes, each.multiple_escapes

    return parts(table) == parts(STANDARD)


class Meanings:
    """Digests of what symbols mean to the compiler now."""

    def __init__(self) -> None:
        self._known: dict[Symbol, tuple[str, list[tuple[Symbol, tuple[Any, ...]]]]] = {}

    def of(self, symbol: Symbol) -> str:
        """The digest of what ``symbol`` means; empty if it means nothing to the compiler, or what cramhy makes it mean."""
        facts = _facts(symbol)
        if not facts:
            return ""
        digest, seen = self._known.get(symbol, ("", None))
        if seen is None or not all(_same(_now(each), then) for each, then in seen):
            digest, seen = _digest(facts, symbol)
            if len(self._known) > 10_000:
                self._known.clear()
            self._known[symbol] = digest, seen
        return digest


meanings = Meanings()
"""Of all files: a digest is made again where a symbol that it was made of means something else."""


class Notes:
    """What the symbols of a file mean while it is compiled."""

    def __init__(self, load_count: Callable[[], int]) -> None:
        self._load_count = load_count
        self._noted: Wanted = {}
        self._loads = load_count()

    def before(self, form: object, package: Any) -> Wanted:
        """What is noted for ``form``, which is compiled next in ``package``: what it wants that no form before it has wanted.

        When another file was loaded meanwhile, also what has changed of the rest.
        """
        current = package.name
        wanted = {(symbol.package.name, symbol.name, current): self._wish(symbol, package) for symbol in symbols_in(form)}
        if self._loads != self._load_count():
            self._loads = self._load_count()
            wanted = {**{key: _found(key) for key in self._noted}, **wanted}
        new = {key: wish for key, wish in wanted.items() if self._noted.get(key) != wish}
        self._noted |= new
        return new

    def _wish(self, symbol: Symbol, package: Any) -> tuple[bool, str]:
        return package.lookup(symbol.name)[0] is symbol, meanings.of(symbol)


class Expectations:
    """What the code of a kept file wants, form after form."""

    def __init__(self, load_count: Callable[[], int]) -> None:
        self._load_count = load_count
        self._wanted: Wanted = {}
        self._loads = load_count()

    def hold(self, wanted: Wanted) -> bool:
        """Whether everything is as the next form's code wants it, and as the code before it wanted it if a file was loaded meanwhile."""
        self._wanted |= wanted
        if self._loads != self._load_count():
            self._loads = self._load_count()
            wanted = self._wanted
        return all(_found(key) == wish for key, wish in wanted.items())


def _found(key: tuple[str, str, str]) -> tuple[bool, str] | None:
    """What is true now of the symbol and the package that ``key`` names; ``None`` when one of them is not there."""
    home, current = named_package(key[0]), registered(key[2])  # a package that is made on demand was made when the form was read
    if home is None or current is None:
        return None
    symbol = home.lookup(key[1])[0]
    if not isinstance(symbol, Symbol):  # the code makes it, and there it is what the current package makes of its name, or not
        return home is current, ""
    return current.lookup(key[1])[0] is symbol, meanings.of(symbol)


# ------------------------------------------------------------------------------------------------------------------ digests


def _facts(symbol: Symbol) -> list[Any]:
    """What ``symbol`` means to the compiler, beside the function of that name."""
    if symbol.__class__ is Keyword or common(symbol) and not was_redefined(symbol):
        return []
    facts: list[Any] = []
    if symbol.macro is not None:
        facts += "macro", symbol.macro
    if symbol.special:
        facts.append("special")
    if symbol.constant:
        facts += "constant", symbol.value
    for function in (symbol.function, symbol.setf_function):
        if hasattr(function, "slot_of"):
            facts += "slot", function.slot_of.__name__, function.attribute
    if symbol.compiler_data:
        facts += _notes(symbol.compiler_data)
    expander = type_expander(symbol)
    return facts if expander is None else [*facts, "type", expander]


def _notes(data: dict[str, Any]) -> list[Any]:
    facts: list[Any] = []
    for name in sorted(data):
        if not any(part in name for part in _ABOUT_USERS):
            facts += (name, *_notes(data[name])) if isinstance(data[name], dict) else (name, data[name])
    return facts


def _now(symbol: Symbol) -> tuple[Any, ...]:
    """The objects that make the meaning of ``symbol`` another one when they change."""
    data = symbol.compiler_data
    return (*_state(symbol), type_expander(symbol), symbol.constant and symbol.value, *(data.values() if data else ()))


def _same(objects: tuple[Any, ...], others: tuple[Any, ...]) -> bool:
    return len(objects) == len(others) and all(map(is_, objects, others))


@functools.cache
def _folders_of_hy() -> tuple[str, ...]:
    language = importlib.util.find_spec("cramhy")
    return tuple(f"{folder}{os.sep}" for folder in (language and language.submodule_search_locations or ()))


def _is_ours(code: types.CodeType) -> bool:
    """Whether ``code`` comes with cramhy, and is part of what the fingerprint of a kept file tells."""
    return of_the_library(code.co_filename) or code.co_filename.startswith(_folders_of_hy())


def _is_set(cell: types.CellType) -> bool:
    try:
        cell.cell_contents  # noqa: B018
    except ValueError:
        return False
    return True


@functools.lru_cache(4096)
def globals_of(code: types.CodeType) -> list[tuple[str, frozenset[str]]]:
    """(name, attributes of it that are used, such as "function" of a symbol) for the globals that ``code`` uses, each once."""
    import dis  # only where macros of the user's are

    found: dict[str, frozenset[str]] = {}
    last = None
    for instruction in dis.get_instructions(code):
        if instruction.opname.startswith("LOAD_GLOBAL") or instruction.opname == "LOAD_NAME":
            last = instruction.argval
            found.setdefault(last, frozenset())
        else:
            if last is not None and isinstance(instruction.argval, str):
                found[last] |= {instruction.argval}
            last = None
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            for name, used in globals_of(constant):
                found[name] = found.get(name, frozenset()) | used
    return list(found.items())


_digests: dict[int, tuple[object, str, list[tuple[Symbol, tuple[Any, ...]]]]] = {}
"""Number of a function → it, the digest of its code, and the state of the symbols that were looked at for that."""


def code_digest(function: object) -> str:
    """A digest of the code of ``function`` and of the functions that it calls; empty if there is none."""
    if function is None or isinstance(function, UndefinedFunction):
        return ""
    known = _digests.get(id(function))
    if known is not None and all(_same(_now(each), then) for each, then in known[2]):
        return known[1]
    if len(_digests) > 2000:
        _digests.clear()
    digest, seen = _digest([function])
    _digests[id(function)] = function, digest, seen
    return digest


def _digest(facts: list[Any], symbol: Symbol | None = None) -> tuple[str, list[tuple[Symbol, tuple[Any, ...]]]]:
    """(the digest of ``facts``, which are about ``symbol``, the symbols that were looked at with their state)"""
    from cramhy_runtime.storage.digests import sha256

    words: list[str] = []
    symbols = [] if symbol is None else [(symbol, _now(symbol))]
    numbers: dict[int, int] = {} if symbol is None else {id(symbol): 0}
    alive: list[Any] = []  # ids are keys
    stack = facts[::-1]
    while stack:
        item = stack.pop()
        if isinstance(item, (str, bytes, int, float, complex)) or item is None or item is Ellipsis:
            words.append(f"{item.__class__.__name__} {item!r}")
            continue
        key = id(item)
        if key in numbers:
            words.append(f"#{numbers[key]}")
            continue
        numbers[key] = len(numbers)
        alive.append(item)
        if isinstance(item, Symbol):
            words.append(f"{item.package.name}::{item.name}" if item.package else "#:")
            if item.package is not None:
                symbols.append((item, _now(item)))
                stack += _facts(item)[::-1]
        elif isinstance(item, Cons):
            words.append("(")
            stack += item.cdr, item.car
        elif isinstance(item, (list, tuple)):
            words.append(f"{item.__class__.__name__} {len(item)}")
            stack += reversed(item)
        elif isinstance(item, Comma):
            words.append(f", {item.kind}")
            stack.append(item.form)
        elif isinstance(item, types.FunctionType):
            words.append(f"function {item.__qualname__}")
            stack += [cell.cell_contents for cell in item.__closure__ or () if _is_set(cell)]
            if not _is_ours(item.__code__):
                stack += item.__defaults__ or (), item.__code__
                for name, attributes in globals_of(item.__code__):
                    used = item.__globals__.get(name)
                    stack.append(used)
                    if isinstance(used, Symbol) and not _CALLS.isdisjoint(attributes):
                        symbols.append((used, _now(used)))
                        stack += used.function, used.setf_function
        elif isinstance(item, types.CodeType):
            words += item.co_code.hex(), _NUMBERED.sub("K", " ".join(item.co_names)), str(item.co_flags & 0x0F)
            stack += reversed(item.co_consts)
        else:
            words.append(f"{item.__class__.__qualname__} {getattr(item, '__name__', '')}")
            if not isinstance(item, UndefinedFunction):
                stack += [method.function for method in getattr(item, "methods", ()) if hasattr(method, "function")]
    return sha256("\n".join(words).encode(errors="surrogatepass")).hexdigest()[:32], symbols
