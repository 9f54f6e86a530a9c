"""``inspect``: walking through an object part by part, at a prompt of its own.

The parts are numbered; a number goes into a part, ``u`` back up, ``r`` shows the object again, ``q`` leaves, and any other form
is evaluated, with the object as the value of ``sb-ext:*inspected*``. Lines come from ``*query-io*``, as for other questions, so
it works on a terminal and on piped input. Source: ANSI 25.2 (INSPECT); commands and layout are those of SBCL 2.2.9.
"""

from __future__ import annotations

import itertools

from ..collections import arrays
from cramhy_runtime.lisp_core import hash_tables
from cramhy_runtime.lisp_core.arrays import dimensions
from cramhy_runtime.lisp_core.conditions import Condition, restart_case
from cramhy_runtime.lisp_core.data import NO_VALUES, UNBOUND, Cons, Symbol, UndefinedFunction, all_values, list_from
from cramhy_runtime.lisp_core.dynamic import binding, special
from ..evaluation.evaluator import evaluate
from ..evaluation.function_facts import lambda_list_of, shown_name
from ..objects.classes import class_name
from ..objects.protocol import names_of_slots
from ..objects.slots import slot_boundp, slot_value
from ..objects.structures import StructureObject
from cramhy_runtime.lisp_core.packages import Package, ensure_package, is_symbol, sym, symbol_name, symbol_package
from ..printer.printer import prin1_to_string
from cramhy_runtime.lisp_core.printing import attempt_to_print
from ..reader.reader import Reader, incomplete
from ..streams.streams import QUERY_IO, input_stream, output_stream
from .describing import public_attributes

LISP_NAMES = "inspect"
SB_EXT = ensure_package("SB-EXT")
INSPECTED = special(SB_EXT.intern("*INSPECTED*"))
SB_EXT.export(INSPECTED)
LONGEST = 10
"""How many elements of a long list are shown; the rest is one part more."""
MISSING = object()

HELP = """
help for INSPECT:
  Q, E        -  Quit the inspector.
  <integer>   -  Inspect the numbered slot.
  R           -  Redisplay current inspected object.
  U           -  Move upward/backward to previous inspected object.
  ?, H, Help  -  Show this help.
  <other>     -  Evaluate the input as an expression.
Within the inspector, the special variable SB-EXT:*INSPECTED* is bound
to the current inspected object, so that it can be referred to in
evaluated expressions.
"""


def parts(obj):
    """(title, whether the parts are named, [(label, value)]); an unbound part has the value `MISSING`."""
    if is_symbol(obj):
        return "The object is a SYMBOL.", True, _symbol_parts(obj)
    if isinstance(obj, Cons):
        return _list_parts(obj)
    if arrays.arrayp(obj):
        return _array_parts(obj)
    if isinstance(obj, hash_tables.HashTable):
        entries = [(attempt_to_print(prin1_to_string, key), value) for key, value in obj.items()]
        return f"The object is a HASH-TABLE of type {prin1_to_string(hash_tables.hash_table_test(obj))}.", True, entries
    if isinstance(obj, Package):
        entries = [
            ("Name", obj.name),
            ("Nicknames", list_from(obj.nicknames)),
            ("Use-list", list_from(obj.use)),
            ("Used-by-list", list_from(obj.used_by)),
            ("External-symbols", list_from(list(obj.external.values()))),
            ("Internal-symbols", list_from(list(obj.internal.values()))),
        ]
        return "The object is a PACKAGE.", True, entries
    if isinstance(obj, type):
        entries = [("Superclasses", list_from(obj.__bases__)), ("Subclasses", list_from(type.__subclasses__(obj)))]
        return f"The object is a CLASS named {prin1_to_string(class_name(obj))}.", True, entries
    if callable(obj):
        name = getattr(obj, "__lisp_name__", None)
        named = f" named {shown_name(name)}" if name is not None else ""
        return f"The object is a FUNCTION{named}.", True, [("Lambda-list", lambda_list_of(obj))]
    return _instance_parts(obj)


def _symbol_parts(obj):
    symbol = isinstance(obj, Symbol)
    value = obj.value if symbol else obj
    function = obj.function if symbol and not isinstance(obj.function, UndefinedFunction) else MISSING
    return [
        ("Name", symbol_name(obj)),
        ("Package", symbol_package(obj)),
        ("Value", MISSING if value is UNBOUND else value),
        ("Function", function),
        ("Plist", obj.plist if symbol else None),
    ]


