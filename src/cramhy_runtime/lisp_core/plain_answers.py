"""The answers of the ports where no language is installed: plain Python, enough to print and fail readably.

Objects look as Common Lisp prints them, as far as that needs no printer: lists in parentheses, symbols in capitals, strings in quotes,
conditions by their report. Of FORMAT there are the directives that messages of the runtime use.
"""

from __future__ import annotations

import io
import sys

from cramhy_runtime.kernel.reports import write_shown
from cramhy_runtime.kernel.typing_names import Any

from .data import UNBOUND, Character, Cons, Keyword, LispString, MultipleValues, Symbol, is_ratio, list_parts, one, python_list
from .packages import (
    COMMON_LISP,
    COMMON_LISP_USER,
    CURRENT,
    Package,
    ensure_package,
    is_symbol,
    keyword,
    printed,
    sym,
    symbol_name,
    symbol_package,
)
from .ports import PORTS

# ------------------------------------------------------------------------------------------------------------------ the printer


printers: dict = {}
"""How the instances of a class print: functions of the object and a stream."""
printers_found: dict = {}


def printer_for(cls: type) -> Any:
    """The function that prints instances of ``cls``: that of the nearest superclass that has one; ``None`` if none has."""
    found = printers_found.get(cls)
    if found is None:
        found = next((printers[ancestor] for ancestor in cls.__mro__ if ancestor in printers), None)
        if found is not None:
            printers_found[cls] = found
    return found


class PlainPrinter:
    """Prints without control variables: what can be read back with ``escape``, else what people read."""

    def prin1(self, thing: Any) -> str:
        return self.text(thing, True)

    def princ(self, thing: Any) -> str:
        return self.text(thing, False)

    def text(self, thing: Any, escape: bool) -> str:
        if thing is None or thing is False or thing is True or isinstance(thing, Symbol):
            return _in_case(symbol_text(thing) if escape else symbol_name(thing or None))
        if isinstance(thing, (str, LispString)):
            return '"' + str(thing).replace("\\", "\\\\").replace('"', '\\"') + '"' if escape else str(thing)
        if isinstance(thing, float):
            return repr(thing)
        if isinstance(thing, int) or is_ratio(thing):
            return str(thing)
        if isinstance(thing, Cons):
            return self._list(thing, escape)
        if isinstance(thing, (list, tuple)) and not isinstance(thing, MultipleValues):
            return f"#({' '.join(self.text(each, escape) for each in thing)})"
        if isinstance(thing, Character):
            return f"#\\{thing.char}" if escape else thing.char
        if isinstance(thing, type):
            return f"#<CLASS {symbol_text(PORTS.classes.name(thing))}>"
        return self._other(thing, escape)

    def _list(self, cell: Any, escape: bool) -> str:
        items, end = list_parts(cell)
        parts = [self.text(item, escape) for item in items]
        if end is not None:
            parts += [".", self.text(end, escape)]
        return f"({' '.join(parts)})"

    guard: Any = None
    """A function of an object and of one that makes its text: it says what stands for an object whose text cannot be made."""

    def _other(self, thing: Any, escape: bool) -> str:
        if self.guard is None:
            return self._text_of_other(thing, escape)
        return self.guard(thing, lambda: self._text_of_other(thing, escape))

    def _text_of_other(self, thing: Any, escape: bool) -> str:
        if hasattr(thing, "report") and isinstance(thing, BaseException):
            name = symbol_text(PORTS.classes.name(type(thing)))
            return f'#<{name} "{thing}">' if escape else str(thing)
        printer = printer_for(type(thing))
        if printer is not None:
            stream = io.StringIO()
            printer(thing, stream)
            return stream.getvalue()
        own = type(thing).__repr__
        if own is not object.__repr__ and not callable(thing):
            return repr(thing)
        if callable(thing):
            return f"#<FUNCTION {_function_name(thing)}>"
        return f"#<{symbol_text(PORTS.classes.name(type(thing)))}>"

    def output_object(self, thing: Any, stream: Any) -> None:
        stream.write(self.text(thing, True))

    def write(self, thing: Any, stream: Any, escape: bool) -> None:
        stream.write(self.text(thing, escape))

    def print_unreadable(self, thing: Any, stream: Any, text: Any, type_: bool, identity: bool, body: Any) -> None:
        stream.write("#<")
        if type_:
            stream.write(symbol_text(PORTS.classes.name(type(thing))))
        if text is not None or body is not None:
            stream.write(" " * type_)
            stream.write(text) if body is None else body()
        stream.write(f" {{{self.address(thing)}}}>" if identity else ">")

    def print_slots(self, name: Any, slots: list, stream: Any) -> None:
        parts = "".join(f" :{symbol_name(slot)} {self.text(value, True)}" for slot, value in slots)
        stream.write(f"#S({symbol_text(name)}{parts})")

    def report(self, condition: Any) -> str:
        return str(condition)

    def address(self, thing: Any) -> str:
        return f"{id(thing):X}"

    def formatted(self, control: Any, *arguments: Any) -> str:
        if callable(control):
            return str(control(None, *arguments))
        return _Format(str(control)).run(list(arguments))

    def format_to(self, stream: Any, control: Any, *arguments: Any) -> None:
        stream.write(self.formatted(control, *arguments))


