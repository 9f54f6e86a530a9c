"""``describe``: what is known about an object, laid out as SBCL lays it out.

``describe-object`` is a generic function, so users and the runtime's rooms say what is worth knowing about their own classes.
The methods here are for what Common Lisp has itself. A `Description` collects lines; everything that is printed into one is
cut or folded at the right margin, 72 columns unless ``*print-right-margin*`` says otherwise. Derived types of functions, which
SBCL's compiler knows, are not shown. Source: ANSI 25.1 (DESCRIBE); the layout is that of SBCL 2.2.9.
"""

from __future__ import annotations

from contextlib import contextmanager

from ...operators import operator_of
from ...operators.declaration import hy_shape
from ..collections import arrays
from cramhy_runtime.lisp_core import hash_tables
from ..collections.characters import char_name
from cramhy_runtime.lisp_core.arrays import is_simple
from cramhy_runtime.lisp_core.data import (
    NO_VALUES,
    UNBOUND,
    Character,
    Cons,
    Keyword,
    LispString,
    Symbol,
    UndefinedFunction,
    list_end,
    list_from,
)
from cramhy_runtime.lisp_core.dynamic import binding
from ..evaluation.forms import SPECIAL_OPERATORS
from ..evaluation.function_facts import lambda_list_of, plain, position_of, shown_name
from cramhy_runtime.lisp_core.source_places import describe as place_text
from ..pathnames.pathnames import pathname_directory, pathname_name, pathname_type
from ..objects.builtin_classes import CLASSES, BuiltInClass, lisp_mro
from ..objects.class_objects import direct_slots, effective_slots
from ..objects.classes import class_name, class_of, metaclass_of, symbol_class
from ..printer.clos_printing import specializer_names
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from ..objects.protocol import names_of_slots
from cramhy_runtime.lisp_core.dispatch.generic_functions import protocol_function
from ..objects.slots import slot_boundp, slot_value
from ..objects.structures import StructureObject
from cramhy_runtime.lisp_core.packages import KEYWORD, Package, is_symbol, sym, symbol_name
from ..printer.print_controls import PACKAGE, PRINT_GENSYM, PRINT_LINES, PRINT_RIGHT_MARGIN
from ..printer.printer import prin1_to_string
from cramhy_runtime.lisp_core.printing import not_ending
from ..streams.streams import Stream, StringOutputStream, output_stream
from ..types import types
from .documentation import shown_documentation

LISP_NAMES = "describe describe-object"
FUNCTION, TYPE, VARIABLE, SETF, T = sym("FUNCTION"), sym("TYPE"), sym("VARIABLE"), sym("SETF"), True


class Description:
    """Lines that describe something, written to ``stream``, each at the current indentation."""

    def __init__(self, stream):
        self.stream, self.indentation = stream, 0

    def line(self, text=""):
        self.stream.write((" " * self.indentation + text if text else "") + "\n")

    @contextmanager
    def indented(self, columns=2):
        self.indentation += columns
        yield
        self.indentation -= columns

    def header(self, text, kind):
        self.stream.fresh_line()
        self.line(text)
        self.line(f"  [{kind}]")

    def value(self, label, obj):
        """``label: obj``, the object printed over as many lines as it needs, all under the first."""
        column = self.indentation + len(label) + 2
        with binding(PRINT_RIGHT_MARGIN, max(20, margin() - column)):
            first, *rest = prin1_to_string(obj).split("\n")
        self.line(f"{label}: {first}")
        with self.indented(len(label) + 2):
            for text in rest:
                self.line(text)

    def lambda_list(self, lambda_list):
        if lambda_list is None:
            self.line("Lambda-list: ()")
        else:
            with binding(PRINT_GENSYM, None):
                self.value("Lambda-list", lambda_list)

    def items(self, label, texts):
        """``label: a, b, c``, folded at the margin."""
        texts = list(texts)
        line, first = f"{label}: ", True
        for index, text in enumerate(texts):
            more = text + ("," if index < len(texts) - 1 else "")
            if not first and self.indentation + len(line) + 1 + len(more) > margin():
                self.line(line)
                line, first = " " * (len(label) + 2), True
            line += more if first else " " + more
            first = False
        self.line(line)

    def documentation(self, text, columns=2):
        if text:
            import inspect  # 5 ms, for who describes something

            self.line("Documentation:")
            with self.indented(columns):
                for line in inspect.cleandoc(str(text)).replace("``", "").splitlines():
                    self.line(line)