def _list_parts(obj):
    cell, items = obj, []
    while isinstance(cell, Cons) and len(items) <= LONGEST:
        items.append(cell.car)
        cell = cell.cdr
    if len(items) > LONGEST:
        rest = obj
        for _ in range(LONGEST):
            rest = rest.cdr
        entries = [(str(index), item) for index, item in enumerate(items[:LONGEST])] + [("REST", rest)]
        return f"The object is a long list (more than {LONGEST} elements).", True, entries
    if cell is None:
        return f"The object is a proper list of length {len(items)}.", True, [(str(index), item) for index, item in enumerate(items)]
    if len(items) == 1:
        return "The object is a CONS.", True, [("CAR", obj.car), ("CDR", obj.cdr)]
    entries = [(str(index), item) for index, item in enumerate(items)] + [("TAIL", cell)]
    return "The object is a dotted list.", True, entries


def _array_parts(obj):
    sizes = dimensions(obj)
    if len(sizes) == 1:
        elements = [arrays.aref(obj, index) for index in range(len(obj))]
        return f"The object is a VECTOR of length {len(elements)}.", False, [("", element) for element in elements]
    indices = itertools.product(*map(range, sizes))
    entries = [(f"[{','.join(map(str, index))}] ", arrays.aref(obj, *index)) for index in indices]
    kind = prin1_to_string(arrays.array_element_type(obj))
    return f"The object is an ARRAY of {kind}.\nIts dimensions are {prin1_to_string(list_from(sizes))}.", True, entries


def _instance_parts(obj):
    names = [] if isinstance(obj, (str, int, float, complex)) else names_of_slots(obj)
    kind = prin1_to_string(class_name(type(obj)))
    if names or isinstance(obj, (StructureObject, Condition)):
        what = "STRUCTURE-OBJECT" if isinstance(obj, StructureObject) else "CONDITION" if isinstance(obj, Condition) else "STANDARD-OBJECT"
        entries = [(symbol_name(name), slot_value(obj, name) if slot_boundp(obj, name) else MISSING) for name in names]
        return f"The object is a {what} of type {kind}.", True, entries
    public = public_attributes(obj)
    if public:
        return f"The object is a {kind}." if kind != "T" else f"The object is a Python {type(obj).__qualname__}.", True, public
    return f"The object is an ATOM:\n  {attempt_to_print(prin1_to_string, obj)}", True, []


class Inspector:
    """One session of ``inspect``: the objects from the first to the current one, and where to read and write."""

    def __init__(self, obj):
        self.path = [obj]
        self.source, self.output = input_stream(QUERY_IO.value), output_stream(QUERY_IO.value)

    def write(self, text):
        self.output.write(text)
        self.output.flush()

    def show(self):
        title, named, entries = parts(self.path[-1])
        lines = ["", title]
        for index, (label, value) in enumerate(entries):
            head = f"{index}. {label}: " if named else f"{index}. "
            shown = '"unbound"' if value is MISSING else attempt_to_print(prin1_to_string, value)
            lines.append(head + shown.replace("\n", "\n" + " " * len(head)))
        self.write("\n".join(lines) + "\n")

    def run(self):
        self.show()
        while True:
            self.write("> ")
            line, ended = self.source.read_line()
            command = line.strip().upper()
            if ended and not command or command in ("Q", "E", ":Q", ":E"):
                return
            if command:
                self.carry_out(line, command)

    def carry_out(self, line, command):
        if command.isdigit():
            return self.descend(int(command))
        if command in ("U", ":U"):
            if len(self.path) == 1:
                return self.write("\nThe object is the top one.\n")
            self.path.pop()
            return self.show()
        if command in ("R", ":R"):
            return self.show()
        if command in ("?", "H", "HELP"):
            return self.write(HELP)
        while incomplete(line):
            more, ended = self.source.read_line()
            if ended and not more:
                break
            line += "\n" + more
        return restart_case([(sym("ABORT"), lambda: None, "Return to the inspector.")], lambda: self.evaluate(line))

    def descend(self, index):
        _, _, entries = parts(self.path[-1])
        if index >= len(entries):
            why = f"Enter a valid index (:0-{len(entries) - 1})." if entries else "This object has no parts to go into."
            return self.write(f"\n{why}\n")
        if entries[index][1] is MISSING:
            return self.write("\nThat slot is unbound.\n")
        self.path.append(entries[index][1])
        return self.show()

    def evaluate(self, text):
        reader, end, values = Reader(text, filename="<inspector>"), object(), ()
        with binding(INSPECTED, self.path[-1]):
            while (form := reader.read(eof_error=False, eof_value=end)) is not end:
                values = all_values(evaluate(form))
                self.output.fresh_line()
                self.write("".join(prin1_to_string(value) + "\n" for value in values))


def inspect(obj):
    """``inspect``: walk through ``obj`` at a prompt; no values."""
    Inspector(obj).run()
    return NO_VALUES
