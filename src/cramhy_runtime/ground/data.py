"""The data of Common Lisp as Python objects.

``nil`` is ``None``, ``t`` is ``True``, a cons is a `Cons`, a symbol is an interned `Symbol`. Integers, ratios and strings are
Python's own. A plain ``float`` stands for the single-float, because literals and ordinary arithmetic make singles and should
run at Python's speed; `DoubleFloat` marks the doubles that ROS messages and ``1.0d0`` give, and keeps its type through
arithmetic (contagion). A function that returns several values returns one `MultipleValues`; `one` takes the first.

What is equal in Python need not be ``eql`` in Lisp (``True == 1 == 1.0``), so nothing here compares by ``==`` on behalf of
Lisp: see ``ground/equality.py``.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from itertools import islice
from operator import index as as_index

from cramhy_runtime.kernel.active import checkpoint
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar, overload

from .ports import PORTS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from .packages import Package

T = TypeVar("T")


class _Marker:
    """A named object that is nothing but itself."""

    __slots__ = ("name",)

    def __init__(self, name):
        self.name = name

    def __repr__(self):
        return self.name


UNBOUND = _Marker("#<unbound>")
"""The value of a symbol or slot that has none."""
UNSUPPLIED = _Marker("#<unsupplied>")
"""Default of an &optional or &key parameter where ``nil`` and "not given" differ."""


STRETCH = range(256)
"""So many elements of a list a loop passes between two checkpoints: a circular list must not keep Ctrl-C from its plan."""

LONG = 20_000
"""A list of more elements is made in parts, with a checkpoint before each."""


class Classes(set):
    """A set of classes. ``last``: the one that came last, with which compiled code compares first, as that is quicker."""

    __slots__ = ("last",)

    def replace(self, classes):
        """Have ``classes``, in this order, for elements."""
        self.clear()
        self.update(classes)
        self.last = classes[-1] if classes else None


class SlotClasses(dict):
    """For the function of a symbol: attribute → the set of the classes from whose objects compiled code may take the slot itself.

    They are the classes of whose objects the function reads, or writes, just that attribute. A set is made when compiled code asks for
    it, as ``symbol.reads.of_speed``. `Symbol.function_changed` keeps the sets right, and so do generic functions.
    """

    __slots__ = ("symbol", "cell")

    def __init__(self, symbol, cell):
        self.symbol, self.cell = symbol, cell

    def __getattr__(self, name):
        if not name.startswith("of_"):
            raise AttributeError(name)
        return self[name.removeprefix("of_")]

    def __missing__(self, attribute):
        self[attribute] = Classes()
        self.refresh()
        return self[attribute]

    def refresh(self):
        """Find out anew what the function does."""
        accesses = _accesses(getattr(self.symbol, self.cell))
        for attribute, classes in self.items():
            classes.replace([cls for cls, other in accesses if other == attribute])


def _effective_functions(function, count):
    """What a call of ``function`` with ``count`` arguments calls, by the class of the first, as far as that is known and decides."""
    return dict(function.cache) if getattr(function, "by_first_of", None) == count else {}


def _accesses(function):
    """The pairs (class, attribute) for which ``function`` just reads or writes that attribute of an object of that class."""
    known = getattr(function, "__dict__", None)
    if known and "slot_of" in known and "traced" not in known:
        return ((function.slot_of, function.attribute),)
    accesses = getattr(function, "slot_accesses", None)
    return () if accesses is None else accesses()


class Symbol:
    """A name with a value, a function, a property list and a home package.

    ``value`` is the current dynamic value: see ``ground/dynamic.py`` for how tasks keep theirs apart.
    ``function`` is always callable; that of an undefined function signals ``undefined-function``.
    ``reads`` and ``writes`` tell from which objects ``function`` and ``setf_function`` just read or write an attribute (`SlotClasses`),
    ``keyed`` are the ways in which compiled code calls ``function`` with keywords (`ground.keyword_calls`). ``unary`` and ``binary`` are
    tables for calls with one and two arguments, if ``function`` is generic: the function to call, by the class of the first argument.
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
        "_reads",
        "_writes",
        "keyed",
        "_unary",
        "_binary",
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
        self._reads = self._writes = self.keyed = self._unary = self._binary = None

    def function_changed(self):
        """To be called after ``function`` or ``setf_function`` got another value."""
        self.more_known()
        if self.keyed is not None:
            for calls in self.keyed.values():
                calls.refresh()

    def more_known(self):
        """To be called after ``function`` or ``setf_function``, which is generic, found the methods for a call."""
        if self._reads is not None:
            self._reads.refresh()
        if self._writes is not None:
            self._writes.refresh()
        for count, table in ((1, self._unary), (2, self._binary)):
            if table is not None:
                table.clear()
                table.update(_effective_functions(self.function, count))

    @property
    def reads(self) -> SlotClasses:
        if self._reads is None:
            self._reads = SlotClasses(self, "function")
        return self._reads

    @property
    def writes(self) -> SlotClasses:
        if self._writes is None:
            self._writes = SlotClasses(self, "setf_function")
        return self._writes

    @property
    def unary(self) -> dict[type, Callable[..., Any]]:
        if self._unary is None:
            self._unary = _effective_functions(self.function, 1)
        return self._unary

    @property
    def binary(self) -> dict[type, Callable[..., Any]]:
        if self._binary is None:
            self._binary = _effective_functions(self.function, 2)
        return self._binary

    def __repr__(self) -> str:
        return f"{self.package.name}::{self.name}" if self.package else f"#:{self.name}"

    def __reduce__(self):
        return (_symbol_in, (self.name, self.package.name)) if self.package else (Symbol, (self.name,))