def margin():
    """The column where lines end: ``*print-right-margin*``, or 72."""
    return PRINT_RIGHT_MARGIN.value or 72


def one_line(obj):
    """``obj`` as ``prin1`` prints it, cut after one line or at the margin with two dots."""
    with binding(PRINT_LINES, 2):
        text = prin1_to_string(obj)
    line, _, rest = text.partition("\n")
    limit = margin()
    if rest or len(line) > limit:
        return line[: limit - 2] + ".."
    return line


def describe(obj, stream=None):
    """``describe``: print what is known about ``obj`` to ``stream``; no values."""
    with binding(PRINT_RIGHT_MARGIN, margin()), not_ending():
        describe_object(obj, output_stream(stream))
    return NO_VALUES


def description(obj):
    """What `describe` prints of ``obj``, without empty lines before it."""
    output = StringOutputStream()
    describe(obj, output)
    return output.take().lstrip("\n")


def describe_facts(obj, stream, kind, facts):
    """A ``describe-object`` method of a room: the object, its ``kind``, and a line ``Label: value`` for each of ``facts``.

    facts: (label, value) pairs; text that is meant as it stands is a value of the type `str` with a label ending in a blank.
    """
    out = Description(output_stream(stream))
    out.header(prin1_to_string(obj), kind)
    out.line()
    for label, value in facts:
        if label.endswith(" "):
            out.line(f"{label[:-1]}: {value}")
        else:
            out.value(label, value)
    return NO_VALUES


# ------------------------------------------------------------------------------------------------------------- any object


def kind_of(obj):
    """What stands in brackets under the object: ``fixnum``, ``standard-object``, ``simple specialized array``."""
    if obj is None or obj is False:
        return "null"
    if is_symbol(obj):
        return "symbol"
    if isinstance(obj, Character):
        return "standard-char" if obj.code in range(32, 127) or obj.char == "\n" else "character"
    if isinstance(obj, GenericFunction):
        return "generic-function"
    if isinstance(obj, type):
        return "standard-object"
    if arrays.arrayp(obj):
        return _kind_of_array(obj)
    if isinstance(obj, Cons):
        return "list" if list_end(obj) is None else "cons"
    if callable(obj) and CLASSES["FUNCTION"] in lisp_mro(type(obj)):
        return "compiled closure" if _closed_over(obj) else "compiled function"
    cls = class_of(obj)
    name = symbol_name(class_name(cls))
    if name in CLASSES:
        return "structure-object" if name in ("RANDOM-STATE", "READTABLE", "RESTART") else name.lower()
    if isinstance(obj, Stream):
        return "stream"
    for root in ("STRUCTURE-OBJECT", "CONDITION"):
        if symbol_class(sym(root)) in type(obj).__mro__:
            return root.lower()
    return "standard-object" if cls is not object else "Python object"


def _closed_over(function):
    code = getattr(plain(function), "__code__", None)
    return code is not None and any(not name.startswith("L") for name in code.co_freevars)  # L...: the compiler's own


def _kind_of_array(array):
    simple, kind, rank = is_simple(array), arrays.array_element_type(array), arrays.array_rank(array)
    if isinstance(array, (str, LispString)):
        return "simple-string" if simple else "string"
    if kind is sym("BIT") and rank == 1:
        return "simple-bit-vector" if simple else "bit-vector"
    if rank == 1 and kind is True:
        return "simple-vector" if simple else "vector"
    words = ["simple"] * simple + ["specialized"] * (kind is not True) + ["vector" if rank == 1 else "array"]
    return " ".join(words)


def _describe_anything(obj, stream):
    out = Description(output_stream(stream))
    if is_symbol(obj) and obj is not False:
        return describe_symbol(obj, out)
    out.header(one_line(obj), kind_of(obj))
    _describe_contents(obj, out)
    return NO_VALUES


