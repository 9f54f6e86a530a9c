"""``subtypep``: is every object of one type also of another?

The answer is yes, no, or unknown (second value ``nil``), the last for ``satisfies`` and for types that are not defined. Unions
and intersections are taken apart, finite types are tested element by element, numeric types are compared by kind and range,
array types by kind, element type and dimensions, all other names by their classes. Source: ANSI SUBTYPEP; checked against SBCL.
"""

from __future__ import annotations

from ..data import Cons, MultipleValues, Symbol, lisp_list, list_from
from ..objects.builtin_classes import BuiltInClass, lisp_mro
from ..objects.classes import class_name, symbol_class
from ..packages import is_symbol, sym
from .types import bounds, expand_type, is_known_type, is_star, same_specifier, typep

_DEFINED_AS = {
    "LIST": "(OR CONS NULL)", "SEQUENCE": "(OR CONS NULL VECTOR)", "NUMBER": "(OR REAL COMPLEX)",
    "BOOLEAN": "(MEMBER T NIL)", "NULL": "(MEMBER NIL)", "CHARACTER": "(OR BASE-CHAR EXTENDED-CHAR)",
}
_NUMERIC = {  # kinds of numbers, by name: (the leaf kinds it consists of, low, high)
    "INTEGER": (("INTEGER",), None, None), "RATIO": (("RATIO",), None, None), "RATIONAL": (("INTEGER", "RATIO"), None, None),
    "SINGLE-FLOAT": (("SINGLE",), None, None), "SHORT-FLOAT": (("SINGLE",), None, None),
    "DOUBLE-FLOAT": (("DOUBLE",), None, None), "LONG-FLOAT": (("DOUBLE",), None, None),
    "FLOAT": (("SINGLE", "DOUBLE"), None, None), "REAL": (("INTEGER", "RATIO", "SINGLE", "DOUBLE"), None, None),
    "BIT": (("INTEGER",), 0, 1), "FIXNUM": (("INTEGER",), -(2 ** 62), 2 ** 62 - 1), "UNSIGNED-BYTE": (("INTEGER",), 0, None),
    "SIGNED-BYTE": (("INTEGER",), None, None),
}
_ARRAYS = {"ARRAY": (False, False, None), "SIMPLE-ARRAY": (True, False, None), "VECTOR": (False, True, None),
           "SIMPLE-VECTOR": (True, True, True), "STRING": (False, True, "CHARACTER"), "SIMPLE-STRING": (True, True, "CHARACTER"),
           "BASE-STRING": (False, True, "BASE-CHAR"), "SIMPLE-BASE-STRING": (True, True, "BASE-CHAR"),
           "BIT-VECTOR": (False, True, "BIT"), "SIMPLE-BIT-VECTOR": (True, True, "BIT")}
_PARENTS = {"KEYWORD": "SYMBOL", "BASE-CHAR": "CHARACTER", "STANDARD-CHAR": "BASE-CHAR", "EXTENDED-CHAR": "CHARACTER",
            "COMPILED-FUNCTION": "FUNCTION", "STANDARD-GENERIC-FUNCTION": "GENERIC-FUNCTION", "GENERIC-FUNCTION": "FUNCTION"}
_CLASSES = {**{name: "INTEGER" for name in ("UNSIGNED-BYTE", "SIGNED-BYTE", "MOD", "BIT")}, "SHORT-FLOAT": "SINGLE-FLOAT",
            "LONG-FLOAT": "DOUBLE-FLOAT", "BASE-STRING": "STRING", "SIMPLE-BASE-STRING": "SIMPLE-STRING"}
"""Types without a class → the least class that contains them."""


def subtypep(type_1, type_2, environment=None):
    """``cl:subtypep``: two values, whether it is so, and whether that is certain."""
    answer = _subtype(_name_of(type_1), _name_of(type_2))
    return MultipleValues((True if answer else None, None if answer is None else True))


def _name_of(specifier):
    return class_name(specifier) if isinstance(specifier, type) else specifier


def _parts(specifier):
    """(name, arguments) of a specifier whose deftypes are expanded."""
    if isinstance(specifier, Cons):
        return (specifier.car.name if isinstance(specifier.car, Symbol) else ""), list(specifier.cdr or ())
    return (specifier.name if isinstance(specifier, Symbol) and specifier.package is _CL else ""), []


_CL = sym("CAR").package


def _all(answers):
    """Three-valued "and"."""
    unknown = False
    for answer in answers:
        if answer is False:
            return False
        unknown = unknown or answer is None
    return None if unknown else True


def _any(answers):
    """Three-valued "or"."""
    unknown = False
    for answer in answers:
        if answer:
            return True
        unknown = unknown or answer is None
    return None if unknown else False