def _symbol_in(name, package):
    """What unpickling a symbol calls."""
    return PORTS.signals.intern(name, package)


class Keyword(Symbol):
    """A symbol of the package KEYWORD: its value is itself."""

    __slots__ = ()

    def __init__(self, name: str, package: Package | None = None):
        super().__init__(name, package)
        self.value = self
        self.constant = True

    def __eq__(self, other: object) -> bool:
        """Whether they are the same object. It warns who compares a keyword with the text of its name, which is never equal."""
        if self is other:
            return True
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


class UndefinedFunction:
    """What stands in the function cell of a symbol without a function: calling it is the error.

    So a call needs no test, and the error names the symbol that the user wrote.
    """

    __slots__ = ("symbol",)

    def __init__(self, symbol: Symbol):
        self.symbol = symbol

    def __call__(self, *arguments: object, **keywords: object) -> Any:
        return PORTS.signals.undefined_function(self.symbol, arguments, keywords)


class LazyRest:
    """The end of a list whose rest is not computed yet, which Python's loops have computed: see `utilities.lazy_lists`."""

    __slots__ = ()

    def computed(self) -> Any:
        """What comes in its place: a list, or ``None``."""
        raise NotImplementedError


ENDLESS = 1_000_000
"""A lazy list that has given so many elements for ``len`` alone counts as endless."""


class Cons:
    """A pair, and to Python the sequence of the elements of the list that starts here; a dotted tail ends it.

    Who iterates has the elements of a lazy list computed, one after the other; who asks for the length, all of them. A list is equal to a
    list or tuple of Python with equal elements. Lisp does not compare by that, and as a key a list is itself, since it can be changed.
    """

    __slots__ = ("car", "cdr")

    def __init__(self, car: Any, cdr: Any = None):
        self.car = car
        self.cdr = cdr

    def __iter__(self) -> Iterator[Any]:
        cell = self
        while True:
            for _ in STRETCH:
                yield cell.car
                rest = cell.cdr
                if rest.__class__ is not Cons:
                    rest = cell._computed_rest()
                    if rest is None:
                        return
                cell = rest
            checkpoint()

    def _computed_rest(self) -> Cons | None:
        rest = self.cdr
        if isinstance(rest, LazyRest):
            rest = self.cdr = rest.computed()
        return rest if isinstance(rest, Cons) else None

    # For Python code that gets a list from Lisp. A list is never empty (that is None), so it is true whatever its length.

    def __bool__(self) -> bool:
        return True

    def __len__(self) -> int:
        """The number of elements. A circular list has none, an OverflowError, and neither has a lazy one that does not end."""
        count, cell, lazy = 1, self, 0
        while True:
            for _ in STRETCH:
                rest = cell.cdr
                if rest.__class__ is not Cons:
                    rest, lazy = cell._computed_rest(), lazy + 1
                    if rest is None:
                        return count
                    if lazy > ENDLESS:
                        raise OverflowError(
                            f"This lazy list has given {ENDLESS} elements and goes on, so it has no length. "
                            "Take as many as you need: itertools.islice(answers, 10)."
                        )
                cell, count = rest, count + 1
            checkpoint()
            if count > ENDLESS > count - len(STRETCH) - 1 and isinstance(list_end(self), Cons):
                raise OverflowError("This list is circular, so it has no length.")

    def __getitem__(self, index: Any) -> Any:
        """The element at ``index``, which may be negative; a slice gives a Python list."""
        if isinstance(index, slice):
            bounds = [part for part in (index.start, index.stop) if part is not None]
            if index.stop is not None and all(part >= 0 for part in bounds) and (index.step is None or index.step > 0):
                return list(islice(self, index.start, index.stop, index.step))  # an endless list has a beginning
            return list(self)[index]
        index = as_index(index)
        if index < 0:
            return list(self)[index]
        for item in self:
            if not index:
                return item
            index -= 1
        raise IndexError("list index out of range")

    def __eq__(self, other: object) -> bool:
        kind = other.__class__
        if kind is Cons:
            return self is other or _same_lists(self, other)
        if kind is tuple or isinstance(other, list):
            theirs = iter(other)  # type: ignore[call-overload]
            for item in self:
                if not _same_elements(item, next(theirs, UNSUPPLIED)):
                    return False
            return next(theirs, UNSUPPLIED) is UNSUPPLIED and list_end(self) is None
        return NotImplemented

    __hash__ = object.__hash__

    def __reversed__(self) -> Iterator[Any]:
        return reversed(list(self))

    def index(self, value: object, start: int = 0, stop: int | None = None) -> int:
        """Where ``value`` stands, as of a list of Python; a ValueError if it does not."""
        return list(self).index(value, start, sys.maxsize if stop is None else stop)

    def count(self, value: object) -> int:
        """How often ``value`` stands in the list."""
        return list(self).count(value)

    def __repr__(self):
        parts, cell, limit = [], self, 50
        while isinstance(cell, Cons) and limit:
            parts.append(repr(cell.car) if cell.car is not None else "NIL")
            cell, limit = cell.cdr, limit - 1
        if cell is not None:
            parts += [".", "..." if isinstance(cell, Cons) else repr(cell)]
        return "(" + " ".join(parts) + ")"


