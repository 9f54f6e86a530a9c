"""How process modules are printed: ``#<NAME {address}>`` with the name of the class."""

from __future__ import annotations

from ..lisp.data import list_from
from ..lisp.printer.printer import define_printer, print_unreadable
from ..lisp.tools.describing import describe_facts, describe_object
from .modules import AbstractProcessModule, ProcessModule


def print_module(module, stream):
    print_unreadable(module, stream, type_=True, identity=True)


define_printer(AbstractProcessModule, print_module)


@describe_object.method(AbstractProcessModule, None)
def describe_module(module, stream):
    """Its name and state, what it works on, and what waits in its queue."""
    facts = [("Name", module.name), ("Status", module.status_fluent.peek())]
    if isinstance(module, ProcessModule):
        facts += [("Works on", module.request and module.request.input),
                  ("Queue", list_from([request.input for request in module.queue])), ("Last result", module.result_fluent.peek())]
    return describe_facts(module, stream, "process-module", facts)
