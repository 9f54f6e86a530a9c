"""How code is laid out: the functions that pretty-print ``let``, ``defun``, calls and the other forms.

With ``*print-pretty*`` on, a list that looks like code is printed as code, data or not; for each operator a function
knows where its lines may break. The layouts are those of SBCL (``src/code/pprint.lisp``, public domain), which writes
them as format controls; here they are functions, because they run often. Which function prints what:
``pprint_dispatch.py``.
"""

from __future__ import annotations

from .components import COMPONENTS
from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.packages import COMMON_LISP, is_symbol, sym, symbol_name
from .pretty import call_logical_block, is_pair, newline_if_pretty, pprint_fill, pprint_linear
from .print_controls import PRINT_PRETTY, bound

DECLARATION_QUOTES = special(Symbol("*PPRINT-QUOTE-WITH-SYNTACTIC-SUGAR*"), True)


def _output(obj, stream):
    COMPONENTS.output_object(obj, stream)


# -------------------------------------------------------------------------------------------------------------- layouts


def _indent(out, amount, relative_to="block"):
    if PRINT_PRETTY.value is not None:
        out.indent(relative_to, amount)


def _each(out, block, kind):
    """The rest of the block: a newline of ``kind`` and a space before each element."""
    while not block.exhausted:
        out.write(" ")
        newline_if_pretty(out, kind)
        _output(block.pop(), out)


def _first(out, block):
    """The head of a form. Leaves the block when nothing follows it."""
    block.exit_if_exhausted()
    _output(block.pop(), out)
    block.exit_if_exhausted()


def _block(stream, lst, body):
    call_logical_block(stream, lst, body, "(", ")")


def pprint_call(stream, form, *_):
    """A function call: the arguments below each other, right of the name."""
    _block(stream, form, _call)


def _aligned(first, others):
    """The head, then the rest below each other right of it: newlines of the kinds ``first`` and ``others``."""

    def body(out, block):
        _first(out, block)
        out.write(" ")
        newline_if_pretty(out, first)
        _indent(out, 0, "current")
        _output(block.pop(), out)
        _each(out, block, others)

    return body


_call, _spread_call = _aligned("fill", "fill"), _aligned("fill", "mandatory")
_do_binding, _dolist_binding = _aligned("miser", "linear"), _aligned("fill", "linear")


def pprint_call_form(stream, form, *_):
    """A call of a function, or of a macro with a body, whose body is indented by two."""
    position = _body_position(form.car)
    if position is None:
        pprint_call(stream, form)
        return

    def macro_call(out, block):
        _first(out, block)
        out.write(" ")
        for index in range(position):
            if index:
                _indent(out, 3)
                newline_if_pretty(out, "mandatory")
            _output(block.pop(), out)
            block.exit_if_exhausted()
        _indent(out, 1)
        newline_if_pretty(out, "mandatory")
        while True:
            _output(block.pop(), out)
            block.exit_if_exhausted()
            newline_if_pretty(out, "mandatory")

    _block(stream, form, macro_call)


_BODIES = {
    "DEFGENERIC": 2,
    "DEFINE-COMPILER-MACRO": 2,
    "DEFINE-CONDITION": 3,
    "DEFINE-METHOD-COMBINATION": 1,
    "HANDLER-BIND": 1,
    "RESTART-BIND": 1,
    "RESTART-CASE": 1,
    "WITH-ACCESSORS": 2,
    "WITH-CONDITION-RESTARTS": 2,
    "WITH-SLOTS": 2,
}
OPERATORS = frozenset(
    "AND ASSERT CALL-METHOD CHECK-TYPE COND DECF DEFCLASS DEFINE-SYMBOL-MACRO FORMATTER GO HANDLER-CASE "
    "IGNORE-ERRORS IN-PACKAGE INCF LOAD-TIME-VALUE LOOP-FINISH MULTIPLE-VALUE-LIST NTH-VALUE OR POP "
    "PPRINT-EXIT-IF-LIST-EXHAUSTED PPRINT-POP PUSH PUSHNEW REMF RETURN ROTATEF SHIFTF THE TRACE UNTRACE".split()
) | frozenset(_BODIES)


