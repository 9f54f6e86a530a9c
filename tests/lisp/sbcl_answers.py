"""What SBCL 2.2.9 answered, and an evaluator just large enough to ask the runtime's functions the same questions.

The folder ``sbcl`` holds forms with the answers that SBCL printed (``record.lisp`` made them). The evaluator here reads a form
with our reader, calls the Python functions by their Lisp names and prints with our printer; it knows a handful of special
forms and nothing of the compiler, so these tests fail only for what the functions do.
"""

import importlib
import operator
from functools import reduce
from pathlib import Path

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.languages.commonlisp.packages import face_definition as faces
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, all_values, list_from, one, truth
from cramhy_runtime.lisp_core.packages import find_package
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.reader.reader import read_from_string

MODULES = """lisp_core.functions lisp_core.equality collections.lists collections.list_search collections.sequences
    collections.sequence_mapping collections.sequence_search collections.sequence_change collections.sequence_sort
    collections.strings collections.characters collections.arrays collections.array_making lisp_core.hash_tables""".split()
FOLDER = Path(__file__).parent / "sbcl"


def _chain(relation):
    def compare(*numbers):
        for number in numbers:
            if not isinstance(number, (int, float)) or number is True:
                conditions.type_error(number, "NUMBER" if relation is operator.eq else "REAL")
        return True if all(map(relation, numbers, numbers[1:])) else None

    return compare


FUNCTIONS = {
    "+": lambda *numbers: sum(numbers),
    "-": lambda *numbers: reduce(operator.sub, numbers) if numbers[1:] else -numbers[0],
    "*": lambda *numbers: reduce(operator.mul, numbers, 1),
    "1+": lambda number: number + 1,
    "1-": lambda number: number - 1,
    "=": _chain(operator.eq),
    "<": _chain(operator.lt),
    ">": _chain(operator.gt),
    "EVENP": lambda number: True if number % 2 == 0 else None,
    "ODDP": lambda number: True if number % 2 else None,
    "NUMBERP": lambda thing: True if isinstance(thing, (int, float)) and thing is not True else None,
    "SYMBOLP": lambda thing: True if isinstance(thing, Symbol) else None,
    "GENSYM": lambda: Symbol("G"),
    "EXPT": operator.pow,
    "MOD": operator.mod,
    "ABS": abs,
}
SETTERS = {}
for _module in MODULES:
    _module = importlib.import_module(
        ("cramhy_runtime." if _module.startswith("lisp_core.") else "cramhy_runtime.languages.commonlisp.") + _module
    )
    for _name in _module.LISP_NAMES.split():
        _function = getattr(_module, faces.python_name(_name), None) or getattr(_module, faces.python_name(_name) + "_")
        FUNCTIONS[_name.upper()] = faces.lispify(_function)
    SETTERS.update(getattr(_module, "SETTERS", {}))


def evaluate(form, variables):
    """The values of ``form``; ``variables`` maps names to values."""
    if isinstance(form, Symbol) and not isinstance(form, Keyword):
        return variables[form.name]
    if not isinstance(form, Cons):
        return form
    name, arguments = form.car.name, list(form.cdr or ())
    if name == "QUOTE":
        return arguments[0]
    if name == "FUNCTION":
        return function(arguments[0], variables)
    if name == "LAMBDA":
        return function(form, variables)
    if name in ("LET", "LET*"):
        inner = dict(variables)
        for binding in arguments[0] or ():
            inner[binding.car.name] = one(evaluate(binding.cdr.car, inner))
        return sequence(arguments[1:], inner)
    if name == "PROGN":
        return sequence(arguments, variables)
    if name == "IF":
        return evaluate(arguments[1 if truth(one(evaluate(arguments[0], variables))) else 2], variables)
    if name == "MULTIPLE-VALUE-LIST":
        return list_from(all_values(evaluate(arguments[0], variables)))
    if name in ("SETF", "SETQ"):
        return assign(*arguments, variables)
    return function(form.car, variables)(*[one(evaluate(argument, variables)) for argument in arguments])


def sequence(forms, variables):
    value = None
    for form in forms:
        value = evaluate(form, variables)
    return value


def function(name, variables):
    if isinstance(name, Symbol):
        return FUNCTIONS[name.name] if name.name in FUNCTIONS else name.function
    parameters, body = [parameter.name for parameter in name.cdr.car or ()], name.cdr.cdr

    def closure(*arguments):
        return sequence(body, {**variables, **dict(zip(parameters, arguments, strict=True))})

    return closure


def assign(place, form, variables):
    value = one(evaluate(form, variables))
    if isinstance(place, Symbol):
        variables[place.name] = value
        return value
    return SETTERS[place.car.name](value, *[one(evaluate(argument, variables)) for argument in place.cdr])


def line(text):
    return " ".join(text.split())


def answer(text):
    """What we answer to the form in ``text``, written as in the files."""
    kernel.start(clock="virtual")
    for name, value in FUNCTIONS.items():  # functions are given by name too: (sort list '<)
        symbol = find_package("COMMON-LISP").intern(name)
        if symbol.function.__class__.__name__ == "UndefinedFunction":
            symbol.function = value
    try:
        values = all_values(evaluate(one(read_from_string(text)), {}))
    except conditions.Error as condition:
        return f"!! {condition.lisp_name.rpartition(':')[2]} {line(condition.report())}"
    return ("=> " + " ; ".join(line(prin1_to_string(value)) for value in values)).rstrip()


def recorded(name):
    """The (form, answer) pairs of the file ``name``."""
    lines = [text for text in (FOLDER / name).read_text().splitlines() if text and not text.startswith(";")]
    return list(zip(lines[::2], [text.rstrip() for text in lines[1::2]], strict=True))