def _plain(specifier):
    """A specifier whose deftype is expanded, with ATOM as a complement; complements of complements and compounds are resolved."""
    specifier = expand_type(_name_of(specifier))
    name, arguments = _parts(specifier)
    if name == "ATOM":
        return lisp_list(sym("NOT"), sym("CONS"))
    if name != "NOT" or len(arguments) != 1:
        return specifier
    inner = _plain(arguments[0])
    if inner is None or inner is True:
        return True if inner is None else None
    inner_name, parts = _parts(inner)
    if inner_name == "NOT":
        return _plain(parts[0])
    if inner_name in ("OR", "AND"):
        return _compound("AND" if inner_name == "OR" else "OR", [lisp_list(sym("NOT"), part) for part in parts])
    return lisp_list(sym("NOT"), inner)


def _compound(operator, parts):
    return parts[0] if len(parts) == 1 else list_from([sym(operator), *parts])


def _subtype(first, second):
    first, second = _plain(first), _plain(second)
    if first is None or second is True or (is_symbol(first) and first is second) or is_star(second):
        return True
    if isinstance(first, Cons) and isinstance(second, Cons) and same_specifier(first, second):
        return True
    if second is None:
        inhabited = _inhabited(first)
        return None if inhabited is None else not inhabited
    if not is_known_type(first) or not is_known_type(second):
        return None
    name, arguments = _parts(first)
    other, others = _parts(second)
    if name == "AND" and not arguments:
        return _subtype(True, second)
    if name == "OR":
        return _all(_subtype(argument, second) for argument in arguments)
    if other == "AND":
        return _all(_subtype(first, argument) for argument in others)
    if name in ("MEMBER", "EQL"):
        return all(typep(argument, second) for argument in arguments)
    if other == "NOT":
        return _subtype(others[0], arguments[0]) if name == "NOT" else _disjoint(first, others[0])
    if other == "OR":
        answer = _any(_subtype(first, argument) for argument in others)
        if not answer and first is True:
            answer = _covers_all(others) or answer
        return answer if answer else _subtype_of_union(first, name, arguments, second, answer)
    if name == "AND":
        return _intersection_within(first, arguments, second)
    if name == "SATISFIES" or other == "SATISFIES":
        return None
    if first is True:
        return False
    return _compare(first, name, arguments, second, other, others)


def _covers_all(parts):
    """Whether a union is everything: one of its ``parts`` is the complement of what others contain."""
    for part in parts:
        name, arguments = _parts(_plain(part))
        rest = [other for other in parts if other is not part]
        if name == "NOT" and rest and _subtype(arguments[0], _compound("OR", rest)):
            return True
    return False


def _intersection_within(first, arguments, second):
    """Whether the intersection of the types ``arguments``, which ``first`` is, lies in ``second``: its parts are taken one by one."""
    if second is not None and _any(_subtype(argument, second) for argument in arguments):
        return True
    types = [_plain(argument) for argument in arguments]
    for index, part in enumerate(types):
        name, its_arguments = _parts(part)
        others = [*types[:index], *types[index + 1:]]
        if name == "AND":
            return _subtype(_compound("AND", [*its_arguments, *others]), second)
        if name in ("MEMBER", "EQL"):
            return None if "SATISFIES" in map(_head, others) else all(
                typep(member, second) for member in its_arguments if all(typep(member, other) for other in others))
        alternatives = _alternatives(name, its_arguments)
        if alternatives:
            return _all(_subtype(_compound("AND", [alternative, *others]), second) for alternative in alternatives)
    if any(_disjoint(one, other) for index, one in enumerate(types) for other in types[index + 1:]):
        return True
    ranges = [_numeric(*_parts(part)) for part in types]
    if len(types) > 1 and all(limits is not None and limits[0] == ("INTEGER",) for limits in ranges):
        low = max((limits[1] for limits in ranges if limits[1] is not None), default=sym("*"))
        high = min((limits[3] for limits in ranges if limits[3] is not None), default=sym("*"))
        return _subtype(lisp_list(sym("INTEGER"), low, high), second)
    if second is None:
        return None
    return False if _inhabited(first) and any(_disjoint(part, second) for part in types) else None


def _head(specifier):
    return _parts(specifier)[0]


