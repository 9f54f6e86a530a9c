"""Which of the compiler's warnings are only consequences of others: one slip gets one message.

* An operator that nobody has defined is taken for a function, and so all that stands in its form for variables and calls. If several of
  them are unknown, too, the operator was meant to be a macro, and nothing that is unknown in its form needs to be told.
* A variable that is unknown at ten places is one mistake, with ten places.
* A variable that nothing uses in its scope, and that is unknown behind it, has a scope that ends too early.
* In a form whose parentheses are wrong (``reader/unmatched_closes.py``) everything may be in the wrong place.
"""

from __future__ import annotations


MACRO = 3
"""So many unknown names in a call, one of a variable at least, tell that its unknown operator is no function."""


def without_consequences(told, in_doubt):
    """Those of the conditions ``told`` that stand for themselves, in the order given. in_doubt: whether a position is in a form whose
    parentheses are wrong."""
    kept = [condition for condition in told if not in_doubt(condition.position)]
    unknown = [condition for condition in kept if getattr(condition, "undefined", None) in ("function", "variable")]
    macros = [call for condition in unknown for call in getattr(condition, "calls", ()) if _is_macro(call, unknown)]
    dropped = {id(condition) for condition in unknown if any(inside(condition.position, call) for call in macros)}
    variables = {}
    for condition in unknown:
        if condition.undefined == "variable" and id(condition) not in dropped:
            first = variables.setdefault(condition.name, condition)
            if first is not condition:
                dropped.add(id(condition))
                if condition.position != first.position:
                    first.also = list(dict.fromkeys([*getattr(first, "also", ()), condition.position]))
    dropped |= _scopes_that_end_early(kept, variables.values())
    return [condition for condition in kept if id(condition) not in dropped]


def _scopes_that_end_early(told, unknown):
    """The ids of those of ``told`` that need no message, since one of ``unknown`` gets a hint about the scope of its variable."""
    bindings = {}
    dropped = set()
    for condition in unknown:
        unused = [
            other for other in told if getattr(other, "unused", None) is condition.name and _same_form(other.position, condition.position)
        ]
        if unused:
            binding = unused[-1]
            first = bindings.setdefault(binding.position[:2], condition)
            dropped.add(id(binding))
            if first is not condition:
                dropped.add(id(condition))
            else:
                line, column = binding.position[1:3]
                first.hint = (
                    f"It is bound at line {line}, column {column}, where nothing uses it: the scope of that ends before line "
                    f"{condition.position[1]}. Look at the parentheses in between."
                )
    return dropped


def _same_form(before, behind):
    """Whether the second position follows the first, with no form in between that begins at the margin."""
    if not before or not behind or before[0] != behind[0] or before[1:] > behind[1:]:
        return False
    import linecache  # it imports the tokenizer

    return not any(linecache.getline(before[0], line).startswith("(") for line in range(before[1] + 1, behind[1] + 1))


def _is_macro(call, unknown):
    found = [condition for condition in unknown if inside(condition.position, call)]
    return len({condition.name for condition in found}) >= MACRO and any(condition.undefined == "variable" for condition in found)


def inside(position, call):
    """Whether ``position`` is inside of the form ``call``, (file, line, column, end line, end column), and not its beginning."""
    return bool(position) and position[0] == call[0] and call[1:3] < (position[1], position[2] or 0) <= call[3:5]
