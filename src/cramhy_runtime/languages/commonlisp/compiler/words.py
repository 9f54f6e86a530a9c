"""Words of the generated code that many parts of the generator write, and tests of classes."""

from __future__ import annotations

from .core import Symbol, expression, word
from .declared_types import GREATEST_FIXNUM, LEAST_FIXNUM

INT_CLASS, FLOAT_CLASS, SINGLE_CLASS = word("Lint"), word("Lfloat"), word("Lsingle")
CLASS, CLASSES = word("__class__"), word("Lc")
IS, IS_NOT, AND, OR, IF, DOT, SETX = map(word, "is is-not and or if . setx".split())


def class_of(model):
    return expression(DOT, model, CLASS)


def nameable(model):
    """Whether ``model`` may be evaluated twice: a name or a number."""
    return model.__class__ in (Symbol, int, float)


def fixnum_test(model):
    """A test that ``model``, an integer, is a fixnum."""
    return expression(word("<="), LEAST_FIXNUM, model, GREATEST_FIXNUM)
