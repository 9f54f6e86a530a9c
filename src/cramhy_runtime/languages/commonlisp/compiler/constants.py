"""The objects that compiled code refers to: symbols, quoted lists, standard functions.

Each gets a name (``K17``) that is a global of the code. Code that runs at once has the objects put into its globals. Code that
is kept in a file brings forms that make them again when it is loaded; an object that no form can make (a hash table inserted
by ``#.``, say) makes the file one that is compiled anew each time.
"""

from __future__ import annotations

from fractions import Fraction
from operator import attrgetter

from cramhy_runtime.lisp_core.arrays import LispArray, SimpleArray, TypedVector, Vector
from cramhy_runtime.lisp_core.catching import Case
from cramhy_runtime.lisp_core.keyword_calls import KeywordCalls
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Character, Cons, LispString, Symbol, all_values
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.packages import Package
from ..format.format_pieces import Piece
from ..numbers.complex_numbers import parts
from ..objects.class_objects import StandardObject
from ..objects.makers import Maker
from ..objects.protocol_functions import make_load_form
from ..objects.slots import NamedSlot
from ..objects.structures import StructureObject
from ..pathnames.pathname_objects import Pathname, parts_of_pathname
from ..syntax.backquote import Comma
from .core import List, expression, word
from .several_values import ValuesCalls


_WITH_PARTS = (Cons, list, SimpleArray)
_MANY = 10_000  # parts: more than most constants have, fewer than one would wait for


class NotStorable(Exception):
    """An object that no code can rebuild."""