Sequence.register(Cons)  # for ``match``, and for who asks whether something is a sequence
new_object = object.__new__


def _same_lists(one_list, other):
    """Whether two lists have equal elements and the same end, for Python."""
    while isinstance(one_list, Cons) and isinstance(other, Cons):
        for _ in STRETCH:
            if one_list is other:
                return True
            if not _same_elements(one_list.car, other.car):
                return False
            here, there = one_list._computed_rest(), other._computed_rest()
            if here is None or there is None:
                return one_list.cdr is other.cdr or not (here or there) and bool(one_list.cdr == other.cdr)
            one_list, other = here, there
        checkpoint()
    return False


def _same_elements(ours, theirs):
    """Whether an element of a list is equal to one of Python's; ``nil`` is the empty list, too."""
    return ours is theirs or bool(ours == theirs) or ours is None and theirs.__class__ in (list, tuple) and not theirs


@overload
def lisp_list() -> None: ...
@overload
def lisp_list(first: object, /, *more: object) -> Cons: ...
def lisp_list(*items: object) -> Cons | None:
    """The list of ``items``; ``None`` when there are none."""
    head = None
    for item in reversed(items):
        cell = new_object(Cons)
        cell.car, cell.cdr = item, head
        head = cell
    return head


def list_from(iterable: Iterable[object], tail: Any = None) -> Any:
    """The list of the elements of ``iterable``, ending in ``tail``."""
    head, items = tail, iterable if isinstance(iterable, (list, tuple)) else list(iterable)
    if len(items) > LONG:
        rest = len(items) % LONG
        for start in range(len(items) - LONG, rest - 1, -LONG):
            checkpoint()
            head = list_from(items[start : start + LONG], head)
        items = items[:rest]
    for item in reversed(items):
        cell = new_object(Cons)  # made without its constructor, which would be a call of a Python function
        cell.car, cell.cdr = item, head
        head = cell
    return head


def python_list(lst: Any) -> list[Any]:
    """The elements of the Lisp list ``lst`` as a Python list."""
    if lst.__class__ is not Cons:
        return [] if lst is None else list(_iterator(lst))
    return list_parts(lst)[0]


def _iterator(thing):
    try:
        return iter(thing)
    except TypeError:
        return PORTS.signals.type_error(thing, "LIST")


def list_parts(cell):
    """(the elements of the list ``cell`` as a Python list, what stands behind its last cons)"""
    items = []
    while True:
        for _ in STRETCH:
            if cell.__class__ is not Cons:
                return items, cell
            items.append(cell.car)
            cell = cell.cdr
        checkpoint()


def conses(lst):
    """The conses of the list ``lst``, one after the other, whatever it ends in."""
    while True:
        for _ in STRETCH:
            if lst.__class__ is not Cons:
                return
            yield lst
            lst = lst.cdr
        checkpoint()


