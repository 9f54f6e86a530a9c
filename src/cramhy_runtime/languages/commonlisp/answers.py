"""What Common Lisp answers at the ports of lisp_core: its printer, classes, streams, package locks and systems (`lisp_core/ports.py`)."""

from __future__ import annotations

from cramhy_runtime.lisp_core import classes
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import lisp_list, one
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import KEYWORD, Package, keyword
from cramhy_runtime.lisp_core.ports import PORTS
from .compiler import compilation_unit
from .objects import builtin_classes, protocol
from .objects import classes as class_world
from .objects.class_definition import define_class
from .objects.instances import make_instance, plan_for
from .objects.structures import slots_of
from .format.format import format_, format_to_string
from .printer import printer
from .printer.print_controls import PACKAGE
from .reader.dispatch_macros import READ_EVAL
from .reader.reader import Reader
from .reader.reader_functions import read_from_string
from .printer.printer import prin1_to_string, princ_to_string
from .printer.printing_support import with_standard_io_syntax
from .printer.standard_printers import print_slots
from .streams import streams
from .tools import user_queries
from .packages.package_errors import check_symbol
from .systems.systems import load_library
from .tools.advice import hint_for, report_text, show_warnings
from .types import types
from .types.type_names import simplified_type
from .evaluation.evaluator import evaluate
from .evaluation.function_facts import lambda_list_of


class _Printer:
    output_object = staticmethod(printer.output_object)
    print_unreadable = staticmethod(printer.print_unreadable)
    print_slots = staticmethod(print_slots)
    address = staticmethod(printer.address)

    def write(self, thing, stream, escape):
        printer.write(thing, stream, escape=escape)

    report = staticmethod(report_text)

    prin1 = staticmethod(prin1_to_string)
    princ = staticmethod(princ_to_string)
    formatted = staticmethod(format_to_string)

    def format_to(self, stream, control, *arguments):
        format_(stream, control, *arguments)


class _Classes:
    name = staticmethod(class_world.class_name)
    precedence = staticmethod(builtin_classes.lisp_mro)

    def define(self, symbol, superclass):
        return define_class(symbol, lisp_list(class_world.class_name(superclass)), None)

    def customized(self, cls):
        return plan_for(cls).custom

    find = staticmethod(class_world.find_class)
    make = staticmethod(make_instance)
    slots = staticmethod(slots_of)


class _Types:
    known = staticmethod(types.is_known_type)
    test = staticmethod(types.type_test)
    predicate = staticmethod(types.type_predicate)
    declared = staticmethod(types.declared_predicate)
    expand = staticmethod(types.expand_type)
    without_parameters = staticmethod(types.expand_without_parameters)
    of = staticmethod(types.type_of)
    simplified = staticmethod(simplified_type)


class _Output:
    hint = staticmethod(hint_for)
    designated = staticmethod(streams.output_stream)
    warning = staticmethod(user_queries.warning_line)

    def stream(self, name):
        return streams.output_stream(_STREAMS[name].value)


_STREAMS = {"standard-output": streams.STANDARD_OUTPUT, "error-output": streams.ERROR_OUTPUT, "trace-output": streams.TRACE_OUTPUT}


class _User:
    def read(self, text):
        with binding(READ_EVAL, None, PACKAGE, KEYWORD):
            return one(read_from_string(text))

    def read_with_places(self, text, filename):
        reader = Reader(text, filename=filename)
        try:
            with binding(PACKAGE, Package("TEXT-THAT-IS-READ-AGAIN")):
                return reader.read(eof_error=False), reader.positions
        except Condition:
            return None, {}

    evaluate = staticmethod(evaluate)
    form = staticmethod(user_queries.ask_for_form)


class _Systems:
    def load(self, name):
        """Load a library whose package was named, whatever is bound where that happens: a package without Common Lisp, a readtable."""
        with_standard_io_syntax(lambda: load_library(name))


class _Definitions:
    check_symbol = staticmethod(check_symbol)
    warn = staticmethod(compilation_unit.warn_of)
    expansion_place = staticmethod(compilation_unit.expansion_place)
    lambda_list = staticmethod(lambda_list_of)

    def no_applicable_method(self, function, arguments, default):
        if protocol.no_applicable_method.user_methods:
            return protocol.no_applicable_method(function, *arguments)
        return default(function, arguments)

    def no_next_method(self, function, method, arguments, default):
        return protocol.no_next_method(function, method, *arguments)

    def generic_function_of(self, class_, name, lambda_list):
        return make_instance(class_, keyword("NAME"), name, keyword("LAMBDA-LIST"), lambda_list)

    def maker_of_methods(self, class_):
        from .objects.metafunctions import as_method_of

        return as_method_of(class_world.find_class_or_error(class_))


def install():
    """Let Common Lisp answer from now on; what generic functions found out by plain answers is forgotten."""
    PORTS.install(
        printer=_Printer(),
        classes=_Classes(),
        types=_Types(),
        output=_Output(),
        user=_User(),
        systems=_Systems(),
        definitions=_Definitions(),
    )
    compilation_unit.usually_report_to(show_warnings)
    classes.touch_classes()