_PRINT_CASE = sym("*PRINT-CASE*")


def _in_case(text: str) -> str:
    case = _PRINT_CASE.value
    return text.lower() if isinstance(case, Keyword) and case.name == "DOWNCASE" else text


def symbol_text(symbol: Any) -> str:
    """``symbol`` with the package that it needs where the current package is ``*package*``."""
    symbol = symbol or None
    package, current = symbol_package(symbol), CURRENT.value
    if package in (None, COMMON_LISP) or isinstance(symbol, Keyword):
        return printed(symbol) if package is not COMMON_LISP else symbol_name(symbol)
    if not isinstance(current, Package) or current.lookup(symbol_name(symbol))[0] is symbol:
        return symbol_name(symbol)
    return printed(symbol)


def _function_name(function: Any) -> str:
    name = getattr(function, "__lisp_name__", None)
    if name is not None and is_symbol(name):
        return symbol_text(name)
    return getattr(function, "__name__", type(function).__name__).replace("_", "-").upper()


_DIRECTIVE = r"(?s)~((?:-?\d+|#|,|'.)*)([:@]*)(\n\s*|.)"


class _Format:
    """A format control: its pieces are texts and directives (parameters, modifiers, character)."""

    def __init__(self, control: str):
        import re

        self.pieces: list = []
        end = 0
        for match in re.finditer(_DIRECTIVE, control):
            self.pieces += [control[end : match.start()], (match[1], match[2], match[3][0].upper())]
            end = match.end()
        self.pieces.append(control[end:])

    def run(self, arguments: list) -> str:
        out: list = []
        try:
            self._run(0, len(self.pieces), arguments, out)
        except StopIteration:
            pass
        return "".join(out)

    def _matching(self, start: int, closing: str) -> tuple[int, list]:
        # the place of the directive that closes the one before ``start``, and those of the ``~;`` between
        opening = {"}": "{", "]": "[", ">": "<", ")": "("}[closing]
        depth, separators = 0, []
        for index in range(start, len(self.pieces)):
            piece = self.pieces[index]
            if piece.__class__ is tuple:
                if piece[2] == opening:
                    depth += 1
                elif piece[2] == closing:
                    if not depth:
                        return index, separators
                    depth -= 1
                elif piece[2] == ";" and not depth:
                    separators.append(index)
        return len(self.pieces), separators

    def _run(self, start: int, end: int, arguments: list, out: list) -> None:
        index = start
        while index < end:
            piece = self.pieces[index]
            index += 1
            if piece.__class__ is str:
                out.append(piece)
                continue
            parameters, modifiers, character = piece
            if character in "ASDPCW":
                out.append(self._shown(character, modifiers, arguments))
            elif character == "F" or character == "$":
                out.append(_fixed(arguments.pop(0), parameters))
            elif character == "%":
                out.append("\n" * int(parameters or 1))
            elif character == "&":
                out.append("" if not out or "".join(out[-1:]).endswith("\n") else "\n")
            elif character == "~":
                out.append("~")
            elif character == "*":
                del arguments[: int(parameters or 1)]
            elif character == "^" and not arguments:
                raise StopIteration
            elif character in "{[<":
                close, separators = self._matching(index, {"{": "}", "[": "]", "<": ">"}[character])
                self._block(character, modifiers, index, close, separators, arguments, out)
                index = close + 1

    def _shown(self, character: str, modifiers: str, arguments: list) -> str:
        thing = arguments.pop(0)
        if character == "P":
            return "" if thing == 1 else "s"
        if character == "D" and isinstance(thing, int):
            return f"{thing:,}" if ":" in modifiers else str(thing)
        if ":" in modifiers and thing is None:
            return "()"
        return (PORTS.printer.prin1 if character in "SW" else PORTS.printer.princ)(thing)

    def _block(self, kind: str, modifiers: str, start: int, end: int, separators: list, arguments: list, out: list) -> None:
        if kind == "<":
            self._run(start, end, python_list(arguments.pop(0)) if ":" in modifiers else arguments, out)
        elif kind == "{":
            items = arguments if "@" in modifiers else python_list(arguments.pop(0))
            while items:
                try:
                    self._run(start, end, list(items.pop(0)) if ":" in modifiers else items, out)
                except StopIteration:
                    break
        elif "@" in modifiers:
            if arguments[0] is None or arguments[0] is False:
                arguments.pop(0)
            else:
                self._run(start, end, arguments, out)
        else:
            clauses = list(zip([start, *(each + 1 for each in separators)], [*separators, end]))
            chosen = arguments.pop(0)
            chosen = (0 if chosen is None or chosen is False else 1) if ":" in modifiers else chosen
            if chosen < len(clauses):
                self._run(*clauses[chosen], arguments, out)