def _describe_contents(obj, out):
    if isinstance(obj, Character):
        out.line()
        out.line(f"Char-code: {obj.code}")
        out.line(f"Char-name: {char_name(obj) or obj.char}")
    elif arrays.arrayp(obj):
        describe_array(obj, out)
    elif isinstance(obj, hash_tables.HashTable):
        out.line()
        out.line(f"Occupancy: {len(obj) / max(hash_tables.hash_table_size(obj), len(obj), 1):.1f}")
        out.line(f"Rehash-threshold: {prin1_to_string(hash_tables.hash_table_rehash_threshold(obj))}")
        out.line(f"Rehash-size: {prin1_to_string(hash_tables.hash_table_rehash_size(obj))}")
        out.line(f"Size: {hash_tables.hash_table_size(obj)}")
        out.line("Synchronized: no")
    elif isinstance(obj, Package):
        describe_package(obj, out)
    elif isinstance(obj, type):
        out.line()
        out.line()
        describe_class(obj, out)
    elif isinstance(obj, Cons):
        if obj.car is SETF and isinstance(obj.cdr, Cons) and isinstance(obj.cdr.car, Symbol):
            _named_function(obj.cdr.car.setf_function, obj, out)
    elif callable(obj) and CLASSES["FUNCTION"] in lisp_mro(type(obj)):
        out.line()
        out.line()
        describe_function(obj, out)
    elif types.typep(obj, sym("PATHNAME")) is not None:
        out.line()
        for label, value in (
            ("HOST", None),
            ("DIRECTORY", pathname_directory(obj)),
            ("NAME", pathname_name(obj)),
            ("TYPE", pathname_type(obj)),
            ("VERSION", sym(":NEWEST")),
        ):
            out.line(f"  {label:10} = {prin1_to_string(value)}")
    elif isinstance(obj, Stream) or symbol_name(class_name(class_of(obj))) in CLASSES:
        pass
    elif class_of(obj) is object:
        describe_python_object(obj, out)
    else:
        describe_slots(obj, out)


def describe_slots(obj, out):
    """The slots of an instance, by allocation, the last slot's first."""
    groups = {}
    slots = {} if isinstance(obj, StructureObject) else effective_slots(type(obj))
    for name in names_of_slots(obj):
        allocation = "CLASS" if name in slots and slots[name].cell is not None else "INSTANCE"
        groups.setdefault(allocation, []).append(name)
    if not groups:
        return out.line("No slots.")
    out.line()
    width = max(30, *(len(symbol_name(name)) for names in groups.values() for name in names))
    for allocation in reversed(groups):
        out.line(f"Slots with :{allocation} allocation:")
        for name in groups[allocation]:
            shown = one_line(slot_value(obj, name)) if slot_boundp(obj, name) else "#<unbound slot>"
            out.line(f"  {symbol_name(name):{width}} = {shown}")
    return None


def public_attributes(obj):
    """(name, value) of the data that an object of Python code shows to all; attributes that are computed are left out."""
    names = [name for base in type(obj).__mro__ for name in vars(base).get("__slots__", ()) if hasattr(obj, name)]
    names += getattr(obj, "__dict__", {})
    return [(name, getattr(obj, name)) for name in sorted(set(names)) if not name.startswith("_")]


def describe_python_object(obj, out):
    """The public data of an object that Python code made."""
    out.line()
    out.line(f"Python type: {type(obj).__module__}.{type(obj).__qualname__}")
    out.documentation(type(obj).__doc__)
    attributes = public_attributes(obj)
    if attributes:
        out.line("Attributes:")
        width = max(30, *(len(name) for name, _ in attributes))
        for name, value in attributes:
            out.line(f"  {name:{width}} = {one_line(value)}")


def describe_array(array, out):
    """Element type, size and what is behind an array."""
    rank = arrays.array_rank(array)
    out.line()
    out.line(f"Element-type: {prin1_to_string(arrays.array_element_type(array))}")
    if rank != 1:
        out.line(f"Dimensions: {prin1_to_string(arrays.array_dimensions(array))}")
    elif arrays.array_has_fill_pointer_p(array):
        out.line(f"Fill-pointer: {arrays.fill_pointer(array)}")
        out.line(f"Size: {arrays.array_total_size(array)}")
    elif is_simple(array):
        out.line(f"Length: {arrays.array_total_size(array)}")
    else:
        out.line(f"Size: {arrays.array_total_size(array)}")
    if not is_simple(array):
        displaced = getattr(array, "displaced_to", None)
        out.line(f"Adjustable: {'yes' if arrays.adjustable_array_p(array) else 'no'}")
        out.line("Displaced: no" if displaced is None else f"Displaced-to: {one_line(displaced)}")


