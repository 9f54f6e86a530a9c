"""``disassemble`` and ``function-lambda-expression``: what the compiler made of a function, and what it made it of.

The machine code of cramhy is Python: a function is shown as the Python text that its form was compiled to, which is what
``pdb`` and tracebacks walk through; a function that was written in Python as it was written. Without a text, Python's byte
code is shown. Source: ANSI 25.2 (DISASSEMBLE), 5.3 (FUNCTION-LAMBDA-EXPRESSION).
"""

from __future__ import annotations

import ast
import contextlib
import io

from cramhy_runtime.ground.keyword_calls import KeywordCalls
from cramhy_runtime.ground.conditions import type_error
from cramhy_runtime.ground.data import Cons, MultipleValues, Symbol, truth
from cramhy_runtime.ground.dynamic import binding
from ..evaluation.control import fdefinition
from ..evaluation.evaluator import PACKAGE, Unit, compile_lambda, compiler
from ..evaluation.function_facts import defining_forms, lambda_expression, plain, position_of, shown_name
from cramhy_runtime.ground.dispatch.generic_functions import GenericFunction
from cramhy_runtime.ground.packages import sym
from ..objects.makers import Maker
from ..printer.printer import prin1_to_string
from ..streams.streams import output_stream

LISP_NAMES = "disassemble function-lambda-expression"
SETF, LAMBDA = sym("SETF"), sym("LAMBDA")


def function_lambda_expression(function):
    """Three values: the lambda expression if its text is still there, t (it may close over variables), the name."""
    if not callable(function) or isinstance(function, (Symbol, type)):
        return type_error(function, "FUNCTION")
    return MultipleValues((lambda_expression(function), True, getattr(plain(function), "__lisp_name__", None)))


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


def python_text(function):
    """The Python text of a compiled function, made again from its form; ``None`` when the form is not there."""
    code = getattr(function, "__code__", None)
    for form, positions, package in defining_forms(function):
        unit = Unit(code.co_filename, positions)
        with binding(PACKAGE, package):
            for part in unit.toplevel_parts(form):
                for node in ast.walk(compiler().python_tree(unit.statements(part))):
                    if isinstance(node, (ast.FunctionDef, ast.Lambda)) and _is_it(node, code):
                        return ast.unparse(_Named(unit.namespace).visit(node))
    return None


def _is_it(node, code):
    """Whether the text ``node`` became the code object ``code``."""
    names = [argument.arg for argument in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]
    return (
        node.lineno == code.co_firstlineno
        and getattr(node, "name", "<lambda>") == code.co_name
        and names == list(code.co_varnames[: len(names)])
    )


class _Named(ast.NodeTransformer):
    """Puts the Lisp names of constants and runtime functions for the numbered names that the compiler gives them."""

    def __init__(self, namespace):
        self.namespace = namespace

    def visit_Name(self, node):
        value = self.namespace.get(node.id)
        if node.id[:1] == "K" and node.id[1:].isdigit() and truth(value):
            if isinstance(value, Symbol):
                return ast.Name(f"«{prin1_to_string(value)}»", node.ctx)
            if value.__class__ is dict:  # of effective functions
                return ast.Name("{" + ", ".join(sorted(each.__name__ for each in value)) + "}", node.ctx)
            if value.__class__ is set:  # of classes whose slot the code takes itself
                return ast.Name("{" + ", ".join(sorted(each.__name__ for each in value)) + "}", node.ctx)
            if isinstance(value, KeywordCalls):
                return ast.Name(f"«{prin1_to_string(value.symbol)}»", node.ctx)
            if isinstance(value, Maker):
                return ast.Name(f"«{prin1_to_string(value.name)}»", node.ctx)
            name = getattr(value, "__name__", None)
            if callable(value) and name:
                return ast.Name(name, node.ctx)
            return ast.Name(f"«{prin1_to_string(value)}»", node.ctx)
        return node