def _fixed(number: Any, parameters: str) -> str:
    digits = parameters.partition(",")[2]
    return f"{float(number):.{digits}f}" if digits.isdigit() else repr(float(number))


# ------------------------------------------------------------------------------------------------------------------ the classes

registered: dict = {}
"""The classes that symbols name, as far as somebody registered or looked for them. A language goes on with this table."""


def register_class(symbol: Any, cls: type) -> type:
    """Make ``cls`` the class that ``symbol`` names."""
    registered[symbol] = cls
    if "lisp_symbol" not in vars(cls) and "lisp_name" not in vars(cls):
        cls.lisp_symbol = symbol  # type: ignore[attr-defined]
    return cls


def named(lisp_name: str) -> Any:
    """The symbol for a ``lisp_name`` attribute, such as ``"CPL-IMPL::PLAN-FAILURE"``; its package is made if need be."""
    package, _, name = lisp_name.rpartition("::")
    home = ensure_package(package or "COMMON-LISP")
    return home.intern(name)


class PlainClasses:
    """Python's classes, which may have a ``lisp_name`` or be registered under a symbol."""

    def name(self, cls: type) -> Any:
        for base in cls.__mro__[:-1]:
            if "lisp_symbol" in vars(base):
                return vars(base)["lisp_symbol"]
            if "lisp_name" in vars(base):
                return named(vars(base)["lisp_name"])
        return Symbol(cls.__name__.upper())

    def define(self, symbol: Any, superclass: type) -> type:
        return register_class(symbol, type(symbol_name(symbol).title().replace("-", ""), (superclass,), {}))

    def customized(self, cls: type) -> bool:
        return False

    def find(self, symbol: Any, required: bool) -> Any:
        found = registered.get(symbol)
        if found is None and isinstance(symbol, Symbol) and symbol.package is not None:
            found = _find_subclass(object, {f"{name}::{symbol.name}" for name in symbol.package.names} | {symbol.name}, set())
            if found is not None:
                registered[symbol] = found
        if found is None and required:
            return PORTS.signals.error("There is no class named ~A.", printed(symbol) if is_symbol(symbol) else symbol)
        return found

    def make(self, cls: type, *initargs: Any) -> Any:
        attributes = {name: attribute for base in reversed(cls.__mro__) for name, attribute in getattr(base, "initargs", {}).items()}
        slots = {}
        for key, value in zip(initargs[::2], initargs[1::2]):
            name = symbol_name(key)
            slots.setdefault(attributes.get(name, name.replace("-", "_").lower()), value)
        return cls(**slots)

    def precedence(self, cls: type) -> tuple:
        return cls.__mro__

    def slots(self, structure: Any) -> list:
        return [(keyword(name.upper()), value) for name, value in vars(structure).items()]


class PlainTypes:
    """Names of classes, and what ``and``, ``or``, ``not``, ``member``, ``eql`` and ``satisfies`` make of them."""

    def known(self, specifier: Any) -> bool:
        if isinstance(specifier, Cons):
            return symbol_name(specifier.car) in ("AND", "OR", "NOT", "MEMBER", "EQL", "SATISFIES")
        return specifier is True or specifier is None or self._class(specifier) is not None

    def test(self, specifier: Any) -> Any:
        return self.predicate(specifier) if self.known(specifier) else None

    def declared(self, specifier: Any) -> Any:
        return self.predicate(specifier)

    def predicate(self, specifier: Any) -> Any:
        if isinstance(specifier, Cons):
            return self._compound(symbol_name(specifier.car), python_list(specifier.cdr))
        if specifier is True or specifier is None:
            return lambda thing: specifier is True
        cls = self._class(specifier)
        if cls is None:
            return PORTS.signals.error("unknown type specifier: ~S", specifier)
        return lambda thing: isinstance(thing, cls)

    def _class(self, specifier: Any) -> Any:
        return specifier if isinstance(specifier, type) else PORTS.classes.find(specifier, False)

    def _compound(self, operator: str, parts: list) -> Any:
        if operator in ("OR", "AND"):
            tests, both = [self.predicate(part) for part in parts], all if operator == "AND" else any
            return lambda thing: both(test(thing) for test in tests)
        if operator == "NOT":
            test = self.predicate(parts[0])
            return lambda thing: not test(thing)
        if operator in ("EQL", "MEMBER"):
            return lambda thing: any(thing is part or thing.__class__ is part.__class__ and thing == part for part in parts)
        return lambda thing: one(parts[0].function(thing)) is not None

    def expand(self, specifier: Any) -> Any:
        return specifier

    def simplified(self, specifier: Any) -> Any:
        return specifier

    def of(self, thing: Any) -> Any:
        return PORTS.classes.name(type(thing))


