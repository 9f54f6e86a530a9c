"""The Python that the compiler made of a form, as a text, for ``disassemble``. It takes Python's module `ast`, 4 ms to import."""

from __future__ import annotations

import ast

from cramhy_runtime.lisp_core.data import Symbol, truth
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.keyword_calls import KeywordCalls
from ..compiler.several_values import ValuesCalls
from ..evaluation.evaluator import PACKAGE, Unit, compiler
from ..evaluation.function_facts import defining_forms
from ..objects.makers import Maker
from ..printer.printer import prin1_to_string


def python_text(function):
    """The Python text of a compiled function, made again from its form; ``None`` when the form is not there."""
    code = getattr(function, "__code__", None)
    for form, positions, package in defining_forms(function):
        unit = Unit(code.co_filename, positions)
        with binding(PACKAGE, package):
            for part in unit.toplevel_parts(form):
                nodes = ast.walk(compiler().python_tree(unit.statements(part)))
                found = [node for node in nodes if isinstance(node, (ast.FunctionDef, ast.Lambda)) and _is_it(node, code)]
                if found:  # of two of one name, the first is that which returns a tuple of values
                    return ast.unparse(_Named(unit.namespace).visit(found[-1] if isinstance(found[0], ast.FunctionDef) else found[0]))
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
            if isinstance(value, (KeywordCalls, ValuesCalls)):
                return ast.Name(f"«{prin1_to_string(value.symbol)}»", node.ctx)
            if isinstance(value, Maker):
                return ast.Name(f"«{prin1_to_string(value.name)}»", node.ctx)
            name = getattr(value, "__name__", None)
            if callable(value) and name:
                return ast.Name(name, node.ctx)
            return ast.Name(f"«{prin1_to_string(value)}»", node.ctx)
        return node
