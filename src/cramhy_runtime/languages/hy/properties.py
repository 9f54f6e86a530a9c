"""The names of properties where Hy code writes them: ``max_speed`` and ``:max-speed`` are one.

Hy sees no difference between dashes and underscores in names, and a designator of Python code has its ``max_speed`` as ``:max-speed``. To
Lisp they are two keywords. So the keys in designators, in goals ``desig-prop``, in ``with-desig-props`` and in ``desig-prop-value`` have
dashes. Other keywords, such as the fields of messages, stay as they are written.
"""

from __future__ import annotations

from hy import models

from .lisp_data import DESIGNATORS, is_call_of

_NESTED = frozenset((*map(str.lower, DESIGNATORS), "the", "some"))
_GOALS = frozenset(("desig-prop", "desig:desig-prop", "cram-designators:desig-prop"))
_SEQUENCES = (models.Expression, models.List, models.Tuple)
_FUNCTIONS = {"DESIG-PROP-VALUE": 1, "DESIG-PROP-VALUES": 1}
"""The functions that take the key of a property, and the place of that argument."""


def key(model):
    """The key of a property with dashes; a variable, or what is no name, as it is."""
    if isinstance(model, models.Keyword):
        return models.Keyword(_dashes(model.name)).replace(model)
    if isinstance(model, models.Symbol) and not str(model).startswith(("?", "_", "*", "+")):
        return models.Symbol(_dashes(str(model))).replace(model)
    return model


def _dashes(name):
    return name[0] + name[1:].replace("_", "-") if name else name


def in_designator(arguments):
    """The parts of a designator, ``(a type pair...)``, with the keys of its pairs, and of designators in it, as `key` has them."""
    return [*arguments[:1], *map(_pair, arguments[1:])]


def _pair(model):
    if not isinstance(model, _SEQUENCES) or not len(model):
        return model
    return _like(model, [key(model[0]), *map(_value, model[1:])])


def _value(model):
    if not isinstance(model, _SEQUENCES) or not len(model):
        return model
    if isinstance(model[0], models.Symbol) and str(model[0]).rpartition(":")[2] in _NESTED and isinstance(model, models.Expression):
        return _like(model, [model[0], *in_designator(model[1:])])
    return _like(model, list(map(_value, model)))


def in_goal(model):
    """A goal in which the property of each ``desig-prop`` consists of keywords: ``(desig-prop ?d (max_speed ?s))``."""
    if not isinstance(model, _SEQUENCES) or not len(model):
        return model
    if str(model[0]) in _GOALS and len(model) == 3 and isinstance(model[2], _SEQUENCES):
        words = [_as_keyword(part) for part in model[2]]
        return _like(model, [model[0], model[1], _like(model[2], [*map(key, words[:1]), *words[1:]])])
    if is_call_of("unquote", model) or is_call_of("unquote-splice", model):
        return model
    return _like(model, list(map(in_goal, model)))


def _as_keyword(part):
    """A word of a property as a keyword; a variable stays."""
    if isinstance(part, models.Symbol) and not str(part).startswith(("?", "_")) and str(part) not in ("None", "True", "False", "nil", "t"):
        return models.Keyword(str(part)).replace(part)
    return part


def in_call(name, arguments):
    """The arguments of a call of our function ``name``, a name of Lisp, with the keys among them as `key` has them."""
    place = _FUNCTIONS.get(name)
    arguments = list(arguments)
    if place is not None and len(arguments) > place:
        arguments[place] = _quoted(arguments[place], key)
    elif name == "MAKE-DESIGNATOR" and len(arguments) > 1:
        arguments[1] = _quoted(
            arguments[1], lambda pairs: _like(pairs, list(map(_pair, pairs))) if isinstance(pairs, _SEQUENCES) else pairs
        )
    elif name == "PROLOG" and arguments:
        arguments[0] = _quoted(arguments[0], in_goal)
    return arguments


def _quoted(model, change):
    """``model`` with what it quotes changed, or itself if it is a keyword."""
    if is_call_of("quote", model) or is_call_of("quasiquote", model):
        return _like(model, [model[0], change(model[1])])
    return change(model) if isinstance(model, models.Keyword) else model


def _like(model, parts):
    return type(model)(parts).replace(model)
