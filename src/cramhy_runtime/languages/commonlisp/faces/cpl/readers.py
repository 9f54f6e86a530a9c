"""The structures of the plan language as Lisp sees them: constructors, copiers, readers and writers of codes, tree nodes and policies.

In CRAM these are ``defstruct``s; here they are Python classes, so that the machine can use their slots at full speed, and the
functions that ``defstruct`` would have made stand in this module. `WRITERS` are those for ``setf``.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.cpl.failures.failure_types import PolicyFailure
from .plan_tree import PlanTreeNode
from cramhy_runtime.cpl.forms.policies import Policy
from cramhy_runtime.cpl.tree.task_tree import Code, TaskTreeNode
from cramhy_runtime.cpl.type_checks import of


def name(thing):
    """The name of a fluent, task, policy or process module."""
    try:
        return thing.name
    except AttributeError:
        return type_error(thing, "(OR FLUENT TASK POLICY PROCESS-MODULE)")


# ---------------------------------------------------------------------------------------------------------------- policies


def parameters(thing):
    """The parameter names of a policy; the parameter forms of the use of a policy that a ``policy-failure`` tells of."""
    return thing.parameters if isinstance(thing, Policy | PolicyFailure) else type_error(thing, "(OR POLICY POLICY-FAILURE)")


@of(Policy)
def policy_name(policy):
    return policy.name


@of(Policy)
def policy_parameters(policy):
    return policy.parameters


@of(Policy)
def policy_init(policy):
    return policy.init


@of(Policy)
def policy_check(policy):
    return policy.check


@of(Policy)
def policy_recover(policy):
    return policy.recover


@of(Policy)
def policy_clean_up(policy):
    return policy.clean_up


# ------------------------------------------------------------------------------------------------------------------- codes


def make_code(*, sexp=None, function=None, task=None, parameters=None):
    """What runs at a node of the task tree."""
    return Code(sexp, function, task, parameters)


@of(Code)
def copy_code(code):
    copy = Code(code.sexp, code.function, code.task, code.parameters)
    copy.called_with = code.called_with
    return copy


def code_p(thing):
    return True if isinstance(thing, Code) else None


@of(Code)
def code_sexp(code):
    return code.sexp


@of(Code)
def code_function(code):
    return code.function


@of(Code)
def code_task(code):
    return code.task


@of(Code)
def code_parameters(code):
    return code.parameters


# --------------------------------------------------------------------------------------------------- nodes of the task tree


def make_task_tree_node(*, code=None, code_replacements=None, parent=None, children=None, path=None):
    """A node that belongs to no tree yet; ``children`` is an alist from path part to node, the newest first."""
    node = TaskTreeNode(path, parent, code)
    node.code_replacements, node.children_alist = code_replacements, children
    return node


@of(TaskTreeNode)
def copy_task_tree_node(node):
    """A node of the same contents; codes and children are shared."""
    return make_task_tree_node(
        code=node.code, code_replacements=node.code_replacements, parent=node.parent, children=node.children_alist, path=node.path
    )


def task_tree_node_p(thing):
    return True if isinstance(thing, TaskTreeNode) else None


@of(TaskTreeNode)
def task_tree_node_path(node):
    return node.path


@of(TaskTreeNode)
def task_tree_node_code(node):
    return node.code


@of(TaskTreeNode)
def task_tree_node_code_replacements(node):
    """The codes that replace its own, the newest first."""
    return node.code_replacements


@of(TaskTreeNode)
def task_tree_node_parent(node):
    return node.parent


@of(TaskTreeNode)
def task_tree_node_children(node):
    """The children as an alist from path part to node, the newest first."""
    return node.children_alist


# --------------------------------------------------------------------------------------------------- nodes of the plan tree


def make_plan_tree_node(*, sexp=None, path=None, parent=None, children=None):
    node = PlanTreeNode(sexp, path, parent)
    node.children = children
    return node


@of(PlanTreeNode)
def copy_plan_tree_node(node):
    return make_plan_tree_node(sexp=node.sexp, path=node.path, parent=node.parent, children=node.children)


def plan_tree_node_p(thing):
    return True if isinstance(thing, PlanTreeNode) else None


@of(PlanTreeNode)
def plan_tree_node_sexp(node):
    return node.sexp


@of(PlanTreeNode)
def plan_tree_node_path(node):
    return node.path


@of(PlanTreeNode)
def plan_tree_node_parent(node):
    return node.parent


@of(PlanTreeNode)
def plan_tree_node_children(node):
    """The nodes below it, in the order of the text."""
    return node.children


# ----------------------------------------------------------------------------------------------------------------- writers


def _writer(cls, slot):
    def write(value, thing):
        if not isinstance(thing, cls):
            return type_error(thing, cls.lisp_name.partition("::")[2])
        setattr(thing, slot, value)
        return value

    return write


WRITERS = {
    **{f"CODE-{slot}": _writer(Code, slot.lower()) for slot in ("SEXP", "FUNCTION", "TASK", "PARAMETERS")},
    **{
        f"TASK-TREE-NODE-{slot}": _writer(TaskTreeNode, slot.lower().replace("-", "_"))
        for slot in ("CODE", "CODE-REPLACEMENTS", "PARENT", "PATH")
    },
    "TASK-TREE-NODE-CHILDREN": _writer(TaskTreeNode, "children_alist"),
    **{f"PLAN-TREE-NODE-{slot}": _writer(PlanTreeNode, slot.lower()) for slot in ("SEXP", "PATH", "PARENT", "CHILDREN")},
}
"""Name of a reader → function of a value and an object, for ``(setf (reader object) value)``."""