def _alternatives(name, arguments):
    """The types that a union, or a name of one, consists of; ``None`` for other types."""
    if name == "OR":
        return arguments
    definition = _definition(name, arguments)
    if definition is not None:
        head, rest = _parts(definition)
        return rest if head == "OR" else [definition]
    numeric = _numeric(name, arguments)
    if numeric is None or len(numeric[0]) < 2:
        return None
    names = {"INTEGER": "INTEGER", "RATIO": "RATIO", "SINGLE": "SINGLE-FLOAT", "DOUBLE": "DOUBLE-FLOAT"}
    limits = arguments if name in ("RATIONAL", "REAL", "FLOAT") else []
    return [lisp_list(sym(names[kind]), *limits) if limits and kind != "RATIO" else sym(names[kind]) for kind in numeric[0]]


def _subtype_of_union(first, name, arguments, second, answer):
    # The union may cover the type although no part of it does: take the type apart.
    alternatives = _alternatives(name, arguments)
    return _all(_subtype(part, second) for part in alternatives) if alternatives else answer


def _definition(name, arguments):
    text = _DEFINED_AS.get(name) if not arguments else None
    if text is None:
        return None
    head, *rest = text.strip("()").split()
    return list_from([sym(head), *(None if part == "NIL" else True if part == "T" else sym(part) for part in rest)])


def _compare(first, name, arguments, second, other, others):
    numeric, other_numeric = _numeric(name, arguments), _numeric(other, others)
    if numeric is not None and other_numeric is not None:
        return _range_within(numeric, other_numeric)
    if name in _ARRAYS and other in _ARRAYS:
        return _array_within(name, arguments, other, others)
    if name == "CONS" and other == "CONS":
        return _all(_subtype(a, b) for a, b in zip(_cons_parts(arguments), _cons_parts(others)))
    if name == "NOT":  # the complement of a type lies in a named type only if that is nearly everything
        return None if isinstance(second, Cons) else False
    if other == "NOT":
        return None
    for specifier, its_name, its_arguments in ((first, name, arguments),):
        definition = _definition(its_name, its_arguments)
        if definition is not None and not _class_answer(specifier, second):
            return _subtype(definition, second)
    if other in ("MEMBER", "EQL"):
        return _few_within(numeric, others)
    if name == "BIGNUM" and other_numeric is not None:  # bignums have both signs and no bounds
        return _subtype(sym("INTEGER"), second)
    if others and other not in ("CONS",) and other not in _ARRAYS and other_numeric is None:
        return False if other == "COMPLEX" and _class_answer(first, sym(other)) is False else None
    definition = _definition(other, others)
    answer = _class_answer(first, second)
    if not answer and definition is not None and other not in ("LIST", "NULL"):
        return _subtype(first, definition)
    if answer and others:
        return None if name != other else False
    return answer


def _few_within(numeric, members):
    """Whether a type that is no MEMBER type lies within the objects ``members``: only a range of a few integers can."""
    if numeric is None or numeric[0] != ("INTEGER",) or numeric[1] is None or numeric[3] is None or numeric[3] - numeric[1] > len(members):
        return False
    return all(any(number.__class__ is int and number == member for member in members) for number in range(numeric[1], numeric[3] + 1))


def _cons_parts(arguments):
    return [True if is_star(argument) else argument for argument in [*arguments, True, True][:2]]


def _class_answer(first, second):
    """Whether the class that ``first`` names is a subclass of that of ``second``; ``None`` when one names no class."""
    name, _ = _parts(first)
    other, _ = _parts(second)
    while name in _PARENTS:
        if name == other:
            return True
        name = _PARENTS[name]
        if name == other:
            return True
        first = sym(name)
    if other in _PARENTS:
        return False
    one_class = symbol_class(sym(_CLASSES.get(name, name)) if name else first)
    other_class = symbol_class(sym(_CLASSES.get(other, other)) if other else second)
    if one_class is None or other_class is None:
        return None
    if other_class in lisp_mro(one_class) or issubclass(one_class, other_class):
        return True
    return False


def _numeric(name, arguments):
    """(leaf kinds, low, low exclusive, high, high exclusive) of a numeric type; ``None`` for others."""
    if name == "MOD":
        return ("INTEGER",), 0, False, arguments[0] - 1, False
    if name in ("UNSIGNED-BYTE", "SIGNED-BYTE") and arguments and not is_star(arguments[0]):
        signed = name == "SIGNED-BYTE"
        limit = 2 ** (arguments[0] - (1 if signed else 0))
        return ("INTEGER",), -limit if signed else 0, False, limit - 1, False
    if name not in _NUMERIC:
        return None
    kinds, low, high = _NUMERIC[name]
    if not arguments:
        return kinds, low, False, high, False
    low, above, high, below = bounds(arguments, None)
    if kinds == ("INTEGER",):
        low, above = (low + 1 if above else low, False) if low is not None else (None, False)
        high, below = (high - 1 if below else high, False) if high is not None else (None, False)
    return kinds, low, above, high, below