def describe_package(package, out):
    package.complete()
    out.line()
    out.line()
    out.documentation(package.documentation)
    if package.nicknames:
        out.items("Nicknames", package.nicknames)
    if package.use:
        out.items("Use-list", sorted(other.name for other in package.use))
    if package.used_by:
        out.items("Used-by-list", sorted(other.name for other in package.used_by))
    if package.external:
        out.items("Exports", sorted(package.external))
    out.line(f"{len(package.internal)} internal symbol{'' if len(package.internal) == 1 else 's'}.")


# -------------------------------------------------------------------------------------------------------------- functions


def describe_function(function, out):
    """Lambda list, documentation, place; for a generic function its combination and methods too."""
    out.lambda_list(lambda_list_of(function))
    generic = function if isinstance(function, GenericFunction) else None
    if generic is not None and generic.shape.required > 1:
        names = generic.shape.names
        out.value("Argument precedence order", list_from([names[index] for index in generic.precedence or range(len(names))]))
    out.documentation(shown_documentation(function, T))
    if generic is not None:
        out.line(f"Method-combination: {symbol_name(generic.combination.name)}")
        out.line("Methods:" if generic.methods else "No methods.")
        with out.indented():
            for method in generic.methods:
                out.line(one_line(list_from([generic.__lisp_name__, *method.qualifiers, specializer_names(method)])))
                with out.indented():
                    out.documentation(method.documentation)
    position = position_of(function)
    if position is not None:
        out.line(f"Source file: {place_text(position)}")


def describe_operator(operator, function, out):
    """How an operator of the plan language is written, and what it is for."""
    out.line(f"Written: {operator.shape}")
    out.line(f"In Hy: {hy_shape(operator)}")
    out.documentation(shown_documentation(function, T))


def _named_function(function, name, out):
    if function is None or isinstance(function, UndefinedFunction):
        return
    out.line()
    kind = "generic function" if isinstance(function, GenericFunction) else "compiled function"
    out.line(f"{shown_name(name)} names a {kind}:")
    with out.indented():
        describe_function(function, out)


# ----------------------------------------------------------------------------------------------------------------- symbols


def describe_symbol(symbol, out):
    """Everything that a symbol names."""
    from ..compiler.analyze import SPECIAL_FORMS  # a program that describes nothing starts without the compiler

    with binding(PACKAGE, KEYWORD):
        out.header(one_line(symbol), kind_of(symbol))
    name = symbol_name(symbol)
    if not isinstance(symbol, Symbol):
        _variable(symbol, name, "constant variable", symbol, out)
        if symbol is True:
            _class(object, name, out)
        return NO_VALUES
    data = symbol.compiler_data or {}
    _describe_variable(symbol, name, data, out)
    if symbol in SPECIAL_OPERATORS:
        out.line()
        out.line(f"{name} names a special operator.")
    elif symbol.macro is not None or symbol in SPECIAL_FORMS:
        out.line()
        out.line(f"{name} names a macro:")
        with out.indented():
            operator = operator_of(symbol)
            if operator is not None:
                describe_operator(operator, symbol.macro, out)
            elif symbol.macro is not None:
                describe_function(symbol.macro, out)
    _named_function(symbol.function, symbol, out)
    _named_function(symbol.setf_function, list_from([SETF, symbol]), out)
    expander = data.get("setf-expander")
    if expander is not None:
        out.line()
        updater = getattr(expander, "updater", None)
        out.line(
            f"(SETF {name}) has setf-expansion: {symbol_name(updater)}"
            if is_symbol(updater) and updater is not None
            else f"(SETF {name}) has a complex setf-expansion:"
        )
        with out.indented():
            out.documentation(shown_documentation(symbol, SETF))
    _describe_type(symbol, name, out)
    return NO_VALUES


