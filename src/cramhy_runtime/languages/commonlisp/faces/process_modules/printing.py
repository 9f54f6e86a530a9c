"""How process modules are printed: ``#<NAME {address}>`` with the name of the class."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.printing import define_printer, print_unreadable
from ...tools.describing import describe_facts, describe_object
from cramhy_runtime.process_modules.modules import AbstractProcessModule, ProcessModule


def print_module(module, stream):
    print_unreadable(module, stream, type_=True, identity=True)


def describe_module(module, stream):
    """Its name and state, what it works on, and what waits in its queue."""
    facts = [("Name", module.name), ("Status", module.status_fluent.peek())]
    if isinstance(module, ProcessModule):
        facts += [
            ("Works on", module.request and module.request.input),
            ("Queue", list_from([request.input for request in module.queue])),
            ("Last result", module.result_fluent.peek()),
        ]
    return describe_facts(module, stream, "process-module", facts)


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_printer(AbstractProcessModule, print_module)
    describe_object.method(AbstractProcessModule, None)(describe_module)
