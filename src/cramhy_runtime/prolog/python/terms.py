"""Terms in Python's notation: ``P.parent("tom", V.who)`` is the goal ``(parent "tom" ?who)``.

* ``V.who`` is the variable ``?who``, and ``V._`` the one that matches anything. ``V.A`` and ``V.a`` are two variables.
* ``P.parent`` is the name ``parent``. A call of it makes a goal; among arguments it stands for the symbol. Names of built-in
  predicates stand for these (``P.member``, ``P.findall``, ``P.not_``). Others are symbols of the package PYTHON-USER, so Lisp code can
  write ``python-user:parent``, and ``python-user:|Parent|`` for ``P.Parent``, which is another name. ``names("TUT")`` gives the names of
  another package.
* ``kw.driving`` is the keyword ``:driving``, the object itself. A Python string is a string, and equal to no name. Keywords are shared with
  Lisp, which does not see case: ``kw.Driving`` is an error.
* A list or tuple is a list, ``[V.first, *V.rest]`` one whose rest is a variable. ``None``, ``False`` and ``[]`` are one term, as Lisp
  has one object for them, ``nil``. They come back to Python as they went in. ``True`` is ``t``, and neither 1 nor 1.0.
* In a goal or a fact, a set, a range, a view of a dict, a deque and an array are lists, too; equal sets are the same list. An iterator
  and a dict in the place of a list are refused. A predicate or function that is written in Python gets such objects as they are.
* A function is a symbol with that function, so rules and ``perform`` can call it. Any other object, also a named tuple, stands for
  itself. Two terms with such objects are the same if the objects are values of one class and equal (dates, paths, bytes, frozen
  dataclasses), or if they are one object.

``&``, ``|`` and ``~`` combine goals, and ``<``, ``>``, ``<=`` and ``>=`` compare numbers. As with fluents, ``==`` asks whether two things
are the same object, and ``and``, ``or``, ``not`` are errors. Python sees lists of Lisp as Python lists (`to_python`).
"""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from collections import deque
from types import BuiltinFunctionType, FunctionType, GeneratorType, MethodType
from cramhy_runtime.kernel.typing_names import Any, NoReturn, Self, annotations_of

from cramhy_runtime.lisp_core.data import STANDS_FOR, WRITABLE_STRINGS, Character, Cons, EmptyList, Keyword, Symbol, list_from
from cramhy_runtime.lisp_core.python_names import attribute_symbols, hy_name
from cramhy_runtime.lisp_core.packages import KEYWORD, Package, ensure_package, named_package, near_names, package_names, printed
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import CURRENT
from cramhy_runtime.utilities.lazy_lists import force_ll, lazy_list_p
from cramhy_runtime.utilities.patterns import ANONYMOUS, NOTHING, Inserted
from .ground import reasoning
from .spelling import exact_lisp_name, lisp_name, other_case, python_name
from ..symbols import sym

USER: Package = ensure_package("PYTHON-USER")
"""The package of the names that Python code makes."""

_CALLS = {sym("CRAM-PROLOG::LISP-FUN"): sym("CRAMHY::PYTHON-FUNCTION"), sym("CRAM-PROLOG::LISP-PRED"): sym("CRAMHY::PYTHON-TEST")}
_FUNCTIONS = (FunctionType, BuiltinFunctionType, MethodType, functools.partial)


class Goal:
    """A goal, or the head of a rule. A call of a name makes it, or an operator. ``form`` is the Lisp data."""

    __slots__ = ("form",)

    def __init__(self, form: Cons):
        self.form = form

    def __and__(self, other: Goal) -> Goal:
        return _joined("AND", self, other)

    def __or__(self, other: Goal) -> Goal:
        return _joined("OR", self, other)

    def __invert__(self) -> Goal:
        return Goal(list_from([sym("NOT"), self.form]))

    def __bool__(self) -> NoReturn:
        raise TypeError(
            f"The goal {self!r} was asked whether it is true, by if, while, and, or, not, or a comparison like 1 < x < 3. "
            "Ask holds(goal) for that; goal & goal, goal | goal, ~goal combine goals."
        )

    def __repr__(self) -> str:
        return show(self.form)


def _joined(operator: str, first: Goal, second: Any) -> Goal:
    if not isinstance(second, Goal):
        raise TypeError(f"{second!r} cannot be joined to the goal {first}: it is no goal.{_hint_about(second)}")
    functor = sym(operator)
    parts = list(first.form.cdr) if first.form.car is functor else [first.form]
    return Goal(Cons(functor, list_from(parts + [second.form])))


