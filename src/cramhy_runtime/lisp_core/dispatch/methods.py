"""Methods: their specializers, the shape of their lambda lists, and when they apply.

A method knows its qualifiers, one specializer per required parameter (a class or ``(eql value)``), and its function. What a
lambda list says about calls (how many arguments, which keywords) is a `Shape`; methods and generic functions must agree in it
(ANSI 7.6.4). How methods are called is described in ``generic_functions.py``.
"""

from __future__ import annotations

from ..classes import BigInteger, find_class_or_error
from ..condition_types import Condition
from ..data import Cons, Keyword, Symbol, lisp_list, list_from, python_list
from ..equality import eql_key
from ..packages import keyword, sym, symbol_name


class EqlSpecializer:
    """``(eql value)``: interned, so equal specializers are the same object."""

    _interned: dict = {}
    lisp_name = "SB-MOP::EQL-SPECIALIZER"

    def __new__(cls, value):
        key = eql_key(value)
        found = cls._interned.get(key)
        if found is None:
            found = super().__new__(cls)
            found.value, found.key = value, key
            cls._interned[key] = found
        return found


class Shape:
    """What the lambda list of a generic function or method says about calls: counts and keywords."""

    __slots__ = ("required", "optional", "rest", "has_keys", "keys", "allow_other_keys", "names")

    def __init__(self, lambda_list=None):
        self.required = self.optional = 0
        self.rest = self.has_keys = self.allow_other_keys = False
        self.keys, self.names = [], []
        state = "required"
        for item in shape_items(lambda_list):
            name = item.name if isinstance(item, Symbol) else ""
            if name == "&OPTIONAL":
                state = "optional"
            elif name in ("&REST", "&BODY"):
                self.rest, state = True, "rest"
            elif name == "&KEY":
                self.has_keys, state = True, "key"
            elif name == "&ALLOW-OTHER-KEYS":
                self.allow_other_keys = True
            elif name == "&AUX":
                break
            elif state == "required":
                self.required += 1
                self.names.append(item.car if isinstance(item, Cons) else item)
            elif state == "optional":
                self.optional += 1
            elif state == "key":
                self.keys.append(_key_name(item))

    @property
    def maximum(self):
        return None if self.rest or self.has_keys else self.required + self.optional

    def agrees_with(self, other):
        """Whether a method of shape ``other`` fits a generic function of this shape (ANSI 7.6.4)."""
        return (
            self.required == other.required
            and self.optional == other.optional
            and (self.rest or self.has_keys) == (other.rest or other.has_keys)
            and not self.keys_unknown_to(other)
        )

    def keys_unknown_to(self, other):
        """The keywords of this generic function that a method of shape ``other`` does not take."""
        takes_all = other.allow_other_keys or (other.rest and not other.has_keys)
        return [] if takes_all else [key for key in self.keys if key not in other.keys]


def shape_items(lambda_list):
    """The items of a lambda list, a Lisp list or the text of a Python room."""
    if isinstance(lambda_list, str):  # "(object &key name)", as Python rooms write it
        return [sym(word.upper()) if word.startswith("&") else Symbol(word.upper()) for word in lambda_list.strip("()").split()]
    return python_list(lambda_list)


def _key_name(item):
    if isinstance(item, Cons):
        item = item.car
    if isinstance(item, Cons):
        return item.car
    return item if isinstance(item, Keyword) else keyword(symbol_name(item))


class MethodObject:
    """METHOD: the root of the classes of methods."""

    lisp_name = "METHOD"


class Method(MethodObject):
    """One method. ``specializers`` are classes and `EqlSpecializer`; ``per_class``: ``function`` makes the function per classes."""

    lisp_name = "STANDARD-METHOD"

    def __init__(self, generic_function, qualifiers, specializers, function, uses_next, shape, per_class=False, documentation=None):
        self.generic_function = generic_function
        self.qualifiers, self.specializers, self.function = qualifiers, specializers, function
        self.uses_next, self.shape, self.per_class, self.documentation = uses_next, shape, per_class, documentation

    metafunction = None
    """The function of a method that was made by ``make-instance``: of a list of arguments and one of next methods."""

    def lisp_init(self, qualifiers=None, lambda_list=None, specializers=None, function=None, documentation=None):
        """What ``make-instance`` does: a method that belongs to no generic function."""

        def run(following, *arguments):
            return function(list_from(arguments), None if following.exists is None else lisp_list(following))

        shape = Shape(lambda_list)
        Method.__init__(
            self, None, tuple(python_list(qualifiers)), python_list(specializers), run, True, shape, documentation=documentation
        )
        self.metafunction = function

    def applies(self, mros, keys):
        """Whether the method is applicable to arguments with these class precedence lists and eql keys."""
        for specializer, mro, key in zip(self.specializers, mros, keys):
            if specializer is object:
                continue
            if specializer.__class__ is EqlSpecializer:
                if specializer.key != key or specializer.key.__class__ is not key.__class__:
                    return False
            elif specializer not in mro:
                return False
        return True

    def rank(self, mros, order):
        """A key that sorts the more specific method first."""
        return tuple(-1 if self.specializers[i].__class__ is EqlSpecializer else mros[i].index(self.specializers[i]) for i in order)

    def callable_for(self, classes):
        return self.function(classes) if self.per_class else self.function


class AccessorMethod(Method):
    """A method that was made for a slot, ``slot_definition``."""

    lisp_name = "SB-MOP::STANDARD-ACCESSOR-METHOD"
    slot_definition: object = None


class ReaderMethod(AccessorMethod):
    lisp_name = "SB-MOP::STANDARD-READER-METHOD"


class WriterMethod(AccessorMethod):
    lisp_name = "SB-MOP::STANDARD-WRITER-METHOD"


class ConditionClass(type):
    """The class of the classes of conditions, as SBCL has it. For Python these have other metaclasses."""

    lisp_name = "SB-PCL::CONDITION-CLASS"


def class_for_dispatch(argument):
    """The class that methods are chosen by: Python's own, but that integers beyond the fixnums have one of their own."""
    if argument.__class__ is int:
        return int if -(2**62) <= argument < 2**62 else BigInteger
    return type(None) if argument is False else argument.__class__


def class_by_value(argument):
    """The same where a method `is_told_by_value`: classes of conditions have a class of their own."""
    if isinstance(argument, type) and issubclass(argument, Condition):
        return ConditionClass
    return class_for_dispatch(argument)


def is_told_by_value(specializer):
    """Whether objects are instances of ``specializer`` by more than their Python class: integers by their size, classes of conditions."""
    return specializer is ConditionClass or getattr(specializer, "lisp_name", None) in ("FIXNUM", "BIGNUM")


def may_be_told_by_value(cls):
    """Whether an object of the Python class ``cls`` may be one that `is_told_by_value`."""
    return cls is int or issubclass(cls, type)


def specializer_of(designator):
    """The specializer that a class, a class name, ``(eql value)`` with its value, or an `EqlSpecializer` stands for."""
    if designator is True or designator is object:
        return object
    if isinstance(designator, (EqlSpecializer, type)):
        return designator
    if isinstance(designator, Cons) and designator.car is sym("EQL"):
        return EqlSpecializer(designator.cdr.car)
    return find_class_or_error(designator)


def generic_lambda_list(lambda_list):
    """The lambda list of a method without specializers and defaults, and with no particular keywords."""
    result, keys = [], False
    for item in python_list(lambda_list):
        name = item.name if isinstance(item, Symbol) else ""
        if name == "&AUX":
            break
        if not keys:
            result.append(item.car if isinstance(item, Cons) else item)
        keys = keys or name == "&KEY"
    return list_from(result)