def _range_within(first, second):
    if not set(first[0]) <= set(second[0]):
        return False
    low, above, other_low, other_above = first[1], first[2], second[1], second[2]
    high, below, other_high, other_below = first[3], first[4], second[3], second[4]
    if low is not None and high is not None and low > high:
        return True
    if other_low is not None and (low is None or low < other_low or (low == other_low and other_above and not above)):
        return False
    if other_high is not None and (high is None or high > other_high or (high == other_high and other_below and not below)):
        return False
    return True


def _array_parts(name, arguments):
    """(simple, rank or dimensions, element type or None) of an array type."""
    from ..collections.element_types import upgraded_element_type

    simple, vector, element = _ARRAYS[name]
    shape = None
    if element is not None:
        element = True if element is True else sym(element)
        if arguments and not is_star(arguments[0]):
            shape = [arguments[0]]
    else:
        if arguments and not is_star(arguments[0]):
            element = upgraded_element_type(arguments[0])
        if len(arguments) > 1 and not is_star(arguments[1]):
            size = arguments[1]
            shape = [size] if vector else [sym("*")] * size if isinstance(size, int) else list(size or ())
    if vector and shape is None:
        shape = [sym("*")]
    return simple, shape, element


def _array_within(name, arguments, other, others):
    simple, shape, element = _array_parts(name, arguments)
    other_simple, other_shape, other_element = _array_parts(other, others)
    if other_simple and not simple:
        return False
    if other_element is not None and (element is None or not same_specifier(element, other_element)):
        if not (element is sym("BASE-CHAR") and other in ("STRING", "SIMPLE-STRING")):  # strings are of any characters
            return False
    if other_shape is None:
        return True
    if shape is None or len(shape) != len(other_shape):
        return False
    return all(is_star(wanted) or wanted == given for given, wanted in zip(shape, other_shape))


def _disjoint(first, second):
    """Whether no object is of both types."""
    first, second = _plain(first), _plain(second)
    name, arguments = _parts(first)
    other, others = _parts(second)
    if name in ("MEMBER", "EQL"):
        return not any(typep(argument, second) for argument in arguments)
    if other in ("MEMBER", "EQL"):
        return not any(typep(argument, first) for argument in others)
    if name == "OR":
        return _all(_disjoint(argument, second) for argument in arguments)
    if other == "OR":
        return _all(_disjoint(first, argument) for argument in others)
    if _definition(name, arguments) is not None:
        return _disjoint(_definition(name, arguments), second)
    if _definition(other, others) is not None:
        return _disjoint(first, _definition(other, others))
    if name == "NOT" or other == "NOT":
        return _subtype(second, arguments[0]) if name == "NOT" else _subtype(first, others[0])
    if name == "AND" or other == "AND":
        pairs = [(part, second) for part in arguments] if name == "AND" else [(first, part) for part in others]
        return True if any(_disjoint(*pair) for pair in pairs) else None
    if "SATISFIES" in (name, other):
        return None
    numeric, other_numeric = _numeric(name, arguments), _numeric(other, others)
    if numeric is not None and other_numeric is not None:
        if not set(numeric[0]) & set(other_numeric[0]):
            return True
        low = max((limit for limit in (numeric[1], other_numeric[1]) if limit is not None), default=None)
        high = min((limit for limit in (numeric[3], other_numeric[3]) if limit is not None), default=None)
        return True if low is not None and high is not None and low > high else False
    if _class_answer(first, second) is False and _class_answer(second, first) is False:
        # A system class and one that is not related to it have no common instances; two of users may get a common subclass.
        both = [symbol_class(sym(_CLASSES.get(part, part)) if part else specifier) for part, specifier in ((name, first), (other, second))]
        return True if any(isinstance(cls, BuiltInClass) or name in _PARENTS for cls in both) else None
    return False


def _inhabited(specifier):
    """Whether there are objects of the type; ``None`` when that cannot be told."""
    specifier = _plain(specifier)
    name, arguments = _parts(specifier)
    numeric = _numeric(name, arguments)
    if numeric is not None and numeric[1] is not None and numeric[3] is not None:
        return numeric[1] <= numeric[3]
    if name == "OR":
        return _any(_inhabited(argument) for argument in arguments)
    if name == "AND" and len(arguments) == 2 and _parts(arguments[1])[0] == "NOT":
        inner = _subtype(arguments[0], arguments[1].cdr.car)
        return None if inner is None else not inner
    if name == "AND":
        empty = _intersection_within(specifier, arguments, None)
        return None if empty is None else not empty
    return None if name in ("SATISFIES", "NOT") else specifier is not None
