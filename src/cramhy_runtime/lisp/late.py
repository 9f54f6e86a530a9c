"""What the ground of this room needs from what stands on it: one seam instead of imports in twenty functions.

Symbols, packages, conditions and streams are the ground: everything imports them. But a condition prints itself with the printer,
an undefined function signals a condition, and ``warn`` writes to a stream; these stand higher. Such a name is taken from `late`,
which looks it up in the module that has it when it is first used; the table below is all that the ground knows of the rest.
"""

from __future__ import annotations

from importlib import import_module

WHERE = {
    "conditions": "error package_error package_does_not_exist program_error type_error undefined_function",
    "condition_types": "StreamError StyleWarning",
    "packages": "intern",
    "classes": "class_name find_class make_instance",
    "types": "typep",
    "printer": "prin1_to_string",
    "format": "format_ format_to_string",
    "streams": "warning_line ask_for_form",
    "reader": "read_from_stream",
    "evaluator": "evaluate",
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
