"""What to try when a function got a fluent and wanted its value: ``(<= *distance* 2)``.

``<`` and nine other functions make nets in the plan language; ``<=`` and all others of Common Lisp do not (cpl.md 1.2). The advice names
the operator at the place of the error, since nobody can know that by heart.
"""

from __future__ import annotations


from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime.cpl.fluents.fluents import Fluent
from cramhy_runtime.lisp_core.condition_types import TypeError_
from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.packages import COMMON_LISP, find_package
from ..printer.print_controls import PACKAGE

_OPERATOR = late_pattern(r"""\(\s*([^\s()'"`,;]+)""")
_MAKE_NETS = "< > = + - * / eq eql not"
"""The functions of the plan language that stand for those of Common Lisp and make nets."""


def fluent_advice(condition):
    """What to write instead; ``None`` when ``condition`` is no type error with a fluent."""
    if not isinstance(condition, TypeError_) or not isinstance(condition.datum, Fluent):
        return None
    now = "(value fluent) is what the fluent holds now"
    symbol = _operator_at(getattr(condition, "position", None))
    if symbol is None or symbol.package is not COMMON_LISP or symbol.macro is not None:
        return f"A fluent stands in the place of its value: {now}."
    name = symbol.name.lower()
    if name in _MAKE_NETS.split():
        return f"cl:{name} makes no net of a fluent, cpl:{name} does; {now}."
    return (
        f"{name} makes no net of a fluent. In the plan language these functions of Common Lisp do: {_MAKE_NETS}.\n"
        f"(fl-funcall #'{name} ...) makes the net; {now}."
    )


def _operator_at(position):
    """The symbol of the operator of the form that stands at ``position`` (file, line, column), or ``None``."""
    if not position or not position[2]:
        return None
    import linecache  # it imports the tokenizer

    found = _OPERATOR.match(linecache.getline(position[0], position[1]), position[2] - 1)
    if found is None:
        return None
    prefix, _, name = found[1].upper().rpartition(":")
    package = find_package(prefix.rstrip(":")) if prefix else PACKAGE.value
    symbol = package.lookup(name)[0] if package is not None else None
    return symbol if isinstance(symbol, Symbol) else None