def _find_subclass(root: type, names: set, seen: set) -> Any:
    for cls in type.__subclasses__(root):
        if cls not in seen:
            seen.add(cls)
            if vars(cls).get("lisp_name") in names:
                return cls
            found = _find_subclass(cls, names, seen)
            if found is not None:
                return found
    return None


# ------------------------------------------------------------------------------------------------------------------ the others


class PlainStream:
    """One of Python's standard streams, looked up when it is written to; it knows whether it stands at the beginning of a line."""

    def __init__(self, name: str):
        self.name, self.at_line_start = name, True

    def write(self, text: str) -> None:
        write_shown(getattr(sys, self.name), text)
        if text:
            self.at_line_start = text.endswith("\n")

    def fresh_line(self) -> None:
        if not self.at_line_start:
            self.write("\n")

    def flush(self) -> None:
        getattr(sys, self.name).flush()


class PlainOutput:
    """Answers and traces go to ``sys.stdout``, warnings to ``sys.stderr``."""

    def __init__(self) -> None:
        self.streams = {
            "standard-output": PlainStream("stdout"),
            "trace-output": PlainStream("stdout"),
            "error-output": PlainStream("stderr"),
        }

    def warning(self, condition: Any) -> None:
        self.streams["error-output"].write(f"WARNING: {condition}\n")
        for line in filter(None, (getattr(condition, "where", None), getattr(condition, "hint", None))):
            self.streams["error-output"].write(f"  {line}\n")

    def designated(self, designator: Any) -> Any:
        return self.streams["standard-output"] if designator is True or designator is None else designator

    def hint(self, condition: Any) -> str | None:
        hint = getattr(condition, "hint", None)
        lines = [*(getattr(condition, "circumstances", None) or ()), hint(condition) if callable(hint) else hint]
        return "\n".join(filter(None, lines)) or None

    def stream(self, name: str) -> PlainStream:
        return self.streams[name]


class NoUser:
    """Nobody can be asked."""

    def form(self, prompt: str) -> Any:
        return PORTS.signals.error(f"{prompt}There is nobody to ask here: give the value to the restart.")

    def read(self, text: str) -> Any:
        import ast  # 2 ms, and hardly anybody reads

        return ast.literal_eval(text)

    def read_with_places(self, text: str, filename: str) -> tuple[Any, dict]:
        return None, {}

    def evaluate(self, form: Any) -> Any:
        return PORTS.signals.error("No language is started that could evaluate ~S.", form)


class NoSystems:
    """No library can be loaded."""

    def load(self, name: str) -> None:
        PORTS.signals.error(
            f"The library {name} is written in Common Lisp, which is not started: call cramhy_runtime.session.boot() first."
        )


class FreeDefinitions:
    """No package is locked, and nobody has added methods to the errors of generic functions."""

    def check_symbol(self, symbol: Any, control: str, *arguments: Any) -> None: ...

    def no_applicable_method(self, function: Any, arguments: tuple, default: Any) -> Any:
        return default(function, arguments)

    def warn(self, kind: type, control: str, *arguments: Any) -> None: ...

    def expansion_place(self) -> Any:
        return None

    def lambda_list(self, function: Any) -> Any:
        return None

    def no_next_method(self, function: Any, method: Any, arguments: tuple, default: Any) -> Any:
        return default(function, method, arguments)


if CURRENT.value is UNBOUND:
    CURRENT.value, CURRENT.special = COMMON_LISP_USER, True
PORTS.install(
    printer=PlainPrinter(),
    classes=PlainClasses(),
    types=PlainTypes(),
    output=PlainOutput(),
    user=NoUser(),
    systems=NoSystems(),
    definitions=FreeDefinitions(),
)