def goal_form(goal: Any) -> Cons:
    """The Lisp data of ``goal``. Anything but a goal is a TypeError that says what to write."""
    if isinstance(goal, Goal):
        return goal.form
    if isinstance(goal, Cons):
        return goal
    raise TypeError(f"{goal!r} is no goal.{_hint_about(goal)}")


def _hint_about(thing: Any) -> str:
    if isinstance(thing, bool):
        return ' (== compares objects, at once; P["=="](a, b) is the goal that makes terms the same.)'
    if isinstance(thing, Name):
        return f" Call it with its arguments: {thing.python_name}(...)."
    return ' A goal is a name with arguments: P.parent(V.x, "tom").'


class Variable:
    """A variable of Prolog, such as ``V.who``. The same name always gives the same object."""

    __slots__ = ("symbol",)

    def __init__(self, symbol: Symbol):
        self.symbol = symbol

    @property
    def name(self) -> str:
        """Its Python name, which is also the name of the attribute in an answer."""
        return python_name(self.symbol.name[1:])

    def __iter__(self) -> Iterator[Tail]:
        """For ``[first, *V.rest]``: the variable as the rest of a list, or of the arguments of a goal."""
        return iter((Tail(self),))

    def __lt__(self, other: object) -> Goal:
        return make_goal(sym("<"), (self, other))

    def __gt__(self, other: object) -> Goal:
        return make_goal(sym(">"), (self, other))

    def __le__(self, other: object) -> Goal:
        return make_goal(sym("<="), (self, other))

    def __ge__(self, other: object) -> Goal:
        return make_goal(sym(">="), (self, other))

    def __bool__(self) -> NoReturn:
        raise TypeError(f"The variable {self!r} was asked whether it is true. It has a value in an answer only.")

    def __repr__(self) -> str:
        return other_case(self.symbol.name)

    def __format__(self, how: str) -> NoReturn:
        raise TypeError(
            f"The variable {self!r} stands in a text, by an f-string or by format: f'... {{V.{self.name}}} ...'. It has no value yet, "
            "so the text would have its name. Make the text in a @function, which is called with the value. To show the variable itself, "
            f"write {{V.{self.name}!r}}."
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return variable_of, (self.symbol,)

    def __copy__(self) -> Variable:
        return self

    def __deepcopy__(self, memo: object) -> Variable:
        return self


class Tail:
    """The rest of a list that ends in ``rest``: a variable (``*V.rest``), or, in an answer, the end of a dotted list."""

    __slots__ = ("rest",)

    def __init__(self, rest: object):
        self.rest = rest

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Tail) and bool(self.rest == other.rest)

    def __hash__(self) -> int:
        return hash((Tail, self.rest))

    def __repr__(self) -> str:
        return f"*{self.rest!r}"


class Variables:
    """``V``: its attributes are variables. It has no others, so a variable may have any name."""

    __slots__ = ()

    def __getattr__(self, name: str) -> Variable:
        if name.startswith("__"):
            raise AttributeError(name)
        return variable_of(ANONYMOUS if name == "_" else USER.intern("?" + exact_lisp_name(name)))

    def __reduce__(self) -> str:
        return "V"


_variables: dict[Symbol, Variable] = {}


def variable_of(symbol: Symbol) -> Variable:
    """The variable of a symbol of Lisp. Variables of symbols without a package are not remembered."""
    if symbol.package is None:
        return Variable(symbol)
    found = _variables.get(symbol)
    if found is None:
        found = _variables[symbol] = Variable(symbol)
    return found


V = Variables()


class Name:
    """A name of a predicate, or a symbol as a value. It is equal to its symbol, and answers contain symbols."""

    __slots__ = ("symbol",)

    def __init__(self, symbol: Symbol):
        self.symbol = symbol

    @property
    def python_name(self) -> str:
        """The name as Python writes it, such as ``lisp_fun``."""
        return python_name(self.symbol.name)

    def __call__(self, *arguments: object) -> Goal:
        return make_goal(self.symbol, arguments)

    def __eq__(self, other: object) -> bool:
        return self.symbol is (other.symbol if isinstance(other, Name) else other)

    def __hash__(self) -> int:
        return hash(self.symbol)

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: object) -> Self:
        return self

    def __repr__(self) -> str:
        return show(self.symbol)


