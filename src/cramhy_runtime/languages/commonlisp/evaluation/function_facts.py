"""What can be told about a function: its lambda list, its name, where it was written, and the form that it was made from.

``defun``, ``defmacro`` and ``defgeneric`` leave the lambda list with what they define. For other functions, those of the
runtime and of Python among them, it is made from Python's signature. The form of a function is read again from the text that
it came from, so that nothing is kept for it; it is there for functions of files and of the REPL. ``describe``,
``disassemble``, ``function-lambda-expression`` and the Python face of a Lisp function use this.
"""

from __future__ import annotations


from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import FLOATS, Cons, Keyword, Symbol, lisp_list, list_from
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.dispatch.methods import shape_items
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER, is_symbol, sym, symbol_name
from ..reader.reader import Reader
from ..syntax.body_parts import body_parts
from .evaluator import PACKAGE, evaluate
from cramhy_runtime.lisp_core.source_places import is_user_file

IN_PACKAGE, SETF = sym("IN-PACKAGE"), sym("SETF")


def plain(function):
    """The function itself, without the wrapping of ``trace`` and of keyword arguments."""
    function = getattr(function, "traced", function)
    return getattr(function, "source", None) or getattr(function, "python", function)


def lambda_list_of(function):
    """The lambda list of a function, macro expander or generic function, as a Lisp list."""
    function = getattr(function, "traced", function)
    known = getattr(function, "__lisp_lambda_list__", function)
    if known is not function:
        return known
    if hasattr(function, "lambda_list"):
        return list_from(shape_items(function.lambda_list))
    return from_signature(plain(function))


def from_signature(function):
    """The lambda list that a Python signature stands for: keyword-only parameters are ``&key``."""
    try:
        import inspect  # 5 ms, for who asks about a function of Python

        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return list_from([sym("&REST"), Symbol("ARGUMENTS")])
    items, state = [], None
    for parameter in parameters:
        marker = {parameter.VAR_POSITIONAL: "&REST", parameter.KEYWORD_ONLY: "&KEY"}.get(parameter.kind)
        if parameter.kind is parameter.VAR_KEYWORD:
            items += [] if state == "&KEY" else [sym("&KEY")]
            items.append(sym("&ALLOW-OTHER-KEYS"))
            continue
        if marker is None and parameter.default is not parameter.empty:
            marker = "&OPTIONAL"
        if marker is not None and marker != state:
            items.append(sym(marker))
            state = marker
        name, default = Symbol(parameter.name.strip("_").replace("_", "-").upper()), parameter.default
        items.append(lisp_list(name, default) if default.__class__ in {int, *FLOATS, Keyword} else name)
    return list_from(items)


def position_of(function):
    """(file, line) where the function was written by a user, or ``None``."""
    code = getattr(plain(function), "__code__", None)
    if code is None or not is_user_file(code.co_filename):
        return None
    return code.co_filename, code.co_firstlineno


def defining_forms(function):
    """(form, positions, package) of each top-level form that the function may have been made by, read again from its text.

    They are the forms that begin on the function's line, and the last one before it. None are found when the text is gone.
    """
    position = position_of(function)
    if position is None or position[0].endswith(".hy"):
        return []
    filename, line = position
    import linecache  # it imports the tokenizer

    reader, end, found = Reader("".join(linecache.getlines(filename)), filename=filename), object(), []
    read = []  # all forms stay alive meanwhile: places are found by the identity of a form
    with binding(PACKAGE, PACKAGE.value if filename.startswith("<") else COMMON_LISP_USER):
        try:
            while (form := reader.read(eof_error=False, eof_value=end)) is not end:
                read.append(form)
                start = reader.positions[id(form)][0] if id(form) in reader.positions else 0
                if start > line:
                    break
                if start < line:
                    found.clear()
                if isinstance(form, Cons):
                    found.append((form, reader.positions, PACKAGE.value))
                    if form.car is IN_PACKAGE:
                        evaluate(form)
        except Condition:
            return []  # the text has changed and cannot be read any more
    return found


def lambda_expression(function):
    """The lambda expression of a function that ``defun`` made and whose text is still there; else ``None``."""
    name = getattr(plain(function), "__lisp_name__", None)
    if name is None:
        return None
    for form in (part for found, _, _ in defining_forms(function) for part in _parts(found)):
        if form.car is sym("DEFUN") and isinstance(form.cdr, Cons) and isinstance(form.cdr.cdr, Cons) and _same_name(form.cdr.car, name):
            lambda_list, (documentation, declarations, body) = form.cdr.cdr.car, body_parts(form.cdr.cdr.cdr)
            head = [*([] if documentation is None else [documentation]), *declarations]
            block = name.cdr.car if isinstance(name, Cons) else name
            return list_from([sym("LAMBDA"), lambda_list, *head, list_from([sym("BLOCK"), block, *body])])
    return None


def _parts(form):
    """The list forms in ``form``, itself first."""
    stack = [form]
    while stack:
        current = stack.pop()
        if isinstance(current, Cons):
            yield current
            stack.extend(reversed([item for item in current if isinstance(item, Cons)]))


def _same_name(one, other):
    if isinstance(one, Cons) and isinstance(other, Cons):
        return one.car is SETF and one.cdr.car is other.cdr.car
    return one is other


def shown_name(name):
    """A function's name for people: ``MOVE`` or ``(SETF SPEED)``."""
    if isinstance(name, Cons):
        return f"(SETF {symbol_name(name.cdr.car)})"
    return symbol_name(name) if is_symbol(name) else str(name)
