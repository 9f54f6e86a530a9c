"""What SBCL 2.2.9 printed, and an evaluator just large enough to make the printer and ``format`` print the same.

The folder ``printing`` holds forms with the answers of SBCL (``record.lisp`` made them). The evaluator reads a form with our
reader and calls the Python functions behind the Lisp names; it knows ``let`` of specials and three macros, and nothing of the
compiler, so these tests fail only for what printing does.
"""

import json
from pathlib import Path

from cramhy_runtime.languages.commonlisp.packages import face_definition as faces
from cramhy_runtime.languages.commonlisp.collections import array_making
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Character, Cons, Keyword, Symbol, lisp_list, one, python_list
from cramhy_runtime.languages.commonlisp.format import format
from cramhy_runtime.lisp_core.packages import find_package, sym
from cramhy_runtime.languages.commonlisp.printer import pprint_dispatch, pretty, printer
from cramhy_runtime.languages.commonlisp.printer.print_controls import bound
from cramhy_runtime.languages.commonlisp.reader.reader import read_from_string
from cramhy_runtime.languages.commonlisp.streams import stream_functions

FOLDER = Path(__file__).parent / "printing"
FUNCTIONS = {
    "LIST": lisp_list,
    "VECTOR": lambda *items: list(items),
    "CODE-CHAR": lambda code: Character(chr(code)),
    "MAKE-SYMBOL": Symbol,
    **{name.upper(): faces.lispify(function) for name, function in printer.LISP_FUNCTIONS.items()},
}
for _module in (printer, format, pretty, pprint_dispatch, stream_functions):
    for _name in _module.LISP_NAMES.split():
        _python = faces.python_name(_name)
        _function = getattr(_module, _python, None) or getattr(_module, _python + "_")
        FUNCTIONS[_name.upper()] = faces.lispify(_function)

FUNCTIONS_OF_SBCL = "LIST CAR FILL + - 1+ 1- * = EVENP PRINT".split()
"""Names of functions that occur as heads of lists in the recorded forms."""


def define_names(monkeypatch):
    """Give the symbols that the forms use the functions that they have in Lisp."""
    monkeypatch.setattr(sym("MAKE-ARRAY"), "function", faces.lispify(array_making.make_array))
    for name in FUNCTIONS_OF_SBCL:
        monkeypatch.setattr(sym(name), "function", FUNCTIONS.get(name, print))
    for name in ("PPRINT-FILL",):
        monkeypatch.setattr(find_package("CL-USER").intern(name), "function", FUNCTIONS[name])


def evaluate(form):
    """The value of ``form``."""
    if isinstance(form, Keyword):
        return form
    if isinstance(form, Symbol):
        return form.value
    if not isinstance(form, Cons):
        return form
    name, arguments = form.car.name, python_list(form.cdr)
    if name == "QUOTE":
        return arguments[0]
    if name == "LET":
        pairs = [part for binding in arguments[0] or () for part in (binding.car, evaluate(binding.cdr.car))]
        with bound(*pairs):
            return _in_order(arguments[1:])
    if name == "WITH-OUTPUT-TO-STRING":
        stream = stream_functions.make_string_output_stream()
        with bound(arguments[0].car, stream):
            _in_order(arguments[1:])
        return stream.take()
    if name == "PPRINT-LOGICAL-BLOCK":
        return _logical_block(arguments[0], arguments[1:])
    return one(FUNCTIONS[name](*map(evaluate, arguments)))


def _in_order(forms):
    value = None
    for form in forms:
        value = evaluate(form)
    return value


def _logical_block(specification, body):
    stream, _, *options = specification
    given = {key.name: evaluate(value) for key, value in zip(options[::2], options[1::2])}
    prefix = given.get("PREFIX") or given.get("PER-LINE-PREFIX") or ""

    def run(out, block):
        with bound(stream, out):
            _in_order(body)

    pretty.call_logical_block(evaluate(stream), pretty.NO_OBJECT, run, prefix, given.get("SUFFIX", ""), "PER-LINE-PREFIX" in given)


def answer(text):
    """What the form ``text`` returns, as ``record.lisp`` writes it down."""
    try:
        value = evaluate(one(read_from_string(text)))
        return value if isinstance(value, str) else printer.prin1_to_string(value)
    except Condition as condition:
        return "ERROR " + printer.princ_to_string(condition)


def recorded(name):
    """The (form, answer) pairs of the file ``name``."""
    return [json.loads(line) for line in (FOLDER / f"{name}.jsonl").read_text().splitlines()]


def differences(name):
    """The recorded forms to which the answer is another one: list of (form, SBCL's answer, ours)."""
    return [(form, wanted, got) for form, wanted in recorded(name) if (got := answer(form)) != wanted]
