"""``disassemble`` and ``function-lambda-expression``: what the compiler made of a function, and what it made it of.

The machine code of cramhy is Python: a function is shown as the Python text that its form was compiled to, which is what
``pdb`` and tracebacks walk through; a function that was written in Python as it was written. Without a text, Python's byte
code is shown. Source: ANSI 25.2 (DISASSEMBLE), 5.3 (FUNCTION-LAMBDA-EXPRESSION).
"""

from __future__ import annotations

import contextlib
import io

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import Cons, MultipleValues, Symbol
from ..evaluation.control import fdefinition
from ..evaluation.evaluator import compile_lambda
from ..evaluation.function_facts import lambda_expression, plain, position_of, shown_name
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from cramhy_runtime.lisp_core.packages import sym
from ..printer.printer import prin1_to_string
from ..printer.standard_printers import function_name
from ..streams.streams import output_stream

LISP_NAMES = "disassemble function-lambda-expression"
SETF, LAMBDA = sym("SETF"), sym("LAMBDA")


def function_lambda_expression(function):
    """Three values: the lambda expression if its text is still there, t (it may close over variables), the name."""
    if not callable(function) or isinstance(function, (Symbol, type)):
        return type_error(function, "FUNCTION")
    name = getattr(plain(function), "__lisp_name__", None)
    return MultipleValues((lambda_expression(function), True, function_name(function) if name is None else name))


def _function_named(designator):
    if isinstance(designator, Cons) and designator.car is LAMBDA:
        return compile_lambda(designator)
    if isinstance(designator, Cons) and designator.car is SETF and isinstance(designator.cdr, Cons):
        return fdefinition(designator)
    if isinstance(designator, Symbol):
        return designator.macro.source if hasattr(designator.macro, "source") else fdefinition(designator)
    if callable(designator):
        return designator
    return type_error(designator, "(OR FUNCTION SYMBOL (CONS (EQL SETF)) (CONS (EQL LAMBDA)))")


def disassemble(fn, *, stream=None, use_labels=None):
    """``disassemble``: print the Python that a function (or its name, or a lambda expression) was compiled to; nil."""
    output = output_stream(stream)
    function = plain(_function_named(fn))
    name = getattr(function, "__lisp_name__", None)
    shown = shown_name(name) if name is not None else prin1_to_string(function)
    output.fresh_line()
    if isinstance(function, GenericFunction):
        for method in function.methods:
            output.write(f"; {prin1_to_string(method)}\n")
            _show(method.function, output)
        return None
    output.write(f"; Python of {shown}\n")
    _show(function, output)
    return None


def _show(function, output):
    from .python_texts import python_text

    text = python_text(function)
    if text is None and position_of(function) is None:
        with contextlib.suppress(OSError, TypeError):
            import inspect

            text = inspect.getsource(function).rstrip("\n")
    if text is None:
        code = io.StringIO()
        with contextlib.redirect_stdout(code), contextlib.suppress(TypeError):
            import dis

            dis.dis(function)
        text = code.getvalue().rstrip("\n") or "; It is part of Python itself, which shows no code of it."
    output.write(text + "\n")
