"""The data of Common Lisp as Python objects.

``nil`` is ``None``, ``t`` is ``True``, a cons is a `Cons`, a symbol is an interned `Symbol`. Integers, ratios and strings are
Python's own. A double-float is Python's ``float``, as messages and poses have it; the other floats of Lisp are
in ``lisp_core/floats.py``. A function that returns several values returns one `MultipleValues`; `one` takes the first.

What is equal in Python need not be ``eql`` in Lisp (``True == 1 == 1.0``), so nothing here compares by ``==`` on behalf of
Lisp: see ``lisp_core/equality.py``.
"""

from __future__ import annotations

import warnings

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar

from .conses import (
    LONG as LONG,
    STRETCH as STRETCH,
    UNBOUND as UNBOUND,
    UNSUPPLIED as UNSUPPLIED,
    Cons as Cons,
    EmptyList as EmptyList,
    LazyRest as LazyRest,
    conses as conses,
    list_end as list_end,
    list_from as list_from,
    list_parts as list_parts,
    lisp_list as lisp_list,
    new_object as new_object,
    python_list as python_list,
)
from .floats import FLOATS as FLOATS, is_ratio as is_ratio
from .known_calls import KnownCalls
from .ports import PORTS

if TYPE_CHECKING:
    from collections.abc import Callable

    from .packages import Package

T = TypeVar("T")


class Symbol:
    """A name with a value, a function, a property list and a home package.

    ``value`` is the current dynamic value: see ``lisp_core/dynamic.py`` for how tasks keep theirs apart.
    ``function`` is always callable; that of an undefined function signals ``undefined-function``.
    """

    __slots__ = (
        "name",
        "package",
        "value",
        "function",
        "macro",
        "setf_function",
        "plist",
        "special",
        "constant",
        "compiler_data",
        "_calls",
        "__weakref__",
    )

    def __init__(self, name: str, package: Package | None = None):
        self.name = name
        self.package = package
        self.value: Any = UNBOUND
        self.function: Callable[..., Any] = UndefinedFunction(self)
        self.macro = None
        self.setf_function = None
        self.plist = None
        self.special = False
        self.constant = False
        self.compiler_data = None
        self._calls: KnownCalls | None = None

    def function_changed(self):
        """To be called after ``function`` or ``setf_function`` got another value."""
        if self._calls is not None:
            self._calls.function_changed()

    def more_known(self):
        """To be called after ``function`` or ``setf_function``, which is generic, found the methods for a call."""
        if self._calls is not None:
            self._calls.more_known()

    @property
    def calls(self) -> KnownCalls:
        """What compiled code knows of its functions."""
        if self._calls is None:
            self._calls = KnownCalls(self)
        return self._calls

    def __repr__(self) -> str:
        return f"{self.package.name}::{self.name}" if self.package else f"#:{self.name}"

    def __deepcopy__(self, memo):
        return self

    def __copy__(self):
        return self


class Keyword(Symbol):
    """A symbol of the package KEYWORD: its value is itself."""

    __slots__ = ()

    def __init__(self, name: str, package: Package | None = None):
        super().__init__(name, package)
        self.value = self
        self.constant = True

    def __eq__(self, other: object) -> bool:
        """Whether they are the same object. It warns who compares a keyword with the text of its name, which is never equal."""
        if other.__class__ is Keyword:
            return self is other
        if other.__class__ in STANDS_FOR:
            return STANDS_FOR[other.__class__](other) is self
        if isinstance(other, str) and other.lstrip(":").upper().replace("_", "-") == self.name:
            written = self.name.lower().replace("-", "_")
            warnings.warn(
                f"A keyword is no string: {self!r} == {other!r} is false. Write kw.{written}, from cramhy_runtime.prolog, "
                f"or :{self.name.lower()} in Hy.",
                RuntimeWarning,
                stacklevel=2,
            )
        return NotImplemented

    __hash__ = Symbol.__hash__

    def __repr__(self) -> str:
        return ":" + self.name


STANDS_FOR: dict[type, Callable[[Any], object]] = {}
"""A class of Python → the object of Lisp that one of its objects stands for: a keyword of Hy stands for that of Lisp."""


class UndefinedFunction:
    """What stands in the function cell of a symbol without a function: calling it is the error.

    So a call needs no test, and the error names the symbol that the user wrote.
    """

    __slots__ = ("symbol",)

    def __init__(self, symbol: Symbol):
        self.symbol = symbol

    def __call__(self, *arguments: object, **keywords: object) -> Any:
        return PORTS.signals.undefined_function(self.symbol, arguments, keywords)