def list_end(lst):
    """What ends the list ``lst``: ``None`` for a proper one, else the last ``cdr``; of a circular list a cons, for it has no end."""
    slow, steps = lst, 0
    while isinstance(lst, Cons):
        lst, steps = lst.cdr, steps + 1
        if not steps % 2:
            slow = slow.cdr
            if slow is lst and isinstance(lst, Cons):
                return lst
    return None if lst is False else lst


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
        answer = hasattr(cls, "__bool__") and (
            cls.__name__ in ("bool", "bool_", "NAType")  # numpy.bool has another name before numpy 2; pandas.NA refuses to answer
            or hasattr(cls, "dtype")
            and hasattr(cls, "shape")
            and not any(base.__name__ == "generic" for base in cls.__mro__)
        )
        if len(OWN_ANSWERS) >= 500:  # classes that nobody else keeps must not stay for ever
            OWN_ANSWERS.clear()
        OWN_ANSWERS[cls] = answer
    return answer


def plain_truth(value: Any) -> Any:
    """``value``, or Python's ``True`` or ``False`` for a truth value of another library. Lisp's own code compares with nothing else.

    An array without dimensions is one if its elements are truth values.
    """
    cls = value.__class__
    if cls in TRUE_CLASSES or value is None or not _answers_for_itself(cls):
        return value
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

TRUE_CLASSES = frozenset({bool, int, float, complex, str, bytes, list, tuple, dict, set, Cons, Symbol, Keyword, Character})
"""Classes whose objects are true in Lisp, whatever they are, but for ``False``. See `truth`."""
OWN_ANSWERS: dict[type, bool] = {}
"""What `_answers_for_itself` found out of other classes."""


def is_ratio(thing: object) -> bool:
    """Whether ``thing`` is a ratio, which is a `Fraction` of Python.

    There are ratios only where somebody has imported ``fractions``. The rooms that plans need do not: its import takes a tenth of theirs.
    `isinstance` would ask the abstract class of `Fraction`, which is slow.
    """
    fractions = sys.modules.get("fractions")
    return fractions is not None and fractions.Fraction in thing.__class__.__mro__


class DoubleFloat(float):
    """A double-float: ``5.0d0``. Arithmetic with any real gives a double again; see ANSI 12.1.4.4 (float contagion)."""

    __slots__ = ()

    def __repr__(self):
        return float.__repr__(self) + "d0"

    def __reduce__(self):
        return DoubleFloat, (float(self),)


def _keep_double(name):
    operation = getattr(float, name)

    def method(self, other):
        result = operation(self, other)
        if result is NotImplemented:
            return DoubleFloat(operation(self, float(other))) if is_ratio(other) else result
        return DoubleFloat(result)

    method.__name__ = name
    return method


for _name in ("add", "radd", "sub", "rsub", "mul", "rmul", "truediv", "rtruediv"):
    setattr(DoubleFloat, f"__{_name}__", _keep_double(f"__{_name}__"))
DoubleFloat.__neg__ = lambda self: DoubleFloat(float.__neg__(self))
DoubleFloat.__pos__ = lambda self: self
DoubleFloat.__abs__ = lambda self: DoubleFloat(float.__abs__(self))


class FreshString(str):
    """A simple string that was made at run time, as ``format``, ``subseq`` or ``make-string`` make it: the program may store into it.

    Until somebody does, it is a ``str`` like any other, for Python too. With the first store it becomes a `ChangedString`.
    """

    __slots__ = ("_chars",)

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
        arguments = [str(each) if each.__class__ is ChangedString else each for each in arguments]
        return operation(str(self), *arguments, **keywords)

    method.__name__ = name
    return method


for _name in dir(str):
    if callable(getattr(str, _name)) and _name not in ChangedString.__dict__ and _name not in dir(object):
        setattr(ChangedString, _name, _of_now(_name))
for _name in ("__eq__", "__ne__", "__lt__", "__le__", "__gt__", "__ge__", "__hash__", "__repr__", "__format__"):
    setattr(ChangedString, _name, _of_now(_name))


class LispString:
    """A string with a fill pointer, or one that is adjustable: its length may change, so it is no ``str``.

    Literals are plain ``str``, what functions make is a `FreshString`.
    """

    __slots__ = ("chars", "fill_pointer", "adjustable")

    def __init__(self, chars="", fill_pointer=None, adjustable=False):
        self.chars = list(chars)
        self.fill_pointer = fill_pointer
        self.adjustable = adjustable

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


WRITABLE_STRINGS = frozenset((FreshString, ChangedString, LispString))
"""The classes of strings that have ``writable``."""
TEXTS = frozenset((str, FreshString))
"""The classes of strings whose characters Python's own functions see as they are."""