class Names:
    """The names of a Lisp package as attributes. Items, such as ``["*->"]``, are the names that Python cannot write."""

    def __init__(self, package: Package):
        self._package = package

    def __getattr__(self, name: str) -> Name:
        if name.startswith("__"):
            raise AttributeError(name)
        exact = exact_lisp_name(name)
        symbol, status = self._package.lookup(exact)
        if status:
            return Name(symbol)
        capitals = exact != exact.upper()
        known = () if capitals or self._package is USER else attribute_symbols(self._package, name)
        if known:
            return Name(known[0])
        if capitals and self._package is not USER:
            raise AttributeError(
                f"The name {name!r} has capitals, and those of the Lisp package {self._package.name} are in small letters in Python: "
                f"names({self._package.name!r}).{name.lower()}.",
                name=name,
                obj=self,
            )
        return self._name(exact)

    def __getitem__(self, name: str) -> Name:
        return self._name(name.upper())

    def _name(self, lisp_name: str) -> Name:
        symbol = self._package.intern(lisp_name)
        if self._package is USER and symbol.package is USER:
            USER.export(symbol)
        return Name(symbol)

    def __repr__(self) -> str:
        return f"<names of {self._package.name}>"


class Keywords:
    """``kw``: its attributes are keywords."""

    def __getattr__(self, name: str) -> Keyword:
        if name.startswith("__"):
            raise AttributeError(name)
        name = hy_name(name)
        if name != name.lower():
            raise AttributeError(_CAPITALS.format(f"kw.{name}", f"kw.{name.lower()}"), name=name, obj=self)
        return self[lisp_name(name)]

    def __getitem__(self, name: str) -> Keyword:
        if name != name.lower() and name != name.upper():
            raise KeyError(_CAPITALS.format(f"kw[{name!r}]", f"kw[{name.lower()!r}]"))
        found: Keyword = KEYWORD.intern(name.upper())
        return found

    def __reduce__(self) -> str:
        return "kw"


_CAPITALS = "{} has capitals. Keywords of Lisp do not differ by case, so that all of Python's are written in small letters: {}."

P = Names(USER)
kw = Keywords()


def names(package: str) -> Names:
    """The names of the Lisp package ``package``: ``names("TUT").drive``. If there is no such package, it is a LookupError."""
    with reasoning():
        found = named_package(package.upper())
    if found is None:
        near = near_names(package.upper(), [name for name in package_names() if name != package.upper()], 1)
        hint = f"Did you mean {near[0]!r}?" if near else "Load the system that defines it first: import my_package."
        raise LookupError(f"There is no Lisp package {package.upper()!r}. {hint}")
    return Names(found)


def import_predicates(*symbols: Any) -> None:
    """Give ``P`` these symbols under their names. If Python code has used such a name already, it keeps its own symbol, with a warning."""
    for symbol in symbols:
        known = USER.external.get(symbol.name)
        if known is None:
            USER.import_symbol(symbol)
            USER.export(symbol)
        elif known is not symbol:
            warnings.warn(
                f"P.{python_name(symbol.name)} was used before the module that has the predicate {printed(symbol).lower()} was "
                "imported, and stays another name. Import cramhy_runtime.designators and cramhy_runtime.process_modules first.",
                stacklevel=2,
            )


_owners: dict[Symbol, str] = {}


def claim(symbol: Symbol, function: Any, kind: str) -> None:
    """Note that ``function`` defines ``symbol``, a ``kind``. If a function of another module did so before, warn at the place of this."""
    module = getattr(function, "__module__", "")
    before = _owners.get(symbol, module)
    _owners[symbol] = module
    code = getattr(function, "__code__", None)
    if before != module and code is not None:
        warnings.warn_explicit(
            f"The {kind} {python_name(symbol.name)} of the module {module} replaces that of {before}: names are global "
            "in Prolog. Give one of them another: name=P.another_name.",
            RuntimeWarning,
            code.co_filename,
            code.co_firstlineno,
        )


# ------------------------------------------------------------------------------------------------------------ to Lisp and back


def make_goal(functor: Symbol, arguments: tuple[object, ...]) -> Goal:
    """The goal of ``functor`` with ``arguments``, which are converted to Lisp data.

    A Python callable as the function of ``lisp-fun`` or ``lisp-pred`` is called as Python calls it: its exceptions are raised. An error
    in a function of Lisp is a warning, and the goal fails.
    """
    if functor in _CALLS and arguments and callable(arguments[0]) and not isinstance(arguments[0], Name):
        return Goal(Cons(_CALLS[functor], Cons(arguments[0], _lisp_list(arguments[1:], False, NOTHING))))
    if gets_objects(functor):
        return Goal(Cons(functor, _lisp_list(arguments, False, NOTHING)))
    if functor in _OF_LISTS:
        for argument in arguments:
            _refuse_dict(functor, argument)
    return Goal(Cons(functor, _lisp_list(arguments, True, NOTHING)))


