"""Words of Hy in a text of Common Lisp, and how Lisp writes the same. The other way round: ``languages/hy/shapes.py``."""

from __future__ import annotations

OPERATORS = {
    "+=": "(incf name value)",
    "-=": "(decf name value)",
    "DEFN": "(defun name (parameter ...) form...)",
    "FN": "(lambda (parameter ...) form...)",
    "FOR": "(dolist (name values) form...)",
    "IS": "(eq a b)",
    "LEN": "(length values)",
    "LFOR": "(loop for name in values collect value)",
    "MATCH": "(case value (key form...) ...)",
    "RAISE": "(error ...), or (fail ...) in a plan",
    "SETV": "(setf name value)",
    "SETX": "(setf name value)",
    "TRY": "(handler-case form (type (problem) form...)), or (unwind-protect form cleanup...)",
    "WHILE": "(loop while test do form...)",
}
VARIABLES = {"FALSE": "nil", "NONE": "nil", "TRUE": "t"}
_BRACKETS = {"[": "'(1 2), or #(1 2) for a vector", "{": "(make-hash-table)"}
_WHERE_HY_IS = "In a .hy file and at the prompt of hy, Hy begins after (in-hy)."


def hint_for_operator(name: str) -> str | None:
    """What to try where the operator or function ``name``, as Lisp's reader reads it, is not defined."""
    if name == "IN-HY":
        return (
            "(in-hy) leads to Hy in a .hy file and at the prompt of hy, but not in the debugger: leave that first, by the number of its "
            "last restart. cramhy repl --hy is such a prompt, too."
        )
    shape = OPERATORS.get(name)
    return f"{name.lower()} is Hy. In Common Lisp it is written {shape}. {_WHERE_HY_IS}" if shape else None


def hint_for_variable(name: str) -> str | None:
    """What to try where the variable ``name``, as Lisp's reader reads it, is unbound."""
    if name == "CRAMHY":
        return f"(require cramhy *) is Hy, and has been done: this is Common Lisp. {_WHERE_HY_IS}"
    written = VARIABLES.get(name)
    if written:
        return f"{name.capitalize()} is Hy. In Common Lisp it is {written}. {_WHERE_HY_IS}"
    brackets = _BRACKETS.get(name[:1])
    return f"{name[0]} is a bracket of Hy. Common Lisp writes {brackets}. {_WHERE_HY_IS}" if brackets else None


__all__ = ["hint_for_operator", "hint_for_variable"]