def _body_position(symbol):
    """How many arguments come before the &body of the macro ``symbol``; ``None`` when it is no such macro."""
    if symbol.package is COMMON_LISP:
        return _BODIES.get(symbol.name)
    names = getattr(symbol.macro, "__lisp_lambda_list__", None)
    count = 0
    while isinstance(names, Cons):
        name, names = names.car, names.cdr
        spelled = symbol_name(name) if is_symbol(name) else ""
        if spelled == "&BODY":
            return count
        count += spelled != "&OPTIONAL"
    return None


def pprint_block(stream, form, *_):
    """``(block name forms)``: one distinguished argument, then forms indented by two."""

    def body(out, block):
        _first(out, block)
        _indent(out, 3)
        out.write(" ")
        newline_if_pretty(out, "fill")
        _output(block.pop(), out)
        _indent(out, 1)
        _each(out, block, "linear")

    _block(stream, form, body)


def pprint_lambda_list(stream, lambda_list, *_):
    def body(out, block):
        state, first = "required", True
        while True:
            block.exit_if_exhausted()
            if not first:
                out.write(" ")
            argument = block.pop()
            keyword = symbol_name(argument) if is_symbol(argument) else ""
            if keyword in ("&OPTIONAL", "&AUX", "&REST", "&BODY", "&KEY"):
                state = {"&KEY": "key", "&REST": "required", "&BODY": "required"}.get(keyword, "optional")
                newline_if_pretty(out, "linear")
            else:
                newline_if_pretty(out, "fill")
            _block(out, argument, _required_argument if state == "required" else _optional_argument(state == "key"))
            first = False

    _block(stream, lambda_list, body)


def _required_argument(out, block):
    block.exit_if_exhausted()
    _output(block.pop(), out)
    _each(out, block, "linear")


def _optional_argument(key):
    def body(out, block):
        block.exit_if_exhausted()
        if key:
            _block(
                out, block.pop(), lambda inner, names: (names.exit_if_exhausted(), _output(names.pop(), inner), _each(inner, names, "fill"))
            )
        else:
            _output(block.pop(), out)
        _each(out, block, "linear")

    return body


def pprint_lambda(stream, form, *_):
    def body(out, block):
        _first(out, block)
        _indent(out, 3)
        out.write(" ")
        newline_if_pretty(out, "fill")
        pprint_lambda_list(out, block.pop())
        _indent(out, 1)
        _each(out, block, "linear")

    _block(stream, form, body)


def _local_function(out, block):
    _first(out, block)
    _indent(out, 3)
    out.write(" ")
    newline_if_pretty(out, "fill")
    pprint_lambda_list(out, block.pop())
    _indent(out, 1)
    newline_if_pretty(out, "mandatory")
    _rest_linear(out, block)


def _rest_linear(out, block):
    while not block.exhausted:
        _output(block.pop(), out)
        block.exit_if_exhausted()
        out.write(" ")
        newline_if_pretty(out, "linear")


def _bindings(element):
    def body(out, block):
        while not block.exhausted:
            _block(out, block.pop(), element)
            block.exit_if_exhausted()
            out.write(" ")
            newline_if_pretty(out, "linear")

    return body


def _let_like(element):
    def body(out, block):
        _first(out, block)
        out.write(" ")
        newline_if_pretty(out, "miser")
        _block(out, block.pop(), _bindings(element))
        _indent(out, 1)
        block.exit_if_exhausted()
        newline_if_pretty(out, "mandatory")
        _rest_linear(out, block)

    return body


def pprint_let(stream, form, *_):
    _block(stream, form, _let_like(_one_binding))


def _one_binding(out, block):
    block.exit_if_exhausted()
    _output(block.pop(), out)
    _each(out, block, "linear")