def gets_objects(functor: Symbol) -> bool:
    """Whether the arguments of a goal of ``functor`` are those of a function of Python, which gets collections as they are."""
    return functor in _CALLS or functor in python_predicates


def list_argument(functor: Symbol | None, thing: Any) -> Any:
    """The Lisp data for ``thing`` as an argument of ``functor``: a collection of Python is a list. What cannot be one is a TypeError."""
    if functor in _OF_LISTS:
        _refuse_dict(functor, thing)
    return to_lisp(thing, True)


def _refuse_dict(functor: Symbol | None, thing: object) -> None:
    if thing.__class__ is dict and functor is not None:
        raise TypeError(
            f"The goal {python_name(functor.name)} is about lists, and a dict is none: {shortened(thing)}. "
            "Write list(d) for its keys, list(d.values()) for its values, or list(d.items())."
        )


python_predicates: set[Symbol] = set()
"""The names of predicates written in Python."""


def collection(thing: Any) -> Any:
    """The Lisp list for a collection of Python's in a goal, or ``thing`` itself if it is none."""
    if isinstance(thing, (set, frozenset)):
        try:
            return _lisp_list(sorted(thing), True, NOTHING)
        except TypeError:
            return _lisp_list(sorted(thing, key=lambda each: (type(each).__name__, repr(each))), True, NOTHING)
    kind = thing.__class__
    if kind in _COLLECTIONS:
        return _lisp_list(list(thing), True, NOTHING)
    if hasattr(kind, "tolist") and kind is not memoryview:  # an array of numpy, torch, or the module array; a column of pandas
        return to_lisp(thing.tolist(), True, NOTHING)
    if kind.__module__ in ("builtins", "itertools") and hasattr(kind, "__next__"):
        raise TypeError(
            f"A goal has {'a generator' if kind is GeneratorType else 'an iterator'} for an argument: {thing!r}. It can be read once only, "
            "and a goal may be asked again. Write list(...) around it."
        )
    return thing


def shortened(thing: object) -> str:
    """How ``thing`` is written, on one line of a message."""
    text = repr(thing)
    return text if len(text) <= 60 else text[:57] + "..."


_COLLECTIONS: tuple[type, ...] = (range, type({}.keys()), type({}.values()), type({}.items()), deque)
_OF_LISTS = {sym(f"CRAM-PROLOG::{name}") for name in ("MEMBER", "LENGTH", "APPEND", "NTH", "TAKE")}


def to_lisp(thing: Any, collections: bool = False, nothing: Any = None) -> Any:
    """The Lisp data for a Python term; see the head of this module. collections: sets, ranges, arrays and the like become lists.

    nothing: what stands for None, ``nil`` or `NOTHING`, which comes back as None.
    """
    kind = thing.__class__
    if kind is str or kind is int or kind is float or kind is bool:
        return thing
    if thing is None:
        if nothing is not None:
            Inserted.nothing = True
        return nothing
    if kind is list or kind is tuple or kind is EmptyList:
        return _lisp_list(thing, collections, nothing)
    if isinstance(thing, (Variable, Name)):
        return thing.symbol
    if kind is Goal:
        return thing.form
    if kind is Tail:
        raise TypeError(f"{thing!r} stands for the rest of a list: [first, *V.rest], P.f(first, *V.rest).")
    if isinstance(thing, _FUNCTIONS):
        return function_symbol(thing)
    if kind.__module__ == "numpy" and getattr(thing, "shape", None) == () and hasattr(thing, "item"):
        return to_lisp(thing.item(), nothing=nothing)  # a number of numpy's is the number
    if kind in STANDS_FOR:
        return STANDS_FOR[kind](thing)
    return collection(thing) if collections else thing


def _lisp_list(items: Any, collections: bool = False, nothing: Any = None) -> Any:
    end = None
    if items and items[-1].__class__ is Tail:
        items, end = items[:-1], to_lisp(items[-1].rest)
    return list_from([to_lisp(item, collections, nothing) for item in items], end)