class MultipleValues(tuple[Any, ...]):
    """What a form returns that returns no values, or two or more. Exactly one value is returned bare.

    To Python and Hy it is a tuple. Where it is asked whether it is true, its first value counts, as in Lisp.
    """

    __slots__ = ()

    def __bool__(self) -> bool:
        return bool(self[0]) if len(self) else False


NO_VALUES = MultipleValues()


def values(*items: object) -> Any:
    """``cl:values``: return ``items`` as the values of the calling form."""
    return items[0] if len(items) == 1 else MultipleValues(items)


def one(value: Any) -> Any:
    """The primary value: ``nil`` when there are no values."""
    if value.__class__ is MultipleValues:
        return value[0] if len(value) else None
    return value


def all_values(value: Any) -> tuple[Any, ...]:
    """All values of a form as a tuple."""
    return tuple(value) if value.__class__ is MultipleValues else (value,)


def truth(value: object) -> bool:
    """Whether ``value`` is true in Lisp: everything but ``nil``, so ``0`` and ``""`` are true; Python's ``False`` is false.

    The truth values and the arrays of other libraries answer for themselves: ``numpy.False_`` is false, and an array of several elements
    raises numpy's ValueError. All that asks for truth on behalf of plans asks here; hot code looks at `TRUE_CLASSES` first, without a call.
    """
    if value is None or value is False:
        return False
    cls = value.__class__
    return cls in TRUE_CLASSES or not _answers_for_itself(cls) or bool(value)


def _answers_for_itself(cls: type) -> bool:
    """Whether objects of ``cls`` are truth values or arrays of a library, as numpy, pandas and torch have them.

    Numbers of such libraries do not: they are true like all numbers.
    """
    answer = OWN_ANSWERS.get(cls)
    if answer is None:
        answer = (
            cls is EmptyList
            or cls in STANDS_FOR
            or hasattr(cls, "__bool__")
            and (
                cls.__name__ in ("bool", "bool_", "NAType")  # numpy.bool has another name before numpy 2; pandas.NA refuses to answer
                or hasattr(cls, "dtype")
                and hasattr(cls, "shape")
                and not any(base.__name__ == "generic" for base in cls.__mro__)
            )
        )
        if len(OWN_ANSWERS) >= 500:  # classes that nobody else keeps must not stay for ever
            OWN_ANSWERS.clear()
        OWN_ANSWERS[cls] = answer
    return answer


def plain_truth(value: Any) -> Any:
    """``value``, or Python's ``True`` or ``False`` for a truth value of another library. Lisp's own code compares with nothing else.

    For an object that stands for one of Lisp, such as a keyword of Hy, it is that one.

    An array without dimensions is one if its elements are truth values.
    """
    cls = value.__class__
    if cls in TRUE_CLASSES or value is None or not _answers_for_itself(cls) or cls is EmptyList:
        return value
    if cls in STANDS_FOR:
        return STANDS_FOR[cls](value)
    if cls.__name__ in ("bool", "bool_"):
        return bool(value)
    return bool(value) if value.shape == () and str(value.dtype).removeprefix("torch.") == "bool" else value


def boolean(flag: object) -> bool | None:
    """The Lisp truth value for a Python condition: ``True`` or ``None``."""
    return True if flag else None


class Character:
    """A character object, ``#\\a``. Interned: two characters with the same code are the same object."""

    __slots__ = ("char",)

    def __new__(cls, char):
        return CHARACTERS[char]

    @property
    def code(self):
        return ord(self.char)

    def __repr__(self):
        return f"Character({self.char!r})"

    def __reduce__(self):
        return Character, (self.char,)


class _Characters(dict):
    """One-character string → `Character`, made when it is asked for. So Python finds those of a whole text in one call of `map`."""

    def __missing__(self, char):
        found = self[char] = new_object(Character)
        found.char = char
        return found


CHARACTERS: dict[str, Character] = _Characters()
"""All characters that there are, by their one-character strings."""

OWN_ANSWERS: dict[type, bool] = {}
"""What `_answers_for_itself` found out of other classes."""


class _FormerClass(type):
    """The class of a name that means ``float`` and goes away: each use warns at its place."""

    def __call__(cls, *arguments: Any) -> float:
        cls._warn()
        return float(*arguments)

    def __instancecheck__(cls, thing: object) -> bool:
        cls._warn()
        return isinstance(thing, float)

    def _warn(cls) -> None:
        text = f"{cls.__name__} goes away in cramhy 0.2. A double-float is a float of Python: write float instead of {cls.__name__}."
        warnings.warn(text, DeprecationWarning, stacklevel=3)