def pprint_flet(stream, form, *_):
    rest = form.cdr
    if isinstance(rest, Cons) and isinstance(rest.cdr, Cons) and rest.cdr.car is not sym(":IN"):
        _block(stream, form, _let_like(_local_function))
        return

    def name(out, block):  # (flet foo :in bar), the name of a function
        block.exit_if_exhausted()
        while True:
            _output(block.pop(), out)
            block.exit_if_exhausted()
            out.write(" ")

    _block(stream, form, name)


def pprint_progn(stream, form, *_):
    pprint_linear(stream, form)


def pprint_prog2(stream, form, *_):
    """``progv``, ``multiple-value-bind``, ``prog2``: two distinguished arguments, then forms."""

    def body(kind):
        def print_it(out, block):
            _first(out, block)
            _indent(out, 3)
            out.write(" ")
            newline_if_pretty(out, kind)
            _output(block.pop(), out)
            block.exit_if_exhausted()
            out.write(" ")
            newline_if_pretty(out, "linear")
            _output(block.pop(), out)
            block.exit_if_exhausted()
            _indent(out, 1)
            _each(out, block, "linear")

        return print_it

    _block(stream, form, body("linear" if form.car is sym("PROGV") else "fill"))


def pprint_quote(stream, form, *_):
    if is_pair(form):
        name = symbol_name(form.car)
        if name == "QUASIQUOTE" or DECLARATION_QUOTES.value:
            stream.write({"FUNCTION": "#'", "QUASIQUOTE": "`"}.get(name, "'"))
            _output(form.cdr.car, stream)
            return
    pprint_fill(stream, form)


def pprint_declare(stream, form, *_):
    with bound(DECLARATION_QUOTES, None):
        _block(stream, form, _spread_call)


def pprint_setq(stream, form, *_):
    def body(out, block):
        _first(out, block)
        out.write(" ")
        if not isinstance(form.cdr, Cons):
            out.write(". ")
        newline_if_pretty(out, "miser")
        call_logical_block(out, form.cdr, pairs)

    def pairs(out, block):
        while True:
            _indent(out, 2)
            _output(block.pop(), out)
            block.exit_if_exhausted()
            out.write(" ")
            newline_if_pretty(out, "fill")
            _indent(out, 0)
            _output(block.pop(), out)
            block.exit_if_exhausted()
            out.write(" ")
            newline_if_pretty(out, "mandatory")

    _block(stream, form, body)


def _tagbody_rest(out, block):
    while True:
        block.exit_if_exhausted()
        out.write(" ")
        form = block.pop()
        _indent(out, 1 if isinstance(form, Cons) else 0)
        newline_if_pretty(out, "linear")
        _output(form, out)


def pprint_tagbody(stream, form, *_):
    def body(out, block):
        _first(out, block)
        _tagbody_rest(out, block)

    _block(stream, form, body)


def _clauses(print_clause):
    def body(out, block):
        _first(out, block)
        out.write(" ")
        _indent(out, 3)
        newline_if_pretty(out, "fill")
        _output(block.pop(), out)
        _indent(out, 1)
        while not block.exhausted:
            out.write(" ")
            newline_if_pretty(out, "linear")
            _block(out, block.pop(), print_clause)

    return body


def _case_clause(out, block):
    block.exit_if_exhausted()
    pprint_fill(out, block.pop())
    _each(out, block, "linear")


def pprint_case(stream, form, *_):
    _block(stream, form, _clauses(_case_clause))


def pprint_typecase(stream, form, *_):
    _block(stream, form, _clauses(_one_binding))


def _definition(methods):
    def body(out, block):
        _first(out, block)
        out.write(" ")
        newline_if_pretty(out, "miser")
        _indent(out, 0, "current")
        _output(block.pop(), out)
        block.exit_if_exhausted()
        out.write(" ")
        if methods:
            _output(block.pop(), out)
            block.exit_if_exhausted()
            out.write(" ")
        newline_if_pretty(out, "fill")
        pprint_lambda_list(out, block.pop())
        _indent(out, 1)
        _each(out, block, "linear")

    return body