def to_python(thing: Any, empty: Any = None) -> Any:
    """The Python data for Lisp data: Python lists, `Variable` objects and ``str``. For nil it is ``empty``; ``list`` means ``[]``."""
    kind = thing.__class__
    if thing is None:
        return [] if empty is list else empty
    if thing is NOTHING:
        return None
    if kind is Cons:
        return _python_list(thing, empty)
    if isinstance(thing, Symbol):
        if thing.name[:1] == "?":
            return variable_of(thing)
        return getattr(thing.function, "called_from_lisp", thing)
    if kind in WRITABLE_STRINGS:
        return str(thing)
    if kind is Character:
        return thing.char
    return thing


def _python_list(lst: Cons, empty: Any) -> list[Any]:
    if lazy_list_p(lst):
        with reasoning():
            force_ll(lst)
    items, cell = [], lst
    while cell.__class__ is Cons:
        items.append(to_python(cell.car, empty))
        cell = cell.cdr
    if cell is not None:
        items.append(Tail(to_python(cell)))
    return items


def function_symbol(function: Callable[..., Any]) -> Symbol:
    """A symbol whose function is ``function``: the same symbol each time, if the function can remember it."""
    known = getattr(function, "__dict__", None)
    found = known.get("__lisp_symbol__") if known is not None else None
    if found is None:
        named = getattr(function, "func", function)  # what a partial calls
        found = Symbol(lisp_name(getattr(named, "__name__", "function")))
        found.function = _LispFunction(function)
        if isinstance(function, (FunctionType, functools.partial)):
            function.__dict__["__lisp_symbol__"] = found
        elif isinstance(function, BuiltinFunctionType):
            found = _builtins.setdefault(function, found)
    assert isinstance(found, Symbol)
    return found


_builtins: dict[Any, Symbol] = {}


class _LispFunction:
    """A Python function for Lisp code. It is called with Lisp data, which it converts for the function."""

    __slots__ = ("called_from_lisp", "nothing")

    symbol_of = staticmethod(function_symbol)

    def __init__(self, function: Callable[..., Any]):
        self.called_from_lisp = function
        self.nothing = what_nil_means(function, None)

    def __call__(self, *arguments: Any) -> Any:
        return self.called_from_lisp(*python_arguments(arguments, self.nothing, None))


def what_nil_means(function: Any, default: Any) -> list[Any]:
    """The value of each parameter of ``function`` for nil, by its annotation: False for ``bool``, ``[]`` for ``list``, or ``default``."""
    code = getattr(function, "__code__", None)
    if code is None:
        return []
    annotations = annotations_of(function)
    return [nil_as(annotations[name], default) if name in annotations else default for name in code.co_varnames[: code.co_argcount]]


def nil_as(annotation: Any, default: Any) -> Any:
    """The value for nil where ``annotation``, a type or its text, is expected; ``list`` stands for a new empty list."""
    text = annotation if isinstance(annotation, str) else getattr(annotation, "__name__", str(annotation))
    if text == "bool":
        return False
    if text.partition("[")[0] in ("list", "List", "Sequence", "Iterable"):
        return list
    return None if text in ("int", "float", "str") or "None" in text or "Optional" in text else default


def python_arguments(arguments: Any, nothing: list[Any], default: Any) -> list[Any]:
    """The Python arguments for ``arguments``, which are Lisp data. ``nothing`` has the value for nil for each, see `what_nil_means`."""
    if not nothing:
        return [to_python(argument, default) for argument in arguments]
    return [
        to_python(argument, nothing[index] if index < len(nothing) else default) if argument is None else to_python(argument, default)
        for index, argument in enumerate(arguments)
    ]


# ---------------------------------------------------------------------------------------------------------------------- text


@contextmanager
def in_python_names() -> Iterator[None]:
    """Print symbols within the block as in the package PYTHON-USER, so that names of Python code have no package."""
    with reasoning(), binding(CURRENT, USER):
        yield


def show(form: Any) -> str:
    """Lisp data as text for Python programmers: in small letters, without packages, and with objects as Python shows them."""
    if isinstance(form, Cons):
        parts, cell, limit = [], form, 30
        while cell.__class__ is Cons and limit:
            parts.append(show(cell.car))
            cell, limit = cell.cdr, limit - 1
        if cell.__class__ is Cons:
            parts.append("...")
        elif cell is not None:
            parts += [".", show(cell)]
        return f"({' '.join(parts)})"
    if form is None or form is NOTHING or form is False:
        return "nil"
    if form is True:
        return "t"
    if isinstance(form, Keyword):
        return ":" + form.name.lower()
    if isinstance(form, Symbol):
        return other_case(form.name)
    if isinstance(form, str):
        return '"' + form.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return repr(form)
