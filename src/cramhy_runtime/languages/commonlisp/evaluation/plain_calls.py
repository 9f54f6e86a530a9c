"""Calls of users' functions with constant arguments, as they are typed at a prompt: ``(drive 5 2)``.

Of such a form there is nothing to find out, so it is not analysed. Its code is that which the compiler would make, and has the same places
for errors; only the way there is shorter, and a session that types nothing else never loads the compiler. A form declines, and is
compiled, wherever the compiler might say or do more: another number of arguments than the function takes, keywords, a compiler macro, a
function that was not compiled by us.
"""

from __future__ import annotations

import _ast as trees  # what `ast` is made of; that one takes 4 ms to import
import math
from types import FunctionType

from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol
from cramhy_runtime.lisp_core.packages import COMMON_LISP, CRAMHY, sym
from ..compiler.frame_exits import DEBUGGED

QUOTE = sym("QUOTE")
_LOAD, _STORE = trees.Load(), trees.Store()


def _place(position):
    """(line, column, end line, end column) as a node of Python has it."""
    return dict(zip(("lineno", "col_offset", "end_lineno", "end_col_offset"), position, strict=True))


_NOWHERE = _place((1, 0, 1, 1))
_TAKES_MORE = 0x0C
"""Flags of a code object with rest or keyword arguments."""
_USUAL = {"__lisp_lambda_list__", "__lisp_name__", "beside"}
"""Attributes of a function that say nothing about how it is called."""
_OURS = "LMultipleValues"
"""A global name of all code that the compiler makes."""


def code_of_plain_call(form, unit):
    """The code object of ``form``, a cons, in ``unit``, a `Unit`, if it is a plain call; else ``None``."""
    head = form.car
    if head.__class__ is not Symbol or head.macro is not None or head.package is COMMON_LISP or head.package is CRAMHY or DEBUGGED.value:
        return None
    function = head.function
    if function.__class__ is not FunctionType or _OURS not in function.__globals__ or not function.__dict__.keys() <= _USUAL:
        return None
    if head.compiler_data is not None and "compiler-macro" in head.compiler_data:
        return None
    values, cell = [], form.cdr
    while cell.__class__ is Cons:
        value = cell.car
        if value.__class__ is Cons:
            if value.car is not QUOTE or value.cdr.__class__ is not Cons or value.cdr.cdr is not None:
                return None
            value = value.cdr.car
        elif value.__class__ is not Keyword and isinstance(value, Symbol):  # some variables are of classes of their own
            return None
        if value.__class__ is float and not math.isfinite(value):
            return None
        values.append(value)
        cell = cell.cdr
    code = function.__code__
    least = code.co_argcount - len(function.__defaults__ or ())
    if cell is not None or code.co_flags & _TAKES_MORE or code.co_kwonlyargcount or not least <= len(values) <= code.co_argcount:
        return None
    return _code(head, values, unit, unit.positions.get(id(form)))


def _code(symbol, values, unit, position):
    """The code object of a call of the function of ``symbol`` at ``position``, or nowhere."""
    own = _NOWHERE if position is None else _place(position)
    inner = own | {"end_lineno": own["lineno"], "end_col_offset": own["col_offset"] + 1}
    name = unit.constants.name("object", symbol)
    function = trees.Attribute(trees.Name(name, _LOAD, **inner), "function", _LOAD, **inner)
    arguments = [
        trees.Constant(None if value is False else value, **inner)
        if value is None or value is True or value is False or value.__class__ in (str, int, float) and _is_short(value)
        else trees.Name(unit.constants.name("object", value), _LOAD, **inner)
        for value in values
    ]
    call = trees.Call(trees.NamedExpr(trees.Name("Lf", _STORE, **inner), function, **inner), arguments, [], **own)
    parameters = trees.arguments(posonlyargs=[], args=[], vararg=None, kwonlyargs=[], kw_defaults=[], kwarg=None, defaults=[])
    toplevel = trees.FunctionDef("toplevel", parameters, [trees.Return(call, **_NOWHERE)], [], None, None, **_NOWHERE)
    if "type_params" in toplevel._fields:
        toplevel.type_params = []
    run = trees.Call(trees.Name("toplevel", _LOAD, **_NOWHERE), [], [], **_NOWHERE)
    result = trees.Assign([trees.Name("Lresult", _STORE, **_NOWHERE)], run, **_NOWHERE)
    unit.namespace.update(unit.constants.take_objects())
    return compile(trees.Module([toplevel, result], []), unit.filename, "exec")


def _is_short(value):
    """Whether a text or a number stands in the code itself."""
    return value.__class__ is not int or abs(value) < 1 << 64