def pprint_defun(stream, form, *_):
    _block(stream, form, _definition(False))


def pprint_defmethod(stream, form, *_):
    rest = form.cdr
    plain = isinstance(rest, Cons) and isinstance(rest.cdr, Cons) and isinstance(rest.cdr.car, Cons)
    _block(stream, form, _definition(not plain))


def pprint_defpackage(stream, form, *_):
    def option(out, block):
        _first(out, block)
        out.write(" ")
        _indent(out, 0, "current")
        newline_if_pretty(out, "miser")
        _rest_linear(out, block)

    def body(out, block):
        _output(block.pop(), out)
        block.exit_if_exhausted()
        out.write(" ")
        _indent(out, 3)
        newline_if_pretty(out, "fill")
        _output(block.pop(), out)
        block.exit_if_exhausted()
        _indent(out, 1)
        while not block.exhausted:
            newline_if_pretty(out, "mandatory")
            _block(out, block.pop(), option)

    _block(stream, form, body)


def pprint_destructuring_bind(stream, form, *_):
    def body(out, block):
        _first(out, block)
        _indent(out, 3)
        out.write(" ")
        newline_if_pretty(out, "linear")
        pprint_lambda_list(out, block.pop())
        block.exit_if_exhausted()
        out.write(" ")
        newline_if_pretty(out, "linear")
        _output(block.pop(), out)
        block.exit_if_exhausted()
        _indent(out, 1)
        _each(out, block, "linear")

    _block(stream, form, body)


def pprint_do(stream, form, *_):
    def bindings(out, block):
        while not block.exhausted:
            _block(out, block.pop(), _do_binding)
            block.exit_if_exhausted()
            newline_if_pretty(out, "mandatory")

    def body(out, block):
        _first(out, block)
        out.write(" ")
        _indent(out, 0, "current")
        _block(out, block.pop(), bindings)
        block.exit_if_exhausted()
        out.write(" ")
        newline_if_pretty(out, "linear")
        pprint_linear(out, block.pop())
        _tagbody_rest(out, block)

    _block(stream, form, body)


def pprint_dolist(stream, form, *_):
    def body(out, block):
        _first(out, block)
        _indent(out, 3)
        out.write(" ")
        newline_if_pretty(out, "fill")
        _block(out, block.pop(), _dolist_binding)
        _tagbody_rest(out, block)

    _block(stream, form, body)


def pprint_prog(stream, form, *_):
    def body(out, block):
        _first(out, block)
        out.write(" ")
        newline_if_pretty(out, "miser")
        pprint_fill(out, block.pop())
        _tagbody_rest(out, block)

    _block(stream, form, body)


_LOOP_WORDS = frozenset(
    "AND WITH FOR INITIALLY FINALLY DO DOING COLLECT COLLECTING APPEND APPENDING NCONC NCONCING COUNT COUNTING SUM "
    "SUMMING MAXIMIZE MAXIMIZING MINIMIZE MINIMIZING IF WHEN UNLESS END WHILE UNTIL REPEAT ALWAYS NEVER THEREIS".split()
)


def pprint_loop(stream, form, *_):
    if not isinstance(form.cdr, Cons) or isinstance(form.cdr.car, Cons):
        _block(stream, form, _spread_call)
        return

    def body(out, block):
        _first(out, block)
        out.write(" ")
        _indent(out, 0, "current")
        _output(block.pop(), out)
        block.exit_if_exhausted()
        out.write(" ")
        while True:
            item = block.pop()
            if is_symbol(item) and symbol_name(item) in _LOOP_WORDS:
                newline_if_pretty(out, "mandatory")
            _output(item, out)
            block.exit_if_exhausted()
            out.write(" ")

    _block(stream, form, body)


def pprint_if(stream, form, *_):
    def body(out, block):
        _first(out, block)
        out.write(" ")
        _indent(out, 0, "current")
        _output(block.pop(), out)
        _each(out, block, "mandatory")

    _block(stream, form, body)
