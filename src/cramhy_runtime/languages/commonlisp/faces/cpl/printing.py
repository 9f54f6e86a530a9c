"""How fluents, tasks and tree nodes are printed (cpl.md 2.2, 3.1, 7.3) and described. Printing reads nothing that reading would change."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Symbol, list_from, truth
from cramhy_runtime.lisp_core.packages import keyword
from ...printer.pretty import logical_block, pprint_newline
from ...printer.printer import print_as_symbols, write
from cramhy_runtime.lisp_core.printing import address, define_printer, print_unreadable
from cramhy_runtime.lisp_core.printing import prin1_to_string, princ_to_string
from ...tools.describing import describe_facts, describe_object
from cramhy_runtime.cpl.fluents.fluents import Fluent, ValueFluent
from .plan_tree import PlanTreeNode
from cramhy_runtime.cpl.symbols import sym
from cramhy_runtime.cpl.task_variables import TaskStateSymbol
from cramhy_runtime.cpl.tasks.tasks import AbstractTask, ToplevelTask
from cramhy_runtime.cpl.tree.task_tree import Code, TaskTreeNode

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


SWITCHES = {
    "*task-tree-node-print-path*": keyword("FULL"),
    "*task-tree-node-print-code*": None,
    "*task-tree-node-print-children*": keyword("COUNT"),
    "*task-tree-node-print-identity*": True,
}
"""What of a task tree node is printed: its path, ``:full``, ``:one`` for the last part, or nil; its code; its children, ``:full``,
``:count`` or nil; its address."""


def print_node(node, stream):
    """``#<TASK-TREE-NODE :PATH path :CHILD-COUNT n {address}>``, on several lines if one is too short (`SWITCHES`)."""
    path, code, children, identity = (sym(f"CPL-IMPL::{name.upper()}").value for name in SWITCHES)
    parts = []
    if truth(path):
        parts.append((":PATH", node.path if path is not ONE or node.path is None else node.path.car))
    if truth(code):
        parts.append((":CODE", node.effective_code))
    if truth(children):
        full = children is FULL
        parts.append(
            (":CHILDREN", list_from([child for child in reversed(node.children.values())]))
            if full
            else (":CHILD-COUNT", len(node.children))
        )

    with logical_block(stream, "#<", ">") as out:
        _write_parts(out, "TASK-TREE-NODE", parts)
        if truth(identity):
            out.write(f" {{{address(node)}}}")


def print_code(code, stream):
    """As the structure that it is in CRAM: ``#S(CODE :SEXP form :FUNCTION function :TASK task :PARAMETERS list)``."""
    with logical_block(stream, "#S(", ")") as out:
        _write_parts(
            out,
            prin1_to_string(CODE),
            [(":SEXP", code.sexp), (":FUNCTION", code.function), (":TASK", code.task), (":PARAMETERS", code.parameters)],
        )


def print_plan_node(node, stream):
    """``#(PLAN-TREE-NODE :SEXP form :PATH path :CHILDREN (node...))``."""
    with logical_block(stream, "#(", ")") as out:
        _write_parts(out, "PLAN-TREE-NODE", [(":SEXP", node.sexp), (":PATH", node.path), (":CHILDREN", node.children)])


def _write_parts(out, name, parts):
    out.write(name)
    for label, value in parts:
        out.write(" ")
        pprint_newline("linear", out)
        out.write(label + " ")
        write(value, out, True)


FULL, ONE, CODE = keyword("FULL"), keyword("ONE"), sym("CPL-IMPL::CODE")


def describe_fluent(fluent, stream):
    """What it is called and worth, how often it pulsed, and who observes it."""
    waiting = [task.owner or Symbol(str(task.name)) for task in fluent.waiters]
    return describe_facts(
        fluent,
        stream,
        "fluent",
        [
            ("Name", fluent.name),
            ("Value", fluent.peek()),
            ("Pulses", fluent.pulses),
            ("Waiting tasks", list_from(waiting)),
            ("Fluents computed from it", list_from(fluent.living_nets())),
            ("Callbacks", list_from(list(fluent.callbacks or ()))),
        ],
    )


def describe_task(task, stream):
    """What it does now, what came of it, and its place in the tree of tasks."""
    facts = [("Name", task.name), ("Status", task.status), ("Parent", task.parent), ("Children", list_from(list(task.children)))]
    if task.dead:
        facts.append(("Result", task.result if not isinstance(task.result, tuple) else list_from(task.result)))
    elif task.kernel_task is not None and task.kernel_task.describe_why():
        facts.append(("Waits for ", task.kernel_task.describe_why()))
    return describe_facts(task, stream, "task", [*facts, ("Path", task.path)])


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_printer(Fluent, print_fluent)
    define_printer(AbstractTask, print_task)
    print_as_symbols(TaskStateSymbol)
    define_printer(TaskTreeNode, print_node)
    define_printer(Code, print_code)
    define_printer(PlanTreeNode, print_plan_node)
    describe_object.method(Fluent, None)(describe_fluent)
    describe_object.method(AbstractTask, None)(describe_task)