class Constants:
    """The table of one text. ``fresh`` are the entries made since it was last asked: (name, kind, object)."""

    def __init__(self, prefix="K"):
        self.prefix = prefix
        self.names = {}
        self.alive = []  # ids are keys: the objects must live as long
        self.fresh = []
        self.made = set()
        self.cases = {}  # ids of lists of types, which the cases keep alive, and the `Case` of each
        self.statements = []
        self.count = 0

    def name(self, kind, obj):
        """The global name for ``obj``; kind is "object", or for the symbol ``obj`` the way to what is meant: "function", "setf_function",
        "function.python"."""
        key = (kind, obj if obj.__class__ is Symbol else id(obj))  # Python tells a hook of each `id`, and most are symbols
        found = self.names.get(key)
        if found is None:
            self.count += 1
            found = self.names[key] = f"{self.prefix}{self.count}"
            self.alive.append(obj)
            self.fresh.append((found, kind, obj))
        return found

    def case(self, types):
        """The global name for the `Case` of a ``handler-case`` with clauses of ``types``, a Lisp list."""
        case = self.cases.get(id(types))
        if case is None:
            case = self.cases[id(types)] = Case(types)
        return self.name("object", case)

    def own_name(self, base):
        """A global name that nothing else in the text has."""
        self.count += 1
        return f"{base}_{self.prefix}{self.count}"

    def take_objects(self):
        """name → object for the entries made since the last call."""
        fresh, self.fresh = self.fresh, []
        return {name: obj if kind == "object" else attrgetter(kind)(obj) for name, kind, obj in fresh}

    def take_forms(self):
        """Statements (core forms) that make the entries made since the last call."""
        fresh, self.fresh, self.statements = self.fresh, [], []
        for name, kind, obj in fresh:
            if name in self.made:
                continue
            if is_circular(obj):
                raise NotStorable(obj)
            value = self.builder(obj, top=True)
            if kind == "function.python":
                value = expression(word("Lpython_function"), value)
            elif kind != "object":
                for attribute in kind.split("."):
                    value = expression(word("."), value, word(attribute))
            self.make(name, value)
        self.fresh = []
        return self.statements

    def make(self, name, value):
        self.statements.append(expression(word("setv"), word(name), value))
        self.made.add(name)

    def builder(self, obj, top=False):
        """A core form that makes ``obj``. Inside a list, symbols that have a name already are referred to by it."""
        if obj is None or obj is True:
            return word("None" if obj is None else "True")
        if not top:
            known = self.names.get(("object", obj if obj.__class__ is Symbol else id(obj)))
            if known in self.made:
                return word(known)
        kind = type(obj)
        if isinstance(obj, Symbol):
            if obj.package is None:
                maker = expression(word("Lgensym"), obj.name)
                if top:
                    return maker
                name = self.name("object", obj)  # the same symbol wherever it occurs in the text
                self.make(name, maker)
                return word(name)
            return expression(word("Lintern"), obj.name, obj.package.name)
        if kind is Cons:
            items, cell = [], obj
            while isinstance(cell, Cons):
                items.append(self.builder(cell.car))
                cell = cell.cdr
            if cell is None:
                return expression(word("Llist"), *items)
            return expression(word("Ldotted"), *items, self.builder(cell))
        if isinstance(obj, (str, LispString)):
            of_characters = getattr(obj, "kind", False) is False
            return str(obj) if of_characters else expression(word("Lkind_string"), str(obj), self.builder(obj.kind))
        if kind is int:
            return obj
        if kind is float:
            return float_model(obj)
        if kind is SingleFloat:
            return expression(word("Lsingle"), float_model(float(obj)))
        if kind is Fraction:
            return expression(word("Lratio"), obj.numerator, obj.denominator)
        if isinstance(obj, complex):
            return expression(word("Lcomplex"), *map(self.builder, parts(obj)))
        if kind is Character:
            return expression(word("Lcharacter"), obj.char)
        if kind is Comma:
            return expression(word("Lcomma"), obj.kind, self.builder(obj.form))
        if kind is list:
            return List([self.builder(item) for item in obj])
        if isinstance(obj, (TypedVector, Vector)):  # the literal is simple, as it may be (ANSI 3.2.4.4)
            items = List([self.builder(item) for item in obj])
            return items if obj.element_type is True else expression(word("Ltyped_vector"), items, self.builder(obj.element_type))
        if isinstance(obj, LispArray):
            items = List([self.builder(item) for item in obj.active()])
            return expression(word("Larray"), List([*obj.dimensions]), items, self.builder(obj.element_type))
        if isinstance(obj, Pathname):
            return expression(word("Lpathname"), *map(self.builder, parts_of_pathname(obj)))
        if isinstance(obj, Package) and obj.name is not None:
            return expression(word("Lpackage"), obj.name)
        if kind is KeywordCalls:
            return expression(word("Lkeyword_calls"), self.builder(obj.symbol), obj.count, *map(self.builder, obj.keys))
        if kind is Piece:
            return expression(word("Lpiece"), obj.control, obj.index)
        if kind is Case:
            return expression(word("Lcase"), self.builder(obj.specifiers))
        if kind is NamedSlot:
            return expression(word("Lnamed_slot"), self.builder(obj.name))
        if kind is ValuesCalls:
            return expression(word("Lvalues_calls"), self.builder(obj.symbol))
        if kind is Maker:
            return expression(word("Lmaker"), self.builder(obj.name), *map(self.builder, obj.keys))
        if isinstance(obj, (StandardObject, StructureObject, Condition)) and make_load_form.user_methods:
            return self.loaded(obj)
        raise NotStorable(obj)

    def loaded(self, obj):
        """The name of an object that is made by the forms that the program's ``make-load-form`` gives (ANSI 3.2.4.4)."""
        creation, *initialization = all_values(make_load_form(obj))
        name = self.name("object", obj)
        if name not in self.made:
            self.make(name, expression(word("Levaluate"), self.builder(creation)))
            for form in initialization:
                self.statements.append(expression(word("Levaluate"), self.builder(form)))
        return word(name)


def is_circular(obj):
    """Whether the conses and arrays of a constant come back to themselves."""
    if not isinstance(obj, _WITH_PARTS) or _ends(obj):
        return False
    active, done, stack = set(), set(), [(obj, False)]
    while stack:
        item, leaving = stack.pop()
        if leaving:
            active.discard(id(item))
            done.add(id(item))
        elif isinstance(item, _WITH_PARTS) and id(item) not in done:
            if id(item) in active:
                return True
            active.add(id(item))
            stack.append((item, True))
            stack += [(part, False) for part in _parts(item)]
    return False


def _ends(obj):
    """Whether a walk through the constant ends after a few thousand parts: then it is not circular."""
    rest, steps = [obj], _MANY
    while rest and steps:
        steps -= 1
        item = rest.pop()
        if isinstance(item, _WITH_PARTS):
            rest += _parts(item)
    return not rest


def _parts(item):
    return (item.car, item.cdr) if isinstance(item, Cons) else item.storage if isinstance(item, SimpleArray) else item


def float_model(value):
    if value != value or value in (float("inf"), float("-inf")):
        return expression(word("Lfloat"), str(float(value)))
    return value
