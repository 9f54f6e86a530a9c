"""How fluents, tasks and tree nodes are printed (cpl.md 2.2, 3.1, 7.3) and described. Printing reads nothing that reading would change."""

from __future__ import annotations

from ..lisp.data import Symbol, list_from, truth
from ..lisp.printer.pretty import logical_block, pprint_newline
from ..lisp.printer.printer import define_printer, prin1_to_string, princ_to_string, print_unreadable, write
from ..lisp.tools.describing import describe_facts, describe_object
from .fluents import Fluent, ValueFluent
from .symbols import sym
from .tasks import AbstractTask, ToplevelTask
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
define_printer(AbstractTask, print_task)
define_printer(TaskTreeNode, print_node)


@describe_object.method(Fluent, None)
def describe_fluent(fluent, stream):
    """What it is called and worth, how often it pulsed, and who observes it."""
    waiting = [getattr(task.local, "plan_task", None) or Symbol(str(task.name)) for task in fluent.waiters]
    return describe_facts(fluent, stream, "fluent", [
        ("Name", fluent.name), ("Value", fluent.peek()), ("Pulses", fluent.pulses), ("Waiting tasks", list_from(waiting)),
        ("Fluents computed from it", list_from(fluent.living_nets())), ("Callbacks", list_from(list(fluent.callbacks or ())))])


@describe_object.method(AbstractTask, None)
def describe_task(task, stream):
    """What it does now, what came of it, and its place in the tree of tasks."""
    facts = [("Name", task.name), ("Status", task.status), ("Parent", task.parent), ("Children", list_from(list(task.children)))]
    if task.dead:
        facts.append(("Result", task.result if not isinstance(task.result, tuple) else list_from(task.result)))
    elif task.kernel_task is not None and task.kernel_task.describe_why():
        facts.append(("Waits for ", task.kernel_task.describe_why()))
    return describe_facts(task, stream, "task", [*facts, ("Path", task.path)])
