"""How fluents, tasks and tree nodes are printed (cpl.md 2.2, 3.1, 7.3). Printing reads nothing that reading would change."""

from __future__ import annotations

from ..lisp.data import truth
from ..lisp.pretty import logical_block, pprint_newline
from ..lisp.printer import define_printer, prin1_to_string, princ_to_string, print_unreadable, write
from .fluents import Fluent, ValueFluent
from .symbols import sym
from .tasks import Task, ToplevelTask
from .tree import TaskTreeNode

VERBOSITY = sym("CPL-IMPL::*TASK-PPRINT-VERBOSITY*")


def print_fluent(fluent, stream):
    """``#<FLUENT NAME>``, with the value in brackets for value fluents; a line is broken before the bracket."""
    with logical_block(stream, "#<", ">") as out:
        out.write("FLUENT " + princ_to_string(fluent.name))
        if isinstance(fluent, ValueFluent):
            out.write(" ")
            pprint_newline("linear", out)
            out.write("[")
            write(fluent.stored, out, True)
            out.write("]")


def print_task(task, stream):
    """``#<TASK "NAME" {address}>``; with ``*task-pprint-verbosity*`` above 0 the status too."""
    text = ("TOPLEVEL-TASK " if isinstance(task, ToplevelTask) else "TASK ") + prin1_to_string(task.name)
    verbosity = VERBOSITY.value
    if truth(verbosity) and isinstance(verbosity, int) and verbosity > 0:
        text += " " + prin1_to_string(task.status)
    print_unreadable(task, stream, text, identity=True)


def print_node(node, stream):
    """``#<TASK-TREE-NODE :PATH path :CHILD-COUNT n {address}>``."""
    print_unreadable(node, stream, f"TASK-TREE-NODE :PATH {prin1_to_string(node.path)} :CHILD-COUNT {len(node.children)}", identity=True)


define_printer(Fluent, print_fluent)
define_printer(Task, print_task)
define_printer(TaskTreeNode, print_node)