def _describe_variable(symbol, name, data, out):
    if "symbol-macro" in data:
        out.line()
        out.line(f"{name} names a symbol macro:")
        with out.indented():
            out.value("Expansion", data["symbol-macro"])
    elif symbol.constant or symbol.special or symbol.value is not UNBOUND:
        kind = "constant variable" if symbol.constant else "special variable" if symbol.special else "undefined variable"
        _variable(symbol, name, kind, symbol.value, out)


def _variable(symbol, name, kind, value, out):
    out.line()
    out.line(f"{name} names a{'n' if kind[0] == 'u' else ''} {kind}:")
    with out.indented():
        if value is UNBOUND:
            out.line("Currently unbound.")
        else:
            out.value("Value", value)
        if isinstance(symbol, Symbol) and not isinstance(symbol, Keyword):
            out.documentation(shown_documentation(symbol, VARIABLE))


def _describe_type(symbol, name, out):
    expander = types.type_expander(symbol)
    cls = symbol_class(symbol)
    if expander is not None:
        out.line()
        out.line(f"{name} names a type-specifier:")
        with out.indented():
            out.documentation(shown_documentation(symbol, TYPE))
            lambda_list = expander.__lisp_lambda_list__
            out.lambda_list(lambda_list)
            if lambda_list is None:
                out.value("Expansion", types.expand_type(symbol))
    elif cls is not None:
        _class(cls, name, out)


# ----------------------------------------------------------------------------------------------------------------- classes


def _class(cls, name, out):
    out.line()
    out.line(f"{name} names the {symbol_name(class_name(metaclass_of(cls))).lower()} {prin1_to_string(cls)}:")
    with out.indented():
        describe_class(cls, out)


def _class_names(classes):
    return [prin1_to_string(class_name(cls)) for cls in classes]


def describe_class(cls, out):
    """Documentation, relatives and slots of a class."""
    if not isinstance(cls, BuiltInClass) and cls is not object:
        out.documentation(vars(cls).get("__doc__"))
    precedence = dict.fromkeys(_class_names(base for base in cls.__mro__ if _is_lisp(base)))
    out.items("Class precedence-list", precedence)
    supers = dict.fromkeys(_class_names(base for base in cls.__bases__ if _is_lisp(base)))
    if cls is not object:
        out.items("Direct superclasses", supers)
    subclasses = dict.fromkeys(_class_names(other for other in reversed(type.__subclasses__(cls)) if _is_lisp(other)))
    if subclasses:
        out.items("Direct subclasses", subclasses)
    else:
        out.line("No subclasses.")
    structure = vars(cls).get("lisp_structure")
    if structure is not None:
        _structure_slots(structure, out)
    else:
        _direct_slots(cls, out)


def _is_lisp(cls):
    return cls is object or isinstance(vars(cls).get("lisp_symbol"), Symbol) or isinstance(vars(cls).get("lisp_name"), str)


def _structure_slots(structure, out):
    out.line("Slots:" if structure.slots else "No slots.")
    with out.indented():
        for slot in structure.slots:
            out.line(symbol_name(slot.name))
            with out.indented():
                out.value("Type", slot.type)
                if slot.read_only:
                    out.line("Read-only: yes")


def _direct_slots(cls, out):
    slots = direct_slots(cls)
    out.line("Direct slots:" if slots else "No direct slots.")
    with out.indented():
        for slot in slots:
            out.line(symbol_name(slot.name))
            with out.indented():
                if slot.type is not True:
                    out.value("Type", slot.type)
                if slot.cell is not None:
                    out.line("Allocation: :CLASS")
                if slot.initargs:
                    out.items("Initargs", map(prin1_to_string, reversed(slot.initargs)))
                if slot.initfunction is not None:
                    out.value("Initform", slot.initform)
                if slot.readers:
                    out.items("Readers", map(prin1_to_string, slot.readers))
                if slot.writers:
                    out.items("Writers", map(prin1_to_string, slot.writers))
                out.documentation(slot.documentation, 1)


describe_object = protocol_function("DESCRIBE-OBJECT", "(object stream)", _describe_anything)
