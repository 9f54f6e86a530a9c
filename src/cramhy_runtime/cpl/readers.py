"""Reader functions with the Lisp names of slots: the name of anything that has one, the parts of codes and tree nodes."""

from __future__ import annotations

from .tree import TaskTreeNode


def name(thing):
    """The name of a fluent, task, policy or process module."""
    return thing.name


def parameters(policy):
    """The parameter names of a policy."""
    return policy.parameters


def code_sexp(code):
    return code.sexp


def code_function(code):
    return code.function


def code_task(code):
    return code.task


def code_parameters(code):
    return code.parameters


def task_tree_node_path(node):
    return node.path


def task_tree_node_code(node):
    return node.code


def task_tree_node_parent(node):
    return node.parent


def task_tree_node_p(thing):
    return True if isinstance(thing, TaskTreeNode) else None


def make_task_tree_node(*, path=None, parent=None, code=None):
    """``make-task-tree-node``: a node that belongs to no tree yet."""
    return TaskTreeNode(path, parent, code)
