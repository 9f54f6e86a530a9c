"""What the ground of the Lisp room needs from what stands on it: one seam instead of imports in twenty functions.

Symbols, packages, conditions and streams are the ground: everything imports them. But a condition prints itself with the printer,
an undefined function signals a condition, and ``warn`` writes to a stream; these stand higher. And some things are knots by nature:
the parts of the printer print their components with the whole of it, and an object is made by generic functions, which are objects.
Such a name is taken from `late`, which looks it up in the module that has it when it is first used; the table below is all that
lower modules know of higher ones.
"""

from __future__ import annotations

from importlib import import_module

WHERE = {
    "conditions": "error package_error package_does_not_exist program_error unknown_key type_error undefined_function",
    "condition_types": "ClosedStreamError SimpleParseError SimpleTypeError StyleWarning UnboundVariable",
    "python.python_exceptions": "python_condition",
    "packages": "intern",
    "data": "Character",
    "equality": "equal",
    "files.namestrings": "namestring native_namestring",
    "objects.classes": "class_name find_class make_instance",
    "objects.clos_printing": "print_class",
    "objects.instances": "initialize_from_python",
    "objects.slots": "missing_value",
    "objects.structures": "slots_of",
    "types.types": "expand_type is_known_type type_of type_predicate typep",
    "types.type_names": "simplified_type",
    "numbers.rounding": "floor truncate",
    "objects.effective_forms": "function_of_form",
    "objects.protocol": """initialize_instance no_applicable_method no_next_method print_object reinitialize_instance shared_initialize
        slot_missing slot_unbound update_instance_for_different_class update_instance_for_redefined_class""",
    "printer.printer": "output_object output_ugly prin1_to_string print_unreadable write_string_text",
    "printer.standard_printers": "print_python_object",
    "printer.pprint_code": "is_backquoted",
    "evaluation.function_facts": "lambda_list_of",
    "format.format": "format_ format_to_string",
    "format.format_directives": "HANDLERS",
    "streams.streams": "warning_line ask_for_form",
    "reader.dispatch_macros": "dispatch",
    "reader.standard_syntax": "read_comment",
    "reader.reader": "read_from_stream",
    "evaluation.evaluator": "evaluate macro_expander",
    "systems.systems": "load_system",
    "collections.arrays": "aref",
    "collections.sequences": "length",
    "collections.sequence_types": "BoundingIndicesBad",
}
"""Module → the names that the ground takes from it."""

_modules = {name: module for module, names in WHERE.items() for name in names.split()}


class _Late:
    """`late.name` is that name's function or class; found once, then an ordinary attribute."""

    def __getattr__(self, name):
        if name not in _modules:
            raise AttributeError(f"late.py does not say where {name} is")
        value = getattr(import_module(f"{__package__}.{_modules[name]}"), name)
        setattr(self, name, value)
        return value


late = _Late()