class DoubleFloat(metaclass=_FormerClass):
    """The former class of double-floats, which are floats of Python now. The name goes away in version 0.2."""


TRUE_CLASSES = frozenset({bool, int, *FLOATS, complex, str, bytes, list, tuple, dict, set, Cons, Symbol, Keyword, Character})
"""Classes whose objects are true in Lisp, whatever they are, but for ``False``. See `truth`."""


class FreshString(str):
    """A simple string that was made at run time, as ``format``, ``subseq`` or ``make-string`` make it: the program may store into it.

    Until somebody does, it is a ``str`` like any other, for Python too. With the first store it becomes a `ChangedString`. ``kind`` is
    ``False`` for the element type CHARACTER; see `KindString`.
    """

    __slots__ = ("_chars",)
    kind: Any = False

    def writable(self) -> list[str]:
        """The list of the characters, to be changed in place. It keeps its length."""
        self._chars = list(self)
        self.__class__ = ChangedString
        return self._chars

    def __reduce__(self):
        return FreshString, (str(self),)


class ChangedString(FreshString):
    """A `FreshString` into which something was stored.

    Its characters are in a list. What C code of Python sees in the object (``"".join``, regular expressions) is the text of before: whoever
    hands it there asks for ``str()`` first. Methods and operators of ``str`` know the characters of now.
    """

    __slots__ = ()

    def writable(self):
        return self._chars

    def __str__(self):
        return "".join(self._chars)

    def __len__(self):
        return len(self._chars)

    def __getitem__(self, index):
        return self._chars[index] if index.__class__ is int else str(self)[index]

    def __iter__(self):
        return iter(self._chars)

    def __radd__(self, other):
        return other + str(self) if isinstance(other, str) else NotImplemented

    def __fspath__(self):
        return str(self)


def _of_now(name):
    operation = getattr(str, name)

    def method(self, *arguments, **keywords):
        arguments = [str(each) if isinstance(each, ChangedString) else each for each in arguments]
        return operation(str(self), *arguments, **keywords)

    method.__name__ = name
    return method


for _name in dir(str):
    if callable(getattr(str, _name)) and _name not in ChangedString.__dict__ and _name not in dir(object):
        setattr(ChangedString, _name, _of_now(_name))
for _name in ("__eq__", "__ne__", "__lt__", "__le__", "__gt__", "__ge__", "__hash__", "__repr__", "__format__"):
    setattr(ChangedString, _name, _of_now(_name))


class KindString(FreshString):
    """A `FreshString` whose element type is ``kind``: the symbol BASE-CHAR, or ``None`` for the type nil."""

    __slots__ = ("kind",)

    def __new__(cls, text, kind):
        made = super().__new__(cls, text)
        made.kind = kind
        return made

    def writable(self):
        self._chars = list(self)
        self.__class__ = ChangedKindString
        return self._chars

    def __reduce__(self):
        return KindString, (str(self), self.kind)


class ChangedKindString(ChangedString, KindString):
    """A `KindString` into which something was stored."""

    __slots__ = ()


class LispString:
    """A string with a fill pointer, or one that is adjustable: its length may change, so it is no ``str``.

    Literals are plain ``str``, what functions make is a `FreshString`. ``chars`` is a list, or the `SharedCharacters` of another string;
    ``kind`` is as in a `FreshString`.
    """

    __slots__ = ("chars", "fill_pointer", "adjustable", "kind")

    def __init__(self, chars="", fill_pointer=None, adjustable=False):
        self.chars = list(chars)
        self.fill_pointer = fill_pointer
        self.adjustable = adjustable
        self.kind = False

    def writable(self):
        """The list of the characters, also of those beyond the fill pointer."""
        return self.chars

    def __str__(self):
        return "".join(self.chars if self.fill_pointer is None else self.chars[: self.fill_pointer])

    def __len__(self):
        return len(self.chars) if self.fill_pointer is None else self.fill_pointer

    def __repr__(self):
        return f"LispString({str(self)!r})"

    def __eq__(self, other):
        """Equal to a text with the same characters, for Python code; Lisp does not compare by it."""
        return str(self) == str(other) if isinstance(other, (str, LispString)) else NotImplemented

    __hash__ = object.__hash__  # it can be changed, so its text is no key

    def __iter__(self):
        return iter(str(self))

    def __getitem__(self, index):
        return str(self)[index]

    def __contains__(self, text):
        return str(text) in str(self)


WRITABLE_STRINGS = frozenset((FreshString, ChangedString, KindString, ChangedKindString, LispString))
"""The classes of strings that have ``writable``."""
TEXTS = frozenset((str, FreshString, KindString))
"""The classes of strings whose characters Python's own functions see as they are."""
